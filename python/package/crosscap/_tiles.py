"""Clouds in chunks and in tiles, and what is done to one of them, by whoever holds it.

Workers import this module and no more.
"""

import mmap
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from . import _crosscap, _stores

# Rows of an array or a file that are read at a time.
_ROWS_READ = 1_000_000


@dataclass(frozen=True)
class Chunk:
    """Some rows of a cloud, one after the other, and how to get them."""

    count: int
    load: Any
    arguments: tuple = ()


@dataclass(frozen=True)
class Cloud:
    """A cloud in chunks, in the order of its rows."""

    chunks: list
    width: int

    @property
    def count(self):
        return sum(chunk.count for chunk in self.chunks)

    @property
    def firsts(self):
        counts = [chunk.count for chunk in self.chunks]
        return np.concatenate([[0], np.cumsum(counts)]).astype(int).tolist()


def cloud(points):
    """The chunks of what a caller calls points.

    Raises
    ------
    ValueError
        These are no rows of coordinates.
    """
    if isinstance(points, str | Path):
        return _of_path(Path(points))
    if hasattr(points, "to_delayed"):
        return _of_dask(points)
    if isinstance(points, np.memmap) and isinstance(points.base, mmap.mmap) and points.filename:
        _checked(points.shape, "the array")
        order = "C" if points.flags.c_contiguous else "F"
        mapped = (str(points.filename), points.dtype.str, points.offset, points.shape, order)
        return Cloud(_sliced(len(points), _read_map, mapped), points.shape[1])
    points = np.asarray(points)
    _checked(points.shape, "the array")
    cuts = range(0, len(points), _ROWS_READ)
    slices = [points[at : at + _ROWS_READ] for at in cuts]
    return Cloud([Chunk(len(own), same, (own,)) for own in slices], points.shape[1])


def _checked(shape, what):
    if len(shape) != 2 or shape[1] < 1:
        raise ValueError(f"{what}: found shape {tuple(shape)}, expected rows of coordinates")


def _of_path(path):
    kinds = (".npy", *_stores.SUFFIXES)
    files = [path]
    if path.is_dir():
        files = sorted(file for file in path.iterdir() if file.suffix.lower() in kinds)
    if not files:
        raise ValueError(
            f"{path}: found no {' or '.join(kinds)} file, expected chunks of points, in the order of their names"
        )
    chunks, widths = [], set()
    for file in files:
        if _stores.is_store(file):
            pieces, width = _stores.parts(file)
            chunks += [Chunk(*piece) for piece in pieces]
        else:
            shape = np.load(file, mmap_mode="r").shape
            _checked(shape, file)
            width = shape[1]
            chunks += _sliced(shape[0], _read_file, (str(file),))
        widths.add(width)
    if len(widths) > 1:
        raise ValueError(f"{path}: found rows of {sorted(widths)} coordinates, expected one number")
    return Cloud(chunks, widths.pop())


def _sliced(count, read, arguments):
    cuts = range(0, count, _ROWS_READ)
    ends = [(at, min(at + _ROWS_READ, count)) for at in cuts]
    return [Chunk(end - at, read, (*arguments, at, end)) for at, end in ends]


def _of_dask(points):
    _checked(points.shape, "the array")
    if points.numblocks[1] > 1:
        points = points.rechunk({1: -1})
    if any(np.isnan(points.chunks[0])):
        points = points.compute_chunk_sizes()
    blocks = points.to_delayed().ravel()
    chunks = [Chunk(n, block) for n, block in zip(points.chunks[0], blocks, strict=True)]
    return Cloud(chunks, points.shape[1])


# What is done to chunks and tiles. All of it can be done again.


def same(value):
    return value


def _read_file(path, start, stop):
    return np.load(path, mmap_mode="r")[start:stop]


def _read_map(path, kind, offset, shape, order, start, stop):
    return np.memmap(path, kind, "r", offset, shape, order)[start:stop]


def _aligned(array, kind=None):
    # What came over the network may begin anywhere in memory.
    return np.require(array, kind, ["C", "A"])


def _rows(points, first):
    points = _aligned(points, np.float64)
    wrong = np.argwhere(~np.isfinite(points))
    if len(wrong):
        row, column = wrong[0]
        raise ValueError(f"row {first + row}, column {column} is not a finite number")
    return points


def sampled(points, first, step):
    return _rows(points[-first % step :: step], first)


def split(points, first, tiling, halo, ranks):
    """For every tile the points of a chunk that it holds, their rows and their ranks."""
    points = _rows(points, first)
    rows = np.arange(first, first + len(points), dtype=np.uint32)
    members = _crosscap.tile_members(tiling, points, halo)
    return [(points[own], rows[own], ranks[own]) for own in members]


def joined(*pieces):
    return tuple(np.concatenate(part) for part in zip(*pieces, strict=True))


def answer(tile, number, tiling, halo, question):
    return _crosscap.tile_answer(tiling, number, halo, *map(_aligned, tile), question)


def dimension(tile, number, tiling, estimator, eps, dt):
    points, rows, _ = tile
    found = _crosscap.tile_dimension(tiling, number, _aligned(points), estimator, eps, dt)
    return {**found, "rows": rows[found["own"]]}

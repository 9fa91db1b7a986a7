"""Who holds the tiles of a cloud: files of this machine, or the workers of a cluster."""

import operator
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from . import _tiles


class Here:
    """Tiles in files of a folder, looked at one after the other, or a few side by side."""

    def __init__(self, threads, folder=None):
        self.threads = threads
        self._folder = tempfile.TemporaryDirectory(prefix="crosscap-", dir=folder)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._folder.cleanup()

    def each(self, chunks, function, arguments):
        return [function(_loaded(c), *a) for c, a in zip(chunks, arguments, strict=True)]

    def tiles(self, chunks, arguments, count):
        """Makes `count` tiles of what `split` says of every chunk, in the place of those that are there."""
        folder = Path(self._folder.name)
        for file in folder.iterdir():
            file.unlink()
        tiles = [[folder / f"{number}.{part}" for part in range(3)] for number in range(count)]
        width = 0
        for chunk, own in zip(chunks, arguments, strict=True):
            for files, piece in zip(tiles, _tiles.split(_loaded(chunk), *own), strict=True):
                width = piece[0].shape[1]
                for file, part in zip(files, piece, strict=True):
                    with file.open("ab") as out:
                        part.tofile(out)
        self._tiles, self._width = tiles, width

    def ask(self, function, arguments):
        """What `function` says of every tile, its number and these arguments."""

        def one(number):
            points, rows, ranks = self._tiles[number]
            tile = (
                np.fromfile(points).reshape(-1, self._width),
                np.fromfile(rows, np.uint32),
                np.fromfile(ranks, np.uint32),
            )
            return function(tile, number, *arguments)

        with ThreadPoolExecutor(self.threads) as pool:
            return list(pool.map(one, range(len(self._tiles))))


def _loaded(chunk):
    if hasattr(chunk.load, "compute"):
        return chunk.load.compute()
    return chunk.load(*chunk.arguments)


class There:
    """Tiles held by the workers of a client of Dask, which makes them anew where one is lost."""

    def __init__(self, client):
        self.client = client
        self.threads = sum(client.nthreads().values())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._tiles = []

    def each(self, chunks, function, arguments):
        futures = self._of_chunks(chunks, function, arguments)
        return self.client.gather(futures)

    def _of_chunks(self, chunks, function, arguments):
        submit = self.client.submit
        return [
            submit(function, self._chunk(chunk), *own, pure=False)
            for chunk, own in zip(chunks, arguments, strict=True)
        ]

    def _chunk(self, chunk):
        if hasattr(chunk.load, "compute"):
            return self.client.compute(chunk.load)
        return self.client.submit(chunk.load, *chunk.arguments, pure=False)

    def tiles(self, chunks, arguments, count):
        submit = self.client.submit
        split = self._of_chunks(chunks, _tiles.split, arguments)
        self._tiles = [
            submit(_tiles.joined, *(submit(operator.getitem, own, tile, pure=False) for own in split), pure=False)
            for tile in range(count)
        ]

    def ask(self, function, arguments):
        # Sent once; whoever lost it gets it again.
        arguments = [self.client.submit(_tiles.same, one, pure=False) for one in arguments]
        futures = [
            self.client.submit(function, tile, number, *arguments, pure=False)
            for number, tile in enumerate(self._tiles)
        ]
        return self.client.gather(futures)

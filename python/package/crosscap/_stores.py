"""Points in Parquet and HDF5, by the libraries that their users have: pyarrow and h5py, which nothing else here needs."""

from importlib import import_module
from pathlib import Path

import numpy as np

# What each is read by.
_LIBRARIES = {".parquet": "pyarrow", ".h5": "h5py", ".hdf5": "h5py"}
SUFFIXES = tuple(_LIBRARIES)
# Names of coordinates, and of the array of points, where nothing is said.
_COORDINATES = ("x", "y", "z")
_POINTS = ("points", "vertices")


def is_store(path):
    """Whether a path has one of the suffixes."""
    return Path(path).suffix.lower() in _LIBRARIES


def parts(path, *, array=None, columns=None):
    """What a file is read in, one after the other, ``(rows, function, arguments)`` each; and the number of coordinates."""
    store = _Parquet if _kind(path) == ".parquet" else _Hdf5
    return store(path, array, columns).parts()


def read(path, *, array=None, transpose=False, columns=None):
    """All points of a file, one a row."""
    pieces, _ = parts(path, array=array, columns=None if transpose else columns)
    points = np.concatenate([function(*arguments) for _, function, arguments in pieces])
    if transpose:
        points = points.T
        points = points[:, _picked(path, columns, [str(k) for k in range(points.shape[1])])]
    wrong = np.argwhere(~np.isfinite(points))
    if len(wrong):
        row, column = wrong[0]
        found = points[row, column]
        raise ValueError(f"{path}: row {row}, column {column} (from 0): found {found}, expected a finite number")
    return np.ascontiguousarray(points)


def _kind(path):
    return Path(path).suffix.lower()


def _library(path, module=None):
    name = _LIBRARIES[_kind(path)]
    try:
        return import_module(module or name)
    except ImportError as error:
        raise ImportError(
            f"{path}: reading {_kind(path)} needs {name}, which is not installed: pip install crosscap[files]"
        ) from error


def _picked(path, columns, names):
    """Numbers of the columns that are coordinates."""
    if columns == "all" or columns is None:
        named = {name.lower(): k for k, name in enumerate(names)}
        if columns is None and all(name in named for name in _COORDINATES):
            return [named[name] for name in _COORDINATES]
        return list(range(len(names)))
    found = []
    for item in columns.split(","):
        item = item.strip()
        first, _, last = item.partition("-")
        if item in names:
            found.append(names.index(item))
        elif first.isdigit() and (last or first).isdigit():
            found += range(int(first), int(last or first) + 1)
        else:
            raise ValueError(f"{path}: found columns {', '.join(names)}, expected {item!r} among them")
    if max(found) >= len(names):
        raise ValueError(f"{path}: found {len(names)} columns, expected number {max(found)} among them")
    return found


class _Parquet:
    def __init__(self, path, array, columns):
        if array is not None:
            raise ValueError(f"{path}: found array={array!r}, expected none: a table has columns=")
        self._path = str(path)
        self._file = _library(path, "pyarrow.parquet").ParquetFile(path)
        types = _library(path, "pyarrow.types")
        kinds = (types.is_floating, types.is_integer)
        fields = self._file.schema_arrow
        names = [field.name for field in fields if any(kind(field.type) for kind in kinds)]
        if not names:
            raise ValueError(f"{path}: found no column of numbers, expected coordinates")
        self._names = [names[k] for k in _picked(path, columns, names)]

    def parts(self):
        groups = range(self._file.num_row_groups)
        counts = [self._file.metadata.row_group(k).num_rows for k in groups]
        pieces = [(n, _row_group, (self._path, k, self._names)) for k, n in zip(groups, counts, strict=True)]
        return pieces, len(self._names)


def _row_group(path, number, names):
    table = _library(path, "pyarrow.parquet").ParquetFile(path).read_row_group(number, columns=names)
    # An entry that is missing is no number.
    columns = [table.column(name).to_numpy(zero_copy_only=False) for name in names]
    return np.column_stack([np.asarray(column, float) for column in columns])


class _Hdf5:
    # Rows that are read at a time.
    _ROWS = 1_000_000

    def __init__(self, path, array, columns):
        self._path = str(path)
        with _library(path).File(path, "r") as file:
            found = {}

            def look(name, item):
                if _is_matrix(item):
                    found[name] = item.shape

            file.visititems(look)
            self._name = _chosen(path, array, found)
            self._count, width = found[self._name]
        self._columns = _picked(path, columns, [str(k) for k in range(width)])

    def parts(self):
        cuts = range(0, self._count, self._ROWS)
        ends = [(at, min(at + self._ROWS, self._count)) for at in cuts]
        pieces = [(b - a, _slab, (self._path, self._name, self._columns, a, b)) for a, b in ends]
        return pieces, len(self._columns)


def _is_matrix(item):
    shape, kind = getattr(item, "shape", None), getattr(item, "dtype", None)
    return shape is not None and len(shape) == 2 and kind is not None and kind.kind in "fiu"


def _chosen(path, array, found):
    told = ", ".join(f"{name} {shape[0]} x {shape[1]}" for name, shape in found.items()) or "none"
    if array is not None:
        if array in found:
            return array
        raise ValueError(f"{path}: found the matrices {told}, expected {array!r} among them")
    names = [name for name in _POINTS if name in found] or list(found)
    if len(names) == 1 or names and names[0] in _POINTS:
        return names[0]
    raise ValueError(f"{path}: found the matrices {told}, expected one, or array= to name it")


def _slab(path, name, columns, start, stop):
    with _library(path).File(path, "r") as file:
        return np.asarray(file[name][start:stop], float)[:, columns]

"""Points in Parquet and HDF5."""

import sys

import numpy as np
import pytest

import crosscap
import crosscap.tiles


@pytest.fixture(scope="module")
def torus():
    return crosscap.sample("torus", 3000, random_state=2).points


def told(surface):
    mesh = surface.mesh_
    return [array.tobytes() for array in (mesh.vertices, mesh.triangles, mesh.point_index)]


def test_tables_in_parquet(torus, tmp_path):
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    columns = dict(zip(("time", "X", "y", "z"), (np.arange(3000), *torus.T), strict=True))
    table = pyarrow.table({**columns, "name": ["a"] * 3000})
    path = tmp_path / "part-0.parquet"
    # Row groups are the parts that are read at a time.
    parquet.write_table(table.slice(0, 1700), path, row_group_size=600)
    parquet.write_table(table.slice(1700), tmp_path / "part-1.parquet")
    np.testing.assert_array_equal(crosscap.read_points(path), torus[:1700])
    assert crosscap.read_points(path, columns="time,z")[7].tolist() == [7, torus[7, 2]]
    assert crosscap.read_points(path, columns="all").shape == (1700, 4)
    whole = crosscap.tiles.reconstruct(torus, 0.6, 0.3, surface=True, tiles=2)
    found = crosscap.tiles.reconstruct(tmp_path, 0.6, 0.3, surface=True, tiles=3)
    assert told(found) == told(whole)
    with pytest.raises(ValueError, match=r"found columns time, X, y, z, expected 'w'"):
        crosscap.read_points(path, columns="w")
    missing = pyarrow.table({"x": [1.0, None], "y": [0.0, 1.0], "z": [0.0, 1.0]})
    parquet.write_table(missing, path)
    with pytest.raises(ValueError, match=r"row 1, column 0 \(from 0\): found nan"):
        crosscap.read_points(path)


def test_matrices_in_hdf5(torus, tmp_path):
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "cloud.h5"
    with h5py.File(path, "w") as file:
        file["scan/places"] = torus
        file["scan/times"] = np.arange(3000)
    np.testing.assert_array_equal(crosscap.read_points(path), torus)
    np.testing.assert_array_equal(crosscap.read_points(path, columns="0,2"), torus[:, [0, 2]])
    whole = crosscap.tiles.reconstruct(torus, 0.6, 0.3, surface=True, tiles=2)
    assert told(crosscap.tiles.reconstruct(path, 0.6, 0.3, surface=True, tiles=3)) == told(whole)
    with h5py.File(path, "a") as file:
        file["turned"] = torus.T
    with pytest.raises(ValueError, match="scan/places 3000 x 3, turned 3 x 3000, expected one, or array="):
        crosscap.read_points(path)
    np.testing.assert_array_equal(crosscap.read_points(path, array="turned", transpose=True), torus)


@pytest.mark.parametrize("name", ["points.parquet", "points.h5", "points.hdf5"])
def test_a_library_that_is_not_there_is_named(name, tmp_path, monkeypatch):
    library = "pyarrow" if name.endswith("parquet") else "h5py"
    monkeypatch.setitem(sys.modules, library, None)
    monkeypatch.setitem(sys.modules, f"{library}.parquet", None)
    with pytest.raises(ImportError, match=rf"{name}: reading .* needs {library}.*pip install crosscap\[files\]"):
        crosscap.read_points(tmp_path / name)

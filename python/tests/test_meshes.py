"""Meshes: findings, files, pages, other libraries."""

import importlib

import numpy as np
import pytest

import crosscap

TETRAHEDRON = crosscap.Mesh(
    [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]
)


def library(name):
    """The real library, skipped with a reason where it is not installed."""
    return pytest.importorskip(name, reason=f"{name} is not installed: its bridge is not tried")


def test_homology_of_meshes_from_arrays(spheres):
    assert crosscap.homology(TETRAHEDRON) == ((1, 0, 1), (1, 0, 1), (), 2)
    found = crosscap.homology(spheres.mesh_)
    assert found.betti == (1, 0, 3) and found.torsion == ()


def test_edges_with_other_numbers_of_triangles_are_curves(spheres):
    bare = crosscap.Mesh(spheres.vertices_, spheres.triangles_)
    order = np.lexsort(spheres.curve_edges_.T[::-1])
    assert np.array_equal(bare.curve_edges, spheres.curve_edges_[order])
    assert set(bare.curve_cells) == {4}


def test_a_mesh_is_checked(sphere):
    surface = crosscap.SurfaceReconstruction(eps=0.4, dl=0.2, surface=True).fit(sphere)
    assert crosscap.check(surface.mesh_, sphere, dl=0.2, closed=True).verified
    torn = crosscap.Mesh(surface.vertices_, surface.triangles_[1:])
    found = crosscap.check(torn, sphere, dl=0.2, closed=True)
    assert not found.verified and found.homology.betti == (1, 0, 0)
    assert {"edges", "links"} & {reason.level for reason in found.reasons}
    assert "disc" in found.description


def test_a_mesh_is_checked_by_what_noisy_points_say():
    points = crosscap.sample("sphere", 2000, random_state=3, noise=0.03).points
    points = np.vstack([points, [[2.5, 0, 0], [0, -3, 1]]])
    mesh = crosscap.SurfaceReconstruction(random_state=1).fit(points).mesh_
    found = crosscap.check(mesh, points)
    assert found.verified
    assert found.report["preparation"]["outliers"] == [2000, 2001]
    assert found.report["preparation"]["moved"] > 0.01
    # The points as they are: two of them are far from the mesh.
    as_given = crosscap.check(mesh, points, prepare=False)
    assert not as_given.verified and "preparation" not in as_given.report
    # Nor does noise excuse what is wrong.
    torn = crosscap.Mesh(mesh.vertices, mesh.triangles[1:], metadata=mesh.metadata)
    assert not crosscap.check(torn, points, closed=True).verified


def test_a_mesh_is_checked_by_what_it_tells_of_itself(sphere, tmp_path):
    mesh = crosscap.SurfaceReconstruction(eps=0.4, dl=0.2, surface=True).fit(sphere).mesh_
    assert mesh.metadata["dl"] == 0.2 and mesh.metadata["verified"]
    assert crosscap.check(mesh, sphere).report["certificate"] == (
        crosscap.check(mesh, sphere, dl=0.2, prepare=False).report["certificate"]
    )
    crosscap.write_mesh(tmp_path / "mesh.npz", mesh)
    assert crosscap.read_mesh(tmp_path / "mesh.npz").metadata == mesh.metadata
    told = {**mesh.metadata, "special_points": [7]}
    with pytest.raises(ValueError, match="special points"):
        crosscap.check(crosscap.Mesh(mesh.vertices, mesh.triangles, metadata=told))


def test_arrays_that_are_no_mesh_are_refused():
    with pytest.raises(ValueError, match="vertices"):
        crosscap.Mesh([1.0, 2.0, 3.0], [[0, 1, 2]])
    with pytest.raises(ValueError, match="out of range"):
        crosscap.homology(crosscap.Mesh(np.eye(3), [[0, 1, 7]]))
    with pytest.raises(ValueError, match="negative"):
        crosscap.Mesh(np.eye(3), [[0, 1, -1]])
    with pytest.raises(ValueError, match="expected 3"):
        crosscap.Mesh(np.eye(4), [[0, 1, 2, 3]])


@pytest.mark.parametrize("extension", ["npz", "vtu", "ply", "obj", "off"])
def test_files_go_round(extension, spheres, tmp_path):
    path = tmp_path / f"mesh.{extension}"
    crosscap.write_mesh(path, spheres.mesh_)
    mesh = crosscap.read_mesh(path)
    assert np.array_equal(mesh.vertices, spheres.vertices_)
    assert crosscap.homology(mesh).betti == (1, 0, 3)
    if extension == "npz":
        assert np.array_equal(mesh.triangle_piece, spheres.mesh_.triangle_piece)
        assert mesh.metadata["parameters"]["eps"] == 0.3


def test_points_go_round(sphere, tmp_path):
    np.save(tmp_path / "points.npy", sphere)
    assert np.array_equal(crosscap.read_points(tmp_path / "points.npy"), sphere)
    (tmp_path / "points.csv").write_text("x,y\n1,2\n3,word\n")
    with pytest.raises(ValueError, match="line 3, column 2"):
        crosscap.read_points(tmp_path / "points.csv")
    (tmp_path / "named.csv").write_text("time,x,y,z\n7,1,2,3\n8,4,5,6\n")
    with pytest.warns(UserWarning, match='time.*columns="all" takes'):
        assert crosscap.read_points(tmp_path / "named.csv").tolist() == [[1, 2, 3], [4, 5, 6]]
    chosen = crosscap.read_points(tmp_path / "named.csv", columns="time,2")
    assert chosen.tolist() == [[7, 2], [8, 5]]


def test_isomap_unrolls(spheres):
    found = crosscap.isomap(spheres.mesh_, 2)
    assert found.places.shape == (len(spheres.vertices_), 2)
    assert found.components == 1 and 0 < found.residual_variance < 1


def test_a_fitted_surface_shows_as_a_page(spheres):
    bundle = spheres._repr_mimebundle_()
    assert bundle["text/html"].startswith("<iframe srcdoc=") and "SurfaceRec" in bundle["text/plain"]
    assert "&lt;!DOCTYPE html&gt;" in bundle["text/html"]
    page = spheres.mesh_.page("Two spheres")
    assert "Two spheres" in page and "verified" in page
    # Not fitted: what scikit-learn shows.
    assert "iframe" not in crosscap.SurfaceReconstruction()._repr_html_()


def test_pyvista(spheres):
    library("pyvista")
    mesh = spheres.to_pyvista()
    assert mesh.n_points == len(spheres.vertices_)
    assert mesh.n_cells == len(spheres.triangles_) + len(spheres.curve_edges_)
    lines = mesh.cell_data["cells"] > 0
    assert lines.sum() == len(spheres.curve_edges_) and set(mesh.cell_data["cells"][lines]) == {4}
    on_curve = np.unique(mesh.extract_cells(lines).point_data["point_index"])
    assert np.array_equal(on_curve, np.unique(spheres.point_index_[spheres.curve_edges_]))


def test_trimesh(spheres):
    library("trimesh")
    mesh = spheres.to_trimesh()
    assert np.array_equal(mesh.faces, spheres.triangles_)
    assert np.array_equal(mesh.vertices, spheres.vertices_)
    area = sum(piece.area for piece in spheres.pieces_)
    assert mesh.area == pytest.approx(area)
    assert set(mesh.face_attributes["piece"]) == {0, 1}


def test_meshio(spheres, tmp_path):
    meshio = library("meshio")
    mesh = spheres.to_meshio()
    mesh.write(tmp_path / "mesh.vtu")
    again = meshio.read(tmp_path / "mesh.vtu")
    assert np.array_equal(again.cells_dict["triangle"], spheres.triangles_)
    assert np.array_equal(again.cells_dict["line"], spheres.curve_edges_)
    assert set(again.cell_data_dict["cells"]["line"]) == {4}


def test_open3d(spheres):
    library("open3d")
    mesh = spheres.to_open3d()
    assert np.array_equal(np.asarray(mesh.triangles), spheres.triangles_)


def test_gudhi(spheres):
    library("gudhi")
    tree = spheres.to_gudhi_simplex_tree()
    assert tree.num_vertices() == len(spheres.vertices_)
    tree.compute_persistence(homology_coeff_field=3, persistence_dim_max=True)
    assert tuple(tree.betti_numbers()) == spheres.betti_


def test_networkx(spheres):
    networkx = library("networkx")
    graph = spheres.to_networkx()
    # The circle in which the spheres meet.
    assert len(networkx.cycle_basis(graph)) == 1
    assert all(degree == 2 for _, degree in graph.degree)
    assert {cells for *_, cells in graph.edges(data="cells")} == {4}


def test_a_library_that_is_not_there_is_named(spheres, monkeypatch):
    def absent(name):
        raise ImportError(name)

    monkeypatch.setattr(crosscap._bridges, "import_module", absent)
    for name in crosscap._bridges.BRIDGES:
        with pytest.raises(ImportError, match="pip install"):
            getattr(spheres, name)()


def test_names_of_the_package():
    assert importlib.import_module("crosscap").__version__
    assert len(crosscap.surfaces()) > 10

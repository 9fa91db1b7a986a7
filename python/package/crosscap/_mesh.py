"""Meshes: what is known about them, files, pictures."""

import json
from dataclasses import dataclass, field
from os import fspath
from typing import NamedTuple

import numpy as np

from . import _bridges, _crosscap
from ._refusal import reasons as _reasons


class Homology(NamedTuple):
    """Homology of a mesh.

    Attributes
    ----------
    betti : tuple of int
        Betti numbers over the rational numbers.
    betti_mod2 : tuple of int
        Betti numbers over the field of two elements.
    torsion : tuple of int
        Torsion coefficients of the first homology group, each dividing the next.
    euler : int
        Euler characteristic.
    """

    betti: tuple
    betti_mod2: tuple
    torsion: tuple
    euler: int


class Embedding(NamedTuple):
    """Vertices of a mesh in few dimensions.

    Attributes
    ----------
    places : ndarray of shape (n_vertices, n_dimensions)
        The places.
    residual_variance : float
        Share of the variance of the distances that the places do not show.
    components : int
        Number of connected components, laid out one by one.
    """

    places: np.ndarray
    residual_variance: float
    components: int


@dataclass(frozen=True, eq=False)
class Findings:
    """What is known about a mesh.

    Attributes
    ----------
    verified : bool
        Whether the mesh may be handed over as good.
    reasons : tuple of Reason
        Why not, if not.
    homology : Homology
        Betti numbers and torsion.
    description : str or None
        The pieces and how they meet, in a paragraph; ``None`` where they cannot be told apart.
    report : dict
        Everything that ``crosscap check --json`` prints.
    """

    verified: bool
    reasons: tuple
    homology: Homology
    description: str
    report: dict = field(repr=False)


@dataclass(frozen=True, eq=False, init=False)
class Mesh:
    """A triangulated surface that may cross itself.

    Parameters
    ----------
    vertices : array-like of shape (n_vertices, n_dimensions)
        Places of the vertices.
    triangles : array-like of int of shape (n_triangles, 3)
        Vertices of the triangles.
    curve_edges : array-like of int of shape (n_edges, 2), optional
        Edges along double curves and boundaries. When left out: the edges with another number of
        triangles than two.
    curve_cells : array-like of int of shape (n_edges,), optional
        How many triangles each of them has.
    point_index : array-like of int of shape (n_vertices,), optional
        For each vertex the row of the input that it stands for, -1 for none.
    triangle_piece : array-like of int of shape (n_triangles,), optional
        For each triangle the piece of the surface that it belongs to.
    metadata : dict, optional
        How the mesh came to be; :func:`check` goes by it.

    Examples
    --------
    >>> import crosscap
    >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    >>> mesh = crosscap.Mesh(corners, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])
    >>> crosscap.homology(mesh).betti
    (1, 0, 1)
    """

    vertices: np.ndarray
    triangles: np.ndarray
    curve_edges: np.ndarray
    curve_cells: np.ndarray
    point_index: np.ndarray
    triangle_piece: np.ndarray | None
    metadata: dict | None

    def __init__(
        self,
        vertices,
        triangles,
        curve_edges=None,
        curve_cells=None,
        point_index=None,
        triangle_piece=None,
        metadata=None,
    ):
        def keep(name, value, kind, shape):
            value = np.ascontiguousarray(value, dtype=kind)
            value = value.reshape(shape) if value.size == 0 else value
            if value.ndim != len(shape):
                raise ValueError(f"{name}: found {value.ndim} dimensions, expected {len(shape)}")
            object.__setattr__(self, name, value)

        keep("vertices", vertices, np.float64, (0, np.shape(vertices)[-1]))
        keep("triangles", triangles, np.int64, (0, 3))
        if curve_edges is None or curve_cells is None:
            curve_edges, curve_cells = _crosscap.curves(self.triangles)
        keep("curve_edges", curve_edges, np.int64, (0, 2))
        keep("curve_cells", curve_cells, np.int64, (0,))
        if point_index is None:
            point_index = np.full(len(self.vertices), -1)
        keep("point_index", point_index, np.int64, (0,))
        object.__setattr__(self, "triangle_piece", None)
        if triangle_piece is not None:
            keep("triangle_piece", triangle_piece, np.int64, (0,))
        object.__setattr__(self, "metadata", metadata)

    def __repr__(self):
        count, dimension = self.vertices.shape
        return f"<mesh: {count} vertices in R^{dimension}, {len(self.triangles)} triangles>"

    def _arrays(self):
        names = ("vertices", "triangles", "curve_edges", "curve_cells", "point_index")
        return {name: getattr(self, name) for name in names}

    def places(self):
        """The vertices in three dimensions: their own coordinates, or Isomap above three.

        Returns
        -------
        ndarray of shape (n_vertices, 3)
        """
        dimension = self.vertices.shape[1]
        if dimension > 3 and len(self.vertices):
            return isomap(self).places
        return np.pad(self.vertices, ((0, 0), (0, 3 - dimension)))

    def page(self, title="mesh", verdict=None, points=None):
        """The page on which the mesh is turned: one HTML file.

        Parameters
        ----------
        title : str, default="mesh"
            Heading.
        verdict : str, optional
            What the page says about the mesh.
        points : array-like of shape (n_points, n_dimensions), optional
            The points that it was made from, to be shown with it and colored by their distance to it.

        Returns
        -------
        str
        """
        if verdict is None:
            verified = (self.metadata or {}).get("verified")
            verdict = {True: "verified", False: "not verified"}.get(verified, "not checked")
        if points is not None:
            points = np.ascontiguousarray(points, dtype=np.float64)
        return _crosscap.page(self._arrays(), title, verdict, points)

    def _repr_html_(self):
        return _bridges.framed(self.page()) if len(self.triangles) else None

    to_pyvista = _bridges.to_pyvista
    to_trimesh = _bridges.to_trimesh
    to_meshio = _bridges.to_meshio
    to_open3d = _bridges.to_open3d
    to_gudhi_simplex_tree = _bridges.to_gudhi_simplex_tree
    to_networkx = _bridges.to_networkx


def _homology(told):
    return Homology(
        betti=tuple(told["betti_rational"]),
        betti_mod2=tuple(told["betti_mod2"]),
        torsion=tuple(int(factor) for factor in told["torsion"]),
        euler=told["euler"],
    )


def homology(mesh):
    """Betti numbers over the rational numbers and over Z/2, and torsion, exactly.

    Parameters
    ----------
    mesh : Mesh
        The mesh.

    Returns
    -------
    Homology

    Examples
    --------
    >>> import crosscap
    >>> square = crosscap.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> crosscap.homology(square)
    Homology(betti=(1, 0, 0), betti_mod2=(1, 0, 0), torsion=(), euler=1)
    """
    return _homology(json.loads(_crosscap.homology(mesh._arrays())))


def check(mesh, points=None, *, dl=None, closed=False, prepare=None, least_hole=None):
    """Ask a mesh everything that can be decided without knowing the true surface.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    points : array-like of shape (n_points, n_dimensions), optional
        The points that it was made from: distances both ways are measured.
    dl : float, optional
        Separation of the landmarks; when left out what the mesh was made with, as its metadata tell,
        or 3/4 of the median edge.
    closed : bool, default=False
        Whether the surface is known to have no boundary.
    prepare : bool, optional
        Whether outliers are left out and noise is allowed for, as a reconstruction without parameters
        does: a mesh is smoother than points that scatter, and would be refused for that. What was
        found is in ``report["preparation"]``. When left out what the mesh was made with, and true for
        a mesh from elsewhere.
    least_hole : float, optional
        Width of the narrowest hole that the surface may have, in spacings of the points, where you know
        it: narrower gaps of the points may be covered. When left out what the mesh was made with.

    Returns
    -------
    Findings

    Examples
    --------
    >>> import crosscap
    >>> corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    >>> open_mesh = crosscap.Mesh(corners, [[0, 1, 2], [0, 1, 3], [0, 2, 3]])
    >>> crosscap.check(open_mesh, closed=True).verified
    False
    """
    if points is not None:
        points = np.ascontiguousarray(points, dtype=np.float64)
    metadata = json.dumps(mesh.metadata)
    known = {"dl": dl, "closed": closed, "prepare": prepare, "least_hole": least_hole}
    told = json.loads(_crosscap.check(mesh._arrays(), metadata, points, known))
    return Findings(
        verified=told["verified"],
        reasons=_reasons(told.pop("reasons")),
        homology=_homology(told["homology"]),
        description=told["description"],
        report=told,
    )


def isomap(mesh, dimension=3, *, landmarks=300):
    """Lay a mesh out in few dimensions, keeping distances along it as well as can be.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    dimension : int, default=3
        Number of coordinates.
    landmarks : int, default=300
        Number of vertices from which distances are computed.

    Returns
    -------
    Embedding

    Examples
    --------
    >>> import crosscap
    >>> square = crosscap.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> crosscap.isomap(square, 2).places.shape
    (4, 2)
    """
    return Embedding(**_crosscap.isomap(mesh._arrays(), dimension, landmarks))


def read_mesh(path):
    """Read a mesh from a file; the extension names the format.

    Parameters
    ----------
    path : str or path-like
        The file: ``.npz`` keeps everything; ``.vtu``, ``.ply``, ``.obj``, ``.off``, ``.stl``.

    Returns
    -------
    Mesh

    Raises
    ------
    ValueError
        With the file, the place, what was found and what was expected.

    Examples
    --------
    >>> import crosscap, tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp(), "triangle.off")
    >>> _ = path.write_text("OFF\\n3 1 0\\n0 0 0\\n1 0 0\\n0 1 0\\n3 0 1 2\\n")
    >>> crosscap.read_mesh(path)
    <mesh: 3 vertices in R^3, 1 triangles>
    """
    told = _crosscap.read_mesh(fspath(path))
    told["metadata"] = json.loads(told["metadata"])
    return Mesh(**told)


def write_mesh(path, mesh):
    """Write a mesh, whole or not at all; the extension names the format.

    Parameters
    ----------
    path : str or path-like
        The file: ``.npz`` keeps everything; ``.vtu``, ``.ply``, ``.obj``, ``.off``, ``.stl``, ``.glb``.
    mesh : Mesh
        The mesh.

    Examples
    --------
    >>> import crosscap, tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp(), "triangle.ply")
    >>> crosscap.write_mesh(path, crosscap.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
    >>> len(crosscap.read_mesh(path).triangles)
    1
    """
    pieces = mesh.triangle_piece
    _crosscap.write_mesh(
        fspath(path),
        mesh._arrays(),
        None if pieces is None else pieces.tolist(),
        json.dumps(mesh.metadata),
    )

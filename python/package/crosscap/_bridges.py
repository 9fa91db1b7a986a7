"""Meshes as other libraries have them. Each library is imported when it is asked for."""

import html
from importlib import import_module

import numpy as np


def _library(name):
    try:
        return import_module(name)
    except ImportError as error:
        raise ImportError(f"this needs {name}: pip install {name}") from error


BRIDGES = (
    "to_pyvista",
    "to_trimesh",
    "to_meshio",
    "to_open3d",
    "to_gudhi_simplex_tree",
    "to_networkx",
)


def to_pyvista(self):
    """The mesh for PyVista: triangles, then the curves as lines.

    Returns
    -------
    pyvista.PolyData
        With ``piece`` (triangles; -1 for a line), ``cells`` (how many triangles meet in a line; -1 for a
        triangle) and ``point_index`` (vertices).
    """
    pyvista = _library("pyvista")
    edges, count = self.curve_edges, len(self.triangles)
    mesh = pyvista.PolyData(
        self.places(),
        faces=np.insert(self.triangles, 0, 3, axis=1).ravel(),
        lines=np.insert(edges, 0, 2, axis=1).ravel() if len(edges) else None,
    )
    # VTK counts lines before faces.
    mesh.cell_data["piece"] = np.concatenate([np.full(len(edges), -1), _pieces(self)])
    mesh.cell_data["cells"] = np.concatenate([self.curve_cells, np.full(count, -1)])
    mesh.point_data["point_index"] = self.point_index
    return mesh


def to_trimesh(self):
    """The mesh for trimesh, vertices in their order.

    Returns
    -------
    trimesh.Trimesh
        With the face attribute ``piece`` and the vertex attribute ``point_index``.
    """
    trimesh = _library("trimesh")
    return trimesh.Trimesh(
        self.places(),
        self.triangles,
        process=False,
        face_attributes={"piece": _pieces(self)},
        vertex_attributes={"point_index": self.point_index},
    )


def to_meshio(self):
    """The mesh for meshio: a block of triangles and one of lines.

    Returns
    -------
    meshio.Mesh
        With ``piece`` and ``cells`` as cell data and ``point_index`` as point data.
    """
    meshio = _library("meshio")
    edges = self.curve_edges
    none = [np.full(len(edges), -1), np.full(len(self.triangles), -1)]
    return meshio.Mesh(
        self.places(),
        [("triangle", self.triangles), ("line", edges)],
        point_data={"point_index": self.point_index},
        cell_data={"piece": [_pieces(self), none[0]], "cells": [none[1], self.curve_cells]},
    )


def to_open3d(self):
    """The mesh for Open3D.

    Returns
    -------
    open3d.geometry.TriangleMesh
    """
    open3d = _library("open3d")
    mesh = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(self.places()),
        open3d.utility.Vector3iVector(self.triangles.astype(np.int32)),
    )
    return mesh


def to_gudhi_simplex_tree(self):
    """The mesh for GUDHI: all its simplices, with filtration value 0.

    Returns
    -------
    gudhi.SimplexTree
    """
    gudhi = _library("gudhi")
    tree = gudhi.SimplexTree()
    for simplices in (np.arange(len(self.vertices))[:, None], self.curve_edges, self.triangles):
        if len(simplices):
            tree.insert_batch(simplices.T.astype(np.int32), np.zeros(len(simplices)))
    return tree


def to_networkx(self):
    """The curves for NetworkX: double curves, boundaries, junctions.

    Returns
    -------
    networkx.Graph
        Nodes are vertices, with ``place`` and ``point_index``; edges have ``cells``, the number of
        triangles that meet in them, and ``length``.
    """
    networkx = _library("networkx")
    graph = networkx.Graph()
    for (a, b), cells in zip(self.curve_edges.tolist(), self.curve_cells.tolist(), strict=True):
        for v in (a, b):
            graph.add_node(v, place=self.vertices[v], point_index=int(self.point_index[v]))
        length = float(np.linalg.norm(self.vertices[a] - self.vertices[b]))
        graph.add_edge(a, b, cells=cells, length=length)
    return graph


def framed(page):
    """A page inside a page: its script and style stay its own."""
    return (
        f'<iframe srcdoc="{html.escape(page)}" width="100%" height="640" '
        'style="border:0" sandbox="allow-scripts" title="Crosscap"></iframe>'
    )


def _pieces(mesh):
    if mesh.triangle_piece is None:
        return np.zeros(len(mesh.triangles), dtype=np.int64)
    return mesh.triangle_piece

"""Triangulated surfaces that may cross themselves, from point clouds in any dimension.

>>> import crosscap
>>> cloud = crosscap.sample("sphere", 2000)
>>> surface = crosscap.SurfaceReconstruction(surface=True).fit(cloud.points)
>>> surface.betti_
(1, 0, 1)
"""

from . import laws
from ._crosscap import __version__
from ._compare import ComparedRun, compare
from ._dimension import LocalDimension, dimension
from ._mesh import Embedding, Findings, Homology, Mesh, check, homology, isomap
from ._mesh import read_mesh, write_mesh
from ._reconstruction import Piece, SurfaceReconstruction
from ._plugins import Decomposition
from ._refusal import Place, Reason, Refusal, RefusalWarning
from ._sample import Sample, read_points, sample, surfaces

__all__ = [
    "ComparedRun",
    "Decomposition",
    "Embedding",
    "Findings",
    "Homology",
    "LocalDimension",
    "Mesh",
    "Piece",
    "Place",
    "Reason",
    "Refusal",
    "RefusalWarning",
    "Sample",
    "SurfaceReconstruction",
    "__version__",
    "check",
    "compare",
    "dimension",
    "homology",
    "isomap",
    "laws",
    "read_mesh",
    "read_points",
    "sample",
    "surfaces",
    "write_mesh",
]

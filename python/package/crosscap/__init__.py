"""Triangulated surfaces that may cross themselves, from point clouds in any dimension.

>>> import crosscap
>>> cloud = crosscap.sample("sphere", 2000)
>>> surface = crosscap.SurfaceReconstruction(surface=True).fit(cloud.points)
>>> surface.betti_
(1, 0, 1)
"""

from importlib import import_module

from ._crosscap import __version__

# Where the names are. They are imported when they are asked for: the command line needs none of them, and
# scikit-learn takes a second.
_HOMES = {
    "_compare": ("ComparedRun", "compare"),
    "_dimension": ("LocalDimension", "dimension"),
    "_mesh": (
        "Embedding",
        "Findings",
        "Homology",
        "Mesh",
        "check",
        "homology",
        "isomap",
        "read_mesh",
        "write_mesh",
    ),
    "_plugins": ("Decomposition",),
    "_reconstruction": ("Piece", "SurfaceReconstruction"),
    "_refusal": ("Place", "Reason", "Refusal", "RefusalWarning"),
    "_sample": ("Sample", "read_points", "sample", "surfaces"),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

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


def __getattr__(name):
    if name == "laws":
        return import_module(".laws", __name__)
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f".{_HOME[name]}", __name__), name)
    globals()[name] = value
    return value


def __dir__():
    return sorted(__all__)

"""From points to a verified surface, as an estimator of scikit-learn."""

import io
import json
import warnings
from contextlib import contextmanager
from dataclasses import dataclass
from numbers import Integral

import joblib
import numpy as np
import scipy.sparse
from sklearn.base import BaseEstimator
from sklearn.utils import check_random_state
from sklearn.utils.validation import validate_data

from . import _bridges, _crosscap, _plugins
from ._mesh import Mesh, _homology
from ._refusal import Refusal, RefusalWarning, refusal as _refusal

# Stages of a run, for the progress bar.
_STAGES = ("index", "neighborhoods", "landmarks", "triangulation", "homology", "certificate")
# Fewest points that are worked on.
_LEAST_POINTS = 8


@dataclass(frozen=True)
class Piece:
    """A connected piece of a surface, its crossings taken apart.

    Attributes
    ----------
    name : str
        Name of the surface, such as ``"Klein bottle"``.
    orientable : bool
        Whether it has two sides.
    genus : int
        Number of handles when orientable, of crosscaps when not.
    boundary_circles : int
        Number of circles in which it ends.
    euler : int
        Euler characteristic.
    vertices, edges, triangles : int
        Numbers of them; those on double curves count once for each sheet.
    area : float
        Sum of the areas of its triangles.
    """

    name: str
    orientable: bool
    genus: int
    boundary_circles: int
    euler: int
    vertices: int
    edges: int
    triangles: int
    area: float


class SurfaceReconstruction(BaseEstimator):
    """Reconstruct a surface that may cross itself from points sampled from it.

    Lengths are in the unit of the data.

    Parameters
    ----------
    eps : float or "auto", default="auto"
        Radius of the neighborhoods in which dimension and crossings are looked for.
    dl : float or "auto", default="auto"
        Distance that landmarks, the vertices of the mesh, keep from each other.
    tri_eps : float, optional
        Largest radius of the charts; 3 ``dl`` when left out.
    dt : float, optional
        Share of the variance that may lie outside the dimension; 0.05 when left out.
    dp : float, optional
        Largest root mean squared distance of a neighborhood to its model; ``eps / 5`` when left out.
    ep : float, optional
        A point closer than this to both sheets is on the curve; ``eps / 10`` when left out.
    models : "auto" or sequence of str and models of your own, default="auto"
        Singularity models that compete, such as ``["two-planes", "boundary"]``. Your own has
        ``local_dimension`` and ``decompose(points, fitted, center, radius)``, and returns a
        :class:`Decomposition`, or ``None`` where it does not apply.
    metric : {"euclidean", "geodesic", "lifted", "precomputed"} or a metric of your own, default="euclidean"
        Metric of the analysis. With ``"precomputed"`` ``X`` holds the distances of all points, or of near ones
        in a sparse matrix; distances of no points in a Euclidean space need ``surface=True``. Your own: a function of a point and an array of points to an array of
        distances, or a class whose instances are made of ``X`` and have ``distances(i, rows)``. It has
        to obey the laws: see :func:`crosscap.laws.check`.
    tri_metric : str or a metric of your own, optional
        Metric of the charts; that of the analysis when left out, or, where lengths are left to the program
        too, distances along the surface if it cannot do without.
    neighborhoods : str, optional
        ``"radius"`` (as when left out), ``"k-nearest:K"`` or ``"adaptive:K"``.
    estimator : str or an estimator of your own, default="pca"
        Estimator of the local dimension: see :class:`LocalDimension`. Your own has
        ``estimate(points, distances, radius)``, points nearest first, and returns a number, or dimension,
        value and confidence, or ``None`` where there are too few points.
    boundary : array-like of int, optional
        Rows of points on the boundary.
    surface : bool, default=False
        Whether the surface is known not to cross itself.
    method : {"cells", "paper"}, default="cells"
        The method, or the published algorithm to the letter.
    prepare : bool, optional
        Whether outliers are left out, and points that scatter moved onto fits of their neighborhoods. When left
        out the program decides, where it chooses lengths. Never with a metric of your own.
    least_hole : float, optional
        Width of the narrowest hole that the surface may have, in spacings of the points, where you know it. Gaps
        that are no chance are taken for holes otherwise, as they are at the seams of a scan.
    tries : int, default=7
        Attempts at most, where lengths are left to the program: what a failed one showed decides on the next.
    time_limit : float, optional
        No further attempt begins after so many seconds.
    on_refusal : {"raise", "warn", "ignore"}, default="raise"
        What to do when there is no verified mesh. What there is, is kept in either case.
    random_state : int, RandomState or None, default=0
        Seed of the choice of landmarks.
    n_jobs : int, optional
        Number of threads, as scikit-learn counts them. It changes no result.
    verbose : bool, default=False
        Whether to show progress, where ``tqdm`` is installed.

    Attributes
    ----------
    vertices_ : ndarray of shape (n_vertices, n_dimensions)
        Places of the vertices.
    triangles_ : ndarray of shape (n_triangles, 3)
        Vertices of the triangles.
    curve_edges_ : ndarray of shape (n_edges, 2)
        Edges along double curves, junctions and boundaries.
    curve_cells_ : ndarray of shape (n_edges,)
        How many triangles meet in each of them.
    point_index_ : ndarray of shape (n_vertices,)
        For each vertex the row of ``X`` that it stands for.
    mesh_ : Mesh
        All of that in one.
    pieces_ : tuple of Piece
        What the surface is, its crossings taken apart; empty where that cannot be told.
    description_ : str or None
        The same in a paragraph, with how the pieces meet.
    betti_, betti_mod2_ : tuple of int
        Betti numbers over the rational numbers and over Z/2.
    torsion_ : tuple of int
        Torsion coefficients of the first homology group.
    verdict_ : {"verified", "refused"}
        Whether the mesh may be handed over as good.
    refusal_ : Refusal or None
        Why not, if not.
    certificate_ : dict
        Every level of validity with what was measured.
    report_ : dict
        Parameters, counts and times, and all of the above.
    eps_, dl_ : float
        The radius and the separation that were used.
    n_features_in_ : int
        Number of coordinates of the points.

    Examples
    --------
    >>> import crosscap
    >>> cloud = crosscap.sample("two-spheres", 30_000, thin=0.03)
    >>> surface = crosscap.SurfaceReconstruction(eps=0.25, dl=0.1, models=["two-planes"])
    >>> surface.fit(cloud.points).betti_
    (1, 0, 3)
    >>> [piece.name for piece in surface.pieces_]
    ['sphere', 'sphere']
    """

    def __init__(
        self,
        eps="auto",
        dl="auto",
        *,
        tri_eps=None,
        dt=None,
        dp=None,
        ep=None,
        models="auto",
        metric="euclidean",
        tri_metric=None,
        neighborhoods=None,
        estimator="pca",
        boundary=None,
        surface=False,
        method="cells",
        prepare=None,
        least_hole=None,
        tries=7,
        time_limit=None,
        on_refusal="raise",
        random_state=0,
        n_jobs=None,
        verbose=False,
    ):
        self.eps = eps
        self.dl = dl
        self.tri_eps = tri_eps
        self.dt = dt
        self.dp = dp
        self.ep = ep
        self.models = models
        self.metric = metric
        self.tri_metric = tri_metric
        self.neighborhoods = neighborhoods
        self.estimator = estimator
        self.boundary = boundary
        self.surface = surface
        self.method = method
        self.prepare = prepare
        self.least_hole = least_hole
        self.tries = tries
        self.time_limit = time_limit
        self.on_refusal = on_refusal
        self.random_state = random_state
        self.n_jobs = n_jobs
        self.verbose = verbose

    def fit(self, X, y=None):
        """Reconstruct the surface that the rows of ``X`` were sampled from.

        Parameters
        ----------
        X : array-like of shape (n_points, n_dimensions) or array-like or sparse of shape (n_points, n_points)
            The points, at least 8 of them; or their distances, where the metric is ``"precomputed"``.
        y : ignored

        Returns
        -------
        SurfaceReconstruction
            Itself.

        Raises
        ------
        Refusal
            There is no mesh that may be handed over as good, and ``on_refusal`` is ``"raise"``. The
            attributes hold what there is.
        ValueError
            A parameter or the points make no sense.
        KeyboardInterrupt
            The run was stopped.
        """
        if self.on_refusal not in ("raise", "warn", "ignore"):
            raise ValueError(
                f"on_refusal is {self.on_refusal!r}, expected 'raise', 'warn' or 'ignore'"
            )
        precomputed = isinstance(self.metric, str) and self.metric == "precomputed"
        X = validate_data(
            self,
            X,
            accept_sparse=("csr", "csc", "coo") if precomputed else False,
            dtype=np.float64,
            order="C",
            ensure_min_samples=_LEAST_POINTS,
            ensure_min_features=2,
        )
        with _progress(self.verbose) as progress:
            if precomputed:
                mesh, why = _crosscap.reconstruct_distances(*_file(X), self._settings(), progress)
            else:
                mesh, why = _crosscap.reconstruct(X, self._settings(), progress)
        refusal = None if why is None else _refusal(why)
        if mesh is None:
            self._keep_nothing()
        else:
            self._keep(mesh)
        self._refuse(refusal)
        return self

    def __sklearn_tags__(self):
        tags = super().__sklearn_tags__()
        tags.input_tags.pairwise = isinstance(self.metric, str) and self.metric == "precomputed"
        tags.input_tags.sparse = tags.input_tags.pairwise
        return tags

    def _settings(self):
        def given(value, *usual):
            return None if isinstance(value, str) and value in ("auto", *usual) else value

        models = given(self.models)
        models = [models] if isinstance(models, str) else models
        return {
            "eps": given(self.eps),
            "dl": given(self.dl),
            "tri_eps": self.tri_eps,
            "dt": self.dt,
            "dp": self.dp,
            "ep": self.ep,
            "models": None if models is None else [_own(m, _plugins.model) for m in models],
            "metric": _own(given(self.metric, "euclidean", "precomputed"), _plugins.metric),
            "tri_metric": _own(self.tri_metric, _plugins.metric),
            "neighborhoods": self.neighborhoods,
            "estimator": _own(self.estimator, _plugins.estimator),
            "boundary": [] if self.boundary is None else np.asarray(self.boundary).tolist(),
            "surface": self.surface,
            "method": self.method,
            "prepare": self.prepare,
            "least_hole": self.least_hole,
            "tries": self.tries,
            "time_limit": self.time_limit,
            "seed": _seed(self.random_state),
            "threads": joblib.effective_n_jobs(self.n_jobs),
        }

    def _keep(self, told):
        report = json.loads(told.pop("report"))
        homology = _homology(report["homology"])
        metadata = json.loads(told.pop("metadata"))
        metadata["parameters"] = report["parameters"]
        self._keep_mesh(Mesh(**told, metadata=metadata))
        self.pieces_ = _pieces(report["pieces"])
        self.description_ = report["description"]
        self.betti_, self.betti_mod2_ = homology.betti, homology.betti_mod2
        self.torsion_ = homology.torsion
        self.certificate_ = report["certificate"]
        self.report_ = report
        self.eps_ = report["parameters"]["eps"]
        self.dl_ = report["parameters"]["dl"]

    def _keep_nothing(self):
        self._keep_mesh(Mesh(np.empty((0, self.n_features_in_)), np.empty((0, 3))))
        self.pieces_, self.description_ = (), None
        self.betti_ = self.betti_mod2_ = (0, 0, 0)
        self.torsion_ = ()
        self.certificate_, self.report_ = {}, {}

    def _keep_mesh(self, mesh):
        self.mesh_ = mesh
        self.vertices_ = mesh.vertices
        self.triangles_ = mesh.triangles
        self.curve_edges_ = mesh.curve_edges
        self.curve_cells_ = mesh.curve_cells
        self.point_index_ = mesh.point_index

    def _refuse(self, refusal):
        self.refusal_ = refusal
        self.verdict_ = "verified" if refusal is None else "refused"
        if refusal is None or self.on_refusal == "ignore":
            return
        if self.on_refusal == "raise":
            raise refusal
        warnings.warn(str(refusal), RefusalWarning, stacklevel=3)

    def _repr_html_(self):
        if hasattr(self, "mesh_"):
            return self.mesh_._repr_html_()
        return super()._repr_html_inner()

    def _repr_mimebundle_(self, **kwargs):
        # That of scikit-learn would come before the page.
        bundle = {"text/plain": repr(self), "text/html": self._repr_html_()}
        return {kind: text for kind, text in bundle.items() if text is not None}


def _delegated(name):
    bridge = getattr(_bridges, name)

    def method(self):
        return getattr(self.mesh_, name)()

    method.__name__ = name
    method.__doc__ = bridge.__doc__
    return method


for _name in _bridges.BRIDGES:
    setattr(SurfaceReconstruction, _name, _delegated(_name))


def _file(distances):
    """Name and content of a file of these distances, in the form that is read and checked."""
    file = io.BytesIO()
    if scipy.sparse.issparse(distances):
        scipy.sparse.save_npz(file, distances, compressed=False)
        return "X.npz", file.getvalue()
    np.save(file, distances)
    return "X.npy", file.getvalue()


def _own(value, adapted):
    return value if value is None or isinstance(value, str) else adapted(value)


def _seed(random_state):
    if isinstance(random_state, Integral):
        return int(random_state)
    return int(check_random_state(random_state).randint(np.iinfo(np.int32).max))


def _pieces(told):
    def piece(one):
        return Piece(**one.pop("surface"), **one)

    return tuple(piece(dict(one)) for one in told["pieces"]) if told else ()


@contextmanager
def _progress_of(wanted, count, what):
    """A bar of so many steps, where one is wanted and there is tqdm; else None."""
    try:
        from tqdm.auto import tqdm
    except ImportError:
        wanted = False
    if not wanted:
        yield None
        return
    with tqdm(total=count, desc=what) as bar:
        yield bar


@contextmanager
def _progress(wanted):
    """What shows the stages of a run, or None."""
    with _progress_of(wanted, len(_STAGES), "starting") as bar:
        if bar is None:
            yield None
            return

        def enter(at):
            attempt, stage = at.split()
            bar.set_description(stage if attempt == "1" else f"attempt {attempt}: {stage}")
            bar.n = _STAGES.index(stage)
            bar.refresh()

        yield enter
        bar.update(len(_STAGES) - bar.n)

"""Reconstruction and local dimension of a cloud in tiles, whoever holds them."""

import numpy as np

from . import _crosscap, _tiles
from ._dimension import LocalDimension
from ._reconstruction import SurfaceReconstruction, _progress, _seed
from ._refusal import refusal as _refusal

# Points that cuts are chosen from.
_SAMPLED = 100_000
# Bytes of the coordinates of a tile, about, where nothing else is said.
_TILE_BYTES = 64 * 2**20


def _cut(holder, points, halo, tiles, seed):
    """Has the holder make tiles of a cloud; returns the tiling, and what has them made anew where rows are barred from the random order.
    The seed is that of the order, if there is one."""
    count, firsts = points.count, points.firsts[:-1]
    if count == 0:
        raise ValueError("found no points")
    if count > np.iinfo(np.uint32).max:
        raise ValueError(f"found {count} points, expected fewer than 2^32")
    step = max(1, count // _SAMPLED)
    sample = holder.each(points.chunks, _tiles.sampled, [(first, step) for first in firsts])
    if tiles is None:
        tiles = max(2 * holder.threads, -(-8 * points.width * count // _TILE_BYTES))
    tiling, tiles = _crosscap.tiling(np.concatenate(sample), tiles)

    def bar(rows):
        ranks = np.zeros(count, np.uint32) if seed is None else _crosscap.random_ranks(count, seed, rows)
        ends = zip(points.firsts, points.firsts[1:], strict=False)
        arguments = [(first, tiling, halo, ranks[first:end]) for first, end in ends]
        holder.tiles(points.chunks, arguments, tiles)

    bar(np.empty(0, np.uint32))
    return tiling, bar


def reconstruct(holder, points, eps, dl, *, surface, models, tri_eps, tiles, random_state, on_refusal, verbose):
    """The surface of a cloud whose tiles a holder has."""
    found = SurfaceReconstruction(
        eps, dl, tri_eps=tri_eps, surface=surface, models=models, random_state=random_state, on_refusal=on_refusal
    )
    if on_refusal not in ("raise", "warn", "ignore"):
        raise ValueError(f"on_refusal is {on_refusal!r}, expected 'raise', 'warn' or 'ignore'")
    if isinstance(models, str) or not all(isinstance(name, str) for name in models):
        raise ValueError(f"models is {models!r}, expected a list of names: tiles are asked by those that are built in")
    points = _tiles.cloud(points)
    seed = _seed(random_state)
    settings = {"eps": eps, "dl": dl, "tri_eps": tri_eps, "surface": surface, "models": list(models), "seed": seed}
    halo = _crosscap.tile_halo(settings)
    with holder:
        tiling, bar = _cut(holder, points, halo, tiles, seed)

        def ask(question):
            return holder.ask(_tiles.answer, (tiling, halo, question))

        with _progress(verbose) as progress:
            mesh, why = _crosscap.reconstruct_tiles(
                points.count, points.width, settings, ask, bar, progress
            )
    refusal = None if why is None else _refusal(why)
    found.n_features_in_ = points.width
    found._keep(mesh)
    found._refuse(refusal)
    return found


def local_dimension(holder, points, eps, estimator, *, dt, tiles):
    """The local dimension of a cloud whose tiles a holder has."""
    points = _tiles.cloud(points)
    if not (eps > 0 and np.isfinite(eps)):
        raise ValueError(f"eps is {eps}, expected a positive length")
    with holder:
        tiling, _ = _cut(holder, points, eps, tiles, None)
        answers = holder.ask(_tiles.dimension, (tiling, estimator, eps, dt))
    found = LocalDimension(estimator, eps=eps, dt=dt)
    found.n_features_in_ = points.width
    found.dimension_ = np.full(points.count, -1)
    found.value_ = np.full(points.count, np.nan)
    found.confidence_ = np.full(points.count, np.nan)
    for own in answers:
        found.dimension_[own["rows"]] = own["dimension"]
        found.value_[own["rows"]] = own["value"]
        found.confidence_[own["rows"]] = own["confidence"]
    if (found.dimension_ < 0).all():
        raise ValueError(f"no point has enough others nearer than eps = {eps}: increase it")
    return found

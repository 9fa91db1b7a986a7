"""Dimensions of the clouds of tests/dimension.rs by scikit-dimension, printed as rows of its tables.

    python -m venv venv && venv/bin/pip install scikit-dimension==0.5.0
    venv/bin/python tests/scikit_dimension.py target/release/crosscap

Spheres and cubes are drawn here, number by number as the test draws them; the paper's surfaces by the program
whose path is given. Packing numbers are not in scikit-dimension: they are computed here from the definition.
"""

import subprocess
import sys
import tempfile
import warnings

import numpy as np
import skdim
from scipy.spatial import cKDTree

SURFACES = ["sphere", "torus", "double_torus", "moebius", "klein_r5", "rp2_r6", "two_spheres", "klein_immersion",
            "henneberg"]


class SplitMix:
    """SplitMix64 (Steele, Lea & Flood 2014)."""

    def __init__(self, seed):
        self.state = seed

    def uniform(self):
        mask = (1 << 64) - 1
        self.state = (self.state + 0x9E3779B97F4A7C15) & mask
        z = self.state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & mask
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
        return ((z ^ (z >> 31)) >> 11) / (1 << 53)

    def normal(self):
        a, b = self.uniform(), self.uniform()
        return np.sqrt(-2.0 * np.log(1.0 - a)) * np.cos(2.0 * np.pi * b)


def cloud(kind, d, n):
    draw = SplitMix(d)
    rows = np.zeros((n, 20))
    for row in rows:
        if kind == "sphere":
            x = np.array([draw.normal() for _ in range(d + 1)])
            row[: d + 1] = x / np.sqrt((x * x).sum())
        else:
            row[:d] = [draw.uniform() for _ in range(d)]
    # A reflection, so that no coordinate stays 0.
    return rows - 0.1 * rows.sum(axis=1, keepdims=True)


def packing(x, k):
    """Kegl (2003): greedy packings in random orders at the median distances of the k-th and 4k-th neighbor."""
    tree = cKDTree(x)
    far = tree.query(x, 4 * k + 1)[0]
    radii = [np.median(far[:, k]), np.median(far[:, 4 * k])]
    rng = np.random.default_rng(0)
    logs = [[], []]
    for _ in range(20):
        order = rng.permutation(len(x))
        for r, log in zip(radii, logs):
            covered = np.zeros(len(x), bool)
            size = 0
            for i in order:
                if not covered[i]:
                    size += 1
                    covered[[j for j in tree.query_ball_point(x[i], r)]] = True
            log.append(np.log(size))
    return -(np.mean(logs[1]) - np.mean(logs[0])) / np.log(radii[1] / radii[0])


def row(name, x):
    mle = skdim.id.MLE().fit(x, n_neighbors=20)
    corr = skdim.id.CorrInt(k1=10, k2=20).fit(x)
    pca = skdim.id.lPCA(ver="ratio", alphaRatio=0.95).fit(x)
    tree = skdim.id.PH(n_range_min=0.5, n_range_max=1.0, nsteps=5, subsamples=4, random_state=0).fit(x)
    local = ", ".join(f"{v:.10f}" for v in mle.dimension_pw_[:3])
    print(f'    ({name}, [{local}], {mle.dimension_:.10f}, {corr.dimension_:.8f}, {packing(x, 20):.3f}, '
          f"{tree.dimension_:.3f}, {int(pca.dimension_)}),", flush=True)


warnings.simplefilter("ignore")
for kind in ["sphere", "cube"]:
    for d in range(1, 9):
        row(f'"{kind}", {d}', cloud(kind, d, 1000))
with tempfile.TemporaryDirectory() as folder:
    for name in SURFACES:
        path = f"{folder}/{name}.npy"
        subprocess.run([sys.argv[1], "sample", name, "-n", "2000", "--seed", "1", "-o", path], check=True,
                       stdout=subprocess.DEVNULL)
        row(f'"{name}"', np.load(path))

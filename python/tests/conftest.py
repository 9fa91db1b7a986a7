"""A cloud and a surface that many tests look at."""

import pytest

import crosscap


@pytest.fixture(scope="session")
def sphere():
    return crosscap.sample("sphere", 2000, random_state=7).points


@pytest.fixture(scope="session")
def spheres():
    """Two spheres that cross, reconstructed."""
    cloud = crosscap.sample("two-spheres", 60_000, random_state=1, thin=0.04)
    return crosscap.SurfaceReconstruction(eps=0.3, dl=0.15, models=["two-planes"]).fit(cloud.points)

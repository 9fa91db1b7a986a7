"""The page in a real browser without a window, where one is installed."""

import re
import shutil
import subprocess

import numpy as np
import pytest

import crosscap

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")

# Seen from above: the first vertex is in the middle of what the panel leaves free.
ANGLES = np.arange(6) * np.pi / 3
RIM = np.column_stack([np.cos(ANGLES), np.sin(ANGLES), np.zeros(6)])
FAN = crosscap.Mesh(
    np.vstack([[0.0, 0.0, 0.0], RIM]),
    [[0, k + 1, (k + 1) % 6 + 1] for k in range(6)],
    point_index=[41, *range(6)],
)
WIDTH, HEIGHT, PANEL = 1000, 700, 310
MIDDLE = f"{(WIDTH - PANEL) / 2 / WIDTH}:0.5"


@pytest.fixture
def browse(tmp_path):
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        pytest.skip("no browser is installed: the page is not tried in one")

    def run(page, words):
        path = tmp_path / "page.html"
        path.write_text(page, encoding="utf-8")
        told = subprocess.run(
            [
                browser,
                "--headless",
                "--no-sandbox",
                "--disable-dev-shm-usage",
                "--use-angle=swiftshader",
                "--enable-unsafe-swiftshader",
                f"--user-data-dir={tmp_path / 'profile'}",
                f"--window-size={WIDTH},{HEIGHT}",
                "--virtual-time-budget=4000",
                "--dump-dom",
                f"{path.as_uri()}#{words}",
            ],
            capture_output=True,
            text=True,
            timeout=120,
        )
        assert told.returncode == 0, told.stderr
        return told.stdout

    return run


def inside(html, name):
    return re.search(rf'id="{name}"[^>]*>(.*?)</div>', html, re.DOTALL)[1]


@pytest.mark.parametrize("painter", ["", "plain,"])
def test_a_vertex_is_picked_and_numbers_color(browse, painter):
    points = np.random.default_rng(3).normal(size=(60, 3)) * [0.3, 0.3, 0.01]
    page = FAN.page("Fan", points=points)
    html = browse(page, f"{painter}color=height,pick={MIDDLE}")
    assert "vertex 0, row 41 of the points" in inside(html, "picked")
    trouble = inside(html, "trouble")
    assert "failed" not in trouble and "Nothing" not in trouble
    assert painter == "" or "Drawn without WebGL" in trouble
    names = re.findall(r"<option[^>]*>([^<]*)</option>", html)
    assert {"piece", "height", "dimension", "distance to the mesh"} <= set(names)
    # The ramp with its ends is shown.
    assert '<div id="scale">' in html and "linear-gradient" in html


def test_what_was_refused_is_marked(browse, tmp_path):
    cloud = crosscap.sample("sphere", 2000, random_state=7).points
    np.save(tmp_path / "cap.npy", cloud[cloud[:, 2] > -0.6])
    told = crosscap._crosscap.main(
        ["crosscap", "reconstruct", str(tmp_path / "cap.npy"), "-o", str(tmp_path / "cap.npz")]
        + ["--eps", "0.4", "--dl", "0.2", "--models", "two-planes", "--tries", "1"]
        + ["--surface", "--picture", str(tmp_path / "cap.html")]
    )
    assert told == 1
    html = browse((tmp_path / "cap.html").read_text(encoding="utf-8"), "points")
    assert ">marks<" in html and '"mark_texts":["row ' in html
    assert ">refused<" in html

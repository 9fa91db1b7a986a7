"""The command line that comes with the wheel."""

import os
import subprocess
import sys
import sysconfig

import crosscap


def run(*arguments, program=(sys.executable, "-m", "crosscap")):
    return subprocess.run([*program, *arguments], capture_output=True, text=True)


def test_the_script_and_the_module_are_the_program(tmp_path):
    script = os.path.join(sysconfig.get_path("scripts"), "crosscap")
    for program in [(script,), (sys.executable, "-m", "crosscap")]:
        told = run("--version", program=program)
        assert (told.returncode, told.stdout) == (0, f"crosscap {crosscap.__version__}\n")


def test_exit_codes_come_through(tmp_path):
    points = tmp_path / "points.npy"
    assert run("sample", "sphere", "-n", "1500", "-o", str(points)).returncode == 0
    assert crosscap.read_points(points).shape == (1500, 3)
    mesh = str(tmp_path / "mesh.npz")
    usual = ["reconstruct", str(points), "-o", mesh, "--eps", "0.5", "--dl", "0.25"]
    assert run(*usual, "--surface").returncode == 0
    assert crosscap.homology(crosscap.read_mesh(mesh)).betti == (1, 0, 1)
    refused = run("check", mesh, "--points", str(points), "--dl", "0.001")
    assert refused.returncode == 1 and "not verified" in refused.stderr
    assert run("reconstruct", "nowhere.npy", "-o", mesh).returncode == 2

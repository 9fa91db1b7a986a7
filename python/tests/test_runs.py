"""A run beside the interpreter: threads, signals, progress."""

import signal
import subprocess
import sys
import threading
import time

import pytest

import crosscap

# A process that was started in the background of a script is deaf to Ctrl-C, and so are those that it starts.
LONG = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)
import crosscap
points = crosscap.sample("two-spheres", 200_000, thin=0.005).points
surface = crosscap.SurfaceReconstruction(eps=0.3, dl=0.05)
print("begin", flush=True)
try:
    surface.fit(points)
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""


def test_ctrl_c_stops_a_run():
    with subprocess.Popen([sys.executable, "-c", LONG], stdout=subprocess.PIPE, text=True) as run:
        assert run.stdout.readline() == "begin\n"
        time.sleep(0.5)
        run.send_signal(signal.SIGINT)
        assert run.stdout.readline() == "interrupted\n"
        assert run.wait() == 0


def test_other_threads_go_on(sphere):
    counted = 0
    done = threading.Event()

    def count():
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    other = threading.Thread(target=count)
    other.start()
    before = counted
    crosscap.SurfaceReconstruction(eps=0.4, dl=0.1, surface=True).fit(sphere)
    during = counted - before
    done.set()
    other.join()
    assert during > 2


def test_progress_goes_through_all_stages(sphere, capsys):
    pytest.importorskip("tqdm")
    crosscap.SurfaceReconstruction(eps=0.4, dl=0.2, surface=True, verbose=True).fit(sphere)
    shown = capsys.readouterr().err
    assert "certificate: 100%" in shown and "6/6" in shown


def test_an_exception_in_the_progress_ends_the_run(sphere):
    def complain(stage):
        raise LookupError(stage)

    settings = crosscap.SurfaceReconstruction(eps=0.4, dl=0.2, surface=True)._settings()
    with pytest.raises(LookupError, match="1 index"):
        crosscap._crosscap.reconstruct(sphere, settings, complain)

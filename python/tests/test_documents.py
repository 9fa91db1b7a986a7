"""Examples in the documentation run, and the stubs say what is there."""

import ast
import doctest
import importlib
import inspect
import pkgutil
import subprocess
import sys
from pathlib import Path

import pytest

import crosscap

MODULES = ["crosscap", *(f"crosscap.{m.name}" for m in pkgutil.iter_modules(crosscap.__path__))]


@pytest.mark.parametrize("name", [m for m in MODULES if not m.endswith(("__main__", "._crosscap"))])
def test_examples(name):
    failed, _ = doctest.testmod(importlib.import_module(name), optionflags=doctest.ELLIPSIS)
    assert failed == 0


def test_every_public_thing_is_documented_with_an_example_somewhere():
    for name in crosscap.__all__:
        thing = getattr(crosscap, name)
        if callable(thing):
            assert thing.__doc__ and len(thing.__doc__) > 20, name


def test_every_public_name_is_there_and_the_command_line_needs_none():
    assert set(dir(crosscap)) == set(crosscap.__all__)
    assert set(crosscap._HOME) | {"laws", "__version__"} == set(crosscap.__all__)
    with pytest.raises(AttributeError, match="no attribute 'cusp'"):
        crosscap.cusp
    code = "import sys, crosscap.__main__; print('sklearn' in sys.modules or 'numpy' in sys.modules)"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert told.stdout == "False\n", told.stderr


def test_the_stubs_name_what_the_extension_has():
    stub = Path(crosscap.__file__).with_name("_crosscap.pyi")
    named = {f.name: f for f in ast.parse(stub.read_text()).body if isinstance(f, ast.FunctionDef)}
    there = {n: f for n, f in inspect.getmembers(crosscap._crosscap, inspect.isbuiltin)}
    assert set(named) == set(there)
    for name, function in there.items():
        arguments = list(inspect.signature(function).parameters)
        assert [a.arg for a in named[name].args.args] == arguments, name
    assert Path(crosscap.__file__).with_name("py.typed").exists()


def test_the_stubs_are_true():
    pytest.importorskip("mypy")
    settings = Path(__file__).parent.parent / "pyproject.toml"
    asked = [sys.executable, "-m", "mypy.stubtest", "crosscap", "--concise"]
    told = subprocess.run(
        [*asked, "--ignore-missing-stub", "--mypy-config-file", str(settings)],
        capture_output=True,
        text=True,
    )
    assert told.returncode == 0, told.stdout + told.stderr

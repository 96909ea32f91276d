import ast
import importlib
import inspect
import os
import pathlib
import subprocess
import sys
import zipfile

import flexura
import flexura.env
from flexura import _flexura

PYTHON = pathlib.Path(__file__).resolve().parents[1]


def test_stubs_are_those_of_the_module():
    command = [sys.executable, PYTHON / "tools" / "make_stubs.py", "--check"]
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ)
    assert done.returncode == 0, done.stderr


def names_in(stub):
    return {node.name for node in ast.parse(stub.read_text()).body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}


def test_every_public_name_has_a_stub_and_a_docstring():
    package = PYTHON / "flexura"
    names = names_in(package / "_flexura.pyi") | names_in(package / "_program.py")
    assert {name for name in flexura.__all__ if not name.startswith("_")} <= names
    assert set(flexura.env.__all__) == names_in(package / "env.pyi")
    assert (package / "py.typed").exists()
    for module in (flexura, flexura.env):
        for name in module.__all__:
            value = getattr(module, name)
            assert name == "__version__" or inspect.getdoc(value), name


def described(member, value):
    """Returns the text on a member, without the signature that pybind11 writes."""
    text = value.fget.__doc__ if isinstance(value, property) and not value.__doc__ else value.__doc__
    return text if isinstance(value, property) else text.partition("\n\n")[2]


def test_every_member_says_what_it_is():
    for name, of in vars(_flexura).items():
        if not inspect.isclass(of) or name.startswith("_"):
            continue
        assert of.__doc__, name
        for member, value in vars(of).items():
            if not member.startswith("_") and not issubclass(of, Exception):
                value = value.__func__ if isinstance(value, staticmethod) else value
                assert described(member, value).strip(), f"{name}.{member}"


def test_the_version_is_that_of_the_project(monkeypatch):
    text = (PYTHON.parent / "CMakeLists.txt").read_text()
    assert f"project(flexura VERSION {flexura.__version__} " in text
    monkeypatch.syspath_prepend(PYTHON / "build_backend")
    backend = importlib.import_module("flexura_build")
    assert backend.version() == flexura.__version__


def test_a_wheel_has_the_package(monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(PYTHON / "build_backend")
    backend = importlib.import_module("flexura_build")
    monkeypatch.setattr(backend, "build", lambda settings: pathlib.Path(flexura.__file__).parent)
    name = backend.build_wheel(tmp_path)
    with zipfile.ZipFile(tmp_path / name) as wheel:
        wheel.extractall(tmp_path / "site")
        record = wheel.read(f"flexura-{flexura.__version__}.dist-info/RECORD").decode().splitlines()
        assert len(record) == len(wheel.namelist())
        script = wheel.getinfo(f"flexura-{flexura.__version__}.data/scripts/flexura")
        assert script.external_attr >> 16 == 0o755
    command = [sys.executable, "-c", "import flexura, flexura.env; print(flexura.__file__)"]
    environment = os.environ | {"PYTHONPATH": str(tmp_path / "site")}
    done = subprocess.run(command, capture_output=True, text=True, env=environment, cwd=tmp_path, check=True)
    assert done.stdout.strip() == str(tmp_path / "site/flexura/__init__.py")

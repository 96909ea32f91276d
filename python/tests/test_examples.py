import json
import pathlib
import subprocess
import sys

import pytest

PYTHON = pathlib.Path(__file__).resolve().parents[1]
RESULTS = {
    "campaign": "mm from its target",
    "paper_arm": "E = (-10.738, 5.201)",
    "servo": "reached after ",
    "learned_jacobian": "the tip is at its pixels after ",
    "identification": "Young's modulus 3",
}
SCRIPTS = sorted((PYTHON / "examples").glob("*.py"))
NOTEBOOKS = sorted((PYTHON / "notebooks").glob("*.ipynb"))


def check(name, printed, folder):
    assert RESULTS[name] in printed
    # A plot, or the reason why there is none.
    assert (folder / f"{name}.png").exists() is not printed.rstrip().endswith("matplotlib is not installed")


@pytest.mark.slow
@pytest.mark.parametrize("file", SCRIPTS, ids=lambda file: file.stem)
def test_examples_reach_what_they_promise(file, tmp_path):
    done = subprocess.run([sys.executable, file], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    check(file.stem, done.stdout, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_notebooks_reach_what_they_promise(file, tmp_path, monkeypatch, capsys):
    """Executes the cells in order, without Jupyter."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    names = {"__name__": "__main__"}
    for cell in json.loads(file.read_text())["cells"]:
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), f"{file.name} {cell['id']}", "exec"), names)
    check(file.stem, capsys.readouterr().out, tmp_path)


def test_notebooks_are_those_of_the_scripts():
    command = [sys.executable, PYTHON / "tools" / "make_notebooks.py", "--check"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert [file.stem for file in NOTEBOOKS] == [file.stem for file in SCRIPTS]


def test_notebooks_have_the_format_of_jupyter():
    for file in NOTEBOOKS:
        notebook = json.loads(file.read_text())
        assert (notebook["nbformat"], notebook["nbformat_minor"]) == (4, 5)
        ids = [cell["id"] for cell in notebook["cells"]]
        assert len(set(ids)) == len(ids)
        for cell in notebook["cells"]:
            expected = {"cell_type", "id", "metadata", "source"}
            if cell["cell_type"] == "code":
                expected |= {"execution_count", "outputs"}
                assert cell["outputs"] == [] and cell["execution_count"] is None
            assert cell.keys() == expected and cell["cell_type"] in ("code", "markdown")


def test_nbformat_accepts_the_notebooks():
    nbformat = pytest.importorskip("nbformat", reason="needs python3-nbformat")
    for file in NOTEBOOKS:
        nbformat.validate(nbformat.read(file, as_version=4))

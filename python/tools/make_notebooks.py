#!/usr/bin/env python3
"""Writes the examples as notebooks, python/notebooks/NAME.ipynb, from python/examples/NAME.py.

usage: make_notebooks.py [--check]

The docstring of a script is the first cell of its notebook. A line "# %% TEXT" begins a new cell of code, after a cell
with the TEXT. With --check nothing is written, and the exit status is 1 if a notebook would change.
"""

import ast
import json
import pathlib
import sys

PYTHON = pathlib.Path(__file__).resolve().parents[1]
MARK = "# %% "
METADATA = {
    "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
    "language_info": {"name": "python"},
}


def cell(kind, number, text):
    """Returns a cell with the lines of a text."""
    made = {"cell_type": kind, "id": f"cell-{number}", "metadata": {}, "source": text.strip("\n").splitlines(keepends=True)}
    return made | ({"execution_count": None, "outputs": []} if kind == "code" else {})


def notebook(script):
    """Returns the notebook of a script's text."""
    title, _, rest = ast.get_docstring(ast.parse(script)).partition("\n")
    texts = [("markdown", f"# {title}\n{rest}")]
    _, *parts = ("\n" + script).split("\n" + MARK)
    for part in parts:
        text, _, code = part.partition("\n")
        texts += [("markdown", text), ("code", code)]
    cells = [cell(kind, number, text) for number, (kind, text) in enumerate(texts)]
    return {"cells": cells, "metadata": METADATA, "nbformat": 4, "nbformat_minor": 5}


def main():
    stale = []
    for script in sorted((PYTHON / "examples").glob("*.py")):
        text = json.dumps(notebook(script.read_text()), indent=1) + "\n"
        file = PYTHON / "notebooks" / f"{script.stem}.ipynb"
        if "--check" not in sys.argv:
            file.parent.mkdir(exist_ok=True)
            file.write_text(text)
        elif not file.exists() or file.read_text() != text:
            stale.append(str(file))
    if stale:
        return f"{', '.join(stale)}: not as python/tools/make_notebooks.py writes"
    return 0


if __name__ == "__main__":
    sys.exit(main())

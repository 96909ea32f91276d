"""Writes the type stubs of the extension module, flexura/_flexura.pyi, from the signatures that it contains.

Run with the package: ./dev python python/tools/make_stubs.py [--check]. With --check nothing is written, and the exit status
is 1 if the file would change.
"""

import inspect
import pathlib
import re
import sys

import flexura._flexura as module

STUBS = pathlib.Path(__file__).parents[1] / "flexura" / "_flexura.pyi"
HEAD = '''"""Types of the extension module. Written by python/tools/make_stubs.py."""

import os
import pathlib
from collections.abc import Sequence
from typing import Any, Callable, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

'''
PATH = "Union[str, os.PathLike[str]]"
# Types that a signature does not state, by the names of parameters and of properties.
PARAMETERS = {
    "file": PATH,
    "path": PATH,
    "out": "Optional[NDArray[np.float64]]",
    "tensions": "Optional[ArrayLike]",
    "displacements": "Optional[ArrayLike]",
    "stance": "Optional[dict[str, Any]]",
    "stances": "Optional[Sequence[Optional[dict[str, Any]]]]",
    "camera": "Union[int, str]",
    "shape": "Union[Backbone, ArrayLike]",
    "on_progress": "Optional[Callable[[float, str], Any]]",
    "on_state": "Optional[Callable[[float, NDArray[np.float64]], Any]]",
    "on_event": "Optional[Callable[[float, str, str, str], Any]]",
    "on_message": "Optional[Callable[[str, float, dict[str, Any]], Any]]",
}
# Those that differ between functions.
BY_FUNCTION = {
    "DynamicsBatch.step": {"out": "Optional[NDArray[np.bool_]]"},
    "run": {"out": f"Optional[{PATH}]"},
    "Campaign.run": {"out": PATH},
    "report": {"out": f"Optional[{PATH}]"},
    "to_csv": {"out": f"Optional[{PATH}]"},
    "export": {"results": PATH},
    "identify": {"motion": f"Union[{PATH}, dict[str, ArrayLike]]"},
    "Campaign.__init__": {"experiment": f"Union[Experiment, {PATH}]"},
    "inverse": {"max_tension": "Union[float, ArrayLike]"},
}
RESULTS = {
    "folder": "pathlib.Path",
    "CampaignRun.file": "pathlib.Path",
    "report": "pathlib.Path",
    "to_csv": "pathlib.Path",
    "export": "pathlib.Path",
    "results": "CampaignResults",
    "sensitivity": "Optional[dict[str, float]]",
    "CampaignResults.table": "dict[str, NDArray[Any]]",
    "check": "dict[str, Any]",
    "schema": "dict[str, Any]",
    "table": "dict[str, Any]",
    "summary": "dict[str, Any]",
    "tasks": "list[dict[str, Any]]",
    "projection": "Optional[dict[str, Any]]",
    "take": "Union[NDArray[np.uint8], NDArray[np.uint16]]",
    "inverse_batch": "tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.float64]]",
    "find_board": "tuple[NDArray[np.float64], str]",
    "states": "tuple[NDArray[np.float64], NDArray[np.float64]]",
    "messages": "list[tuple[float, Any]]",
    "topics": "dict[str, int]",
}
TYPE = re.compile(r"numpy\.ndarray\[(?:numpy\.)?(\w+)\]|numpy\.ndarray")


def array(match):
    kind = match[1] or "Any"
    return "NDArray[Any]" if kind == "Any" else f"NDArray[np.{'bool_' if kind == 'bool' else kind}]"


def plain(text):
    text = re.sub(r"(?:flexura\.)?_flexura\.", "", text)
    text = re.sub(r"List\[(\w+)\[\d+\]\]", r"Sequence[\1]", text)
    return re.sub(r"\bList\[", "list[", text).replace("sequence", "Sequence[Any]")


def parameter_type(name, text, function):
    for key in (function, function.rpartition(".")[2]):
        if name in BY_FUNCTION.get(key, {}):
            return BY_FUNCTION[key][name]
    text = plain(text)
    if name in PARAMETERS and text == "object":
        return PARAMETERS[name]
    return TYPE.sub("ArrayLike", re.sub(r"\bdict$", "dict[str, Any]", text)).replace("object", "Any")


def split(text):
    """Splits a parameter list at its outer commas."""
    parts, depth = [""], 0
    for letter in text:
        depth += letter in "([{"
        depth -= letter in ")]}"
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [part.strip() for part in parts if part.strip()]


def signature(name, doc):
    """Returns the parameters and the result of a function from the first line of its docstring."""
    found = re.match(r"(\w*)\((.*)\) -> (.*)", doc.splitlines()[0])
    parameters = []
    for part in split(found[2]):
        declared = re.match(r"(\w+): (.*?)(?: = (.*))?$", part)
        if part in ("*", "**kwargs"):
            parameters.append("*" if part == "*" else "**kwargs: Any")
        elif declared[1] == "self":
            parameters.append("self")
        else:
            default = f" = {declared[3]}" if declared[3] else ""
            kind = parameter_type(declared[1], declared[2], name)
            # pybind11 does not state that a pointer may be None.
            if declared[3] == "None" and not kind.startswith(("Optional", "Union")):
                kind = f"Optional[{kind}]"
            parameters.append(f"{declared[1]}: {kind}{default}")
    plain_name = name.rpartition(".")[2]
    result = RESULTS.get(name) or RESULTS.get(plain_name) or TYPE.sub(array, plain(found[3])).replace("object", "Any").replace("dict", "dict[str, Any]")
    return ", ".join(parameters), result


def class_stub(name, of):
    lines = [f"class {name}:"]
    for member, value in sorted(vars(of).items()):
        if member.startswith("_") and member not in ("__init__", "__len__"):
            continue
        if member == "__init__" and not value.__doc__.startswith("__init__(self"):
            continue  # Only the module makes these objects.
        if isinstance(value, property):
            result = signature(f"{name}.{member}", value.fget.__doc__)[1]
            lines += ["    @property", f"    def {member}(self) -> {result}: ..."]
            continue
        is_static = isinstance(value, staticmethod)
        parameters, result = signature(f"{name}.{member}", value.__func__.__doc__ if is_static else value.__doc__)
        lines += ["    @staticmethod"] * is_static + [f"    def {member}({parameters}) -> {result}: ..."]
    return lines if len(lines) > 1 else [lines[0] + " ..."]


def stubs():
    lines = []
    for name, value in sorted(vars(module).items()):
        if name.startswith("_") and name != "__version__":
            continue
        if name == "__version__":
            lines += ["__version__: str", ""]
        elif inspect.isclass(value) and issubclass(value, Exception):
            lines += [f"class {name}(ValueError):", "    file: Optional[str]", "    line: Optional[int]",
                      "    column: Optional[int]",
                      "    problems: list[tuple[Optional[str], Optional[int], Optional[int], str]]", ""]
        elif inspect.isclass(value):
            lines += [*class_stub(name, value), ""]
        else:
            parameters, result = signature(name, value.__doc__)
            lines += [f"def {name}({parameters}) -> {result}: ...", ""]
    return HEAD + "\n".join(lines)


def main():
    text = stubs()
    if "--check" in sys.argv:
        return 0 if STUBS.read_text() == text else f"{STUBS}: is not as python/tools/make_stubs.py writes it"
    STUBS.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())

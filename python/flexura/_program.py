"""Calls of the program `flexura`, for commands that have no function in Python."""

import dataclasses
import json
import os
import pathlib
import re
import shutil
import subprocess
import sysconfig
from collections.abc import Iterable
from typing import Any, Optional

from ._flexura import InputError


@dataclasses.dataclass(frozen=True)
class ProgramResult:
    """Result of a call of program().

    status: exit status: 0 done, 1 the command did not reach its goal. output: text of stdout. messages: lines of
    stderr.
    """

    status: int
    output: str
    messages: "list[str]"

    @property
    def documents(self) -> "list[Any]":
        """The JSON documents in the output: of `--json`, or one per line. Raises ValueError for other output."""
        decoder, text, found = json.JSONDecoder(), self.output.strip(), []
        while text:
            document, end = decoder.raw_decode(text)
            found.append(document)
            text = text[end:].lstrip()
        return found


def find_program() -> str:
    """Returns the path of the program: FLEXURA_PROGRAM, or where the package was installed or built, or in the PATH."""
    package = pathlib.Path(__file__).parent
    for place in (
        os.environ.get("FLEXURA_PROGRAM"),
        pathlib.Path(sysconfig.get_path("scripts")) / "flexura",
        package.parents[1] / "bin" / "flexura",
        shutil.which("flexura"),
    ):
        if place and os.access(place, os.X_OK):
            return str(place)
    raise FileNotFoundError("the program flexura: expected it in the PATH, or named by FLEXURA_PROGRAM")


def input_error(text: str) -> InputError:
    """Returns the InputError of messages "file:line:column: what"."""
    error = InputError(text)
    error.problems = []
    for line in text.splitlines():
        place = re.match(r"(.+?):(\d+):(\d+): (.*)", line) or re.match(r"(.+?)()(): (.*)", line)
        file, row, column, what = place.groups() if place else (None, "", "", line)
        error.problems.append((file, int(row) if row else None, int(column) if column else None, what))
    error.file, error.line, error.column = error.problems[0][:3] if error.problems else (None, None, None)
    return error


def program(*arguments: Any, lines: "Optional[Iterable[Any]]" = None) -> ProgramResult:
    """Runs a command of the program `flexura`: program("compare", folder, other, "--json").

    lines: objects that the command reads as JSON lines, such as for "statics". Returns a ProgramResult. Raises
    InputError for bad input (exit status 2), and RuntimeError for a failure of the system.
    """
    given = None if lines is None else "".join(json.dumps(line) + "\n" for line in lines)
    command = [find_program(), *(str(argument) for argument in arguments)]
    source = {"stdin": subprocess.DEVNULL} if given is None else {"input": given}
    done = subprocess.run(command, capture_output=True, text=True, check=False, **source)
    if done.returncode == 2:
        raise input_error(done.stderr.strip())
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{' '.join(command)}: exit status {done.returncode}\n{done.stderr.strip()}")
    return ProgramResult(done.returncode, done.stdout, done.stderr.splitlines())

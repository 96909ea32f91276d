#!/usr/bin/env python3
"""Checks that the examples in the documents work, and that their links have targets.

usage: check_docs.py [--root ROOT] [--bin BIN --prefix PREFIX [--python PYTHON]]

BIN is the folder of the built programs, PREFIX an installed Flexura; without them only links and the form of the
blocks are checked. PYTHON is an interpreter that can import flexura. Each document gets its own scratch folder with a copy of examples/. Its fenced blocks are processed
in order:
  console    Each line "$ COMMAND" is run there with BIN in PATH (a trailing \\ continues it). The lines after it, if
             any, are its expected output: "..." matches any text, a line "..." any lines. It has to succeed, or to
             end with the status N of its comment "# exit status N". "./dev ..." is not run, but the command has to
             exist. With --view no browser is opened, and SIGTERM ends the viewer once the results exist.
  cmake      The build of the programs after it: one program, made from main.cc.
  cpp        A whole program, compiled against PREFIX and run. Its comments "// prints: ..." give the expected output.
  python     A whole program, run by PYTHON, unless a first line says otherwise (below). Its comments "# prints: ..."
             give the expected output. Without PYTHON it is not run.
  any other  Only these two checks, which apply to every language:
             A first line with "file: NAME" writes the block to NAME in the scratch folder.
             A first line with "from: PATH" requires that PATH contains the rest, word for word.

Versions in other files have to match that of CMakeLists.txt (VERSIONS lists the places). Names in the prose, except in
the change log, have to exist: one source has both words of `Class::member`, and `Suite.Test` is a test.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
from dataclasses import dataclass
from pathlib import Path

FENCE = re.compile(r"^(\s*)```(\w*)\s*$")
LINK = re.compile(r'\]\(([^)\s]+)(?:\s+"[^"]*")?\)|<img[^>]*\bsrc="([^"]+)"')
HEADER = re.compile(r"^(?:#|//|<!--|--)\s*(file|from):\s*(\S+)")
MEMBER = re.compile(r"`([A-Z]\w*)::(\w+)")
TEST = re.compile(r"`\**([A-Z]\w*[a-z]\w*\.[A-Z]\w*[a-z]\w*)\**`")
DEFINED_TEST = re.compile(r"\bTEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)")
VERSIONS = {
    "CHANGELOG.md": r"^## (\d\S*) - \d{4}-\d\d-\d\d$",
    "viewer/package.json": r'^  "version": "([^"]+)"',
    "viewer/package-lock.json": r'^  "version": "([^"]+)"',
    "docs/viewer-protocol.md": r'"version":"([^"]+)"',
    "docs/library.md": r"find_package\(flexura ([\d.]+)",
    "tests/install/CMakeLists.txt": r"find_package\(flexura ([\d.]+)",
}
PROJECT = """cmake_minimum_required(VERSION 3.25)
project(program LANGUAGES CXX)
"""
PROGRAM = """find_package(flexura REQUIRED)
add_executable(program main.cc)
target_link_libraries(program PRIVATE flexura::flexura)
"""


@dataclass
class Block:
    language: str
    line: int
    lines: list


def split(text):
    """Returns a document's fenced blocks, and its prose with the blocks blanked out."""
    blocks, prose, block, indent = [], [], None, ""
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if block is None and fence:
            indent, block = fence[1], Block(fence[2], number, [])
        elif block is not None and fence and not fence[2]:
            blocks.append(block)
            block = None
        elif block is not None:
            block.lines.append(line.removeprefix(indent))
        prose.append("" if block is not None or fence else line)
    return blocks, prose


def commands(block):
    """Returns (line number, command, expected lines) for each command of a console block."""
    found, continued = [], False
    for number, line in enumerate(block.lines, block.line + 1):
        if continued:
            found[-1][1] += "\n" + line.removeprefix("> ")
        elif line.startswith("$ "):
            found.append([number, line[2:], []])
        elif found:
            found[-1][2].append(line)
        continued = (continued or line.startswith("$ ")) and line.endswith("\\")
    for command in found:
        while command[2] and not command[2][-1].strip():
            command[2].pop()
    return found


def matches(expected, output):
    """Returns whether the text `output` matches the lines `expected`."""
    pattern = ""
    for line in expected:
        if line.strip() == "...":
            pattern += r"(?:.*\n)*?"
        else:
            pattern += ".*".join(re.escape(part) for part in line.rstrip().split("...")) + r"[ \t]*\n"
    return re.fullmatch(pattern, output.rstrip("\n") + "\n" if output.strip() else "") is not None


def anchors(text):
    """Returns the URL fragments of a document's headings."""
    titles = [line.lstrip("#").strip() for line in split(text)[1] if re.match(r"#+ ", line)]
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def broken_links(document):
    for number, line in enumerate(split(document.read_text())[1], 1):
        for match in LINK.finditer(re.sub(r"`[^`]*`", "", line)):
            target = match[1] or match[2]
            if re.match(r"[a-z]+:", target):
                continue
            name, _, fragment = target.partition("#")
            path = document.parent / name if name else document
            if not path.exists():
                yield number, f"the link {target} leads nowhere"
            elif fragment and path.suffix == ".md" and fragment not in anchors(path.read_text()):
                yield number, f"the link {target} leads to no heading"


class Sources:
    """The names in the C++ sources of a project."""

    def __init__(self, root):
        self.words, self.tests = [], set()
        for folder in ("flexura", "tests", "bench"):
            for path in [*root.glob(f"{folder}/**/*.h"), *root.glob(f"{folder}/**/*.cc")]:
                text = path.read_text()
                self.words.append(set(re.findall(r"\w+", text)))
                self.tests.update(f"{suite}.{test}" for suite, test in DEFINED_TEST.findall(text))

    def unknown_names(self, document):
        for number, line in enumerate(split(document.read_text())[1], 1):
            for match in MEMBER.finditer(line):
                if not any(match[1] in words and match[2] in words for words in self.words):
                    yield number, f"no source has {match[1]}::{match[2]}"
            for match in TEST.finditer(line):
                if match[1] not in self.tests:
                    yield number, f"there is no test {match[1]}"


class Runner:
    """Runs one document's blocks in a scratch folder."""

    def __init__(self, root, scratch, programs, prefix, python=None):
        self.root, self.scratch, self.prefix, self.program, self.python = root, scratch, prefix, PROGRAM, python
        self.environment = {
            **os.environ,
            "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
            "CMAKE_PREFIX_PATH": str(prefix),
            "CMAKE_GENERATOR": "Ninja",
            "LC_ALL": "C.UTF-8",
        }
        if (root / "examples").exists():
            shutil.copytree(root / "examples", scratch / "examples")

    def call(self, command, **options):
        """Runs a command in the scratch folder and returns its exit status and output."""
        done = subprocess.run(command, cwd=self.scratch, env=self.environment, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=600,
                              check=False, **options)
        return done.returncode, done.stdout

    def call_viewed(self, command):
        """Does the same for a run with --view, without a browser."""
        headless = command.replace(" --view", " --view --no-browser --port 0", 1)
        with subprocess.Popen(["bash", "-c", f"exec {headless}"], cwd=self.scratch, env=self.environment,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True) as process:
            limit = threading.Timer(600, process.kill)
            limit.start()
            output = ""
            for line in process.stdout:
                output += line
                if line.startswith("results: "):
                    process.terminate()
            limit.cancel()
        return process.returncode, output

    def run(self, block):
        """Yields (line, problem) for one block."""
        header = HEADER.match(block.lines[0]) if block.lines else None
        if header and header[1] == "from":
            yield from self.compare(block, header[2])
        elif header:
            target = self.scratch / header[2]
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text("\n".join(block.lines[1:]) + "\n")
        elif block.language == "console":
            for number, command, expected in commands(block):
                yield from self.run_command(number, command, expected)
        elif block.language == "cmake":
            self.program = "\n".join(block.lines) + "\n"
        elif block.language == "cpp":
            yield from self.run_program(block)
        elif block.language == "python" and self.python:
            yield from self.run_python(block)
        elif block.language in ("sh", "bash", "shell"):
            yield block.line, "a block of commands is a console block"

    def compare(self, block, name):
        path = self.root / name
        if not path.exists():
            yield block.line, f"there is no {name}"
        elif "\n".join(block.lines[1:]).strip("\n") not in path.read_text():
            yield block.line, f"this does not stand in {name}"

    def run_command(self, number, command, expected):
        if command.startswith("./dev"):
            words = command.split()
            usage = subprocess.run([self.root / "dev", "help"], capture_output=True, text=True, check=True).stdout
            if len(words) < 2 or not re.search(rf"^  {re.escape(words[1])}\b", usage, re.MULTILINE):
                yield number, f"./dev help does not know {command}"
            return
        if command.startswith(("git clone ", "cd ")):
            return
        if " --view" in command:
            status, output = self.call_viewed(command)
        else:
            status, output = self.call(["bash", "-o", "pipefail", "-c", command])
        said = re.search(r"# exit status (\d+)", command)
        if status != (int(said[1]) if said else 0):
            yield number, f"exit status {status}: {command}\n{output}"
        elif expected and not matches(expected, output):
            yield number, f"this is printed instead: {command}\n{output}"

    def run_python(self, block):
        text = "\n".join(block.lines) + "\n"
        status, output = self.call([self.python, "-c", text])
        expected = re.findall(r"# prints: (.*)", text)
        if status != 0 or (expected and not matches(expected, output)):
            yield block.line, f"this is printed instead (exit status {status})\n{output}"

    def run_program(self, block):
        text = "\n".join(block.lines) + "\n"
        if "int main" not in text:
            yield block.line, "a cpp block is a whole program, or quotes a file (// from: PATH)"
            return
        folder = self.scratch / f".program-{block.line}"
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text(PROJECT + self.program)
        (folder / "main.cc").write_text(text)
        build = f"cmake -S {folder} -B {folder}/build && cmake --build {folder}/build"
        status, output = self.call(["bash", "-c", build])
        if status != 0:
            yield block.line, f"this does not compile\n{output}"
            return
        name = re.search(r"add_executable\((\w+) main\.cc\)", self.program)
        if name is None:
            yield block.line, "the cmake block before it makes no program of main.cc"
            return
        status, output = self.call([folder / "build" / name[1]])
        expected = re.findall(r"// prints: (.*)", text)
        if status != 0 or (expected and not matches(expected, output)):
            yield block.line, f"this is printed instead (exit status {status})\n{output}"


def version_problems(root):
    """Yields the places with a version other than that of the CMake project."""
    project = root / "CMakeLists.txt"
    version = project.exists() and re.search(r"project\(\w+ VERSION (\S+)", project.read_text())
    if not version:
        return
    for name, pattern in VERSIONS.items():
        if not (root / name).exists():
            continue
        found = re.search(pattern, (root / name).read_text(), re.MULTILINE)
        if not found or version[1].split(".")[: len(found[1].split("."))] != found[1].split("."):
            yield f"{name}: the version is {found[1] if found else 'not said'}, that of CMakeLists.txt {version[1]}"


def documents(root):
    return sorted([*root.glob("*.md"), *root.glob("docs/**/*.md"), *root.glob("examples/**/*.md")])


def problems(root, programs, prefix, python=None):
    """Yields the problems of the documents at `root`, one text each."""
    yield from version_problems(root)
    sources = Sources(root)
    for document in documents(root):
        found = list(broken_links(document))
        if document.name != "CHANGELOG.md":
            found.extend(sources.unknown_names(document))
        if programs:
            with tempfile.TemporaryDirectory() as scratch:
                runner = Runner(root, Path(scratch), programs, prefix, python)
                for block in split(document.read_text())[0]:
                    found.extend(runner.run(block))
        for line, text in found:
            yield f"{document.relative_to(root)}:{line}: {text}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--root", type=Path, default=Path(__file__).parent.parent)
    parser.add_argument("--bin", type=Path)
    parser.add_argument("--prefix", type=Path)
    parser.add_argument("--python", type=Path)
    arguments = parser.parse_args()
    root = arguments.root.resolve()
    programs = arguments.bin and arguments.bin.resolve()
    count = 0
    for problem in problems(root, programs, arguments.prefix and arguments.prefix.resolve(), arguments.python):
        print(problem, flush=True)
        count += 1
    print(f"{len(documents(root))} documents, {count} problems")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())

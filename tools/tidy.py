#!/usr/bin/env python3
"""Runs clang-tidy on the project's sources, in parallel, and only where no result is known yet.

usage: tidy.py --build BUILD [--all]

BUILD holds a compile_commands.json. tools/tidy_record.txt, committed, holds digests of the sources' code, without
comments and words of string literals, for which clang-tidy last passed. Without --all, the product's sources (.cc) that differ from the record are
checked. With --all every source is checked, including tests and benchmarks. That also shows the effects of a changed
header on the sources that include it. The record is updated for each source of the product that passes, with its
digest from before the check.

A source that passed is not checked again on the same machine while its text, the project headers it reaches, its
compile command and .clang-tidy stay the same. Passes are remembered as empty files, named by the hash of all that,
under $FLEXURA_TIDY_CACHE (default ~/.cache/flexura/tidy).
"""

import argparse
import functools
import hashlib
import json
import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TIDY = "clang-tidy-19"
SETTINGS = ROOT / ".clang-tidy"
RECORD = ROOT / "tools/tidy_record.txt"
# String literals, which may contain comment markers, and comments.
TOKEN = re.compile(r'R"(\w*)\((?:.|\n)*?\)\1"|"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*(?:.|\n)*?\*/')
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def include_folders(command):
    """Returns the folders of the project (sources, generated) that a compile command searches."""
    folders = re.findall(r"(?:-I|-isystem )(\S+)", command)
    return [Path(folder) for folder in folders if Path(folder).is_relative_to(ROOT)]


def reached(source, folders):
    """Returns the source and the project's headers that it includes, directly or indirectly."""
    files, waiting = set(), [source]
    while waiting:
        file = waiting.pop()
        if file in files:
            continue
        files.add(file)
        for name in INCLUDE.findall(file.read_text()):
            candidates = [folder / name for folder in [file.parent, *folders]]
            waiting.extend([path for path in candidates if path.exists()][:1])
    return files


@functools.cache
def tidy_version():
    return subprocess.run([TIDY, "--version"], capture_output=True, check=True).stdout


def key(command, files):
    """Returns a hash of all that clang-tidy's result depends on, independent of the project's location."""
    digest = hashlib.sha256()
    digest.update(tidy_version())
    digest.update(command.replace(str(ROOT), "").encode())
    for file in [SETTINGS, *sorted(files)]:
        digest.update(str(file.relative_to(ROOT)).encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()


def essential_code(text):
    """Returns the code without comments, words of string literals, and spaces beside punctuation.

    clang-tidy reads only NOLINT comments, and its findings do not depend on the words of messages.
    """
    def kept(token):
        if token[0].startswith(("//", "/*")):
            return token[0] if "NOLINT" in token[0] else " "
        line = text[text.rfind("\n", 0, token.start()) + 1:token.start()]
        return token[0] if re.fullmatch(r"\s*#\s*include\s*", line) else '""'

    code = re.sub(r"\s*([^\w\s])\s*", r"\1", " ".join(TOKEN.sub(kept, text).split()))
    return re.sub(r'(?:"")+', '""', code)


def digests(files):
    """Returns the first 16 hex digits of the SHA-256 of each file's code, by the file's path in the project."""
    names = sorted(str(file.relative_to(ROOT)) for file in files)
    codes = [essential_code((ROOT / name).read_text()) for name in names]
    return {name: hashlib.sha256(code.encode()).hexdigest()[:16] for name, code in zip(names, codes)}


def recorded(record):
    """Returns the digests of a record, by file; empty if there is no record."""
    if not record.exists():
        return {}
    return dict(reversed(line.split()) for line in record.read_text().splitlines())


def is_product(source):
    """Returns whether the source is compiled into the libraries or the program."""
    return source.is_relative_to(ROOT / "flexura") and not source.stem.endswith(("_test", "_fuzz"))


def changed_since(record, sources):
    """Returns the sources that differ from the record; all of them if the settings differ."""
    now, before = digests({SETTINGS, *sources}), recorded(record)
    changed = {ROOT / name for name, digest in now.items() if before.get(name) != digest}
    return [source for source in sources if source in changed or SETTINGS in changed]


def check(build, source, passed):
    """Runs clang-tidy; returns its exit status and findings. A pass creates the file `passed`."""
    done = subprocess.run([TIDY, "-p", build, "--quiet", source], capture_output=True, text=True, check=False)
    if done.returncode == 0:
        passed.touch()
    return done.returncode, done.stdout + ("" if done.returncode == 0 else done.stderr)


def check_all(build, waiting):
    """Checks sources in parallel, prints the findings, and returns the number of sources with findings."""
    failed = 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        answers = pool.map(lambda item: check(build, *item), waiting.items())
        for source, (status, output) in zip(waiting, answers):
            if status != 0:
                failed += 1
                print(f"--- {source.relative_to(ROOT)}\n{output}", flush=True)
    return failed


def keep_record(known, passed):
    """Updates the record with the digests in `passed`; only files in `known` stay in it."""
    names = {str(source.relative_to(ROOT)) for source in known}
    kept = {name: digest for name, digest in recorded(RECORD).items() if name in names}
    kept.update(passed)
    RECORD.write_text("".join(f"{digest} {name}\n" for name, digest in sorted(kept.items())))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--all", action="store_true")
    arguments = parser.parse_args()
    cache = Path(os.environ.get("FLEXURA_TIDY_CACHE") or Path.home() / ".cache/flexura/tidy")
    cache.mkdir(parents=True, exist_ok=True)

    entries = json.loads((arguments.build / "compile_commands.json").read_text())
    commands = {Path(entry["file"]): entry["command"] for entry in entries}
    # Skip sources generated by the build.
    commands = {source: command for source, command in commands.items() if not source.is_relative_to(ROOT / "build")}
    reach = {source: reached(source, include_folders(command)) for source, command in commands.items()}
    reach = {source: {file for file in files if not file.is_relative_to(ROOT / "build")}
             for source, files in reach.items()}
    sources = list(reach) if arguments.all else changed_since(RECORD, [*filter(is_product, reach)])
    passes = {source: cache / key(commands[source], reach[source]) for source in sources}
    waiting = {source: passed for source, passed in passes.items() if not passed.exists()}

    # Tests and benchmarks are never compared with the record. A file edited during the check has not passed.
    kept = {SETTINGS, *filter(is_product, reach)}
    before = digests(kept)
    start = time.monotonic()
    failed = 0
    try:
        failed = check_all(arguments.build, waiting)
    finally:
        done = {source for source, passed in passes.items() if passed.exists()}
        # Sources checked without a pass leave the record, so that they are checked again even if unchanged.
        passed = (done if failed else done | {SETTINGS}) & kept
        keep_record(kept - (set(sources) - done), {name: before[name] for name in digests(passed)})
    print(f"clang-tidy: {len(sources)} of {len(reach)} sources, {len(waiting)} of them checked now in "
          f"{time.monotonic() - start:.0f} s, {failed} with findings")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

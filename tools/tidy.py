#!/usr/bin/env python3
"""Runs clang-tidy on the project's sources, in parallel, and only where the answer is not known yet.

usage: tidy.py --build BUILD [--since-last-tag]

BUILD holds a compile_commands.json. A source that passed is not checked again while its text, the project
headers it reaches, its compile command and .clang-tidy stay the same: the passes are remembered, as empty
files named by the hash of all that, under $FLEXURA_TIDY_CACHE (default ~/.cache/flexura/tidy).
--since-last-tag leaves out the sources that no change since the last tag can reach (where there is a tag).
"""

import argparse
import functools
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TIDY = "clang-tidy-19"
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def include_folders(command):
    """The folders of the project (sources, generated) that a compile command searches."""
    folders = re.findall(r"(?:-I|-isystem )(\S+)", command)
    return [Path(folder) for folder in folders if Path(folder).is_relative_to(ROOT)]


def reached(source, folders):
    """The source and the project's headers that it includes, directly or not."""
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
    """Names what clang-tidy's answer depends on, the same wherever the project lies."""
    digest = hashlib.sha256()
    digest.update(tidy_version())
    digest.update(command.replace(str(ROOT), "").encode())
    for file in [ROOT / ".clang-tidy", *sorted(files)]:
        digest.update(str(file.relative_to(ROOT)).encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()


def git(*arguments):
    """The lines that a git command prints, or None where there is no git or no repository."""
    if not shutil.which("git"):
        return None
    done = subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True, check=False)
    return done.stdout.split("\n") if done.returncode == 0 else None


def changed_since_last_tag():
    """The files that differ from the last tag, or None where everything counts as changed."""
    tag = git("describe", "--tags", "--abbrev=0")
    if not tag:
        return None
    names = [*git("diff", "--name-only", tag[0]), *git("ls-files", "--others", "--exclude-standard")]
    files = {ROOT / name for name in names if name}
    return None if ROOT / ".clang-tidy" in files else files


def check(build, source, passed):
    """clang-tidy's exit status and findings; a pass makes the file `passed`."""
    done = subprocess.run([TIDY, "-p", build, "--quiet", source], capture_output=True, text=True, check=False)
    if done.returncode == 0:
        passed.touch()
    return done.returncode, done.stdout + ("" if done.returncode == 0 else done.stderr)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=Path, required=True)
    parser.add_argument("--since-last-tag", action="store_true")
    arguments = parser.parse_args()
    cache = Path(os.environ.get("FLEXURA_TIDY_CACHE") or Path.home() / ".cache/flexura/tidy")
    cache.mkdir(parents=True, exist_ok=True)
    changed = changed_since_last_tag() if arguments.since_last_tag else None

    waiting, sources = {}, 0
    for entry in json.loads((arguments.build / "compile_commands.json").read_text()):
        source = Path(entry["file"])
        files = reached(source, include_folders(entry["command"]))
        if changed is not None and not changed & files:
            continue
        sources += 1
        passed = cache / key(entry["command"], files)
        if not passed.exists():
            waiting[source] = passed

    start, failed = time.monotonic(), 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        answers = pool.map(lambda item: check(arguments.build, *item), waiting.items())
        for source, (status, output) in zip(waiting, answers):
            if status != 0:
                failed += 1
                print(f"--- {source.relative_to(ROOT)}\n{output}", flush=True)
    print(f"clang-tidy: {sources} sources, {len(waiting)} of them checked now in "
          f"{time.monotonic() - start:.0f} s, {failed} with findings")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Checks that every folder of flexura/ includes and links only folders on a strictly lower floor.
It also checks that a folder links exactly those that it includes.

usage: check_includes.py [ROOT]

ROOT/flexura/floors.txt lists the folders with their floors. Problems are printed, one per line, and
set exit status 1:
- an include or a link to a folder that is not on a lower floor, or not in the list;
- an include from a folder within a folder to another one there;
- an include of a folder that is not linked, or a link to a folder that nothing includes;
- a folder missing from the list, or a folder of the list without its flexura_folder(NAME ...);
- a type defined in two headers: the compiler never sees both, and the linker merges their code.
If ROOT/flexura/public_headers.txt exists, it must not have:
- a header that does not exist or is listed twice, or one that includes a header not listed;
- a header below "# What these include" that no listed header includes.
"""

import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"')
TYPE = re.compile(r"^(?:class|struct|enum class) (\w+)(?: final)?(?: :[^;\n]*)? \{", re.M)
UNNAMED = re.compile(r"^namespace \{\n.*?^\}  // namespace\n", re.M | re.S)
INNER = "# What these include"  # Where the interface ends in public_headers.txt.
LINK = re.compile(r"\bflexura::(\w+)")


def read_floors(path):
    """Returns the floor of each folder in a floors.txt, by folder."""
    floors = {}
    for line in path.read_text().splitlines():
        words = line.split("#")[0].split()
        if words:
            floor, folder = words
            floors[folder] = int(floor)
    return floors


def may_lean_on(floors, folder, other):
    return other == folder or (other in floors and floors[other] < floors[folder])


def check_source(root, floors, folder, source):
    for number, line in enumerate(source.read_text().splitlines(), 1):
        match = INCLUDE.match(line)
        if not match or match[1].startswith("embedded/"):
            continue
        if match[1].startswith("tests/") and source.stem.endswith(("_test", "_fuzz")):
            continue
        where = f"{source.relative_to(root)}:{number}"
        parts = match[1].split("/")
        if parts[0] != "flexura" or len(parts) < 3:
            yield f'{where}: "{match[1]}" is not written "flexura/FOLDER/FILE"'
        elif parts[1] not in floors:
            yield f"{where}: {parts[1]} is not in flexura/floors.txt"
        elif not may_lean_on(floors, folder, parts[1]):
            yield (f"{where}: {folder} (floor {floors[folder]}) may not include "
                   f"{parts[1]} (floor {floors[parts[1]]})")


def check_rooms(root, folder, source):
    """Yields includes between subfolders of a folder of flexura/, which are not allowed."""
    parts = source.relative_to(root / "flexura" / folder).parts
    if len(parts) < 2:
        return
    for number, line in enumerate(source.read_text().splitlines(), 1):
        match = re.match(rf'\s*#\s*include\s*"flexura/{folder}/(\w+)/', line)
        if match and match[1] != parts[0]:
            yield (f"{source.relative_to(root)}:{number}: {folder}/{parts[0]} may not include "
                   f"{folder}/{match[1]}: each is a room of its own")


def included_folders(root, floors, folder):
    """Returns the folders that the sources of `folder` include, and those that its tests include."""
    by_library, by_tests = set(), set()
    for source in (root / "flexura" / folder).rglob("*"):
        if source.suffix in (".cc", ".h"):
            is_test = source.stem.endswith(("_test", "_fuzz"))
            names = re.findall(r'#\s*include\s*"flexura/(\w+)/', source.read_text())
            (by_tests if is_test else by_library).update(set(names) & set(floors) - {folder})
    return by_library, by_tests


def check_target(root, floors, folder):
    path = root / "flexura" / folder / "CMakeLists.txt"
    text = path.read_text() if path.exists() else ""
    call = re.search(rf"\bflexura_folder\(\s*{folder}\b([^)]*)\)", text)
    if not call:
        yield f"{path.relative_to(root)}: flexura_folder({folder} ...) is missing"
        return
    links, (by_library, by_tests) = LINK.findall(call[1]), included_folders(root, floors, folder)
    for other in links:
        if not may_lean_on(floors, folder, other):
            yield f"{path.relative_to(root)}: {folder} may not link {other}"
        elif other not in by_library | by_tests:
            yield f"{path.relative_to(root)}: {folder} links {other}, of which it includes nothing"
    for other in sorted(by_library - set(links)):
        if may_lean_on(floors, folder, other):
            yield f"{path.relative_to(root)}: {folder} includes {other} and does not link it"


def check_types(root):
    first = {}
    for header in sorted((root / "flexura").rglob("*.h")):
        for name in TYPE.findall(UNNAMED.sub("", header.read_text())):
            if name in first:
                yield f"{header.relative_to(root)}: {name} is defined in {first[name]} too"
            first.setdefault(name, header.relative_to(root))


def check_public(root):
    path = root / "flexura/public_headers.txt"
    listed, inner, included, is_inner = {}, [], set(), False
    for number, line in enumerate(path.read_text().splitlines() if path.exists() else [], 1):
        header = line.split("#")[0].strip()
        is_inner = is_inner or line.startswith(INNER)
        where = f"{path.relative_to(root)}:{number}"
        if not header:
            continue
        if header in listed:
            yield f"{where}: {header} is listed twice"
        elif not (root / "flexura" / header).exists():
            yield f"{where}: there is no {header}"
        else:
            listed[header] = where
            inner += [header] if is_inner else []
    for header, where in listed.items():
        for line in (root / "flexura" / header).read_text().splitlines():
            match = INCLUDE.match(line)
            if not match:
                continue
            included.add(match[1].removeprefix("flexura/"))
            if match[1].removeprefix("flexura/") not in listed:
                yield f"{where}: {header} includes {match[1]}, which is not listed"
    for header in inner:
        if header not in included:
            yield f"{listed[header]}: no listed header includes {header}"


def problems(root):
    """Yields the problems of the tree at `root`, a line each."""
    floors = read_floors(root / "flexura/floors.txt")
    for folder in sorted(entry.name for entry in (root / "flexura").iterdir() if entry.is_dir()):
        if folder not in floors:
            yield f"flexura/{folder} is not in flexura/floors.txt"
    for folder in floors:
        yield from check_target(root, floors, folder)
        for source in sorted((root / "flexura" / folder).rglob("*")):
            if source.suffix in (".cc", ".h"):
                yield from check_source(root, floors, folder, source)
                yield from check_rooms(root, folder, source)
    yield from check_types(root)
    yield from check_public(root)


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    found = list(problems(root))
    print(*found, sep="\n", end="\n" if found else "")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

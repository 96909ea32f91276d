#!/usr/bin/env python3
"""Makes the reference of the public headers, OUT/html/index.html, by Doxygen.

usage: make_reference.py OUT

What is documented are the headers of flexura/public_headers.txt up to its second comment, with
docs/library.md in front. Anything that Doxygen finds wrong in a comment is printed, a line each, and
so is a class without one; then the exit status is 1. Single members need no comment where their
name says all.
"""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

SETTINGS = {
    "PROJECT_NAME": "Flexura",
    "STRIP_FROM_PATH": ".",
    "STRIP_FROM_INC_PATH": ".",
    "JAVADOC_AUTOBRIEF": "YES",
    "EXTRACT_ALL": "NO",
    "WARN_IF_UNDOCUMENTED": "YES",
    "GENERATE_LATEX": "NO",
    "HAVE_DOT": "NO",
    "QUIET": "YES",
    "SHOW_USED_FILES": "NO",
    "EXCLUDE_SYMBOLS": "flexura::Codec",
    "TOC_INCLUDE_HEADINGS": "0",
}


def interface(root):
    """The headers of the interface, as paths from `root`."""
    sections = re.split(r"^#.*$", (root / "flexura/public_headers.txt").read_text(), flags=re.M)
    return ["flexura/" + header for header in sections[2].split()]


def version(root):
    return re.search(r"project\(flexura VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text())[1]


def front_page(root, out):
    """docs/library.md without its links to other documents, which the reference lacks."""
    text = (root / "docs/library.md").read_text()
    page = out / "library.md"
    page.write_text(re.sub(r"\[([^\]]*)\]\([\w./-]+\.md[^)]*\)", r"\1", text))
    return str(page)


def complaints(told):
    """What of Doxygen's words counts, with paths from the root."""
    for line in told.splitlines():
        if re.search(r"warning: Member .* is not documented", line) or not line.strip():
            continue
        yield line.replace(f"{ROOT}/", "")


def main():
    out = Path(sys.argv[1]).resolve()
    out.mkdir(parents=True, exist_ok=True)
    page = front_page(ROOT, out)
    settings = SETTINGS | {
        "USE_MDFILE_AS_MAINPAGE": page,
        "PROJECT_NUMBER": version(ROOT),
        "OUTPUT_DIRECTORY": str(out),
        "INPUT": " ".join([page, *interface(ROOT)]),
    }
    text = "".join(f"{key} = {value}\n" for key, value in settings.items())
    done = subprocess.run(["doxygen", "-"], input=text, text=True, cwd=ROOT, capture_output=True, check=False)
    found = list(complaints(done.stderr))
    print(*found, sep="\n", end="\n" if found else "")
    return 1 if found or done.returncode else 0


if __name__ == "__main__":
    sys.exit(main())

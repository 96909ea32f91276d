#!/usr/bin/env python3
"""Makes the reference of the public headers, OUT/html/index.html, with Doxygen.

usage: make_reference.py OUT

It documents the headers of flexura/public_headers.txt up to its second comment, with docs/library.md as
front page. Problems are printed, a line each, and set exit status 1: errors that Doxygen finds in
comments, and classes and functions without a comment. One comment per set of overloads is enough. No
comment is needed, as the name says all, for: data members; const functions without arguments; defaulted
or deleted functions; overrides; operators; move constructors; default constructors of a ...Config;
fields_of and names_of, which base/table.h describes.
"""

import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
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
    "GENERATE_XML": "YES",
    "XML_PROGRAMLISTING": "NO",
    "HAVE_DOT": "NO",
    "QUIET": "YES",
    "SHOW_USED_FILES": "NO",
    "EXCLUDE_SYMBOLS": "flexura::Codec",
    "TOC_INCLUDE_HEADINGS": "0",
}


# Functions that many types have.
KNOWN = ("fields_of", "names_of")


def interface(root):
    """Returns the headers of the interface, as paths from `root`."""
    sections = re.split(r"^#.*$", (root / "flexura/public_headers.txt").read_text(), flags=re.M)
    return ["flexura/" + header for header in sections[2].split()]


def version(root):
    return re.search(r"project\(flexura VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text())[1]


def front_page(root, out):
    """Writes docs/library.md without links to documents that the reference lacks; returns its path."""
    text = (root / "docs/library.md").read_text()
    page = out / "library.md"
    page.write_text(re.sub(r"\[([^\]]*)\]\([\w./-]+\.md[^)]*\)", r"\1", text))
    return str(page)


def complaints(told):
    """Yields the relevant lines of Doxygen's output, with paths from the root."""
    for line in told.splitlines():
        if re.search(r"warning: Member .* is not documented", line) or not line.strip():
            continue
        yield line.replace(f"{ROOT}/", "")


def needs_words(function):
    """Returns whether a function's memberdef needs a comment."""
    arguments, name = function.findtext("argsstring") or "", function.findtext("name")
    has_no_argument = arguments.startswith("()")
    is_constructor = not function.findtext("type")
    is_question = has_no_argument and (function.get("const") == "yes" or (is_constructor and name.endswith("Config")))
    is_move = is_constructor and re.match(rf"\({re.escape(name)} ?&&", arguments)
    is_given = re.search(r"= ?(default|delete)$", arguments) or is_move
    is_override = function.find("reimplements") is not None
    return not (is_question or is_given or is_override or name.startswith(("operator", "~")) or name in KNOWN)


def silent_functions(xml):
    """Yields a line with the place of each function without a comment in Doxygen's XML."""
    for path in sorted(xml.glob("*.xml")):
        for compound in ElementTree.parse(path).getroot().iter("compounddef"):
            is_inner = compound.findtext("compoundname").endswith("_detail")
            is_ours = compound.get("prot", "public") == "public" and not is_inner
            if compound.get("kind") not in ("class", "struct", "namespace") or not is_ours:
                continue
            functions = [m for m in compound.iter("memberdef") if m.get("kind") == "function"]
            described = {
                m.findtext("name")
                for m in functions
                if any("".join(m.find(part).itertext()).strip() for part in ("briefdescription", "detaileddescription"))
            }
            for function in functions:
                name, at = function.findtext("name"), function.find("location")
                if function.get("prot") == "public" and name not in described and needs_words(function):
                    where = f"{at.get('file').removeprefix(f'{ROOT}/')}:{at.get('line')}"
                    yield f"{where}: {compound.findtext('compoundname')}::{name} has no comment"


def main():
    out = Path(sys.argv[1]).resolve()
    out.mkdir(parents=True, exist_ok=True)
    shutil.rmtree(out / "xml", ignore_errors=True)  # Doxygen does not delete stale files.
    page = front_page(ROOT, out)
    settings = SETTINGS | {
        "USE_MDFILE_AS_MAINPAGE": page,
        "PROJECT_NUMBER": version(ROOT),
        "OUTPUT_DIRECTORY": str(out),
        "INPUT": " ".join([page, *interface(ROOT)]),
    }
    text = "".join(f"{key} = {value}\n" for key, value in settings.items())
    done = subprocess.run(["doxygen", "-"], input=text, text=True, cwd=ROOT, capture_output=True, check=False)
    found = [*complaints(done.stderr), *sorted(set(silent_functions(out / "xml")))]
    print(*found, sep="\n", end="\n" if found else "")
    return 1 if found or done.returncode else 0


if __name__ == "__main__":
    sys.exit(main())

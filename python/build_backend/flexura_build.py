"""Builds the wheel of the package flexura with CMake: a build backend (PEP 517) without dependencies."""

import base64
import csv
import hashlib
import io
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tarfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = [
    "CMakeLists.txt",
    "CMakePresets.json",
    "LICENSE",
    "README.md",
    "cmake",
    "examples",
    "flexura",
    "pyproject.toml",
    "python",
]


def version():
    return re.search(r"project\(flexura VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]


def metadata():
    return f"""Metadata-Version: 2.1
Name: flexura
Version: {version()}
Summary: Simulator for tentacle and continuum robots under visual control
License: Apache-2.0
Requires-Python: >=3.9
Requires-Dist: numpy>=1.21
Provides-Extra: env
Requires-Dist: gymnasium>=0.29; extra == "env"
Description-Content-Type: text/markdown

{(ROOT / "README.md").read_text()}"""


def tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def build(settings):
    """Builds the package and returns its folder. The setting build-dir names the folder for CMake."""
    folder = ROOT / (settings or {}).get("build-dir", "build/wheel")
    options = {
        "CMAKE_BUILD_TYPE": "Release",
        "CMAKE_UNITY_BUILD": "ON",
        "CMAKE_UNITY_BUILD_BATCH_SIZE": "32",
        "FLEXURA_TESTS": "OFF",
        "FLEXURA_VIEWER": "OFF",
        "FLEXURA_PYTHON": "ON",
        "FLEXURA_PYTHON_EXECUTABLE": sys.executable,
    }
    if not (folder / "CMakeCache.txt").exists():
        flags = [f"-D{name}={value}" for name, value in options.items()]
        subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", *flags], check=True)
    subprocess.run(["cmake", "--build", folder, "--target", "flexura_python", "flexura"], check=True)
    return folder / "python" / "flexura"


class Wheel:
    """A zip file with the record of its files, which a wheel needs."""

    def __init__(self, path):
        self.zip = zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED)
        self.record = []

    def add(self, name, data, mode=0o644):
        entry = zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0))
        entry.external_attr = mode << 16
        self.zip.writestr(entry, data, zipfile.ZIP_DEFLATED)
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        self.record.append((name, f"sha256={digest}", len(data)))

    def close(self, info):
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([*self.record, (f"{info}/RECORD", "", "")])
        self.zip.writestr(f"{info}/RECORD", text.getvalue())
        self.zip.close()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    package = build(config_settings)
    name = f"flexura-{version()}-{tag()}.whl"
    info = f"flexura-{version()}.dist-info"
    wheel = Wheel(os.path.join(wheel_directory, name))
    for file in sorted(package.iterdir()):
        if file.is_file():
            wheel.add(f"flexura/{file.name}", file.read_bytes())
    # pip installs the program beside the interpreter.
    wheel.add(f"flexura-{version()}.data/scripts/flexura", (package.parents[1] / "bin" / "flexura").read_bytes(), 0o755)
    wheel.add(f"{info}/METADATA", metadata().encode())
    wheel.add(f"{info}/LICENSE", (ROOT / "LICENSE").read_bytes())
    text = f"Wheel-Version: 1.0\nGenerator: flexura_build\nRoot-Is-Purelib: false\nTag: {tag()}\n"
    wheel.add(f"{info}/WHEEL", text.encode())
    wheel.close(info)
    return name


def build_sdist(sdist_directory, config_settings=None):
    name = f"flexura-{version()}"
    with tarfile.open(os.path.join(sdist_directory, f"{name}.tar.gz"), "w:gz") as archive:
        for source in SOURCES:
            archive.add(ROOT / source, f"{name}/{source}")
        data = metadata().encode()
        entry = tarfile.TarInfo(f"{name}/PKG-INFO")
        entry.size = len(data)
        archive.addfile(entry, io.BytesIO(data))
    return f"{name}.tar.gz"

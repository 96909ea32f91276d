#!/usr/bin/env python3
"""Prints the table of docs/performance.md: the time of each part, its aim, and a peer from the same run.

usage: tools/performance_table.py [BIN] [--repetitions N]

BIN holds the benchmarks (build/bench/bin, which `./dev bench` makes). Each row is the median of N runs (5) in
CPU time, one program after another; nothing else should run.
"""

import argparse
import json
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

TIME_UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}


@dataclass(frozen=True)
class Row:
    """One row: what is measured, where, the aim (s; None: no aim), and the peer from the same run."""

    what: str
    program: str
    name: str
    aim: float | None = None
    peer: str = ""
    peer_name: str = ""


def rate(per_second: float) -> float:
    return 1 / per_second


ROWS = [
    Row(
        "tip pose of an arm of three sections", "kinematics_bench",
        "tip_of_3_sections", None, "Orocos KDL", "tip_of_3_sections_kdl",
    ),
    Row(
        "tip pose and its Jacobian", "kinematics_bench",
        "jacobian_of_3_sections", 150e-9, "Orocos KDL", "jacobian_of_3_sections_kdl",
    ),
    Row(
        "inverse kinematics of a pose, without an initial shape", "inverse_bench",
        "inverse_cold/kind:2", 20e-6, "Orocos KDL", "inverse_kdl_cold",
    ),
    Row("safety check of a motion of 10 s, four obstacles", "safety_bench", "laboratory_10_s_four_obstacles"),
    Row("rendered picture, 640 x 480, gray", "render_bench", "render/gray_640x480", rate(6000)),
    Row("rendered picture, 640 x 480, colour", "render_bench", "render/color_640x480", rate(4000)),
    Row(
        "rendered picture, 640 x 480, gray, with PSF and noise",
        "render_bench", "render_and_read/psf_and_noise_640x480", rate(3000),
    ),
    Row("rendered picture, 1920 x 1080, gray", "render_bench", "render/gray_1920x1080", rate(1200)),
    Row(
        "rendered picture, 1920 x 1080, gray, with PSF and noise",
        "render_bench", "render_and_read/psf_and_noise_1920x1080", rate(500),
    ),
    Row("rendered picture of a laboratory", "render_bench", "render/laboratory_gray_640x480"),
    Row(
        "rendered picture of a laboratory with a tapered arm",
        "render_bench", "render/tapered_laboratory_gray_640x480",
    ),
    Row(
        "centerline in a picture, 640 x 480", "vision_bench",
        "find_arm/640", rate(8000), "OpenCV, without a centerline", "opencv/640",
    ),
    Row(
        "centerline in a picture, 1920 x 1080", "vision_bench",
        "find_arm/1920", rate(1800), "OpenCV, without a centerline", "opencv/1920",
    ),
    Row("shape fit to measured centerlines, from the previous shape", "shape_bench", "fit_following/0", 80e-6),
    Row("shape from two pictures, from the previous shape", "shape_bench", "pictures_following/0", rate(3000)),
    Row(
        "calibration of two cameras with 13 boards", "intrinsics_bench",
        "calibrate/real_each_and_both", 20e-3, "OpenCV", "opencv_calibrates/real_each_and_both",
    ),
    Row("step of a control law with 50 points", "servo_bench", "points_step/25", 3e-6, "ViSP", "visp_step/25"),
    Row("step of the whole servo loop, one thread", "loop_bench", "whole_loop/no_rings/1", rate(750)),
    Row(
        "step of the whole servo loop, arm with marker bands", "loop_bench",
        "whole_loop/rings/1", rate(750), "llvmpipe, OpenCV, ViSP", "packaged/with_llvmpipe_gray",
    ),
]


def measure(folder: Path, program: str, names: list[str], repetitions: int) -> dict[str, float]:
    """Returns the medians, s, of one program's benchmarks with these names, with or without arguments."""
    pattern = "|".join(f"^{re.escape(name)}(/|$)" for name in names)
    command = [
        str(folder / program),
        f"--benchmark_filter={pattern}",
        f"--benchmark_repetitions={repetitions}",
        "--benchmark_report_aggregates_only=true",
        "--benchmark_format=json",
    ]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(f"performance_table: {program} failed (status {run.returncode}): {run.stderr.strip()}")
    found = {}
    for one in json.loads(run.stdout)["benchmarks"]:
        if one.get("aggregate_name") == "median":
            found[one["run_name"]] = one["cpu_time"] * TIME_UNITS[one["time_unit"]]
    return found


def pick(found: dict[str, float], name: str) -> float | None:
    """Returns the value of the benchmark with this name, or of the first one with this name and arguments."""
    for one, value in found.items():
        if one == name or one.startswith(name + "/"):
            return value
    return None


def time_text(seconds: float) -> str:
    for unit in ("ns", "us", "ms"):
        value = seconds / TIME_UNITS[unit]
        if value < 1000:
            return f"{value:.3g} {unit}"
    return f"{seconds:.3g} s"


def line_of(row: Row, found: dict[str, float]) -> str:
    here = pick(found, row.name)
    if here is None:
        sys.exit(f"performance_table: {row.program} has no benchmark {row.name}")
    aim = "" if row.aim is None else time_text(row.aim)
    distance = "" if row.aim is None else ("met" if here <= row.aim else f"{here / row.aim:.1f} times")
    there = pick(found, row.peer_name) if row.peer else None
    peer = "" if there is None else f"{row.peer}: {time_text(there)}, {there / here:.1f} times"
    return f"| {row.what} | {time_text(here)} | {aim} | {distance} | {peer} | `{row.name}` |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=Path, default=Path("build/bench/bin"))
    parser.add_argument("--repetitions", type=int, default=5)
    arguments = parser.parse_args()
    print("| computation | CPU time | aim | time / aim | other program in the same run | benchmark |")
    print("| --- | ---: | ---: | ---: | --- | --- |")
    for program in dict.fromkeys(row.program for row in ROWS):
        rows = [row for row in ROWS if row.program == program]
        names = [name for row in rows for name in (row.name, row.peer_name) if name]
        found = measure(arguments.folder, program, names, arguments.repetitions)
        for row in rows:
            print(line_of(row, found), flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Draws docs/images/cost-by-sections.svg: the cost of rods by their number of sections.

usage: tools/plot_sections.py JSON... > docs/images/cost-by-sections.svg

The JSON files are Google Benchmark's output of statics_bench and dynamics_bench, with repetitions:

    build/bench/bin/statics_bench --benchmark_filter=_sections/ --benchmark_repetitions=7 \\
      --benchmark_min_time=0.02 --benchmark_enable_random_interleaving=true --benchmark_format=json >statics.json

Each point is the least CPU time of the repetitions, because other programs on the machine only add to it. Both axes
are logarithmic. The dashed lines have the slope 1: they begin at each curve's first point.
"""

import argparse
import json
import math
import sys
from pathlib import Path

TIME_UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
# The benchmarks: name, label, and class of the line.
CURVES = [
    ("statics_sections", "static equilibrium, warm", "first"),
    ("step_of_sections", "step in time, one iteration", "second"),
    ("accelerations_of_sections", "mass matrix, forces, accelerations", "third"),
]
WIDTH, HEIGHT = 620, 410
LEFT, RIGHT, TOP, BOTTOM = 72, 24, 94, 52  # Margins of the plot.
STYLE = """
svg { font-family: sans-serif; font-size: 14px; }
text { fill: #1d2730; }
.sheet { fill: #ffffff; }
.middle { text-anchor: middle; }
.end { text-anchor: end; }
.grid { stroke: #e4e8ec; }
.plot { fill: none; stroke: #9aa6b2; }
.slope { stroke: #76828e; stroke-width: 1.3; stroke-dasharray: 5 4; }
.curve { fill: none; stroke-width: 2; }
.first { stroke: #0b62a4; fill: #0b62a4; }
.second { stroke: #b3541e; fill: #b3541e; }
.third { stroke: #2f7d32; fill: #2f7d32; }
.curve.first, .curve.second, .curve.third { fill: none; }
@media (prefers-color-scheme: dark) {
  text { fill: #e3e8ed; }
  .sheet { fill: #161b20; }
  .grid { stroke: #2c343b; }
  .slope { stroke: #8f9ba6; }
  .first { stroke: #6cb6f2; fill: #6cb6f2; }
  .second { stroke: #f0a06a; fill: #f0a06a; }
  .third { stroke: #7fce83; fill: #7fce83; }
}
"""


def times_of(files: list[Path]) -> dict[str, dict[int, float]]:
    """Returns for each curve's benchmark the least CPU time, s, by number of sections."""
    found: dict[str, dict[int, float]] = {name: {} for name, _, _ in CURVES}
    for file in files:
        for one in json.loads(file.read_text())["benchmarks"]:
            name, _, rest = one["name"].partition("/")
            if name not in found or one.get("run_type") != "iteration":
                continue
            sections = int(rest.split("/")[0])
            time = one["cpu_time"] * TIME_UNITS[one["time_unit"]]
            found[name][sections] = min(time, found[name].get(sections, math.inf))
    return found


def duration(seconds: float) -> str:
    for unit in ("us", "ms"):
        if seconds < 0.9995 * 1000 * TIME_UNITS[unit]:
            return f"{seconds / TIME_UNITS[unit]:.3g} {unit}"
    return f"{seconds:.3g} s"


def drawing(found: dict[str, dict[int, float]]) -> str:
    counts = sorted({count for points in found.values() for count in points})
    times = [time for points in found.values() for time in points.values()]
    low, high = math.floor(math.log10(min(times))), math.ceil(math.log10(max(times)))
    span = math.log10(counts[-1] / counts[0])

    def x(count: float) -> float:
        return LEFT + (WIDTH - LEFT - RIGHT) * math.log10(count / counts[0]) / span

    def y(time: float) -> float:
        return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * (math.log10(time) - low) / (high - low)

    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}">',
        "<title>CPU time of rods by their number of sections, both logarithmic</title>",
        f"<style>{STYLE}</style>",
        f'<rect class="sheet" width="{WIDTH}" height="{HEIGHT}"/>',
    ]
    for count in counts:
        lines.append(f'<path class="grid" d="M{x(count):.1f} {TOP}V{HEIGHT - BOTTOM}"/>')
        lines.append(f'<text class="middle" x="{x(count):.1f}" y="{HEIGHT - BOTTOM + 20}">{count}</text>')
    for power in range(low, high + 1):
        at = y(10.0**power)
        lines.append(f'<path class="grid" d="M{LEFT} {at:.1f}H{WIDTH - RIGHT}"/>')
        lines.append(f'<text class="end" x="{LEFT - 8}" y="{at + 5:.1f}">{duration(10.0**power)}</text>')
    lines.append(
        f'<rect class="plot" x="{LEFT}" y="{TOP}" width="{WIDTH - LEFT - RIGHT}" height="{HEIGHT - TOP - BOTTOM}"/>'
    )
    lines.append(f'<text class="middle" x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 10}">sections</text>')
    row = 20
    for name, label, kind in CURVES:
        points = sorted(found[name].items())
        if not points:
            continue
        (first, time), last = points[0], points[-1][0]
        lines.append(
            f'<path class="slope" d="M{x(first):.1f} {y(time):.1f}L{x(last):.1f} {y(time * last / first):.1f}"/>'
        )
        lines.append(f'<path class="curve {kind}" d="M{"L".join(f"{x(n):.1f} {y(t):.1f}" for n, t in points)}"/>')
        lines += [f'<circle class="{kind}" cx="{x(n):.1f}" cy="{y(t):.1f}" r="3.5"/>' for n, t in points]
        lines.append(f'<circle class="{kind}" cx="{LEFT + 6}" cy="{row - 5}" r="4"/>')
        each = f"{duration(time / first)} to {duration(points[-1][1] / last)} per section"
        lines.append(f'<text x="{LEFT + 18}" y="{row}">{label}: {each}</text>')
        row += 20
    lines.append(f'<path class="slope" d="M{LEFT - 3} {row - 5}h17"/>')
    lines.append(f'<text x="{LEFT + 18}" y="{row}">slope 1</text>')
    lines.append("</svg>")
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", type=Path)
    found = times_of(parser.parse_args().files)
    missing = [name for name, points in found.items() if not points]
    if missing:
        sys.exit(f"plot_sections: no benchmark {', '.join(missing)} in the files")
    sys.stdout.write(drawing(found))


if __name__ == "__main__":
    main()

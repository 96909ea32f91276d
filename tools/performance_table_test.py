#!/usr/bin/env python3
"""Tests of performance_table.py, with programs that print the output of benchmarks."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import performance_table  # noqa: E402

TOOL = Path(performance_table.__file__)


def runs_of(name: str, nanoseconds: float) -> list[dict]:
    """A run and its median, as Google Benchmark writes them; only the median is to be used."""
    common = {"run_name": name, "time_unit": "ns"}
    return [
        {**common, "run_type": "iteration", "cpu_time": 9 * nanoseconds},
        {**common, "aggregate_name": "mean", "cpu_time": 7 * nanoseconds},
        {**common, "aggregate_name": "median", "cpu_time": nanoseconds},
    ]


class PerformanceTable(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        for row in performance_table.ROWS:
            # Each takes twice its aim, or 3 us; peers take 30 us.
            self.add(row.program, row.name + "/process_time", 2e9 * row.aim if row.aim else 3000)
            if row.peer:
                self.add(row.program, row.peer_name, 30000)

    def add(self, program: str, name: str, nanoseconds: float):
        found = Path(self.folder.name) / (program + ".json")
        before = json.loads(found.read_text())["benchmarks"] if found.exists() else []
        found.write_text(json.dumps({"benchmarks": before + runs_of(name, nanoseconds)}))
        fake = Path(self.folder.name) / program
        fake.write_text(f'#!/bin/sh\ncat "{found}"\n')
        fake.chmod(0o755)

    def run_tool(self) -> subprocess.CompletedProcess:
        return subprocess.run([sys.executable, TOOL, self.folder.name], capture_output=True, text=True, check=False)

    def test_has_a_row_for_each_with_its_aim_and_its_peer(self):
        run = self.run_tool()
        self.assertEqual(run.returncode, 0, run.stderr)
        lines = run.stdout.splitlines()
        self.assertEqual(len(lines), 2 + len(performance_table.ROWS))
        self.assertIn(
            "| step of a control law with 50 points | 6 us | 3 us | 2.0 times | ViSP: 30 us, 5.0 times | "
            "`points_step/25` |",
            lines,
        )
        self.assertIn(
            "| safety check of a motion of 10 s, four obstacles | 3 us |  |  |  | `laboratory_10_s_four_obstacles` |",
            lines,
        )

    def test_says_what_is_met(self):
        row = performance_table.ROWS[-1]
        self.assertIn("| met |", performance_table.line_of(row, {row.name: row.aim}))
        self.assertIn("| 1.1 times |", performance_table.line_of(row, {row.name: 1.1 * row.aim}))

    def test_fails_where_a_benchmark_is_not_there_or_ends_badly(self):
        (Path(self.folder.name) / "servo_bench.json").write_text(json.dumps({"benchmarks": []}))
        run = self.run_tool()
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("servo_bench has no benchmark points_step/25", run.stderr)
        (Path(self.folder.name) / "kinematics_bench").write_text("#!/bin/sh\necho out of memory >&2\nexit 3\n")
        self.assertIn("kinematics_bench failed (status 3): out of memory", self.run_tool().stderr)


if __name__ == "__main__":
    unittest.main()

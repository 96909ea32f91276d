#!/usr/bin/env python3
"""Tests of plot_sections.py."""

import json
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import plot_sections  # noqa: E402

TOOL = Path(plot_sections.__file__)


def output_of(names: list[str]) -> dict:
    """Google Benchmark's output: two runs per size, of 3 and 2 us per section, and their mean."""
    runs = []
    for name in names:
        for sections in (1, 10, 100):
            common = {"name": f"{name}/{sections}", "time_unit": "us"}
            runs += [{**common, "run_type": "iteration", "cpu_time": each * sections} for each in (3, 2)]
            runs.append({**common, "name": common["name"] + "_mean", "run_type": "aggregate", "cpu_time": 1e-3})
    return {"benchmarks": runs}


class PlotSections(unittest.TestCase):
    def draw(self, names: list[str]) -> subprocess.CompletedProcess:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "runs.json"
            file.write_text(json.dumps(output_of(names)))
            return subprocess.run([sys.executable, str(TOOL), str(file)], capture_output=True, text=True, check=False)

    def test_draws_the_least_of_the_runs(self):
        drawn = self.draw([name for name, _, _ in plot_sections.CURVES])
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        xml.etree.ElementTree.fromstring(drawn.stdout)
        self.assertEqual(drawn.stdout.count("2 us to 2 us per section"), 3)
        # Each curve is proportional to the sections, so that its points lie on the line of slope 1.
        self.assertEqual(drawn.stdout.count("<circle"), 3 * (3 + 1))

    def test_refuses_files_without_a_curve(self):
        drawn = self.draw(["statics_sections"])
        self.assertEqual(drawn.returncode, 1)
        self.assertIn("no benchmark step_of_sections, accelerations_of_sections", drawn.stderr)


if __name__ == "__main__":
    unittest.main()

"""Tests of what ./dev reads from files that Flexura writes."""

import subprocess
import tempfile
import unittest
from pathlib import Path

root = Path(__file__).resolve().parent.parent

# As `flexura run` writes it; the tasks' tips stand in lines of their own.
summary = """{
  "title": "a \\"tip\\": {\\"position\\": [9,9,9]}",
  "tip_at_start": {
    "position": [0.0,16.0,0.0],
    "rotation": [1.0,0.0,0.0,0.0]
  },
  "tip": {
    "position": [-10.738416,5.2009,0.0],
    "rotation": [0.5,0.5,0.5,0.5]
  },
  "tasks": [
    {"name":"move","tip":{"position":[7.0,8.0,0.0],"rotation":[1.0,0.0,0.0,0.0]}},
    {
      "tip": {
        "position": [1.0,2.0,0.0]
      }
    }
  ]
}
"""


def function_of(name):
    """The text of one function of ./dev, without the rest of it."""
    lines = (root / "dev").read_text().splitlines()
    first = lines.index(f"{name}() {{")
    return "\n".join(lines[first : lines.index("}", first) + 1])


class Dev(unittest.TestCase):
    def tip_in_plane(self, text):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            file.write(text)
            file.flush()
            script = f"set -euo pipefail\n{function_of('tip_in_plane')}\ntip_in_plane {file.name}"
            return subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=False)

    def test_the_tip_of_the_run_is_told_and_not_one_of_its_tasks(self):
        ended = self.tip_in_plane(summary)
        self.assertEqual((ended.returncode, ended.stdout), (0, "-10.738, 5.201\n"), ended.stderr)

    def test_a_summary_without_a_tip_of_its_own_is_a_failure(self):
        without = summary.replace('  "tip": {\n    "position": [-10', '  "tips": {\n    "position": [-10')
        self.assertNotEqual(without, summary)
        ended = self.tip_in_plane(without)
        self.assertEqual((ended.returncode, ended.stdout), (1, ""))


if __name__ == "__main__":
    unittest.main()

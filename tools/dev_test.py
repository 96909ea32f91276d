"""Tests of how ./dev reads files that Flexura and ctest write."""

import subprocess
import tempfile
import unittest
from pathlib import Path

root = Path(__file__).resolve().parent.parent

# Format of `flexura run`; the tasks' tips are nested deeper.
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
    """Returns the text of one function of ./dev."""
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

    def show_failures(self, output):
        """Returns what is printed for a failed test with this output, next to a test that passed."""
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "LastTest.log").write_text(
                "1/2 Testing: good\nOutput:\nall went well\n<end of output>\n2/2 Testing: bad\nOutput:\n"
                + "".join(f"{line}\n" for line in output)
                + "<end of output>\nTest time = 1 sec\n"
            )
            Path(folder, "LastTestsFailed.log").write_text("2:bad\n")
            functions = "\n".join(map(function_of, ["show_failures", "excerpt"]))
            script = f"set -euo pipefail\n{functions}\nshow_failures {folder}"
            return subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True).stdout

    def test_what_a_test_found_wrong_is_told_however_much_passed_after_it(self):
        passed = [f"[ RUN      ] A.{i}\n[       OK ] A.{i} (0 ms)\nsome words of {i}" for i in range(100)]
        told = self.show_failures(["[ RUN      ] A.Bad", "a.cc:7: Failure", "Expected: 3", *passed, "[  FAILED  ] A.Bad"])
        self.assertIn("a.cc:7: Failure\nExpected: 3\n", told)
        self.assertTrue(told.endswith("[  FAILED  ] A.Bad\n\nfailed:\nbad\n"), told)
        self.assertNotIn("all went well", told)
        self.assertLess(len(told.splitlines()), 50)

    def test_a_sanitizers_report_is_told_from_its_beginning(self):
        told = self.show_failures(["==1==ERROR: AddressSanitizer: bad", "#0 in f", *["shadow"] * 60, "==1==ABORTING"])
        self.assertIn("==1==ERROR: AddressSanitizer: bad\n#0 in f\n", told)
        self.assertIn("==1==ABORTING\n", told)

    def test_short_outputs_are_told_once(self):
        self.assertEqual(self.show_failures(["one", "two"]), "\n--- bad:\n2/2 Testing: bad\nOutput:\none\ntwo\n\nfailed:\nbad\n")


if __name__ == "__main__":
    unittest.main()

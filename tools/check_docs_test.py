"""Tests of check_docs.py on made-up documents."""

import sys
import tempfile
import unittest
from pathlib import Path

import check_docs


class CheckDocs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        (self.root / "examples").mkdir()
        (self.root / "examples/arm.toml").write_text("length = 2\nradius = 1\n")
        dev = self.root / "dev"
        dev.write_text("#!/bin/sh\nprintf 'usage: ./dev\\n\\n  test [quick]  build and test\\n'\n")
        dev.chmod(0o755)

    def problems(self, text, name="README.md"):
        (self.root / name).parent.mkdir(exist_ok=True)
        (self.root / name).write_text(text)
        return list(check_docs.problems(self.root, self.root, self.root))

    def console(self, text):
        return self.problems(f"```console\n{text}\n```\n")

    def test_a_command_that_does_what_it_says_passes(self):
        self.assertEqual(self.console("$ echo one; echo two\none\ntwo\n\n$ true"), [])

    def test_other_output_is_found_at_its_line(self):
        found = self.console("$ true\n$ echo one\ntwo")
        self.assertEqual(len(found), 1)
        self.assertTrue(found[0].startswith("README.md:3: this is printed instead: echo one\none"), found)

    def test_dots_stand_for_text_and_for_lines(self):
        self.assertEqual(self.console("$ printf 'a 17 b\\nx\\ny\\nend\\n'\na ... b\n...\nend"), [])
        self.assertEqual(len(self.console("$ printf 'a 17 c\\nend\\n'\na ... b\nend")), 1)

    def test_a_failing_command_is_found_unless_its_status_is_said(self):
        self.assertEqual(len(self.console("$ sh -c 'exit 2'")), 1)
        self.assertEqual(self.console("$ sh -c 'exit 2'  # exit status 2"), [])
        self.assertEqual(len(self.console("$ true  # exit status 2")), 1)

    def test_a_failure_inside_a_pipe_is_found(self):
        self.assertEqual(len(self.console("$ false | cat")), 1)

    def test_a_command_may_go_on_over_lines(self):
        self.assertEqual(self.console("$ echo one \\\n    two\none two"), [])

    def test_a_viewer_is_ended_once_the_results_are_there(self):
        viewer = self.root / "viewer"
        viewer.write_text("#!/bin/bash\necho \"viewer: $*\"\ntrap 'echo told; exit 0' TERM\necho results: here\n"
                          "while true; do sleep 0.05; done\n")
        viewer.chmod(0o755)
        told = "viewer: --view --no-browser --port 0\nresults: here\ntold"
        self.assertEqual(self.console(f"$ viewer --view\n{told}"), [])
        viewer.write_text("#!/bin/bash\necho no results\nexit 1\n")
        self.assertEqual(len(self.console("$ viewer --view")), 1)

    def test_commands_share_the_scratch_folder_with_the_examples_and_written_files(self):
        text = "```toml\n# file: mine/b.toml\nb = 1\n```\n```console\n$ cat mine/b.toml examples/arm.toml\n"
        self.assertEqual(self.problems(text + "b = 1\nlength = 2\n...\n```\n"), [])

    def test_a_quoted_file_has_to_hold_the_quotation(self):
        self.assertEqual(self.problems("```toml\n# from: examples/arm.toml\nradius = 1\n```\n"), [])
        found = self.problems("```toml\n# from: examples/arm.toml\nradius = 2\n```\n")
        self.assertEqual(found, ["README.md:1: this does not stand in examples/arm.toml"])

    def test_a_dev_command_has_to_exist(self):
        self.assertEqual(self.console("$ ./dev test quick"), [])
        self.assertEqual(len(self.console("$ ./dev tes")), 1)

    def test_commands_outside_console_blocks_and_parts_of_programs_are_refused(self):
        self.assertEqual(len(self.problems("```bash\nls\n```\n")), 1)
        self.assertEqual(len(self.problems("```cpp\nint a;\n```\n")), 1)

    def test_a_program_is_built_as_the_cmake_block_before_it_says(self):
        program = "```cpp\n#include <cstdio>\nint main() { std::puts(WORD); }\n// prints: yes\n```\n"
        build = ("```cmake\nadd_executable(my_arm main.cc)\n"
                 "{}target_compile_definitions(my_arm PRIVATE WORD=\"{}\")\n```\n")
        self.assertEqual(self.problems(build.format("", "yes") + program), [])
        found = self.problems(build.format("", "no") + program)
        self.assertEqual(len(found), 1)
        self.assertIn("this is printed instead (exit status 0)\nno", found[0])
        self.assertIn("this does not compile", self.problems(build.format("no_command()\n", "yes") + program)[0])
        misspelt = program.replace("puts", "put")
        self.assertIn("this does not compile", self.problems(build.format("", "yes") + misspelt)[0])

    def test_a_python_program_has_to_print_what_it_says(self):
        def found(text):
            (self.root / "README.md").write_text(f"```python\n{text}\n```\n")
            return list(check_docs.problems(self.root, self.root, self.root, sys.executable))

        self.assertEqual(found("print(1 + 1)  # prints: 2"), [])
        self.assertEqual(found("print(open('examples/arm.toml').read())"), [])
        self.assertIn("this is printed instead (exit status 0)\n2", found("print(1 + 1)  # prints: 3")[0])
        self.assertIn("exit status 1", found("raise ValueError")[0])
        self.assertEqual(self.problems("```python\nraise ValueError\n```\n"), [])

    def test_versions_agree(self):
        (self.root / "CMakeLists.txt").write_text("project(flexura VERSION 1.2.3 LANGUAGES CXX)\n")
        (self.root / "viewer").mkdir()
        (self.root / "viewer/package.json").write_text('{\n  "version": "1.2.3"\n}\n')
        newest = "# Changes\n\n## Unreleased\n\n## 1.2.3 - 2026-11-24\n\n## 1.2.2 - 2026-01-01\n"
        self.assertEqual(self.problems(newest, "CHANGELOG.md"), [])
        self.assertEqual(self.problems(newest.replace("1.2.3 - 2026-11-24", "1.2.4 - unreleased"), "CHANGELOG.md"),
                         ["CHANGELOG.md: the version is 1.2.2, that of CMakeLists.txt 1.2.3"])
        (self.root / "viewer/package.json").write_text('{\n  "version": "1.2.2"\n}\n')
        self.assertEqual(len(self.problems(newest, "CHANGELOG.md")), 1)
        for version, count in (("1.2", 1), ("1.1", 2), ("1.2.3", 1), ("1.2.30", 2)):
            (self.root / "docs").mkdir(exist_ok=True)
            (self.root / "docs/library.md").write_text(f"find_package(flexura {version} REQUIRED)\n")
            self.assertEqual(len(self.problems(newest, "CHANGELOG.md")), count, version)

    def test_names_have_to_be_those_of_the_sources(self):
        (self.root / "flexura").mkdir()
        (self.root / "flexura/arm.h").write_text("class Arm { void bend(); };\n")
        (self.root / "flexura/arm_test.cc").write_text("TEST_P(Arm,\n       Bends) {}\n")
        self.assertEqual(self.problems("`Arm::bend` and `Arm::bend(2)`, **`Arm.Bends`**, `X.Y`, `a.b`\n"), [])
        self.assertEqual(
            self.problems("one\n\n`Arm::twist`\n`Leg::bend`, `Arm.Twists`\n"),
            [
                "README.md:3: no source has Arm::twist",
                "README.md:4: no source has Leg::bend",
                "README.md:4: there is no test Arm.Twists",
            ],
        )
        (self.root / "README.md").unlink()
        self.assertEqual(self.problems("`Arm::twist`\n", "CHANGELOG.md"), [])

    def test_a_link_has_to_lead_to_a_file_and_a_heading(self):
        good = "# The `arm`, moved\n[a](examples/arm.toml) [b](#the-arm-moved) [c](https://example.org/x)\n"
        self.assertEqual(self.problems(good), [])
        self.assertEqual(self.problems("\n[a](gone.md)\n"), ["README.md:2: the link gone.md leads nowhere"])
        self.assertEqual(len(self.problems("# A\n[a](#b)\n")), 1)
        self.assertEqual(len(self.problems('<img width="3" src="gone.png">\n')), 1)

    def test_documents_below_docs_are_read(self):
        self.assertEqual(self.problems("[x](../examples/arm.toml)\n", "docs/a.md"), [])
        self.assertEqual(len(self.problems("[x](arm.toml)\n", "docs/a.md")), 1)


if __name__ == "__main__":
    unittest.main()

"""Tests of check_includes.py on a made-up tree."""

import tempfile
import unittest
from pathlib import Path

import check_includes


class CheckIncludes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write("flexura/floors.txt", "# floor folder\n0 base\n1 left\n1 right\n2 top\n")
        self.write("flexura/base/CMakeLists.txt", "flexura_folder(base LINKS fmt::fmt)")
        self.write("flexura/left/CMakeLists.txt", "flexura_folder(left LINKS flexura::base)")
        self.write("flexura/right/CMakeLists.txt", "flexura_folder(right)")
        self.write("flexura/top/CMakeLists.txt", "flexura_folder(top LINKS flexura::left)")
        self.write("flexura/base/a.h", "#include <vector>\n")
        self.write("flexura/left/b.cc", '#include "flexura/left/b.h"\n#include "flexura/base/a.h"\n')
        self.write("flexura/top/c_test.cc", '#include "flexura/left/b.h"\n#include "tests/support/folder.h"\n')

    def write(self, path, text):
        target = self.root / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text)

    def problems(self):
        return list(check_includes.problems(self.root))

    def test_a_tree_that_only_looks_down_passes(self):
        self.assertEqual(self.problems(), [])

    def test_an_include_upwards_is_found_with_its_line(self):
        self.write("flexura/base/a.h", '\n#include "flexura/top/c.h"\n')
        self.assertEqual(self.problems(), ["flexura/base/a.h:2: base (floor 0) may not include top (floor 2)"])

    def test_an_include_sideways_is_found_in_a_subfolder_too(self):
        self.write("flexura/left/deep/d.h", '#  include "flexura/right/e.h"\n')
        self.assertEqual(
            self.problems(), ["flexura/left/deep/d.h:1: left (floor 1) may not include right (floor 1)"])

    def test_an_include_of_a_room_beside_is_found_but_not_one_of_its_own_or_of_what_they_share(self):
        self.write("flexura/left/kitchen/k.h", '#include "flexura/left/b.h"\n#include "flexura/left/kitchen/l.h"\n')
        self.write("flexura/left/all.h", '#include "flexura/left/kitchen/k.h"\n')
        self.assertEqual(self.problems(), [])
        self.write("flexura/left/hall/h.h", '#include "flexura/left/kitchen/k.h"\n')
        self.assertEqual(self.problems(), [
            "flexura/left/hall/h.h:1: left/hall may not include left/kitchen: each is a room of its own"])

    def test_an_include_relative_to_the_file_is_found(self):
        self.write("flexura/left/b.cc", '#include "../right/e.h"\n#include "flexura/base/a.h"\n')
        self.assertEqual(
            self.problems(), ['flexura/left/b.cc:1: "../right/e.h" is not written "flexura/FOLDER/FILE"'])

    def test_a_type_that_two_headers_define_is_found_but_not_an_unnamed_or_a_declared_one(self):
        self.write("flexura/base/a.h", "struct Tube {\n};\nclass Later;\n")
        self.write("flexura/left/b.h", "namespace {\nstruct Tube {\n};\n}  // namespace\nclass Later final : public X {\n};\n")
        self.assertEqual(self.problems(), [])
        self.write("flexura/right/b.h", "class Later : Tube {\n};\nstruct Tube {\n};\n")
        self.assertEqual(self.problems(), [
            "flexura/right/b.h: Later is defined in flexura/left/b.h too",
            "flexura/right/b.h: Tube is defined in flexura/base/a.h too",
        ])

    def test_what_the_tests_share_stays_out_of_the_library(self):
        self.write("flexura/top/c.cc", '#include "tests/support/folder.h"\n')
        self.assertEqual(self.problems(), [
            'flexura/top/c.cc:1: "tests/support/folder.h" is not written "flexura/FOLDER/FILE"'])

    def test_an_unlisted_folder_is_found_and_so_is_its_use(self):
        self.write("flexura/top/c.h", '#include "flexura/left/b.h"\n')
        self.write("flexura/top/c_test.cc", '#include "flexura/cellar/x.h"\n')
        self.write("flexura/cellar/x.h", "")
        self.assertEqual(self.problems(), [
            "flexura/cellar is not in flexura/floors.txt",
            "flexura/top/c_test.cc:1: cellar is not in flexura/floors.txt",
        ])

    def test_a_listed_folder_without_its_target_is_found(self):
        self.write("flexura/right/CMakeLists.txt", "add_library(right right.cc)")
        self.assertEqual(
            self.problems(), ["flexura/right/CMakeLists.txt: flexura_folder(right ...) is missing"])

    def test_a_link_sideways_is_found(self):
        self.write("flexura/left/CMakeLists.txt", "flexura_folder(left LINKS\n flexura::base flexura::right)")
        self.assertEqual(self.problems(), ["flexura/left/CMakeLists.txt: left may not link right"])

    def test_links_are_what_is_included(self):
        self.write("flexura/right/f.h", '#include "flexura/base/a.h"\n')
        self.write("flexura/top/CMakeLists.txt", "flexura_folder(top LINKS flexura::left flexura::base)")
        self.assertEqual(self.problems(), [
            "flexura/right/CMakeLists.txt: right includes base and does not link it",
            "flexura/top/CMakeLists.txt: top links base, of which it includes nothing",
        ])

    def test_public_headers_are_there_once_with_all_that_they_include(self):
        self.write("flexura/left/b.h", '#include "flexura/base/a.h"\n')
        self.write("flexura/public_headers.txt", "# these\nleft/b.h\n\nbase/a.h  # carried\n")
        self.assertEqual(self.problems(), [])
        self.write("flexura/public_headers.txt", "left/b.h\nleft/c.h\nleft/b.h\n")
        self.assertEqual(self.problems(), [
            "flexura/public_headers.txt:2: there is no left/c.h",
            "flexura/public_headers.txt:3: left/b.h is listed twice",
            "flexura/public_headers.txt:1: left/b.h includes flexura/base/a.h, which is not listed",
        ])

    def test_what_is_installed_for_the_compiler_alone_is_included(self):
        self.write("flexura/base/d.h", "")
        self.write("flexura/left/b.h", '#include "flexura/base/a.h"\n')
        self.write("flexura/public_headers.txt", "left/b.h\n# What these include: more\nbase/a.h\nbase/d.h\n")
        self.assertEqual(
            self.problems(), ["flexura/public_headers.txt:4: no listed header includes base/d.h"])


if __name__ == "__main__":
    unittest.main()

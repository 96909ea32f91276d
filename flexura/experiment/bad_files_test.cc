// Invalid experiment files: each must give clear lines with the place, the error and the expectation.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/experiment_files.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* good_file = R"([arm]
kind = "planar"
[[arm.section]]
length = 2.0
[[arm.section]]
length = 1.0
[[task]]
kind = "move"
duration = 2.0
to.archings_pi = [0.1, 0.2]
)";

// Returns the good file with the first `from` replaced.
std::string file_with(const std::string& from, const std::string& to) {
  return replaced(good_file, from, to);
}

TEST(BadFiles, TheGoodOneIsGood) { EXPECT_EQ(error_of_file(good_file), "no error"); }

TEST(BadFiles, EachGetsALineWithPlaceValueAndExpectation) {
  const std::vector<BadFile> files{
      {"empty", "", "x.toml:1:1: arm: missing: expected a table (Arm.)"},
      {"blank", "\n\n# nothing\n", "x.toml:1:1: arm: missing"},
      {"no sections", "[arm]\nkind = 'planar'\n",
       "x.toml:1:2: arm.section: missing: expected an array (Sections from base to tip, as tables "
       "[[arm.section]].)"},
      {"empty arm", "[arm]\nsection = []\n",
       "x.toml:2:11: arm.section is an empty array: expected an array of 1 to 1000"},
      {"no length", file_with("length = 2.0\n", ""), "x.toml:3:1: arm.section[0].length: missing: expected"},
      {"negative length", file_with("2.0", "-2.0"),
       "x.toml:4:10: arm.section[0].length = -2: expected a number from 1e-06 m to 1000000 m"},
      {"zero length", file_with("2.0", "0"),
       "x.toml:4:10: arm.section[0].length = 0: expected a number from 1e-06 m to 1000000 m"},
      {"huge length", file_with("2.0", "1e300"),
       "x.toml:4:10: arm.section[0].length = 1e+300: expected a number from 1e-06 m to 1000000 m"},
      {"a duration that is hardly a number", file_with("duration = 2.0", "duration = 1e-320"),
       "x.toml:9:12: task[0].duration = 1e-320: expected a number from 1e-09 s to 1000000 s"},
      {"NaN", file_with("2.0", "nan"),
       "x.toml:4:10: arm.section[0].length = nan: expected a number from 1e-06 m to 1000000 m"},
      {"infinity", file_with("2.0", "-inf"), "x.toml:4:10: arm.section[0].length = -inf: expected"},
      {"text for a number", file_with("2.0", "'2.0'"),
       "x.toml:4:10: arm.section[0].length = \"2.0\": expected a number"},
      {"number for a text", file_with("\"planar\"", "3"),
       "x.toml:2:8: arm.kind = 3: expected one of \"planar\", \"spatial\""},
      {"table for an array", file_with("[0.1, 0.2]", "{a = 1}"),
       "task[0].to.archings_pi is a table: expected an array"},
      {"array for a table",
       file_with("[arm]\nkind = \"planar\"\n[[arm.section]]", "[[arm]]\n[[arm.section]]"),
       "x.toml:1:1: arm is an array of 1: expected a table"},
      {"date for a number", file_with("2.0", "2026-01-01"),
       "arm.section[0].length = the date 2026-01-01: expected a number"},
      {"misspelt key", file_with("length = 2.0", "lenght = 2.0"),
       "x.toml:4:1: arm.section[0].lenght: unknown key; did you mean \"length\"?"},
      {"misspelt table", file_with("[arm]", "[arms]\n[arm]"),
       "x.toml:1:2: arms: unknown key; did you mean \"arm\"?"},
      {"wrong unit", file_with("length = 2.0", "length_deg = 2.0"),
       "x.toml:4:1: arm.section[0].length_deg: wrong unit: expected length (m), length_mm (mm)"},
      {"two units", file_with("length = 2.0", "length = 2.0\nlength_mm = 2000"),
       "x.toml:5:1: arm.section[0].length_mm: occurs twice: length is already in line 4"},
      {"duplicate key", file_with("length = 2.0", "length = 2.0\nlength = 3.0"),
       "x.toml:5:10: 'length' occurs twice: expected each key once"},
      {"unclosed text", file_with("\"planar\"", "\"planar"), "x.toml:2:"},
      {"unknown kind of task", file_with("\"move\"", "\"jump\""),
       "x.toml:8:8: task[0].kind = \"jump\": expected one of \"move\", \"hold\""},
      {"task without a kind", file_with("kind = \"move\"\n", ""),
       "x.toml:7:1: task[0]: kind is missing: expected one of"},
      {"a length that no coordinate can tell", file_with("2.0", "1e-200"),
       "x.toml:4:10: arm.section[0].length = 1e-200: expected a number from 1e-06 m to 1000000 m"},
      {"a radius of nothing", file_with("length = 2.0", "length = 2.0\nradius_mm = 1e-9"),
       "x.toml:5:13: arm.section[0].radius_mm = 1e-09: expected a number from 0.001 mm to 1000000000 mm"},
      {"cameras that stand on the base",
       file_with("[arm]", "stand.camera_distances = [1, 1e-12]\n[arm]\nbase.position = [1e6, 0, 0]"),
       "x.toml:1:7: stand.camera_distances: puts camera \"side\" at the arm's base"},
      {"two obstacles of one name",
       file_with("[[task]]",
                 "[[obstacle]]\nkind = 'plane'\nname = 'sphere 2'\n[[obstacle]]\n"
                 "kind = 'sphere'\ncenter = [9, 9, 9]\nradius = 1\n[[task]]"),
       "x.toml:10:1: obstacle[1].name: \"sphere 2\" is the name of another obstacle"},
      {"a table for an array of them", file_with("[[task]]", "[task]"),
       "x.toml:7:1: task is a table: expected several, as tables [[task]]"},
      {"a section for several", "[arm]\n[arm.section]\nlength = 1\n",
       "x.toml:2:1: arm.section is a table: expected several, as tables [[arm.section]]"},
      {"a misspelt word", file_with("duration = 2.0", "law = 'linaer'\nduration = 2.0"),
       "x.toml:9:7: task[0].law = \"linaer\": expected one of \"linear\", \"minimum_jerk\", \"trapezoid\"; "
       "did you "
       "mean \"linear\"?"},
      {"a word in capitals", file_with("\"planar\"", "'Planar'"), "did you mean \"planar\"?"},
      {"a misspelt kind", file_with("\"move\"", "\"mvoe\""), "did you mean \"move\"?"},
      {"a bend of hundreds of turns", file_with("archings_pi = [0.1, 0.2]", "archings = [501, 0]"),
       "x.toml:10:16: task[0].to.archings[0] = 501: expected a number from -500 rad to 500 rad"},
      {"the same as a bend", file_with("archings_pi = [0.1, 0.2]", "bends = [[1001, 0], [0, 0]]"),
       "task[0].to.bends[0][0] = 1001: expected a number from -1000 rad to 1000 rad"},
      {"and as an angle of its cord", file_with("archings_pi = [0.1, 0.2]", "cord_angles = [600, 0]"),
       "x.toml:10:4: task[0].to.cord_angles: bends section 1 by 1196.86 rad: expected at most 1000 rad"},
      {"in both directions at once",
       "[arm]\nkind = 'spatial'\ninitial.bends = [[800, 800]]\n[[arm.section]]\nlength = 1\n",
       "x.toml:3:9: arm.initial.bends: bends section 1 by 1131.37 rad: expected at most 1000 rad"},
      {"keyframes without rows",
       file_with("kind = \"move\"\nduration = 2.0\nto.archings_pi = [0.1, 0.2]",
                 "kind = 'keyframes'\ncolumns = ['time', 'arching_1', 'arching_2']\nrows = []"),
       "x.toml:10:1: task[0].rows: 0 rows: expected at least 2"},
      {"keyframes with one row",
       file_with("kind = \"move\"\nduration = 2.0\nto.archings_pi = [0.1, 0.2]",
                 "kind = 'keyframes'\ncolumns = ['time', 'arching_1', 'arching_2']\nrows = [[0, 0, 0]]"),
       "x.toml:10:1: task[0].rows: 1 row: expected at least 2"},
      {"keyframes of too many turns",
       file_with("kind = \"move\"\nduration = 2.0\nto.archings_pi = [0.1, 0.2]",
                 "kind = 'keyframes'\ncolumns = ['time', 'arching_1', 'arching_2']\n"
                 "rows = [[0, 0, 0], [1, 501, 0]]"),
       "task[0].rows[1][1]: angle 501 rad: expected from -500 rad to 500 rad"},
      {"a text in a formula",
       file_with("kind = \"move\"\nduration = 2.0\nto.archings_pi = [0.1, 0.2]",
                 "kind = 'expression'\nduration = 2.0\narchings = 't + \"1\"'"),
       "x.toml:10:17: task[0].archings[0]: contains a text in quotes: expected numbers, names and operators"},
      {"negative duration", file_with("duration = 2.0", "duration = -2.0"),
       "x.toml:9:12: task[0].duration = -2: expected a number from 1e-09 s"},
      {"no target", file_with("to.archings_pi = [0.1, 0.2]\n", ""),
       "x.toml:7:1: task[0].to: missing: expected a table (Target shape, as"},
      {"too few angles", file_with("[0.1, 0.2]", "[0.1]"),
       "x.toml:10:4: task[0].to.archings: 1 given: expected 2 values, one per section"},
      {"bad angle", file_with("0.2]", "true]"),
       "x.toml:10:24: task[0].to.archings_pi[1] = true: expected a number from"},
      {"two ways", file_with("to.archings_pi", "to.cord_angles = [1, 2]\nto.archings_pi"),
       "task[0].to: gives the bends in more than one way"},
      {"out of the plane", file_with("archings_pi = [0.1, 0.2]", "bends = [[0.1, 0.2], [0.1, 0]]"),
       "task[0].to.bends[0]: leaves the plane: expected bend_y = 0 for a planar arm"},
      {"planar words for a spatial arm", file_with("planar", "spatial"),
       "x.toml:10:4: task[0].to.archings: is for planar arms: expected bends for a spatial arm"},
      {"bends that are no pairs", file_with("archings_pi = [0.1, 0.2]", "bends = [[0.1], [0.1, 0, 0]]"),
       "task[0].to.bends[1] is an array of 3: expected an array of 2"},
      {"a quaternion that is none",
       file_with("[arm]\nkind = \"planar\"", "[arm]\nkind = \"spatial\"\nbase.rotation = [1, 1, 0, 0]"),
       "x.toml:3:6: arm.base.rotation: has the norm 1.41421: expected a unit quaternion"},
      {"rotation for a planar arm", file_with("[arm]", "[arm]\nbase.rotation = [1, 0, 0, 0]"),
       "arm.base.rotation: is for spatial arms: expected base.tangent_deg for a planar arm"},
      {"limits the wrong way round", file_with("length = 2.0", "length = 2.0\nstretch_limits = [2, 1]"),
       "x.toml:5:1: arm.section[0].stretch_limits: expected the smaller factor first"},
      {"steps without end", file_with("[arm]", "clock.step = 1e-6\n[arm]"),
       "x.toml:1:14: clock.step: makes 2e+06 steps in 2 s: expected at most 1e+06"},
      {"negative seed", "seed = -1\n" + std::string(good_file),
       "x.toml:1:8: seed = -1: expected a whole number from 0 to"},
      {"a number too large for TOML", file_with("2.0", "99999999999999999999"), "x.toml:4:"},
      {"not text",
       std::string("\x7f"
                   "ELF\x02\x01\x01\0\0\0",
                   10),
       "x.toml:1:8: not a text: byte 0x00: expected TOML in UTF-8"},
      {"a picture", "\x89PNG\r\n", "x.toml:1:1: not a text: byte 0x89: expected TOML in UTF-8"},
      {"another encoding", file_with("planar", "r\xE4umlich"),
       "not a text: byte 0xE4: expected TOML in UTF-8"},
      {"brackets that are no text", std::string(40, '[') + std::string(1, '\0'),
       "x.toml:1:41: not a text: byte 0x00: expected TOML in UTF-8"},
  };
  for (const BadFile& file : files) EXPECT_THAT(error_of_file(file.text), HasSubstr(file.error)) << file.what;
}

TEST(BadFiles, SeveralErrorsAreReportedAtOnceInOneLineEach) {
  EXPECT_EQ(
      error_of_file("[arm]\nknid = 'planar'\n[[arm.section]]\nlength = -1\nradius = 0\n[[arm.section]]\n"),
      "x.toml:2:1: arm.knid: unknown key; did you mean \"kind\"?\n"
      "x.toml:4:10: arm.section[0].length = -1: expected a number from 1e-06 m to 1000000 m\n"
      "x.toml:5:10: arm.section[0].radius = 0: expected a number from 1e-06 m to 1000000 m\n"
      "x.toml:6:1: arm.section[1].length: missing: expected a number from 1e-06 m to 1000000 m "
      "(Length of the section's backbone at stretch 1.)");
}

TEST(BadFiles, WhatTheTruthInheritsIsToldOnce) {
  const std::string text = error_of_file(
      "[arm]\n[[arm.section]]\nlength = 1\n[[camera]]\nname = 'front'\n"
      "mount = { position = [0, 0, 2], look_at = [0, 0, 0] }\nlens = { fx = -3 }\n"
      "[[truth.camera]]\nname = 'front'\nmount.roll_deg = 1\n[[task]]\nkind = 'hold'\nduration = 1\n");
  EXPECT_THAT(text, HasSubstr("camera[0].lens.fx = -3"));
  EXPECT_THAT(text, Not(HasSubstr("truth.camera[0].lens.fx")));
}

TEST(BadFiles, ThousandsOfBandsAreTooMany) {
  std::string text = "[arm]\nlook.bands.per_section = 1000\n";
  for (int i = 0; i < 6; ++i) text += "[[arm.section]]\nlength = 1\n";
  EXPECT_THAT(error_of_file(text + "[[task]]\nkind = 'hold'\nduration = 1\n"),
              HasSubstr("results in 6000 bands: expected at most 4096"));
}

TEST(BadFiles, ATrapezoidFromWhereAFormulaIsNowhereTakesTooLong) {
  EXPECT_THAT(error_of_file("[arm]\n[[arm.section]]\nlength = 1\n"
                            "[[task]]\nkind = 'expression'\nduration = 1\narchings = '1.1e308*t'\n"
                            "[[task]]\nkind = 'move'\nlaw = 'trapezoid'\nmax_rate = 1\n"
                            "max_acceleration = 2\nto.archings = [0.1]\n"),
              HasSubstr("clock.step: makes"));
}

TEST(BadFiles, KeysWrittenTwiceAreToldWithTheRest) {
  EXPECT_EQ(
      error_of_file("[arm]\nkind = 'planar'\nkind = 'spatial'\n[[arm.section]]\nlength = -1\nlength = 2\n"),
      "x.toml:3:8: 'kind' occurs twice: expected each key once\n"
      "x.toml:6:10: 'length' occurs twice: expected each key once\n"
      "x.toml:5:10: arm.section[0].length = -1: expected a number from 1e-06 m to 1000000 m");
  EXPECT_EQ(error_of_file("[arm]\nkind = 'planar'\nkind = [\n 1]\n[[arm.section]]\nlength = -1\n"),
            "x.toml:3:8: 'kind' occurs twice: expected each key once")
      << "what follows a value of several lines is not judged";
  EXPECT_EQ(error_of_file("[arm]\nsection = [{length = 1, length = 2}]\n"),
            "x.toml:2:34: 'length' occurs twice: expected each key once")
      << "nor what stands beside it";
}

TEST(BadFiles, AMillionSectionsAreTooMany) {
  constexpr int count = 1'000'000 / one_case_of;
  std::string text = "[arm]\nsection = [";
  for (int i = 0; i < count; ++i) text += "{length=1},";
  EXPECT_THAT(error_of_file(text + "]\n"),
              HasSubstr(fmt::format("arm.section is an array of {}: expected an array of 1 to 1000", count)));
}

}  // namespace
}  // namespace flexura

#include "flexura/store/toml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "flexura/base/source.h"
#include "flexura/store/json.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

std::string toml_error_of(std::string_view text) {
  try {
    (void)parse_toml(text, "x.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ParseToml, KeepsValuesTheirOrderAndTheirPlaces) {
  const Node node = parse_toml("z = 1\na = [2.5, true]\n[t]\ns = 'x'\n", "x.toml");
  EXPECT_EQ(write_json(node), R"({"z":1,"a":[2.5,true],"t":{"s":"x"}})");
  EXPECT_EQ(node.find("a")->as<Node::Array>()->at(1).where.text(), "x.toml:2:11");
  EXPECT_EQ(node.find("t")->find("s")->where.text(), "x.toml:4:5");
}

TEST(ParseToml, ReportsWhatIsNotToml) {
  EXPECT_THAT(toml_error_of("a = 1\na = 2\n"), HasSubstr("x.toml:2:"));
  EXPECT_THAT(toml_error_of("a = "), HasSubstr("x.toml:1:"));
  EXPECT_THAT(toml_error_of("a = 1\nb = \xff\xfe\n"), HasSubstr("x.toml:2:"));
  EXPECT_THAT(toml_error_of(std::string_view("\0\1\2binary", 9)), HasSubstr("x.toml:1:"));
  EXPECT_THAT(toml_error_of("a = \"open\nb = 1\n"),
              HasSubstr("x.toml:1:10: the text does not end on its line"));
}

TEST(ParseToml, SaysWhatIsExpectedWhereTheTextEndsOrHoldsAWord) {
  EXPECT_EQ(toml_error_of("a ="),
            "x.toml:1:4: the file ends within this key-value pair: expected it to be closed");
  EXPECT_EQ(toml_error_of("a = [1,"),
            "x.toml:1:8: the file ends within this array: expected it to be closed");
  EXPECT_EQ(toml_error_of("a = b"),
            "x.toml:1:5: no value: expected a number, a text in quotes, true or false, an array or a table");
}

TEST(ParseToml, SaysOfANumberWithAUnitWhereUnitsBelong) {
  for (const char* text : {"a = 30cm", "a = 1.5m", "a = 0x1g"})
    EXPECT_THAT(toml_error_of(text),
                HasSubstr("not a number: expected only digits; a unit is part of the key"))
        << text;
  EXPECT_EQ(toml_error_of("a = [1 2]").find("Error while"), std::string::npos);
}

TEST(ParseToml, CanReadOnWhereAKeyIsWrittenTwice) {
  std::vector<Problem> repeated;
  const Node node = parse_toml("a = 1\na = 2\nb = 3\n[t]\nc = 1\nc = 'x'\nd = 4\n", "x.toml", &repeated);
  ASSERT_EQ(repeated.size(), 2U);
  EXPECT_EQ(repeated[0].where.line, 2);
  EXPECT_EQ(repeated[1].where.line, 6);
  EXPECT_EQ(node.find("a")->brief(), "1");
  EXPECT_EQ(node.find("b")->where.text(), "x.toml:3:5");
  EXPECT_EQ(node.find("t")->find("d")->where.text(), "x.toml:7:5");
  // A repeated table header, or other invalid TOML, ends the reading; both errors must be reported.
  EXPECT_THAT(toml_error_of("a = 1\na = 2\n[t]\n[t]\nb = 1\nb = 2\n"), HasSubstr("x.toml:2:"));
  EXPECT_THAT(toml_error_of("[t]\n[t]\n"), HasSubstr("x.toml:2:"));
}

TEST(ParseToml, NamesDatesSoThatNoFieldTakesThem) {
  EXPECT_EQ(parse_toml("a = 2026-01-02", "x.toml").find("a")->brief(), "the date 2026-01-02");
}

TEST(ParseToml, RefusesNestingThatWouldOverflowTheStack) {
  std::string dotted = "a";
  for (int i = 0; i < 1000000; ++i) dotted += ".a";
  EXPECT_THAT(toml_error_of(dotted + " = 1"), HasSubstr("a dotted key nested more than 32 deep"));
  EXPECT_THAT(toml_error_of("[" + dotted + "]"), HasSubstr("dotted key"));
  EXPECT_THAT(toml_error_of("x = [\"\"\"q\"\"\"\", {" + dotted + " = 1}]"), HasSubstr("dotted key"))
      << "a text with quotes of its own hides nothing";
  EXPECT_THAT(toml_error_of("b = " + std::string(100000, '[')),
              HasSubstr("brackets nested more than 32 deep"));
}

TEST(ParseToml, CountsDotsInTextsAndCommentsAsNothing) {
  const std::string dots(100, '.');
  EXPECT_EQ(toml_error_of("a = \"" + dots + "\" # " + dots + "\nb = '" + dots + "'\nc = \"\"\"" + dots +
                          "\"\"\"\n"),
            "");
  EXPECT_EQ(
      toml_error_of(
          "a = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0,"
          "1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]"),
      "");
}

TEST(ParseTomlValue, ReadsAValueOrABareWord) {
  const auto value = [](std::string_view text) { return write_json(parse_toml_value(text, "--set", 1, 3)); };
  EXPECT_EQ(value("2.5"), "2.5");
  EXPECT_EQ(value("[1, 2]"), "[1,2]");
  EXPECT_EQ(value("'a b'"), R"("a b")");
  EXPECT_EQ(value("spatial"), R"("spatial")");
  EXPECT_EQ(value("true"), "true");
  EXPECT_THROW(value(""), InputError);
  EXPECT_THROW(value("1\nb = 2"), InputError);
}

TEST(ParseTomlValue, KnowsThePlacesOfEntriesAndOfTheCharactersOfTexts) {
  const Node node = parse_toml_value(R"(['ab', """c""", "\u0041b"])", "--set", 1, 5);
  const auto& entries = *node.as<Node::Array>();
  EXPECT_EQ(node.where.column, 5);
  EXPECT_EQ(entries[0].where.column, 6);
  EXPECT_EQ(entries[0].where.text_column, 7);
  EXPECT_EQ(entries[1].where.text_column, 15);
  EXPECT_EQ(entries[2].where.text_column, 0) << "escapes";
}

class TomlFile : public ::testing::Test {
 protected:
  void write(const std::string& name, std::string_view text) {
    std::filesystem::create_directories((folder_.path() / name).parent_path());
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
  }
  Node read(const std::string& name) { return read_toml_file(folder_.path() / name); }
  std::string error(const std::string& name) {
    try {
      (void)read(name);
    } catch (const InputError& caught) {
      return caught.what();
    }
    return "";
  }
  TemporaryFolder folder_;
};

TEST_F(TomlFile, IsLaidUponTheFilesItIncludes) {
  write("sub/rig.toml", "a = 1\n[t]\nx = 1\ny = 2\n");
  write("x.toml", "include = ['sub/rig.toml']\n[t]\ny = 3\n");
  EXPECT_EQ(write_json(read("x.toml")), R"({"a":1,"t":{"x":1,"y":3}})");
}

TEST_F(TomlFile, MayComeThroughAPipe) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  ASSERT_EQ(::write(ends[1], "a = 1", 5), 5);
  ::close(ends[1]);
  EXPECT_EQ(write_json(read_toml_file("/proc/self/fd/" + std::to_string(ends[0]))), R"({"a":1})");
  ::close(ends[0]);
}

TEST_F(TomlFile, IncludesNothingOutsideItsFolder) {
  write("secret.toml", "a = 1");
  write("sub/x.toml", "include = ['../secret.toml']");
  write("sub/y.toml", "include = ['" + (folder_.path() / "secret.toml").string() + "']");
  std::filesystem::create_symlink("../secret.toml", folder_.path() / "sub/link.toml");
  write("sub/z.toml", "include = ['link.toml']");
  for (const char* name : {"sub/x.toml", "sub/y.toml", "sub/z.toml"}) {
    EXPECT_THAT(error(name), HasSubstr("is outside the experiment's folder")) << name;
    EXPECT_THAT(error(name), HasSubstr(":1:12: include:")) << name;
  }
}

TEST_F(TomlFile, RefusesBadIncludesWithALine) {
  write("circle.toml", "include = ['circle.toml']");
  std::string crowd;
  for (int i = 0; i < 101; ++i) crowd += "'leaf.toml', ";
  write("leaf.toml", "x = 1");
  write("crowd.toml", "include = [" + crowd + "]");
  EXPECT_THAT(error("crowd.toml"), HasSubstr("include: more than 100 files in total"));
  // Fifteen includes per file, eight levels: without a total limit, reading would take years.
  for (int i = 0; i < 8; ++i) {
    std::string next;
    for (int k = 0; k < 15; ++k) next += "'fan" + std::to_string(i + 1) + ".toml', ";
    write("fan" + std::to_string(i) + ".toml", "include = [" + next + "]");
  }
  write("fan8.toml", "x = 1");
  EXPECT_THAT(error("fan0.toml"), HasSubstr("include: more than 100 files in total"));
  write("missing.toml", "include = ['nothing.toml']");
  write("number.toml", "include = [3]");
  write("word.toml", "include = 'circle.toml'");
  write("folder.toml", "include = ['.']");
  EXPECT_THAT(error("circle.toml"), HasSubstr("circle.toml:1:12: include: circle.toml includes itself"));
  EXPECT_EQ(error("circle.toml").find("by way of"), std::string::npos);
  // An invalid file is no longer open: another file that includes it forms no circle, and its errors are
  // reported once.
  write("broken.toml", "x = 1\ny = ");
  write("again.toml", "include = ['broken.toml', 'broken.toml']");
  EXPECT_EQ(error("again.toml").find("includes itself"), std::string::npos) << error("again.toml");
  EXPECT_EQ(std::ranges::count(error("again.toml"), '\n'), 0) << error("again.toml");
  write("left.toml", "include = ['missing.toml']");
  write("right.toml", "include = ['missing.toml']");
  write("diamond.toml", "include = ['left.toml', 'right.toml']");
  EXPECT_THAT(error("diamond.toml"), HasSubstr("missing.toml:1:12: include: no file \"nothing.toml\""));
  EXPECT_EQ(std::ranges::count(error("diamond.toml"), '\n'), 0) << error("diamond.toml");
  write("a.toml", "x = 1\ninclude = ['b.toml']");
  write("b.toml", "include = ['leaf.toml', './c.toml']");
  write("c.toml", "include = ['a.toml']");
  EXPECT_THAT(error("a.toml"),
              HasSubstr("c.toml:1:12: include: a.toml includes itself, by way of b.toml, c.toml"));
  write("twice.toml", "include = ['leaf.toml', 'leaf.toml']");
  EXPECT_EQ(write_json(read("twice.toml")), R"({"x":1})") << "twice is not itself";
  for (int i = 0; i < 10; ++i)
    write("deep" + std::to_string(i) + ".toml", "include = ['deep" + std::to_string(i + 1) + ".toml']");
  write("deep10.toml", "x = 1");
  EXPECT_THAT(error("deep0.toml"), HasSubstr("include: nested more than 8 files deep"));
  write("nameless.toml", "include = ['']");
  EXPECT_THAT(error("nameless.toml"), HasSubstr("nameless.toml:1:12: include: expected a file name"));
  EXPECT_THAT(error("missing.toml"), HasSubstr("no file \"nothing.toml\""));
  EXPECT_THAT(error("number.toml"), HasSubstr("expected file names in quotes"));
  EXPECT_THAT(error("word.toml"), HasSubstr("expected an array of file names"));
  EXPECT_THAT(error("folder.toml"), HasSubstr("\".\" is not a regular file"));
}

TEST_F(TomlFile, MustExistBeAFileAndOfBoundedSize) {
  EXPECT_THAT(error("none.toml"), HasSubstr("none.toml: no such file"));
  EXPECT_THAT(error("."), HasSubstr("is a folder"));
  write("huge.toml", std::string(max_toml_bytes + 1, '\n'));
  EXPECT_THAT(error("huge.toml"), HasSubstr("is larger than 16 MiB"));
}

TEST(WriteToml, ParsesBackToTheSame) {
  const char* text =
      "title = \"a \\\"b\\\" \\\\ \\n \\u0001 \\u007f é\"\nwhole = 2\nreal = 2.0\nsmall = 1e-300\nthird = "
      "0.3333333333333333\n"
      "yes = true\nmixed = [1, \"x\", [2.5], { a = 1 }]\nnone = []\n\"odd key\" = 1\n[t]\nx = 1\n[t.u]\ny = "
      "1\n[[r]]\na = 1\n[[r]]\n"
      "[[r.s]]\nb = 1\n";
  const Node node = parse_toml(text, "x.toml");
  const std::string written = write_toml(node, {});
  EXPECT_EQ(write_json(parse_toml(written, "written.toml")), write_json(node)) << written;
}

}  // namespace
}  // namespace flexura

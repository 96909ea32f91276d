#include "flexura/store/csv_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "flexura/base/source.h"

namespace flexura {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string csv_error_of(std::string_view text) {
  try {
    (void)parse_csv(text, "x.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ParseCsv, ReadsNamesAndNumbers) {
  const NumberTable table = parse_csv("\xEF\xBB\xBFtime, \"a,\"\"b\" \r\n0,1\r\n\n 2 ,+3e-1\n4,5", "x.csv");
  EXPECT_THAT(table.columns, ElementsAre("time", "a,\"b"));
  EXPECT_THAT(table.rows, ElementsAre(ElementsAre(0, 1), ElementsAre(2, 0.3), ElementsAre(4, 5)));
  EXPECT_THAT(table.lines, ElementsAre(2, 4, 5));
}

TEST(ParseCsv, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(csv_error_of(""), "x.csv:1:1: empty: expected a line of column names");
  EXPECT_EQ(csv_error_of("a,,a\n"),
            "x.csv:1:3: the column has no name\nx.csv:1:4: column \"a\" occurs twice");
  EXPECT_EQ(
      csv_error_of("a,b\n1\n1,2,3\n"),
      "x.csv:2:1: 1 values: expected 2, one per column\nx.csv:3:1: 3 values: expected 2, one per column");
  EXPECT_EQ(csv_error_of("a,b\n1,x\n,2\n"),
            "x.csv:2:3: \"x\": expected a finite number\nx.csv:3:1: \"\": expected a finite number");
  for (const char* bad : {"nan", "inf", "-inf", "1e999", "1.2.3", "0x10", "1 2", "+-1", "+"}) {
    EXPECT_THAT(csv_error_of(std::string("a\n") + bad), HasSubstr("x.csv:2:1: ")) << bad;
  }
  EXPECT_THAT(csv_error_of("a\n\"1\n"), HasSubstr("x.csv:2:1: a quote is not closed"));
  EXPECT_THAT(csv_error_of("a\n\"1\"2\n"), HasSubstr("text follows a closing quote"));
}

TEST(ParseCsv, SaysWhatSeparatesColumnsInOneLine) {
  EXPECT_EQ(csv_error_of("time;a\n0;1,5\n1;2,5\n"),
            "x.csv:1:5: columns are separated by ';': expected commas, and points in numbers");
  EXPECT_EQ(csv_error_of("time\ta\n0\t1\n"),
            "x.csv:1:5: columns are separated by tabs: expected commas, and points in numbers");
  EXPECT_THAT(parse_csv("time,a;b\n0,1\n", "x.csv").columns, ElementsAre("time", "a;b"));
}

TEST(ParseCsv, StopsAfterTwentyProblems) {
  std::string text = "a\n";
  for (int i = 0; i < 100000; ++i) text += "x\n";
  try {
    (void)parse_csv(text, "x.csv");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 20U);
  }
}

}  // namespace
}  // namespace flexura

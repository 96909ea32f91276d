#include "flexura/store/csv.h"

#include <gtest/gtest.h>

#include <array>

namespace flexura {
namespace {

TEST(CsvText, QuotesOnlyWhatMustBeQuoted) {
  CsvText csv;
  csv.cell("plain");
  csv.cell("a,b");
  csv.cell("say \"so\"");
  csv.cell("two\nlines");
  csv.end_row();
  csv.cells(std::array{0.1, -2.0});
  csv.end_row();
  EXPECT_EQ(csv.text(), "plain,\"a,b\",\"say \"\"so\"\"\",\"two\nlines\"\n0.1,-2\n");
}

}  // namespace
}  // namespace flexura

#include "flexura/base/one_line.h"

#include <gtest/gtest.h>

#include "flexura/base/source.h"

namespace flexura {
namespace {

TEST(OneLine, ShowsWhatWouldMoveATerminalAndLeavesTheRest) {
  EXPECT_EQ(one_line("arm \"a\".toml: é 雪 🦑"), "arm \"a\".toml: é 雪 🦑");
  EXPECT_EQ(one_line("a\nb\r\tc\x1b[31m\x7f"), "a\\nb\\r\\tc\\x1b[31m\\x7f");
  EXPECT_EQ(one_line(std::string_view("\0", 1)), "\\x00");
  EXPECT_EQ(one_line("\u0085 \u2028 \u2029 \u00a0"), "\\xc2\\x85 \\xe2\\x80\\xa8 \\xe2\\x80\\xa9 \u00a0");
  EXPECT_EQ(one_line("\xff é \xc3"), "\\xff é \\xc3") << "bytes that are no UTF-8";
  EXPECT_EQ(one_line(""), "");
}

TEST(OneLine, AProblemIsOneWhateverItsFileIsCalled) {
  const InputError error = input_error("arm\n2.toml", "no \"x\ny\"", 3, 4);
  EXPECT_STREQ(error.what(), "arm\\n2.toml:3:4: no \"x\\ny\"");
}

}  // namespace
}  // namespace flexura

#include "flexura/base/node.h"

#include <gtest/gtest.h>

#include <string>

#include "flexura/base/utf8.h"

namespace flexura {
namespace {

TEST(Node, CutsALongTextBetweenTwoCharacters) {
  std::string long_text = "x";
  for (int i = 0; i < 100; ++i) long_text += "\u00e9";
  const std::string brief = text_node(long_text).brief();
  EXPECT_TRUE(is_utf8(brief)) << brief;
  EXPECT_EQ(brief.substr(0, 4), "\"x\u00e9");
  EXPECT_EQ(brief.size(), 1 + 39 + 4U);
  EXPECT_EQ(text_node("\u00e9").brief(), "\"\u00e9\"");
  EXPECT_LT(text_node(std::string(1000, '\x80')).brief().size(), 50U) << "no UTF-8 at all";
}

}  // namespace
}  // namespace flexura

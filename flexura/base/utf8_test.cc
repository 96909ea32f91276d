#include "flexura/base/utf8.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace flexura {
namespace {

/// By the definition of RFC 3629: the bits of a code point in the shortest form.
std::string encoded(unsigned point) {
  const auto tail = [](unsigned bits) { return static_cast<char>(0x80U | (bits & 0x3FU)); };
  if (point < 0x80) return {static_cast<char>(point)};
  if (point < 0x800) return {static_cast<char>(0xC0U | point >> 6U), tail(point)};
  if (point < 0x10000) return {static_cast<char>(0xE0U | point >> 12U), tail(point >> 6U), tail(point)};
  return {static_cast<char>(0xF0U | point >> 18U), tail(point >> 12U), tail(point >> 6U), tail(point)};
}

TEST(Utf8, HasAllCodePointsButSurrogates) {
  for (unsigned point = 0; point < 0x120000; ++point) {
    const bool surrogate = point >= 0xD800 && point <= 0xDFFF;
    ASSERT_EQ(is_utf8(encoded(point)), !surrogate && point <= 0x10FFFF) << point;
  }
}

TEST(Utf8, HasNoHalfCharacters) {
  for (const unsigned point : {0xE4U, 0x20ACU, 0x1F916U}) {
    const std::string whole = encoded(point);
    EXPECT_TRUE(is_utf8(std::string("a").append(whole).append(whole).append("b")));
    for (std::size_t cut = 1; cut < whole.size(); ++cut) {
      EXPECT_FALSE(is_utf8(whole.substr(0, cut)));
      EXPECT_FALSE(is_utf8(whole.substr(cut)));
      EXPECT_FALSE(is_utf8(whole.substr(0, cut) + "b"));
    }
  }
}

TEST(Utf8, GoesAsFarAsItsCharactersAreWhole) {
  EXPECT_EQ(utf8_length(""), 0U);
  EXPECT_EQ(utf8_length("arm"), 3U);
  EXPECT_EQ(utf8_length("a\xC3\xA4 \x80z"), 4U);
  EXPECT_EQ(utf8_length("a\xE2\x82"), 1U);
}

TEST(Utf8, HasNoOverlongForms) {
  for (const std::string& text :
       std::vector<std::string>{"\xC0\x80", "\xC1\xBF", "\xE0\x80\x80", "\xE0\x9F\xBF", "\xF0\x80\x80\x80",
                                "\xF0\x8F\xBF\xBF", "\xFE", "\xFF"}) {
    EXPECT_FALSE(is_utf8(text));
  }
}

}  // namespace
}  // namespace flexura

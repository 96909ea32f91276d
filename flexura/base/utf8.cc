#include "flexura/base/utf8.h"

namespace flexura {

namespace {

/// Valid continuation of a first byte: the number of continuation bytes, and the range of the first
/// continuation byte. Further bytes are 80 to BF.
struct Rest {
  std::size_t count = 0;
  unsigned char low = 0x80;
  unsigned char high = 0xBF;
};

/// Returns the continuation of a first byte; for an invalid first byte, a number of bytes larger than any
/// text.
Rest rest_of(unsigned char first) {
  if (first < 0x80) return {};
  if (first >= 0xC2 && first <= 0xDF) return {1};
  if (first == 0xE0) return {2, 0xA0, 0xBF};
  if (first == 0xED) return {2, 0x80, 0x9F};
  if (first >= 0xE1 && first <= 0xEF) return {2};
  if (first == 0xF0) return {3, 0x90, 0xBF};
  if (first >= 0xF1 && first <= 0xF3) return {3};
  if (first == 0xF4) return {3, 0x80, 0x8F};
  return {std::string_view::npos};
}

}  // namespace

std::size_t utf8_length(std::string_view text) {
  for (std::size_t begin = 0; begin < text.size();) {
    Rest rest = rest_of(static_cast<unsigned char>(text[begin]));
    std::size_t end = begin + 1;
    if (rest.count > text.size() - end) return begin;
    for (; rest.count > 0; --rest.count, ++end) {
      const auto byte = static_cast<unsigned char>(text[end]);
      if (byte < rest.low || byte > rest.high) return begin;
      rest.low = 0x80;
      rest.high = 0xBF;
    }
    begin = end;
  }
  return text.size();
}

bool is_utf8(std::string_view text) { return utf8_length(text) == text.size(); }

}  // namespace flexura

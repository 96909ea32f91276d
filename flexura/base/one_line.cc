#include "flexura/base/one_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "flexura/base/utf8.h"

namespace flexura {
namespace {

// Returns the first character; empty if it is not valid UTF-8.
std::string_view first_character(std::string_view text) {
  constexpr std::size_t longest = 4;
  for (std::size_t size = 1; size <= std::min(longest, text.size()); ++size)
    if (is_utf8(text.substr(0, size))) return text.substr(0, size);
  return {};
}

// Returns whether a character is a control character (C0, DEL, C1) or a line separator of Unicode.
bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character.front());
  if (character.size() == 1) return first < ' ' || first == 0x7f;
  if (character.size() == 2) return first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
  return character == "\u2028" || character == "\u2029";
}

void add_escaped(std::string_view bytes, std::string& line) {
  for (const char byte : bytes) {
    if (byte == '\n')
      line += "\\n";
    else if (byte == '\r')
      line += "\\r";
    else if (byte == '\t')
      line += "\\t";
    else
      line += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
  }
}

}  // namespace

std::string one_line(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const std::string_view character = first_character(text);
    const std::size_t size = std::max<std::size_t>(character.size(), 1);
    if (character.empty() || is_control(character))
      add_escaped(text.substr(0, size), line);
    else
      line += character;
    text.remove_prefix(size);
  }
  return line;
}

}  // namespace flexura

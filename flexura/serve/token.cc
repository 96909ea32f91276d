#include "flexura/serve/token.h"

#include <sys/random.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <system_error>

namespace flexura {

std::string new_token() {
  std::array<std::uint8_t, 16> bytes{};
  // Up to 256 bytes are read completely once the source is seeded; before that, a signal may interrupt.
  ssize_t count = -1;
  do {
    count = ::getrandom(bytes.data(), bytes.size(), 0);
  } while (count < 0 && errno == EINTR);
  if (count != static_cast<ssize_t>(bytes.size())) {
    throw std::system_error(errno, std::generic_category(),
                            "the system returned no random bytes for a token");
  }
  constexpr std::string_view digits = "0123456789abcdef";
  std::string token;
  for (const std::uint8_t byte : bytes) {
    token.push_back(digits[byte >> 4U]);
    token.push_back(digits[byte & 15U]);
  }
  return token;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  const auto at = [](std::string_view text, std::size_t i) { return text[i]; };
  return difference_of(a, b, at) == 0;
}

}  // namespace flexura

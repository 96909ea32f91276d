#include "flexura/store/mcap_cursor.h"

#include <stdexcept>

namespace flexura {

McapCursor McapCursor::take_part(std::uint64_t count) {
  if (count > remaining()) {
    fail("needs " + std::to_string(count) + " bytes where " + std::to_string(remaining()) + " are left");
  }
  McapCursor part = *this;
  position_ += static_cast<std::size_t>(count);
  part.end_ = position_;
  return part;
}

std::string McapCursor::take_text() {
  const auto bytes = take_bytes(take<std::uint32_t>());
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void McapCursor::fail(const std::string& what, std::size_t at) const {
  throw std::runtime_error(*name_ + ": byte " + std::to_string(at) + ": " + what);
}

}  // namespace flexura

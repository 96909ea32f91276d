#include "flexura/store/mcap_records.h"

#include <zlib.h>

namespace flexura {

std::uint32_t mcap_crc(std::uint32_t crc, std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      ::crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void McapBytes::put(std::span<const std::byte> data) {
  bytes_.insert(bytes_.end(), data.begin(), data.end());
}

void McapBytes::put(std::string_view text) {
  if (text.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::length_error("a text in a log must have less than 4 GiB");
  }
  put(static_cast<std::uint32_t>(text.size()));
  put(std::as_bytes(std::span(text)));
}

std::size_t McapBytes::grow(std::size_t count) {
  bytes_.resize(bytes_.size() + count);
  return bytes_.size() - count;
}

}  // namespace flexura

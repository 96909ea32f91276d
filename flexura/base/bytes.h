#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "flexura/base/fields.h"

namespace flexura {

/// Bytes in a message: text in base64 (RFC 4648, with padding) where it is written.
struct Bytes {
  std::string data;

  bool operator==(const Bytes&) const = default;
};

/// The bytes of a file that was read as text; valid as long as the text is.
[[nodiscard]] std::span<const std::uint8_t> bytes_of(std::string_view text);

[[nodiscard]] std::string base64(std::string_view data);
/// None when the text is not base64 as base64() writes it.
[[nodiscard]] std::optional<std::string> from_base64(std::string_view text);

template <>
struct Codec<Bytes> {
  static Type type();
  static bool read(const Node& node, const Spec& spec, Reader& reader, Bytes& value);
  static Node write(const Bytes& value);
};

}  // namespace flexura

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "flexura/base/fields.h"

namespace flexura {

/// Binary data in a message. In a node, the bytes are a base64 text (RFC 4648, with padding).
struct Bytes {
  std::string data;

  bool operator==(const Bytes&) const = default;
};

/// Returns a view of the bytes of `text`, such as a file read as text. The view is valid as long as the text.
[[nodiscard]] std::span<const std::uint8_t> bytes_of(std::string_view text);

[[nodiscard]] std::string base64(std::string_view data);
/// Returns std::nullopt unless the text is base64 as written by base64().
[[nodiscard]] std::optional<std::string> from_base64(std::string_view text);

template <>
struct Codec<Bytes> {
  static Type type();
  static bool read(const Node& node, const Spec& spec, Reader& reader, Bytes& value);
  static Node write(const Bytes& value);
};

}  // namespace flexura

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "flexura/base/table.h"

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
  static Type type() { return {.kind = Type::Kind::bytes}; }
  static bool read(const Node& node, const Spec&, Reader& reader, Bytes& value) {
    const auto* written = node.as<std::string>();
    auto data = written == nullptr ? std::nullopt : from_base64(*written);
    if (!data) return reader.unexpected(node, "bytes in base64"), false;
    value.data = std::move(*data);
    return true;
  }
  static Node write(const Bytes& value) { return {base64(value.data), {}}; }
};

}  // namespace flexura

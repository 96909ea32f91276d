#include "flexura/base/bytes.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "flexura/base/table.h"

namespace flexura {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t no_digit = 64;

constexpr std::array<std::uint8_t, 256> values = [] {
  std::array<std::uint8_t, 256> table{};
  table.fill(no_digit);
  for (std::size_t i = 0; i < digits.size(); ++i)
    table[static_cast<std::uint8_t>(digits[i])] = static_cast<std::uint8_t>(i);
  return table;
}();

}  // namespace

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string base64(std::string_view data) {
  std::string text;
  text.reserve((data.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < data.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, data.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t j = 0; j < 3; ++j)
      bits = bits << 8 | (j < count ? static_cast<std::uint8_t>(data[i + j]) : 0U);
    for (std::size_t j = 0; j < 4; ++j) text += j <= count ? digits[bits >> (18 - 6 * j) & 63U] : '=';
  }
  return text;
}

std::optional<std::string> from_base64(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  std::string data;
  data.reserve(text.size() / 4 * 3);
  for (std::size_t i = 0; i < text.size(); i += 4) {
    const std::string_view four = text.substr(i, 4);
    std::size_t padding = 0;
    if (i + 4 == text.size() && four.ends_with('=')) padding = four.ends_with("==") ? 2 : 1;
    std::uint32_t bits = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      const std::uint8_t value = j < 4 - padding ? values[static_cast<std::uint8_t>(four[j])] : 0;
      if (value == no_digit) return std::nullopt;
      bits = bits << 6 | value;
    }
    // The unused bits of the padding must be 0, so that equal bytes have one text only.
    if ((bits & ((1U << (8 * padding)) - 1)) != 0) return std::nullopt;
    for (std::size_t j = 0; j < 3 - padding; ++j) data += static_cast<char>(bits >> (16 - 8 * j) & 0xff);
  }
  return data;
}

Type Codec<Bytes>::type() { return {.kind = Type::Kind::bytes}; }

bool Codec<Bytes>::read(const Node& node, const Spec&, Reader& reader, Bytes& value) {
  const auto* written = node.as<std::string>();
  auto data = written == nullptr ? std::nullopt : from_base64(*written);
  if (!data) return reader.unexpected(node, "bytes in base64"), false;
  value.data = std::move(*data);
  return true;
}

Node Codec<Bytes>::write(const Bytes& value) { return {base64(value.data), {}}; }

}  // namespace flexura

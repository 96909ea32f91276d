#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// The first and the last eight bytes of a log.
/// Source of everything in this file: MCAP specification, major version 0 (https://mcap.dev/spec).
inline constexpr std::string_view mcap_magic{"\x89MCAP0\r\n", 8};

/// What a record is; its first byte.
enum class McapOp : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  attachment = 0x09,
  attachment_index = 0x0A,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

/// Bytes before a record's content: what it is (1) and the content's length (8).
inline constexpr std::size_t mcap_record_header = 9;
/// The footer's content: where the summary and its offsets start (8 + 8), and the summary's CRC (4).
inline constexpr std::size_t mcap_footer_length = 20;

/// What a channel's messages look like.
struct McapSchema {
  std::string name;
  std::string encoding;  ///< "jsonschema", ...; empty: there is no schema.
  std::string data;

  bool operator==(const McapSchema&) const = default;
};

/// A named stream of messages of one kind, in one encoding ("json", "jpeg", ...).
struct McapChannel {
  std::string topic;
  std::string encoding = "json";
  McapSchema schema{};
  // The braces spare those who leave it out GCC's -Wmissing-field-initializers.
  std::map<std::string, std::string> metadata{};  // NOLINT(readability-redundant-member-init)

  bool operator==(const McapChannel&) const = default;
};

/// The CRC-32 of bytes whose predecessors' CRC is `crc` (0: there are none).
[[nodiscard]] std::uint32_t mcap_crc(std::uint32_t crc, std::span<const std::byte> bytes);

/// Bytes in the order MCAP keeps them, little end first, in a buffer that grows.
class McapBytes {
 public:
  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  void clear() { bytes_.clear(); }

  template <std::unsigned_integral T>
  void put(T value) {
    put_at(grow(sizeof value), value);
  }
  void put(std::span<const std::byte> data);
  /// Length in four bytes, then the text. Throws std::length_error when it has 2^32 bytes or more.
  void put(std::string_view text);
  void put(const std::string& text) { put(std::string_view(text)); }

  /// A record whose content `write` puts.
  template <typename Write>
  void record(McapOp op, Write write) {
    put(static_cast<std::uint8_t>(op));
    measured<std::uint64_t>(write);
  }
  /// What `write` puts, preceded by its length in bytes as a Length.
  template <std::unsigned_integral Length, typename Write>
  void measured(Write write) {
    const std::size_t at = grow(sizeof(Length));
    write();
    const std::size_t length = size() - at - sizeof(Length);
    if (length > std::numeric_limits<Length>::max()) throw std::length_error("too long a list for a log");
    put_at(at, static_cast<Length>(length));
  }

 private:
  /// Makes room at the end; returns where it starts.
  std::size_t grow(std::size_t count);
  template <std::unsigned_integral T>
  void put_at(std::size_t at, T value) {
    for (std::size_t i = 0; i < sizeof value; ++i) {
      bytes_[at + i] = static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFF);
    }
  }

  std::vector<std::byte> bytes_;
};

}  // namespace flexura

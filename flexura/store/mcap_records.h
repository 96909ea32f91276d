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

/// The first and the last eight bytes of a log. Everything in this file follows the MCAP specification, major
/// version 0 (https://mcap.dev/spec).
inline constexpr std::string_view mcap_magic{"\x89MCAP0\r\n", 8};

/// Kind of a record, which is its first byte.
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

/// Bytes before a record's content: its kind (1) and the content's length (8).
inline constexpr std::size_t mcap_record_header = 9;
/// Length of the footer's content: starts of the summary and its offsets (8 + 8), and the summary's CRC (4).
inline constexpr std::size_t mcap_footer_length = 20;

/// Name of the compression of chunks by Zstandard. The name of plain chunks is empty. The CRC and the
/// uncompressed size of a chunk refer to its uncompressed records.
inline constexpr std::string_view mcap_zstd = "zstd";

/// Format of a channel's messages.
struct McapSchema {
  std::string name;
  std::string encoding;  ///< Encoding of the schema, such as "jsonschema"; empty without a schema.
  std::string data;

  bool operator==(const McapSchema&) const = default;
};

/// A named stream of messages of one kind, in one encoding ("json", "jpeg", ...).
struct McapChannel {
  std::string topic;
  std::string encoding = "json";
  McapSchema schema{};
  // The braces avoid GCC's warning -Wmissing-field-initializers where this member is omitted.
  std::map<std::string, std::string> metadata{};  // NOLINT(readability-redundant-member-init)

  bool operator==(const McapChannel&) const = default;
};

/// Returns the CRC-32 of earlier bytes, whose CRC is `crc`, followed by `bytes`. `crc` 0 means that there are
/// no earlier bytes.
[[nodiscard]] std::uint32_t mcap_crc(std::uint32_t crc, std::span<const std::byte> bytes);

/// Growing buffer of bytes in MCAP's byte order, which is little-endian.
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
  /// Appends the length as four bytes, and then the text. Throws std::length_error if the text has 2^32 bytes
  /// or more.
  void put(std::string_view text);
  void put(const std::string& text) { put(std::string_view(text)); }

  /// Appends a record. The content of the record is the output of `write`.
  template <typename Write>
  void record(McapOp op, Write write) {
    put(static_cast<std::uint8_t>(op));
    measured<std::uint64_t>(write);
  }
  /// Appends the output of `write`, preceded by its length in bytes as a value of type Length.
  template <std::unsigned_integral Length, typename Write>
  void measured(Write write) {
    const std::size_t at = grow(sizeof(Length));
    write();
    const std::size_t length = size() - at - sizeof(Length);
    if (length > std::numeric_limits<Length>::max()) throw std::length_error("too long a list for a log");
    put_at(at, static_cast<Length>(length));
  }

 private:
  /// Adds `count` bytes at the end and returns their start.
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

#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "flexura/store/mcap_records.h"

namespace flexura {

/// Reads numbers, texts and blocks of bytes from a range of a log, one after the other. A read beyond the end
/// of the range throws std::runtime_error with the log's name and the position in the log, in bytes.
class McapCursor {
 public:
  McapCursor(std::span<const std::byte> log, const std::string& name)
      : log_(log), name_(&name), end_(log.size()) {}

  /// Returns the position from the log's start, in bytes.
  [[nodiscard]] std::size_t position() const { return position_; }
  [[nodiscard]] std::size_t remaining() const { return end_ - position_; }
  [[nodiscard]] bool done() const { return remaining() == 0; }
  /// Returns the unread bytes.
  [[nodiscard]] std::span<const std::byte> rest() const { return log_.subspan(position_, remaining()); }
  /// Returns the log from byte `from` up to the current position.
  [[nodiscard]] std::span<const std::byte> since(std::size_t from) const {
    return log_.subspan(from, position_ - from);
  }

  /// Reads a number with the least significant byte first.
  template <std::unsigned_integral T>
  T take() {
    std::uint64_t value = 0;
    const auto bytes = take_bytes(sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) value |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
    return static_cast<T>(value);
  }
  std::span<const std::byte> take_bytes(std::uint64_t count) { return take_part(count).rest(); }
  /// Reads the next `count` bytes. Returns a cursor that can read only these bytes.
  McapCursor take_part(std::uint64_t count);
  /// Reads a text: its length in bytes (32 bits), then its bytes.
  std::string take_text();

  /// Throws std::runtime_error with the message `what` and the current position, or the position `at`.
  [[noreturn]] void fail(const std::string& what) const { fail(what, position_); }
  [[noreturn]] void fail(const std::string& what, std::size_t at) const;

 private:
  std::span<const std::byte> log_;
  const std::string* name_;
  std::size_t position_ = 0;
  std::size_t end_;
};

}  // namespace flexura

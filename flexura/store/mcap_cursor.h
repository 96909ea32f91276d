#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "flexura/store/mcap_records.h"

namespace flexura {

/// Reads a part of a log byte by byte, beginning with the first byte of the part. Every read is checked
/// against the part's end. Throws std::runtime_error with the log's name and the position in the log, in
/// bytes, if a read exceeds the part.
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

  template <std::unsigned_integral T>
  T take() {
    std::uint64_t value = 0;
    const auto bytes = take_bytes(sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) value |= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
    return static_cast<T>(value);
  }
  std::span<const std::byte> take_bytes(std::uint64_t count) { return take_part(count).rest(); }
  /// Takes the next `count` bytes as a separate part.
  McapCursor take_part(std::uint64_t count);
  /// Takes a text preceded by its length.
  std::string take_text();

  /// Throws the error `what` at the current position, or at the position `at`.
  [[noreturn]] void fail(const std::string& what) const { fail(what, position_); }
  [[noreturn]] void fail(const std::string& what, std::size_t at) const;

 private:
  std::span<const std::byte> log_;
  const std::string* name_;
  std::size_t position_ = 0;
  std::size_t end_;
};

}  // namespace flexura

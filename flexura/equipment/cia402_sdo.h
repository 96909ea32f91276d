#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "flexura/equipment/cia402_codec.h"

// Transfers of objects by SDO (CiA 301, 7.2.4): expedited writes, expedited and segmented reads.
namespace flexura {

/// The program's side of one transfer. It never waits. The caller sends request() whenever the request has
/// changed, and starts a new transfer if an answer is missing.
class SdoTransfer {
 public:
  static constexpr std::size_t longest = 1024;  ///< Largest number of bytes that a read accepts.

  /// Reads an object of a node.
  static SdoTransfer reading(std::uint8_t node, ObjectAddress object);
  /// Writes the `size` lowest bytes of a value, 1 to 4.
  static SdoTransfer writing(std::uint8_t node, ObjectAddress object, std::uint32_t value, int size);

  /// Returns the frame to send.
  [[nodiscard]] const CanFrame& request() const { return request_; }
  /// Processes any frame of the bus. Returns true if the frame was an answer to this transfer. After an
  /// answer, the transfer is over, or request() is a new request.
  bool take(const CanFrame& frame);
  [[nodiscard]] bool is_over() const { return is_over_; }
  /// Returns the abort code, or 0 for success. If this side aborted the transfer, request() is the abort
  /// frame.
  [[nodiscard]] std::uint32_t abort_code() const { return abort_; }
  /// Returns the bytes that were read.
  [[nodiscard]] const std::string& data() const { return data_; }
  /// Returns the first 4 bytes that were read as an unsigned number, lowest first.
  [[nodiscard]] std::uint32_t number() const;

 private:
  SdoTransfer(std::uint8_t node, ObjectAddress object) : node_(node), object_(object) {}
  void fail(std::uint32_t code);
  void take_first(const CanFrame& frame);
  void take_segment(const CanFrame& frame);
  void ask_segment();

  std::uint8_t node_;
  ObjectAddress object_;
  CanFrame request_;
  bool is_writing_ = false, is_segmented_ = false, toggle_ = false, is_over_ = false;
  std::uint32_t abort_ = 0;
  std::string data_;
};

/// The node's side of SDO transfers. An SdoServer processes one transfer at a time.
class SdoServer {
 public:
  /// Result of reading an object: its bytes, or an abort code.
  using ReadResult = std::variant<std::string, std::uint32_t>;
  using Read = std::function<ReadResult(ObjectAddress)>;
  /// Writes the bytes of an object. Returns an abort code, or 0 for success.
  using Write = std::function<std::uint32_t(ObjectAddress, const std::string& bytes)>;

  SdoServer(std::uint8_t node, Read read, Write write)
      : node_(node), read_(std::move(read)), write_(std::move(write)) {}

  /// Returns the answer to a frame. Returns std::nullopt for a frame that is no request to this node, or
  /// needs no answer.
  std::optional<CanFrame> answer(const CanFrame& request);

 private:
  [[nodiscard]] CanFrame reply(std::uint8_t command, ObjectAddress object) const;
  [[nodiscard]] CanFrame abort(ObjectAddress object, std::uint32_t code);
  CanFrame answer_read(ObjectAddress object);
  CanFrame answer_write(const CanFrame& request, ObjectAddress object);
  CanFrame answer_segment(bool toggle);

  std::uint8_t node_;
  Read read_;
  Write write_;
  // What is left of a segmented read.
  std::optional<std::string> rest_;
  ObjectAddress object_;
  bool toggle_ = false;
};

/// Returns the `size` lowest bytes of a number, lowest first.
[[nodiscard]] std::string little_endian(std::uint32_t number, int size);

}  // namespace flexura

#include "flexura/equipment/cia402_sdo.h"

#include <algorithm>
#include <utility>

namespace flexura {
namespace {

// Command specifiers (first byte) of CiA 301.
constexpr std::uint8_t sdo_abort = 0x80, read_request = 0x40, segment_request = 0x60, write_reply = 0x60,
                       toggle_bit = 0x10;

CanFrame object_frame(std::uint32_t id, std::uint8_t command, ObjectAddress object) {
  CanFrame frame{.id = id};
  append(frame, command, 1);
  append(frame, object.index, 2);
  append(frame, object.sub, 1);
  return frame;
}

CanFrame padded(CanFrame frame) {
  frame.size = 8;
  return frame;
}

ObjectAddress object_of(const CanFrame& frame) {
  return {static_cast<std::uint16_t>(number_at(frame, 1, 2)), frame.data[3]};
}

std::string frame_part(const CanFrame& frame, std::size_t at, std::size_t size) {
  const auto first = frame.data.begin() + static_cast<std::ptrdiff_t>(at);
  return {first, first + static_cast<std::ptrdiff_t>(std::min(size, frame.data.size() - at))};
}

}  // namespace

std::string little_endian(std::uint32_t number, int size) {
  std::string bytes;
  for (int i = 0; i < size; ++i, number >>= 8) bytes += static_cast<char>(number & 0xFF);
  return bytes;
}

SdoTransfer SdoTransfer::reading(std::uint8_t node, ObjectAddress object) {
  SdoTransfer transfer(node, object);
  transfer.request_ = padded(object_frame(cob::sdo_request + node, read_request, object));
  return transfer;
}

SdoTransfer SdoTransfer::writing(std::uint8_t node, ObjectAddress object, std::uint32_t value, int size) {
  SdoTransfer transfer(node, object);
  transfer.is_writing_ = true;
  // Expedited, with the number of unused bytes.
  const auto command = static_cast<std::uint8_t>(0x23U | static_cast<unsigned>(4 - size) << 2U);
  transfer.request_ = object_frame(cob::sdo_request + node, command, object);
  append(transfer.request_, value, size);
  transfer.request_.size = 8;
  return transfer;
}

bool SdoTransfer::take(const CanFrame& frame) {
  if (is_over_ || frame.is_error || frame.is_remote || frame.is_extended ||
      frame.id != cob::sdo_reply + node_ || frame.size < 4)
    return false;
  const std::uint8_t command = frame.data[0];
  if (command == sdo_abort) {
    if (object_of(frame) != object_) return false;
    is_over_ = true;
    abort_ = number_at(frame, 4, 4);
    if (abort_ == 0) abort_ = abort_code::general;
    return true;
  }
  if (is_segmented_) {
    if ((command & 0xE0) != 0) return false;  // Late, of an earlier transfer.
    take_segment(frame);
    return true;
  }
  if (object_of(frame) != object_) return false;
  if (is_writing_ ? command != write_reply : (command & 0xE0) != 0x40) return false;
  take_first(frame);
  return true;
}

std::uint32_t SdoTransfer::number() const {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(data_.size(), 4); ++i)
    number |= std::uint32_t{static_cast<std::uint8_t>(data_[i])} << (8 * i);
  return number;
}

void SdoTransfer::fail(std::uint32_t code) {
  is_over_ = true;
  abort_ = code;
  request_ = object_frame(cob::sdo_request + node_, sdo_abort, object_);
  append(request_, code, 4);
}

void SdoTransfer::take_first(const CanFrame& frame) {
  if (is_writing_) {
    is_over_ = true;
    return;
  }
  const std::uint8_t command = frame.data[0];
  const bool is_expedited = (command & 0x02) != 0, has_size = (command & 0x01) != 0;
  if (is_expedited) {
    is_over_ = true;
    data_ = frame_part(frame, 4, has_size ? 4U - (command >> 2U & 3U) : 4U);
  } else if (has_size && number_at(frame, 4, 4) > longest) {
    fail(abort_code::no_memory);
  } else {
    is_segmented_ = true;
    ask_segment();
  }
}

void SdoTransfer::take_segment(const CanFrame& frame) {
  const std::uint8_t command = frame.data[0];
  if (((command & toggle_bit) != 0) != toggle_) {
    fail(abort_code::toggle);
    return;
  }
  data_ += frame_part(frame, 1, 7U - (command >> 1U & 7U));
  if (data_.size() > longest) {
    fail(abort_code::no_memory);
    return;
  }
  if ((command & 0x01) != 0) {
    is_over_ = true;
    return;
  }
  toggle_ = !toggle_;
  ask_segment();
}

void SdoTransfer::ask_segment() {
  request_ = padded(object_frame(
      cob::sdo_request + node_, static_cast<std::uint8_t>(segment_request | (toggle_ ? toggle_bit : 0)), {}));
}

std::optional<CanFrame> SdoServer::answer(const CanFrame& request) {
  if (request.is_error || request.is_remote || request.is_extended ||
      request.id != cob::sdo_request + node_ || request.size == 0)
    return std::nullopt;
  const std::uint8_t command = request.data[0];
  if (command == sdo_abort) {
    rest_.reset();
    return std::nullopt;
  }
  const ObjectAddress object = object_of(request);
  switch (command >> 5U) {
    case 1:
      return answer_write(request, object);
    case 2:
      return answer_read(object);
    case 3:
      return answer_segment((command & toggle_bit) != 0);
    default:
      return abort(object, abort_code::unknown_command);
  }
}

CanFrame SdoServer::reply(std::uint8_t command, ObjectAddress object) const {
  return object_frame(cob::sdo_reply + node_, command, object);
}

CanFrame SdoServer::abort(ObjectAddress object, std::uint32_t code) {
  rest_.reset();
  CanFrame frame = reply(sdo_abort, object);
  append(frame, code, 4);
  return frame;
}

CanFrame SdoServer::answer_read(ObjectAddress object) {
  rest_.reset();
  const ReadResult result = read_(object);
  if (const auto* code = std::get_if<std::uint32_t>(&result); code != nullptr) return abort(object, *code);
  const auto& bytes = std::get<std::string>(result);
  if (!bytes.empty() && bytes.size() <= 4) {
    CanFrame frame = reply(static_cast<std::uint8_t>(0x43U | (4 - bytes.size()) << 2U), object);
    for (const char byte : bytes) append(frame, static_cast<std::uint8_t>(byte), 1);
    return padded(frame);
  }
  rest_ = bytes, object_ = object, toggle_ = false;
  CanFrame frame = reply(0x41, object);
  append(frame, static_cast<std::uint32_t>(bytes.size()), 4);
  return frame;
}

CanFrame SdoServer::answer_write(const CanFrame& request, ObjectAddress object) {
  rest_.reset();
  const std::uint8_t command = request.data[0];
  if ((command & 0x02) == 0) return abort(object, abort_code::unknown_command);  // Only expedited writes.
  const std::size_t size = (command & 0x01) != 0 ? 4U - (command >> 2U & 3U) : 4U;
  if (request.size < 4 + size) return abort(object, abort_code::wrong_length);
  const std::uint32_t code = write_(object, frame_part(request, 4, size));
  return code != 0 ? abort(object, code) : padded(reply(write_reply, object));
}

CanFrame SdoServer::answer_segment(bool toggle) {
  if (!rest_) return abort({}, abort_code::unknown_command);
  if (toggle != toggle_) return abort(object_, abort_code::toggle);
  toggle_ = !toggle_;
  const std::size_t size = std::min<std::size_t>(rest_->size(), 7);
  const bool is_last = size == rest_->size();
  CanFrame frame{.id = cob::sdo_reply + node_};
  append(frame,
         static_cast<std::uint32_t>((toggle ? toggle_bit : 0) | (7 - size) << 1U | (is_last ? 1U : 0U)), 1);
  for (const char byte : rest_->substr(0, size)) append(frame, static_cast<std::uint8_t>(byte), 1);
  rest_->erase(0, size);
  if (is_last) rest_.reset();
  return padded(frame);
}

}  // namespace flexura

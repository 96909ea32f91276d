#include "flexura/equipment/cia402_codec.h"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/error.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>
#include <vector>

namespace flexura {

static_assert(sizeof(struct ::can_frame) == can_frame_size);

std::string bytes_of(const CanFrame& frame) {
  struct ::can_frame raw{};
  raw.can_id = frame.is_extended ? (frame.id & CAN_EFF_MASK) | CAN_EFF_FLAG : frame.id & CAN_SFF_MASK;
  if (frame.is_remote) raw.can_id |= CAN_RTR_FLAG;
  if (frame.is_error) raw.can_id = (frame.id & CAN_ERR_MASK) | CAN_ERR_FLAG;
  raw.can_dlc = std::min<std::uint8_t>(frame.size, 8);
  std::ranges::copy_n(frame.data.begin(), raw.can_dlc, std::begin(raw.data));
  std::string bytes(sizeof raw, '\0');
  std::memcpy(bytes.data(), &raw, sizeof raw);
  return bytes;
}

std::optional<CanFrame> parse_can_frame(std::string_view bytes) {
  struct ::can_frame raw{};
  if (bytes.size() != sizeof raw) return std::nullopt;
  std::memcpy(&raw, bytes.data(), sizeof raw);
  if (raw.can_dlc > 8) return std::nullopt;
  CanFrame frame;
  frame.is_error = (raw.can_id & CAN_ERR_FLAG) != 0;
  frame.is_extended = !frame.is_error && (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.is_remote = !frame.is_error && (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.is_error || frame.is_extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.size = raw.can_dlc;
  std::ranges::copy_n(std::begin(raw.data), frame.size, frame.data.begin());
  return frame;
}

std::string can_error_text(const CanFrame& frame) {
  static const std::vector<std::pair<std::uint32_t, std::string_view>> classes = {
      {CAN_ERR_BUSOFF, "bus off"},
      {CAN_ERR_ACK, "no other device acknowledges frames"},
      {CAN_ERR_TX_TIMEOUT, "a frame could not be sent in time"},
      {CAN_ERR_RESTARTED, "the controller restarted after bus off"},
      {CAN_ERR_PROT, "disturbed frames"},
      {CAN_ERR_BUSERROR, "disturbed frames"}};
  if ((frame.id & CAN_ERR_CRTL) != 0) {
    if ((frame.data[1] & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0)
      return "many disturbed frames (error passive)";
    if ((frame.data[1] & (CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_TX_OVERFLOW)) != 0)
      return "the interface has lost frames";
  }
  const auto found =
      std::ranges::find_if(classes, [&](const auto& one) { return (frame.id & one.first) != 0; });
  return found == classes.end() ? "" : std::string(found->second);
}

void append(CanFrame& frame, std::uint32_t number, int size) {
  for (int i = 0; i < size && frame.size < 8; ++i, number >>= 8)
    frame.data[frame.size++] = static_cast<std::uint8_t>(number & 0xFF);
}

std::uint32_t number_at(const CanFrame& frame, std::size_t at, int size) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(size) && at + i < frame.data.size(); ++i)
    number |= std::uint32_t{frame.data[at + i]} << (8 * i);
  return number;
}

std::string_view name_of(NmtState state) {
  switch (state) {
    case NmtState::boot_up:
      return "booting";
    case NmtState::stopped:
      return "stopped";
    case NmtState::operational:
      return "operational";
    case NmtState::pre_operational:
      return "pre-operational";
  }
  return "unknown";
}

CanFrame nmt_frame(NmtCommand command, std::uint8_t node) {
  CanFrame frame{.id = cob::nmt};
  append(frame, static_cast<std::uint8_t>(command), 1);
  append(frame, node, 1);
  return frame;
}

CanFrame sync_frame() { return {.id = cob::sync}; }

CanFrame heartbeat_frame(std::uint8_t node, NmtState state) {
  CanFrame frame{.id = cob::heartbeat + node};
  append(frame, static_cast<std::uint8_t>(state), 1);
  return frame;
}

std::string text(ObjectAddress object) {
  return object.sub == 0 ? fmt::format("0x{:04X}", object.index)
                         : fmt::format("0x{:04X}:{}", object.index, object.sub);
}

namespace {

struct CodeText {
  std::uint32_t code;
  std::string_view meaning;
};

constexpr std::array abort_texts = {CodeText{0x05030000, "the toggle bit did not alternate"},
                                    CodeText{0x05040000, "the transfer took too long"},
                                    CodeText{0x05040001, "unknown SDO command"},
                                    CodeText{0x05040005, "not enough memory"},
                                    CodeText{0x06010000, "the object does not support this access"},
                                    CodeText{0x06010001, "the object can only be written"},
                                    CodeText{0x06010002, "the object can only be read"},
                                    CodeText{0x06020000, "the drive has no such object"},
                                    CodeText{0x06040041, "the object cannot be mapped to a PDO"},
                                    CodeText{0x06040042, "the mapped objects are longer than a PDO"},
                                    CodeText{0x06040043, "parameters are incompatible"},
                                    CodeText{0x06040047, "internal incompatibility of the drive"},
                                    CodeText{0x06060000, "a hardware error"},
                                    CodeText{0x06070010, "the length of the data is wrong"},
                                    CodeText{0x06070012, "the data are too long"},
                                    CodeText{0x06070013, "the data are too short"},
                                    CodeText{0x06090011, "the object has no such sub-index"},
                                    CodeText{0x06090030, "the value is out of range"},
                                    CodeText{0x06090031, "the value is too large"},
                                    CodeText{0x06090032, "the value is too small"},
                                    CodeText{0x06090036, "the maximum is less than the minimum"},
                                    CodeText{0x08000000, "a general error"},
                                    CodeText{0x08000020, "the data cannot be transferred or stored"},
                                    CodeText{0x08000021, "local control prevents the transfer"},
                                    CodeText{0x08000022, "the state of the drive prevents the transfer"},
                                    CodeText{0x08000023, "the drive has no dictionary of objects"}};

// An error code belongs to the entry with the most equal leading hexadecimal digits. A trailing 0 of an entry
// stands for any digit.
constexpr std::array error_texts = {
    CodeText{0x1000, "a general error"},
    CodeText{0x2000, "current"},
    CodeText{0x2300, "overcurrent at the motor; is a winding or cable short-circuited?"},
    CodeText{0x3000, "voltage"},
    CodeText{0x3200, "voltage of the supply"},
    CodeText{0x3210, "overvoltage of the supply; brake more slowly or add a brake resistor"},
    CodeText{0x3220, "undervoltage of the supply; is the motor supply on?"},
    CodeText{0x4000, "temperature"},
    CodeText{0x4210, "the drive is too hot"},
    CodeText{0x4300, "temperature of the motor or drive"},
    CodeText{0x4310, "the drive is too hot"},
    CodeText{0x5000, "hardware of the drive"},
    CodeText{0x6000, "software of the drive"},
    CodeText{0x6320, "a parameter is wrong"},
    CodeText{0x7000, "a module, such as motor, brake or sensor"},
    CodeText{0x7120, "the motor; is it blocked or not connected?"},
    CodeText{0x7300, "the position sensor"},
    CodeText{0x7305, "the encoder; check its cable"},
    CodeText{0x8000, "monitoring"},
    CodeText{0x8110, "CAN overrun: the drive has lost frames"},
    CodeText{0x8120, "CAN in error passive mode; check wiring and terminators"},
    CodeText{0x8130, "no heartbeat of the program"},
    CodeText{0x8140, "recovered from bus off; check wiring and terminators"},
    CodeText{0x8200, "a protocol error"},
    CodeText{0x8210, "a PDO was too short"},
    CodeText{0x8220, "a PDO was too long"},
    CodeText{0x8600, "positioning"},
    CodeText{0x8611, "following error: the motor cannot follow; is it blocked or overloaded?"},
    CodeText{0x8612, "a position limit was reached"},
    CodeText{0x9000, "an external error"},
    CodeText{0xF000, "additional functions"},
    CodeText{0xFF00, "specific to the device; see its manual"}};

// Returns how many leading digits of `code` an entry fixes, or 0 if it does not fit.
int digits_fitting(std::uint32_t entry, std::uint32_t code) {
  int digits = 4;
  while (digits > 1 && (entry >> (4 * (4 - digits)) & 0xF) == 0) --digits;
  const int shift = 4 * (4 - digits);
  return entry >> shift == code >> shift ? digits : 0;
}

}  // namespace

std::string sdo_abort_text(std::uint32_t code) {
  const auto* const found = std::ranges::find(abort_texts, code, &CodeText::code);
  return fmt::format("{} (abort code 0x{:08X})",
                     found == abort_texts.end() ? "an unlisted reason" : found->meaning, code);
}

Emergency emergency_in(const CanFrame& frame) {
  return {static_cast<std::uint16_t>(number_at(frame, 0, 2)), frame.data[2]};
}

CanFrame emergency_frame(std::uint8_t node, const Emergency& emergency) {
  CanFrame frame{.id = cob::emergency + node};
  append(frame, emergency.code, 2);
  append(frame, emergency.registry, 1);
  frame.size = 8;
  return frame;
}

std::string drive_error_text(std::uint16_t code) {
  if (code == 0) return "no error code";
  const auto* const best = std::ranges::max_element(
      error_texts, {}, [&](const CodeText& one) { return digits_fitting(one.code, code); });
  return fmt::format("{} (error code 0x{:04X})",
                     digits_fitting(best->code, code) > 0 ? best->meaning : "an unlisted error", code);
}

DriveState drive_state(std::uint16_t statusword) {
  using enum DriveState;
  // Bits 0 to 3 and 6; bit 5 is 0 only while the drive makes a quick stop.
  const unsigned bits = statusword & 0x4FU;
  if (bits == 0x00) return not_ready;
  if (bits == 0x40) return switch_on_disabled;
  if (bits == 0x0F) return fault_reaction_active;
  if (bits == 0x08) return fault;
  const bool is_stopping = (statusword & 0x20U) == 0;
  if (bits == 0x07) return is_stopping ? quick_stop_active : operation_enabled;
  if (is_stopping) return unknown;
  if (bits == 0x01) return ready_to_switch_on;
  return bits == 0x03 ? switched_on : unknown;
}

std::string_view name_of(DriveState state) {
  static constexpr std::array<std::string_view, 9> names = {"not ready to switch on",
                                                            "switch on disabled",
                                                            "ready to switch on",
                                                            "switched on",
                                                            "operation enabled",
                                                            "quick stop active",
                                                            "fault reaction active",
                                                            "fault",
                                                            "unknown"};
  return names[static_cast<std::size_t>(state)];
}

std::uint16_t statusword_of(DriveState state) {
  static constexpr std::array<std::uint16_t, 9> words = {0x00, 0x40, 0x31, 0x33, 0x37,
                                                         0x17, 0x1F, 0x08, 0x00};
  return words[static_cast<std::size_t>(state)];
}

}  // namespace flexura

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

// Frames of CANopen (CiA 301) and words of its drive profile (CiA 402), as pure functions.
namespace flexura {

/// A frame of classical CAN.
struct CanFrame {
  std::uint32_t id = 0;   ///< Identifier without flags; for an error frame: the classes of errors.
  std::uint8_t size = 0;  ///< Number of bytes in `data`, 0 to 8.
  std::array<std::uint8_t, 8> data{};  ///< Bytes beyond `size` are 0.
  bool is_extended = false;            ///< Whether the identifier has 29 bits. CANopen has 11.
  bool is_remote = false;              ///< Whether the frame is a request for a frame (remote frame).
  bool is_error = false;               ///< Whether the interface reports an error of the bus.

  bool operator==(const CanFrame&) const = default;
};

inline constexpr std::size_t can_frame_size = 16;  ///< Size of a SocketCAN frame (struct can_frame), bytes.

/// Returns the frame in the format of SocketCAN.
[[nodiscard]] std::string bytes_of(const CanFrame& frame);
/// Returns the frame in bytes that were read from SocketCAN, or std::nullopt if they are not exactly one
/// frame.
[[nodiscard]] std::optional<CanFrame> parse_can_frame(std::string_view bytes);
/// Returns the errors that an error frame reports, for example "bus off". Source: Linux, linux/can/error.h.
[[nodiscard]] std::string can_error_text(const CanFrame& frame);

/// Appends the `size` lowest bytes of a number, lowest byte first, as far as the frame has space.
void append(CanFrame& frame, std::uint32_t number, int size);
/// Returns the unsigned number of `size` bytes, 1 to 4, from byte `at` on. Missing bytes count as 0.
[[nodiscard]] std::uint32_t number_at(const CanFrame& frame, std::size_t at, int size);

/// Identifiers of the predefined connection set (CiA 301): base plus number of the node.
namespace cob {
inline constexpr std::uint32_t nmt = 0x000, sync = 0x080, emergency = 0x080, tpdo1 = 0x180, rpdo1 = 0x200,
                               rpdo2 = 0x300, sdo_reply = 0x580, sdo_request = 0x600, heartbeat = 0x700;
}  // namespace cob

/// Commands of the network management.
enum class NmtCommand : std::uint8_t {
  start = 0x01,
  stop = 0x02,
  pre_operational = 0x80,
  reset_node = 0x81,
  reset_communication = 0x82
};
/// State of a node in its heartbeat.
enum class NmtState : std::uint8_t {
  boot_up = 0x00,
  stopped = 0x04,
  operational = 0x05,
  pre_operational = 0x7F
};
/// Returns the name of a state, for example "operational"; "unknown" for other numbers.
[[nodiscard]] std::string_view name_of(NmtState state);

/// Returns the frame of a command; node 0: for all nodes.
[[nodiscard]] CanFrame nmt_frame(NmtCommand command, std::uint8_t node);
/// Returns the synchronisation frame, without a counter.
[[nodiscard]] CanFrame sync_frame();
/// Returns the heartbeat of a node.
[[nodiscard]] CanFrame heartbeat_frame(std::uint8_t node, NmtState state);

/// Address in the object dictionary of a node.
struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t sub = 0;
  bool operator==(const ObjectAddress&) const = default;
};
/// Returns the address as text, for example "0x607A" or "0x607D:1".
[[nodiscard]] std::string text(ObjectAddress object);

/// Abort codes of SDO transfers that this program itself sends (CiA 301, table 22).
namespace abort_code {
inline constexpr std::uint32_t toggle = 0x05030000, unknown_command = 0x05040001, no_memory = 0x05040005,
                               read_only = 0x06010002, no_object = 0x06020000, not_mappable = 0x06040041,
                               pdo_too_long = 0x06040042, wrong_length = 0x06070010, no_sub = 0x06090011,
                               out_of_range = 0x06090030, general = 0x08000000, wrong_state = 0x08000022;
}  // namespace abort_code

/// Returns the meaning of an abort code of an SDO transfer (CiA 301, table 22), with the code.
[[nodiscard]] std::string sdo_abort_text(std::uint32_t code);

/// A node's report of an error, or of the end of an error.
struct Emergency {
  std::uint16_t code = 0;     ///< Error code as in object 0x603F; 0: the error has ended.
  std::uint8_t registry = 0;  ///< Error register, object 0x1001.
};
/// Returns the emergency in a frame.
[[nodiscard]] Emergency emergency_in(const CanFrame& frame);
/// Returns the frame of an emergency.
[[nodiscard]] CanFrame emergency_frame(std::uint8_t node, const Emergency& emergency);
/// Returns the meaning of an error code (CiA 301 and CiA 402-2, object 0x603F), with the code.
[[nodiscard]] std::string drive_error_text(std::uint16_t code);

/// State of a drive (CiA 402-2).
enum class DriveState {
  not_ready,
  switch_on_disabled,
  ready_to_switch_on,
  switched_on,
  operation_enabled,
  quick_stop_active,
  fault_reaction_active,
  fault,
  unknown
};
/// Returns the state in a statusword, object 0x6041.
[[nodiscard]] DriveState drive_state(std::uint16_t statusword);
/// Returns the name of a state, for example "operation enabled".
[[nodiscard]] std::string_view name_of(DriveState state);
/// Returns the bits of a statusword that show a state.
[[nodiscard]] std::uint16_t statusword_of(DriveState state);

/// Bits of a statusword that do not belong to the state.
namespace status_bit {
inline constexpr std::uint16_t target_reached = 1U << 10, limit_active = 1U << 11,
                               /// Setpoint acknowledged; in homing mode: homing attained.
    acknowledge = 1U << 12,
                               /// Following error; in homing mode: homing error.
    error = 1U << 13;
}  // namespace status_bit

/// Controlwords, object 0x6040, and bits that are added to `enable`.
namespace control_word {
inline constexpr std::uint16_t disable_voltage = 0x0000, quick_stop = 0x0002, shutdown = 0x0006,
                               switch_on = 0x0007, enable = 0x000F, fault_reset = 0x0080,
                               /// New setpoint; in homing mode: start.
    start = 1U << 4, immediately = 1U << 5, relative = 1U << 6, halt = 1U << 8;
}  // namespace control_word

}  // namespace flexura

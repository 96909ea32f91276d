#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "flexura/equipment/visca_codec.h"

// What drivers send, as text that can be compared with the devices' manuals.
namespace flexura {

/// One message in readable form.
struct SentText {
  std::string text;
  bool asks = false;  ///< Whether the message only asks for a state and changes nothing.
};

/// Returns the lines and realtime bytes that are sent to a Grbl controller, for example "$J=G90G21X1F60" and
/// "0x85 (cancel jog)".
[[nodiscard]] std::vector<SentText> grbl_sent(std::string_view bytes);
/// Returns a VISCA packet in hexadecimal digits, with its meaning. `framing`: framing of the packet.
/// `digits`: numbers of digits of the head's positions.
[[nodiscard]] SentText visca_sent(std::string_view bytes, ViscaFraming framing, ViscaDigits digits);
/// Returns the ONVIF request in an HTTP message, with its positions.
[[nodiscard]] SentText onvif_sent(std::string_view bytes);
/// Returns a CAN frame in the format of can-utils ("201#0F00"), with its meaning for a drive that Cia402Drive
/// has configured. `bytes`: result of bytes_of().
[[nodiscard]] SentText can_sent(std::string_view bytes);

}  // namespace flexura

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The SOAP messages of ONVIF that a pan/tilt/zoom head needs: requests, and what their answers say.
// Elements are found by their names without prefixes. Times are in s since the start of 1970, UTC.
namespace flexura {

/// Signature of a request, which replaces the password (WS-Security UsernameToken with a digest).
struct OnvifToken {
  std::string user;
  std::string digest;   ///< Digest by onvif_digest(), base64.
  std::string nonce;    ///< Random number that is used only once, base64.
  std::string created;  ///< Time of the signature, in the format of onvif_time_text().
};

/// Returns the digest of a password: base64(SHA-1(nonce + created + password)). `nonce`: the bytes of the
/// nonce, not base64.
[[nodiscard]] std::string onvif_digest(std::string_view nonce, std::string_view created,
                                       std::string_view password);
/// Returns a time in the format "2026-01-31T23:59:59.123Z". Times outside the years 1970 to 9999 are clamped.
[[nodiscard]] std::string onvif_time_text(double time);
/// Returns the time in a text of the format of onvif_time_text(); std::nullopt for other texts. The fraction
/// of a second may be missing.
[[nodiscard]] std::optional<double> parse_onvif_time(std::string_view text);

/// Positions of a head in one of its position spaces. The zoom is missing if it is not to be moved, or if the
/// camera does not report it.
struct OnvifPlace {
  double pan = 0, tilt = 0;
  std::optional<double> zoom = {};
};

/// Position space of generic numbers, usually -1 to 1.
inline constexpr std::string_view onvif_generic_space =
    "http://www.onvif.org/ver10/tptz/PanTiltSpaces/PositionGenericSpace";
/// Position space of degrees.
inline constexpr std::string_view onvif_degree_space =
    "http://www.onvif.org/ver10/tptz/PanTiltSpaces/SphericalPositionSpaceDegrees";
/// Position space of the zoom, usually 0 to 1.
inline constexpr std::string_view onvif_zoom_space =
    "http://www.onvif.org/ver10/tptz/ZoomSpaces/PositionGenericSpace";

/// Returns a SOAP message with this body. If there is a token, the message is signed.
[[nodiscard]] std::string soap_message(std::string_view body, const std::optional<OnvifToken>& token = {});

/// The following functions return bodies of requests.
[[nodiscard]] std::string onvif_ask_time();
[[nodiscard]] std::string onvif_ask_services();
[[nodiscard]] std::string onvif_ask_capabilities();
[[nodiscard]] std::string onvif_ask_profiles();
[[nodiscard]] std::string onvif_ask_nodes();
[[nodiscard]] std::string onvif_ask_status(std::string_view profile);
/// `space`: URI of the position space of pan and tilt. `speed`: fraction of the highest speed.
[[nodiscard]] std::string onvif_move(std::string_view profile, const OnvifPlace& place,
                                     std::string_view space, const std::optional<double>& speed);
[[nodiscard]] std::string onvif_stop(std::string_view profile);

/// Reason why a device refuses a request.
struct SoapFault {
  std::string code;    ///< Innermost code without its prefix, such as "NotAuthorized".
  std::string reason;  ///< Text of the device; may be empty.
};
/// Paths of a device's services, without the host; empty if it has none.
struct OnvifServices {
  std::string media, ptz;
};
/// A media profile of a camera. Moves of a head refer to a media profile.
struct OnvifProfile {
  std::string token;
  bool has_head = false;
  std::string node;  ///< Token of the head's node.
};
/// A range of positions.
struct OnvifRange {
  double min = 0, max = 0;
};
/// A position space. For zoom spaces, `y` has no meaning.
struct OnvifSpace {
  std::string uri;
  OnvifRange x, y;
};
/// Properties of a head (PTZ node).
struct OnvifNode {
  std::string token;
  std::vector<OnvifSpace> turn, zoom;  ///< Spaces of absolute moves.
};
/// A head's state.
struct OnvifStatus {
  std::optional<OnvifPlace> place;  ///< Missing if pan and tilt are not reported.
  std::string turn_space;           ///< URI; empty if not reported.
  std::optional<bool> is_moving;    ///< Missing if not reported.
  std::string error;                ///< Error text of the head; usually empty.
};

/// The following functions parse SOAP messages. If a message is not the answer to the request, these
/// functions return std::nullopt. Numbers that are not finite count as missing.
[[nodiscard]] std::optional<SoapFault> parse_soap_fault(std::string_view soap);
[[nodiscard]] std::optional<double> parse_onvif_clock(std::string_view soap);
/// Reads the answer to onvif_ask_services() or onvif_ask_capabilities().
[[nodiscard]] std::optional<OnvifServices> parse_onvif_services(std::string_view soap);
[[nodiscard]] std::optional<std::vector<OnvifProfile>> parse_onvif_profiles(std::string_view soap);
[[nodiscard]] std::optional<std::vector<OnvifNode>> parse_onvif_nodes(std::string_view soap);
[[nodiscard]] std::optional<OnvifStatus> parse_onvif_status(std::string_view soap);
/// Returns whether a message is an answer with this name, such as "StopResponse".
[[nodiscard]] bool is_onvif_answer(std::string_view soap, std::string_view name);

/// A request as parsed by a device.
struct OnvifRequest {
  std::string name;  ///< Name of the request, such as "AbsoluteMove".
  std::optional<OnvifToken> token;
  std::string profile;
  /// For AbsoluteMove: positions. For ContinuousMove: fractions of the highest speed.
  std::optional<double> pan, tilt, zoom;
  std::string turn_space, zoom_space;
  std::optional<double> speed, timeout;  ///< Fraction of the highest speed; timeout of a ContinuousMove, s.
  bool stops_turn = true, stops_zoom = true;
};
/// Reads a request; std::nullopt if the message is not a request.
[[nodiscard]] std::optional<OnvifRequest> parse_onvif_request(std::string_view soap);

}  // namespace flexura

#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/equipment/onvif_soap.h"

// Bodies of the answers of a simulated ONVIF camera (OnvifDevice).
namespace flexura {

/// Token of the camera's only media profile.
inline constexpr std::string_view onvif_fixed_profile = "profile_1";

/// Returns a complete SOAP message with a fault. `code`: ONVIF's code, such as "NotAuthorized".
[[nodiscard]] std::string soap_fault(std::string_view code, std::string_view reason);
/// Returns an answer without content, for requests such as a move.
[[nodiscard]] std::string onvif_empty_answer(std::string_view request);
/// `time`: s since 1970.
[[nodiscard]] std::string onvif_clock_answer(double time);
/// `host`: name or number and port of the camera.
[[nodiscard]] std::string onvif_services_answer(std::string_view host);
[[nodiscard]] std::string onvif_capabilities_answer(std::string_view host);
[[nodiscard]] std::string onvif_nodes_answer(const std::vector<OnvifSpace>& turn,
                                             const std::vector<OnvifSpace>& zoom);
/// `space`: URI of the space of pan and tilt. `time`: s since 1970.
[[nodiscard]] std::string onvif_status_answer(const OnvifPlace& place, std::string_view space,
                                              const std::optional<bool>& is_moving, double time);
/// Returns the answer to a request if the answer is constant and needs no login; otherwise std::nullopt.
[[nodiscard]] std::optional<std::string> onvif_open_answer(std::string_view request);
/// Returns the answer to a request if the answer is constant and needs a login; otherwise std::nullopt.
[[nodiscard]] std::optional<std::string> onvif_fixed_answer(std::string_view request, std::string_view host);

}  // namespace flexura

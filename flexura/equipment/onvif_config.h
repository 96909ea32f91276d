#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/head.h"
#include "flexura/equipment/onvif_soap.h"

namespace flexura {

/// Position space in which a head is commanded and reports.
enum class OnvifPositions {
  generic,  ///< Numbers, usually -1 to 1 (PositionGenericSpace).
  degrees,  ///< Degrees (SphericalPositionSpaceDegrees).
};
const std::vector<std::string>& names_of(const OnvifPositions*);

/// Pan or tilt of an ONVIF head. Positions are in the head's unit.
struct OnvifTurnConfig {
  /// Positions per degree; below 0 if positions grow to the camera's right, or downwards. Default: for
  /// `degrees`, -1 for pan and 1 for tilt; for `generic`, -1/180 and 1/90.
  std::optional<double> per_degree = {};
  double zero = 0;  ///< Position at the head's angle 0.
  /// Smallest and largest position that the program commands. Default: the head's range.
  std::optional<std::array<double, 2>> limits = {};
  double tolerance = 0.2;  ///< Largest distance from the target at which a move counts as done, degrees.
};
/// The pan axis.
struct OnvifPanConfig : OnvifTurnConfig {};
/// The tilt axis.
struct OnvifTiltConfig : OnvifTurnConfig {};

/// The zoom of an ONVIF head.
struct OnvifZoomConfig {
  /// Zoom positions in the head's unit, ascending; at least 2. The first and the last limit the commands.
  std::vector<double> points = {0, 1};
  /// Zoom position (HeadState::zoom) at each of the points, ascending. Between the points, the zoom position
  /// is interpolated linearly. Default: the points.
  std::optional<std::vector<double>> positions = {};
  double tolerance =
      0.01;  ///< Largest distance from the target at which zooming counts as done, in the head's unit.
};

/// A pan/tilt/zoom head of an ONVIF camera.
struct OnvifConfig {
  std::string link;                            ///< Address, tcp:HOST:PORT.
  std::string user;                            ///< User name for the login; empty: no login.
  std::string password_file;                   ///< File with the password in its first line.
  std::string path = "/onvif/device_service";  ///< Path of the device service.
  std::string profile;  ///< Token of the media profile; empty: the first profile with a head.
  OnvifPositions space = OnvifPositions::generic;
  OnvifPanConfig pan;
  OnvifTiltConfig tilt;
  OnvifZoomConfig zoom;
  /// Speed of moves as a fraction of the highest speed; > 0, at most 1. Default: the head's setting.
  std::optional<double> speed = {};
  double reply_timeout = 2;  ///< Longest wait for the answer of the head, s; > 0, at most 30.
  std::int64_t tries = 3;  ///< Number of times that a request is sent before a head counts as lost; 1 to 20.
  /// Time for which a head may rest away from its target, s; > 0. After this time the command is repeated. A
  /// head must also stop within this time after a halt.
  double stall_time = 3;
};

const Table<OnvifPanConfig>& fields_of(const OnvifPanConfig*);
const Table<OnvifTiltConfig>& fields_of(const OnvifTiltConfig*);
const Table<OnvifZoomConfig>& fields_of(const OnvifZoomConfig*);
const Table<OnvifConfig>& fields_of(const OnvifConfig*);

/// Returns the reason why a configuration is invalid; "" if it is valid.
[[nodiscard]] std::string onvif_problem(const OnvifConfig& config);

/// Returns the URI of the configured position space of pan and tilt.
[[nodiscard]] std::string_view onvif_space(const OnvifConfig& config);

/// Ranges of the positions that the program commands.
struct OnvifRanges {
  OnvifRange pan, tilt;
  bool has_zoom = false;
};
/// Returns the position nearest to a state, within the ranges. The state must be finite.
[[nodiscard]] OnvifPlace onvif_place(const OnvifConfig& config, const OnvifRanges& ranges,
                                     const HeadState& state);
/// Returns the state at a position, also outside the ranges. If the position has no zoom, the state has the
/// zoom position of the first point.
[[nodiscard]] HeadState onvif_state(const OnvifConfig& config, const OnvifPlace& place);
/// Returns whether two positions are equal within the tolerances. A missing zoom is equal to any zoom.
[[nodiscard]] bool are_near(const OnvifConfig& config, const OnvifPlace& a, const OnvifPlace& b);

}  // namespace flexura

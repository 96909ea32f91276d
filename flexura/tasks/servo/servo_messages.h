#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/log/messages.h"

namespace flexura {

// Log messages of a servo (log/messages.h), except its steps (servo/servo_step.h).

/// A pixel or polyline that a servo's law compares in a picture, px.
struct FeatureMarkMessage {
  std::vector<std::array<double, 2>> seen, desired;
};

/// flexura.ServoObservation, on /servo/observations: measurements of a servo in one picture.
struct ServoObservationMessage {
  double time = 0;  ///< Middle of the exposure, s.
  std::string camera;
  std::int64_t frame = 0;                ///< Number of the frame.
  std::vector<AxisPointMessage> points;  ///< Points of the centerline, from base to tip.
  /// Image of the target shape in the nominal camera, from base to tip, px.
  std::vector<std::array<double, 2>> desired;
  std::optional<std::vector<FeatureMarkMessage>> features;  ///< Features that the law compares.
  std::optional<std::string> reason;                        ///< Why the picture shows no arm.
};

inline constexpr std::string_view servo_steps_topic = "/servo/steps";
inline constexpr std::string_view servo_observations_topic = "/servo/observations";

const Table<FeatureMarkMessage>& fields_of(const FeatureMarkMessage*);
const Table<ServoObservationMessage>& fields_of(const ServoObservationMessage*);

}  // namespace flexura

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

// The messages of a servo (log/messages.h) beside its steps (servo/servo_step.h).

/// Something that a servo's law compares in a picture: a pixel, or a line of some, px.
struct FeatureMarkMessage {
  std::vector<std::array<double, 2>> seen, wanted;
};

/// flexura.ServoSighting, on /servo/sightings: what a servo measured in one picture.
struct ServoSightingMessage {
  double time = 0;  ///< Middle of the exposure, s.
  std::string camera;
  std::int64_t frame = 0;                ///< Its number.
  std::vector<AxisPointMessage> points;  ///< Of the median axis, from base to tip.
  /// Where the wanted shape would be seen, from base to tip, px; by the camera as it is believed to be.
  std::vector<std::array<double, 2>> wanted;
  std::optional<std::vector<FeatureMarkMessage>> features;  ///< What the law compares.
  std::optional<std::string> reason;                        ///< Why the picture shows no arm.
};

inline constexpr std::string_view servo_steps_topic = "/servo/steps";
inline constexpr std::string_view servo_sightings_topic = "/servo/sightings";

const Table<FeatureMarkMessage>& fields_of(const FeatureMarkMessage*);
const Table<ServoSightingMessage>& fields_of(const ServoSightingMessage*);

}  // namespace flexura

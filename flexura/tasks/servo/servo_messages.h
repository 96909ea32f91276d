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

// What a servo tells (log/messages.h).

/// Where a camera's head was sent to.
struct HeadCommandMessage {
  std::string camera;
  double pan = 0, tilt = 0;  ///< rad
  double zoom = 0;           ///< A position of the lens's table.
};

/// flexura.ServoStep, on /servo/steps: one command of a servo, and what it was made of.
struct ServoStepMessage {
  double time = 0;                                         ///< When it was sent, s.
  std::optional<double> seen_at;                           ///< Of the pictures it goes by, s.
  std::vector<std::array<double, 2>> desired;              ///< Bends wanted at their time, rad,
  std::vector<double> desired_stretches;                   ///< and stretches.
  std::optional<std::vector<std::array<double, 2>>> seen;  ///< By these pictures, rad.
  std::optional<std::vector<double>> seen_stretches;
  std::vector<std::array<double, 2>> sent;  ///< rad
  std::vector<double> sent_stretches;
  std::optional<std::vector<HeadCommandMessage>> heads;  ///< That were sent on with this command.
  std::vector<double> lengths;  ///< Of the unstretched sections, as they are believed to be, m.
  /// Of the simulated truth at the time of the pictures: bends, rad, and lengths with their stretch, m.
  std::optional<std::vector<std::array<double, 2>>> truth;
  std::optional<std::vector<double>> true_lengths;
  std::optional<double> rms, most, tip;                 ///< From seen to desired, shares of the length.
  std::optional<double> true_rms, true_most, true_tip;  ///< Likewise, of the simulated truth.
  double potential = 0;                ///< Half the square of the law's error, rad^2 or px^2.
  bool fresh = false;                  ///< The pictures are new.
  bool singular = false;               ///< Some motion of the arm shows in nothing that is seen.
  std::optional<std::string> limited;  ///< What held the law back.
};

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

const Table<HeadCommandMessage>& fields_of(const HeadCommandMessage*);
const Table<ServoStepMessage>& fields_of(const ServoStepMessage*);
const Table<FeatureMarkMessage>& fields_of(const FeatureMarkMessage*);
const Table<ServoSightingMessage>& fields_of(const ServoSightingMessage*);

}  // namespace flexura

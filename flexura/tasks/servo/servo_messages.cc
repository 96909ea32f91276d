#include "flexura/tasks/servo/servo_messages.h"

#include "flexura/base/table.h"

namespace flexura {

const Table<HeadCommandMessage>& fields_of(const HeadCommandMessage*) {
  using M = HeadCommandMessage;
  static const auto table = Table<M>("flexura.HeadCommand", "Where a camera's head was sent to.")
                                .field("camera", &M::camera, {.meaning = "The camera's name."})
                                .field("pan", &M::pan, {.meaning = "rad, to the camera's left."})
                                .field("tilt", &M::tilt, {.meaning = "rad, upwards."})
                                .field("zoom", &M::zoom, {.meaning = "A ratio or a motor count."});
  return table;
}

const Table<ServoStepMessage>& fields_of(const ServoStepMessage*) {
  using M = ServoStepMessage;
  static const auto table =
      Table<M>("flexura.ServoStep", "A command of a servo, and what it was made of.")
          .field("time", &M::time, {.meaning = "When it was sent, since the experiment's start, s."})
          .field("seen_at", &M::seen_at, {.meaning = "Middle of the exposure of the pictures it goes by, s."})
          .field("desired", &M::desired, {.meaning = "Each section's bend wanted at their time, rad."})
          .field("desired_stretches", &M::desired_stretches,
                 {.meaning = "Each section's stretch wanted then."})
          .field("seen", &M::seen, {.meaning = "Each section's bend as seen in them, rad."})
          .field("seen_stretches", &M::seen_stretches, {.meaning = "Each section's stretch as seen."})
          .field("sent", &M::sent, {.meaning = "Each section's bend as commanded, rad."})
          .field("sent_stretches", &M::sent_stretches, {.meaning = "Each section's stretch as commanded."})
          .field("heads", &M::heads,
                 {.meaning = "Where heads that follow the arm were sent to with this command."})
          .field("lengths", &M::lengths,
                 {.meaning = "Each section's length without stretch, as it is believed to be, m."})
          .field("truth", &M::truth,
                 {.meaning = "Each section's bend in the simulated truth, at the time of the pictures, rad."})
          .field("true_lengths", &M::true_lengths,
                 {.meaning = "Each section's length in the simulated truth then, with its stretch, m."})
          .field("rms", &M::rms,
                 {.meaning =
                      "Distance along the arm from seen to desired, root mean square, share of its length."})
          .field("most", &M::most, {.meaning = "Likewise, the largest."})
          .field("tip", &M::tip, {.meaning = "Likewise, of the tip."})
          .field("true_rms", &M::true_rms, {.meaning = "As rms, from the simulated truth to desired."})
          .field("true_most", &M::true_most, {.meaning = "Likewise, the largest."})
          .field("true_tip", &M::true_tip, {.meaning = "Likewise, of the tip."})
          .field("potential", &M::potential,
                 {.meaning =
                      "Half the square of the law's error: rad^2 for shape and potential, px^2 otherwise."})
          .field("fresh", &M::fresh, {.meaning = "Whether the pictures are new."})
          .field("singular", &M::singular, {.meaning = "Whether some motion shows in nothing that is seen."})
          .field("limited", &M::limited, {.meaning = "What held the law back."});
  return table;
}

const Table<FeatureMarkMessage>& fields_of(const FeatureMarkMessage*) {
  using M = FeatureMarkMessage;
  static const auto table =
      Table<M>("flexura.FeatureMark",
               "Something that a law compares in a picture: a pixel, or a line of some.")
          .field("seen", &M::seen, {.meaning = "As measured, px."})
          .field("wanted", &M::wanted, {.meaning = "As wanted, px."});
  return table;
}

const Table<ServoSightingMessage>& fields_of(const ServoSightingMessage*) {
  using M = ServoSightingMessage;
  static const auto table =
      Table<M>("flexura.ServoSighting", "What a servo measured in one picture.")
          .field("time", &M::time, {.meaning = "Middle of the exposure, since the experiment's start, s."})
          .field("camera", &M::camera, {.meaning = "The camera's name."})
          .field("frame", &M::frame, {.meaning = "The frame's number."})
          .field("points", &M::points, {.meaning = "Points of the median axis, base to tip."})
          .field("wanted", &M::wanted,
                 {.meaning = "Where the camera, as it is believed to be, would see the wanted shape, base to "
                             "tip, px."})
          .field("features", &M::features,
                 {.meaning = "What the law compares in the picture: pixels of points and silhouettes; chords "
                             "of chords and potential, the wanted ones turned about the middles of the "
                             "measured ones; of moments the middle, and the ellipse of the second moments."})
          .field("reason", &M::reason, {.meaning = "Why the picture shows no arm."});
  return table;
}

}  // namespace flexura

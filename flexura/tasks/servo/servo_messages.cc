#include "flexura/tasks/servo/servo_messages.h"

#include "flexura/base/table.h"

namespace flexura {

const Table<FeatureMarkMessage>& fields_of(const FeatureMarkMessage*) {
  using M = FeatureMarkMessage;
  static const auto table =
      Table<M>("flexura.FeatureMark",
               "Something that a law compares in a picture: a pixel, or a polyline of pixels.")
          .field("seen", &M::seen, {.meaning = "As measured, px."})
          .field("target", &M::desired, {.meaning = "Target, px."});
  return table;
}

const Table<ServoObservationMessage>& fields_of(const ServoObservationMessage*) {
  using M = ServoObservationMessage;
  static const auto table =
      Table<M>("flexura.ServoObservation", "What a servo measured in one picture.")
          .field("time", &M::time, {.meaning = "Middle of the exposure, since the experiment's start, s."})
          .field("camera", &M::camera, {.meaning = "The camera's name."})
          .field("frame", &M::frame, {.meaning = "The frame's number."})
          .field("points", &M::points, {.meaning = "Points of the median axis, base to tip."})
          .field("target", &M::desired,
                 {.meaning = "The target shape in the picture of the camera's model, base to "
                             "tip, px."})
          .field("features", &M::features,
                 {.meaning = "What the law compares in the picture: pixels of points and silhouettes; chords "
                             "of chords and potential, the target ones turned about the middles of the "
                             "measured ones; of moments the middle, and the ellipse of the second moments."})
          .field("reason", &M::reason, {.meaning = "Why the picture shows no arm."});
  return table;
}

}  // namespace flexura

#include "flexura/tasks/servo/servo_messages.h"

#include "flexura/base/table.h"

namespace flexura {

const Table<FeatureMarkMessage>& fields_of(const FeatureMarkMessage*) {
  using M = FeatureMarkMessage;
  static const auto table =
      Table<M>("flexura.FeatureMark",
               "Feature that a law compares in a picture: a pixel, or a polyline of pixels.")
          .field("seen", &M::seen, {.meaning = "Measured pixels, px."})
          .field("target", &M::desired, {.meaning = "Target pixels, px."});
  return table;
}

const Table<ServoObservationMessage>& fields_of(const ServoObservationMessage*) {
  using M = ServoObservationMessage;
  static const auto table =
      Table<M>("flexura.ServoObservation", "Measurements of a servo in one picture.")
          .field("time", &M::time, {.meaning = "Middle of the exposure, since the experiment's start, s."})
          .field("camera", &M::camera, {.meaning = "Name of the camera."})
          .field("frame", &M::frame, {.meaning = "Number of the frame."})
          .field("points", &M::points, {.meaning = "Points of the median axis, from base to tip."})
          .field("target", &M::desired,
                 {.meaning = "Image of the target shape in the camera model, from base to tip, px."})
          .field("features", &M::features,
                 {.meaning = "Features that the law compares in the picture. The laws points and silhouettes "
                             "have pixels. The laws chords and potential have chords; a target chord is the "
                             "measured chord, rotated about its middle. The law moments has the centroid and "
                             "the ellipse of the second moments."})
          .field("reason", &M::reason, {.meaning = "Why the picture shows no arm."});
  return table;
}

}  // namespace flexura

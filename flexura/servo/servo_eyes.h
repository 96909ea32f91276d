#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/estimate/shape_tracker.h"
#include "flexura/port/camera_port.h"
#include "flexura/port/rig_model.h"
#include "flexura/servo/servo_watcher.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Makes shapes of pictures of a known arm by two cameras.
class ServoEyes {
 public:
  /// `cameras`: places among the model's; `markers`: middles of the arm's bands, m, rising.
  /// `doubt`: in the views of both.
  ServoEyes(const RigModel& believed, const std::array<std::size_t, 2>& cameras, std::vector<double> markers,
            const ViewDoubt& doubt);

  /// What the pictures show of the arm, seen by these views, of which `guess` is expected
  /// (ShapeTracker::look). Where a picture shows no arm, its reason is set and the estimate is not found.
  /// Where it is found, the sightings' views are without the errors that were found with it.
  [[nodiscard]] ServoSight look(const std::array<Frame, 2>& frames, const std::array<View, 2>& views,
                                const std::optional<ArmState>& guess);

  /// The shape of what was seen, if nothing were wrong with these views.
  [[nodiscard]] ShapeEstimate as_believed(const ServoSight& sight, const std::array<View, 2>& views) const;

  /// The next pictures are of an arm that may stand anyhow.
  void forget() { tracker_.forget(), is_believing_ = false; }

 private:
  [[nodiscard]] ShapeEstimate shape_of(const ServoSight& sight, const std::optional<ArmState>& guess);
  [[nodiscard]] Sighting sighting(std::size_t i, const Picture& picture, const View& view,
                                  std::string& reason);

  Arm arm_;
  std::array<int, 2> whites_ = {};  // The largest value of each camera's pictures.
  bool has_markers_;
  ViewDoubt doubt_;
  ShapePrior prior_;
  ShapeTracker tracker_;
  bool is_believing_ = false;
  struct Finder {
    Eigen::Vector2d base;
    ArmFinder finder;
  };
  std::array<std::optional<Finder>, 2> finders_;
};

}  // namespace flexura

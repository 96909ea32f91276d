#include "flexura/servo/servo_goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <variant>

#include "flexura/model/arm_way.h"

namespace flexura {

ServoGoals::ServoGoals(const std::vector<ServoGoal>& goals, const Arm& arm, PictureMeter& meter,
                       ShapeObserver& observer, ServoFeatures& features, const std::array<View, 2>& views) {
  for (const ServoGoal& goal : goals) {
    times_.push_back(goal.time);
    if (const auto* state = std::get_if<ArmState>(&goal.shape)) {
      shapes_.push_back({*state, {}});
    } else {
      const auto& pictures = std::get<RecordedViews>(goal.shape);
      PicturePair recorded{{}, views};
      for (std::size_t i = 0; i < 2; ++i)
        recorded.frames[i].picture = std::make_shared<const Picture>(pictures[i]);
      measure(recorded, arm, meter, observer, features);
    }
  }
}

void ServoGoals::measure(const PicturePair& recorded, const Arm& arm, PictureMeter& meter,
                         ShapeObserver& observer, ServoFeatures& features) {
  ServoSight sight = meter.measure(recorded);
  observer.estimate_alone(sight);
  if (problem_.empty()) problem_ = wrong_order(sight, recorded, meter, observer);
  WantedShape& wanted = shapes_.emplace_back(WantedShape{ArmState::straight(arm.sections.size()), {}});
  for (std::size_t i = 0; i < 2; ++i)
    if (problem_.empty() && !sight.estimate.is_found && !sight.reasons[i].empty())
      problem_ =
          fmt::format("picture {} of target {} shows no arm: {}", i + 1, times_.size(), sight.reasons[i]);
  if (!problem_.empty()) return;
  if (!sight.estimate.is_found) {
    problem_ =
        fmt::format("the pictures of target {} show no shape: {}", times_.size(), sight.estimate.reason);
    return;
  }
  wanted.state = sight.estimate.shape.state;
  Eigen::VectorXd seen, foreseen;
  if (features.measured(wanted.state, sight.seen, seen) &&
      features.foreseen(wanted.state, {sight.seen[0].view, sight.seen[1].view}, foreseen))
    wanted.offset = seen - foreseen;
}

// Only perspective distinguishes the two mirror images of a shape: nominal cameras fit one of them up to the
// pictures' noise. If they fit neither, the cameras are wrong and the order is not judged.
std::string ServoGoals::wrong_order(const ServoSight& sight, const PicturePair& recorded, PictureMeter& meter,
                                    const ShapeObserver& observer) const {
  constexpr double noise = 1.5, far_worse = 2;  // In noise units; ratio of both fits.
  const auto& [frames, views] = recorded;
  const auto is_taken_by = [&](std::size_t i, std::size_t camera) {
    return std::visit(
        [&](const auto& image) {
          return image.width() == views[camera].width && image.height() == views[camera].height;
        },
        *frames[i].picture);
  };
  if (frames[0].picture->index() != frames[1].picture->index() || !is_taken_by(0, 1) || !is_taken_by(1, 0))
    return "";
  const ServoSight turned = meter.measure({{frames[1], frames[0]}, views});
  const ShapeEstimate given = observer.as_believed(sight, views), other = observer.as_believed(turned, views);
  const bool is_worse = !given.is_found || given.scale >= far_worse * other.scale;
  if (!other.is_found || other.scale > noise || !is_worse) return "";
  const std::string than = given.is_found ? fmt::format(", not {:.2g} px", given.rms) : "";
  return fmt::format(
      "the pictures of target {} are in the wrong order: the other way round they fit the cameras to {:.2g} "
      "px{}",
      times_.size(), other.rms, than);
}

WantedShape ServoGoals::at(double time) const {
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(times_, time) - times_.begin());
  if (after == 0) return shapes_.front();
  if (after == times_.size()) return shapes_.back();
  const double share = (time - times_[after - 1]) / (times_[after] - times_[after - 1]);
  const WantedShape &from = shapes_[after - 1], &to = shapes_[after];
  WantedShape wanted{interpolate(from.state, to.state, share), {}};
  const Eigen::Index size = std::max(from.offset.size(), to.offset.size());
  if (size == 0) return wanted;
  wanted.offset = Eigen::VectorXd::Zero(size);
  if (from.offset.size() > 0) wanted.offset += (1 - share) * from.offset;
  if (to.offset.size() > 0) wanted.offset += share * to.offset;
  return wanted;
}

}  // namespace flexura

#include "flexura/servo/servo_goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <variant>

#include "flexura/model/arm_difference.h"

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
  ServoObservation observed = meter.measure(recorded);
  observer.estimate_alone(observed);
  if (problem_.empty()) problem_ = wrong_order(observed, recorded, meter, observer);
  TargetShape& desired = shapes_.emplace_back(TargetShape{ArmState::straight(arm.sections.size()), {}});
  for (std::size_t i = 0; i < 2; ++i)
    if (problem_.empty() && !observed.estimate.is_found && !observed.reasons[i].empty())
      problem_ =
          fmt::format("picture {} of target {} shows no arm: {}", i + 1, times_.size(), observed.reasons[i]);
  if (!problem_.empty()) return;
  if (!observed.estimate.is_found) {
    problem_ =
        fmt::format("the pictures of target {} show no shape: {}", times_.size(), observed.estimate.reason);
    return;
  }
  desired.state = observed.estimate.shape.state;
  Eigen::VectorXd seen, predicted;
  if (features.measured(desired.state, observed.seen, seen) &&
      features.predict(desired.state, {observed.seen[0].view, observed.seen[1].view}, predicted))
    desired.offset = seen - predicted;
}

// Only perspective distinguishes the two mirror images of a shape: nominal cameras fit one of them up to the
// pictures' noise. If they fit neither, the cameras are wrong and the order is not judged.
std::string ServoGoals::wrong_order(const ServoObservation& observed, const PicturePair& recorded,
                                    PictureMeter& meter, const ShapeObserver& observer) const {
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
  const ServoObservation turned = meter.measure({{frames[1], frames[0]}, views});
  const ShapeEstimate given = observer.with_nominal_views(observed, views),
                      other = observer.with_nominal_views(turned, views);
  const bool is_worse = !given.is_found || given.scale >= far_worse * other.scale;
  if (!other.is_found || other.scale > noise || !is_worse) return "";
  const std::string than = given.is_found ? fmt::format(", not {:.2g} px", given.rms) : "";
  return fmt::format(
      "the pictures of target {} are in the wrong order: in the opposite order, the residual would be {:.2g} "
      "px{}",
      times_.size(), other.rms, than);
}

TargetShape ServoGoals::at(double time) const {
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(times_, time) - times_.begin());
  if (after == 0) return shapes_.front();
  if (after == times_.size()) return shapes_.back();
  const double share = (time - times_[after - 1]) / (times_[after] - times_[after - 1]);
  const TargetShape &from = shapes_[after - 1], &to = shapes_[after];
  TargetShape desired{interpolate(from.state, to.state, share), {}};
  const Eigen::Index size = std::max(from.offset.size(), to.offset.size());
  if (size == 0) return desired;
  desired.offset = Eigen::VectorXd::Zero(size);
  if (from.offset.size() > 0) desired.offset += (1 - share) * from.offset;
  if (to.offset.size() > 0) desired.offset += share * to.offset;
  return desired;
}

}  // namespace flexura

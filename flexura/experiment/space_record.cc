#include "flexura/experiment/space_record.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flexura {
namespace {

constexpr std::size_t points_of_true_arm = 33;
constexpr std::size_t most_true_arms = 240;
constexpr std::size_t most_camera_views = 400;
// Largest distance from the commanded arm that nobody sees, share of the length.
constexpr double invisible_off = 1e-3;

ReportSpace::CameraView view_of(double time, const Camera& camera, const CameraStance& stance) {
  const Intrinsics lens = camera.lens().at(stance.head.zoom);
  const SensorConfig& sensor = camera.config().sensor;
  // Pixel centres are whole numbers.
  const double right = static_cast<double>(sensor.width) - 0.5,
               bottom = static_cast<double>(sensor.height) - 0.5;
  return {time,
          camera.pose(stance),
          {(-0.5 - lens.cx) / lens.fx, (right - lens.cx) / lens.fx, (-0.5 - lens.cy) / lens.fy,
           (bottom - lens.cy) / lens.fy}};
}

// Removes every second item after the first.
template <class Item>
void halve(std::vector<Item>& items) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < items.size(); i += 2, ++kept)
    if (i != kept) items[kept] = std::move(items[i]);
  items.resize(kept);
}

}  // namespace

CameraStance true_stance(const Camera& camera, const CameraStance& first, const CameraStance& reported) {
  CameraStance now = camera.initial_stance();
  now.head.pan += reported.head.pan - first.head.pan;
  now.head.tilt += reported.head.tilt - first.head.tilt;
  now.head.zoom += reported.head.zoom - first.head.zoom;
  now.stage.offset += reported.stage.offset - first.stage.offset;
  // Such a zoom may lie beyond the ends of the true lens.
  now.head.zoom = std::clamp(now.head.zoom, camera.lens().first(), camera.lens().last());
  return now;
}

void SpaceRecord::add_cameras(const Experiment& experiment) {
  const std::vector<CameraConfig> truth = experiment.true_rig().cameras, models = experiment.cameras();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Camera camera(truth[i]);
    const CameraStance start = camera.initial_stance();
    cameras_.push_back(
        {camera, Camera(models[i]).initial_stance(), start, {truth[i].name, {view_of(0, camera, start)}}});
  }
}

const CameraStance* SpaceRecord::first_report(const std::string& camera) const {
  const auto found =
      std::ranges::find(cameras_, camera, [](const CameraRecord& one) { return one.camera.config().name; });
  return found == cameras_.end() ? nullptr : &found->first;
}

void SpaceRecord::report(double time, const std::string& camera, const CameraStance& reported) {
  for (CameraRecord& record : cameras_) {
    if (record.camera.config().name != camera) continue;
    const CameraStance now = true_stance(record.camera, record.first, reported);
    if (now == std::exchange(record.last, now)) return;
    auto& views = record.views.views;
    views.push_back(view_of(time, record.camera, now));
    if (views.size() > most_camera_views) {
      const ReportSpace::CameraView newest = views.back();
      halve(views);
      if (views.back().time < newest.time) views.push_back(newest);
    }
  }
}

void SpaceRecord::true_arm(double time, const Backbone& truth, const Backbone& commanded) {
  last_ = {time, points_along(truth, points_of_true_arm)};
  const std::vector<Eigen::Vector3d> wanted = points_along(commanded, points_of_true_arm);
  for (std::size_t i = 0; i < wanted.size(); ++i)
    largest_off_ = std::max(largest_off_, (last_.points[i] - wanted[i]).norm() / commanded.length());
  if (count_++ % every_ != 0) return;
  arms_.push_back(last_);
  if (arms_.size() < most_true_arms) return;
  halve(arms_);
  every_ *= 2;
}

ReportSpace SpaceRecord::space() && {
  ReportSpace space;
  for (CameraRecord& record : cameras_) space.cameras.push_back(std::move(record.views));
  if (largest_off_ > invisible_off) {
    space.true_arms = std::move(arms_);
    if (space.true_arms.back().time < last_.time) space.true_arms.push_back(std::move(last_));
  }
  return space;
}

std::vector<ReportSpace::Target> targets_of(std::span<const DoneTask> tasks) {
  std::vector<ReportSpace::Target> all;
  for (const DoneTask& task : tasks) {
    const double end = task.start + task.motion.duration();
    if (task.keeps_targets) {
      if (!all.empty() && all.back().end == task.start) all.back().end = end;
      continue;
    }
    for (ReportSpace::Target& target : task.runner.targets(task.motion)) {
      target.start += task.start, target.end += task.start;
      all.push_back(std::move(target));
    }
  }
  return all;
}

}  // namespace flexura

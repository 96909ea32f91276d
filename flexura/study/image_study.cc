#include "flexura/study/image_study.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "flexura/camera/camera.h"
#include "flexura/render/renderer.h"
#include "flexura/study/measured_target.h"
#include "flexura/study/study_view.h"

namespace flexura {
namespace {

// Indices of the columns.
constexpr std::size_t formula = 0, rendered = 1, measured = 2;

double difference(const std::optional<double>& a, const std::optional<double>& b) {
  if (a && b) return std::abs(*a - *b);
  return a || b ? std::numeric_limits<double>::infinity() : 0.0;
}

}  // namespace

bool ImageStudy::in_image(std::size_t i) const {
  // A pixel is a square about its centre.
  return std::ranges::all_of(images[i].circle, [this](const std::optional<Eigen::Vector2d>& p) {
    return p && p->minCoeff() >= -0.5 && p->x() <= width - 0.5 && p->y() <= height - 0.5;
  });
}

bool ImageStudy::is_seen(std::size_t i) const {
  return std::ranges::all_of(columns.front().features[i],
                             [](const std::optional<double>& value) { return value.has_value(); });
}

std::array<double, 2> ImageStudy::largest_difference() const {
  std::array<double, 2> largest{0, 0};
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t k = 0; k < feature_names.size(); ++k) {
      double& most = largest[k < length_features ? 0 : 1];
      most = std::max(most, difference(columns[formula].features[i][k], columns[rendered].features[i][k]));
    }
  }
  return largest;
}

ImageStudy::Measured ImageStudy::measured_difference() const {
  Measured result;
  double squares = 0;
  for (std::size_t i = 0; columns.size() > measured && i < values.size(); ++i) {
    for (std::size_t k = 0; k < length_features; ++k) {
      const auto &expected = columns[formula].features[i][k], &found = columns[measured].features[i][k];
      if (expected && found) ++result.count, squares += (*expected - *found) * (*expected - *found);
    }
  }
  if (result.count > 0) result.rms = std::sqrt(squares / static_cast<double>(result.count));
  return result;
}

ImageStudy study_images(const StudyTask& task, const std::vector<CameraConfig>& cameras, std::uint64_t seed,
                        Progress* progress) {
  const CameraConfig* config = camera_of(task, cameras);
  const std::vector<Variation> varied = variations(task.vary);
  if (config == nullptr || varied.size() != 1 || task.points < 2)
    throw std::invalid_argument("a study needs one of the cameras, one parameter and at least two values");
  const Camera camera(*config);
  const StudyTarget target(task.target);
  Renderer renderer;
  const auto place = static_cast<std::uint64_t>(config - cameras.data());
  MeasuredTarget measured_target(target, config->sensor, {seed, place, 0});
  ImageStudy study{.name = task.name.empty() ? "study" : task.name,
                   .camera = config->name,
                   .variation = varied.front(),
                   .width = static_cast<int>(config->sensor.width),
                   .height = static_cast<int>(config->sensor.height),
                   .values = {},
                   .images = {},
                   .columns = {{"formula", {}}, {"rendered", {}}}};
  if (task.measure) study.columns.push_back({"measured", {}});
  const auto& [first, last] = study.variation.values;
  for (std::int64_t i = 0; i < task.points; ++i) {
    if (progress != nullptr)
      progress->update(static_cast<double>(i) / static_cast<double>(task.points), study.name);
    const double share = static_cast<double>(i) / static_cast<double>(task.points - 1);
    // Exact at both ends, which may be limits of an axis.
    study.values.push_back((1 - share) * first + share * last);
    const View view = view_with(camera, study.variation.parameter, study.values.back(), target);
    study.images.push_back(target.projected(view));
    study.columns[formula].features.push_back(features_of(study.images.back()));
    study.columns[rendered].features.push_back(features_of(target.rendered(view, renderer)));
    if (!task.measure) continue;
    study.columns[measured].features.push_back(
        features_of(measured_target.image(view, static_cast<std::uint64_t>(i))));
  }
  return study;
}

}  // namespace flexura

#pragma once

#include <span>
#include <string>
#include <vector>

#include "flexura/app/estimate_config.h"
#include "flexura/base/node.h"
#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_estimator.h"

namespace flexura {

/// One picture, as the answer tells of it.
struct PictureReport {
  std::string image;   ///< Its file's name.
  std::string camera;  ///< Its camera's.
  std::string reason;  ///< Why it shows no arm; empty where it does.
  std::vector<std::string> notes;
};

/// What `flexura estimate` prints (docs/estimation.md, "flexura estimate"): `found` in `observations`, one
/// for each of `pictures`.
[[nodiscard]] Node estimate_node(const ShapeEstimate& found, std::span<const Observation> observations,
                                 std::span<const PictureReport> pictures, const EstimateConfig& config);

}  // namespace flexura

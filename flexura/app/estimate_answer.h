#pragma once

#include <span>
#include <string>
#include <vector>

#include "flexura/app/estimate_config.h"
#include "flexura/base/node.h"
#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_estimator.h"

namespace flexura {

/// One picture, as the answer reports it.
struct PictureReport {
  std::string image;   ///< File name.
  std::string camera;  ///< Camera name.
  std::string reason;  ///< Why no arm was found, or "".
  std::vector<std::string> notes;
};

/// Returns the answer that `flexura estimate` prints (docs/estimation.md, "flexura estimate"). `found` is the
/// estimate from `observations`, which has one observation per picture.
[[nodiscard]] Node estimate_node(const ShapeEstimate& found, std::span<const Observation> observations,
                                 std::span<const PictureReport> pictures, const EstimateConfig& config);

}  // namespace flexura

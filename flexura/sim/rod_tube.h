#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <mutex>
#include <vector>

#include "flexura/mechanics/rod_chain.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// Computes the backbone and tube of an arm from the strain modes of its rod. Thread-safe.
class RodTube {
 public:
  /// The tube has the radii of `arm` and the centerline of `rod`. Throws the exceptions of RodChain.
  RodTube(const Arm& arm, const Rod& rod);

  /// Returns the backbone in the world frame. `rest_stretches`: factors on the sections' lengths.
  [[nodiscard]] Backbone backbone(const Eigen::VectorXd& q, const std::vector<double>& rest_stretches) const;

 private:
  Arm arm_;
  mutable std::mutex mutex_;
  mutable RodChain chain_;
  std::vector<std::vector<RodNode>> nodes_;  // For each section.
};

/// Returns the positions on the rod, from base to tip, between which RodTube interpolates the backbone. The
/// positions divide each section into equal parts. The backbone has two arcs between successive positions.
[[nodiscard]] std::vector<RodPlace> tube_places(const Rod& rod);

}  // namespace flexura

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <mutex>
#include <vector>

#include "flexura/mechanics/rod_chain.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// The backbone of an arm that is a rod, with its tube, from the rod's strain modes. Several threads may ask.
class RodTube {
 public:
  /// The tube of the arm around the rod. Errors as RodChain.
  RodTube(const Arm& arm, const Rod& rod);

  /// In the world. `rest_stretches`: factors on the sections' own lengths.
  [[nodiscard]] Backbone backbone(const Eigen::VectorXd& q, const std::vector<double>& rest_stretches) const;

 private:
  Arm arm_;
  mutable std::mutex mutex_;
  mutable RodChain chain_;
  std::vector<std::vector<std::size_t>> nodes_;  // of each section
};

/// Where on the rod such a backbone goes through its poses, base first and the tip last, by equal parts of
/// each section. From one to the next there are two arcs.
[[nodiscard]] std::vector<RodPlace> tube_places(const Rod& rod);

}  // namespace flexura

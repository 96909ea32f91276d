#pragma once

#include <mutex>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/statics.h"
#include "flexura/model/backbone.h"
#include "flexura/sim/rod_tube.h"
#include "python/bindings/arm.h"
#include "python/bindings/convert.h"

namespace flexura::python {

/// The elastic rod of an arm with its weight and loads.
struct ArmsRod {
  /// Throws std::invalid_argument if a section of the arm has no material.
  explicit ArmsRod(const DescribedArm& arm);

  [[nodiscard]] std::size_t tendons() const { return rod.tendons.size(); }
  /// Returns the backbone in the world for modes q. Throws py::value_error for modes of another rod.
  [[nodiscard]] Backbone backbone(const Eigen::VectorXd& q) const;
  /// Throws py::value_error unless there are as many modes q as those of this rod.
  void require_own(const Eigen::VectorXd& q) const;

  Rod rod;
  RodLoads loads;
  Pose X_WB;
  RodTube tube;
  Eigen::Index size;  ///< Number of strain modes.
};

/// Throws py::value_error unless a state has the sizes of a state of this arm, `own`.
void require_same_arm(const RodState& state, const RodState& own);

/// Inputs of tendons for many rods: arrays of shape (N, tendons), or nothing.
class TendonArray {
 public:
  /// Throws py::value_error unless the array given has this shape, or both are given.
  TendonArray(const std::optional<Reals>& tensions, const std::optional<Reals>& displacements,
              std::size_t count, std::size_t tendons);
  /// Writes the input of rod `index` to `input`. Needs no GIL.
  void read(std::size_t index, TendonInput& input) const;

 private:
  std::optional<Reals> values_;
  const double* data_ = nullptr;
  std::size_t tendons_;
  bool by_displacement_;
};

/// Returns the input of one rod from lists of numbers; None is an empty list. Throws py::value_error for
/// another number of values than `tendons`, or if both are given.
[[nodiscard]] TendonInput tendon_input(const py::object& tensions, const py::object& displacements,
                                       std::size_t tendons);

}  // namespace flexura::python

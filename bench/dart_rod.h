#pragma once

#include <Eigen/Core>
#include <memory>

#include "flexura/mechanics/rod.h"

namespace flexura {

/// A bending rod of one section as DART's chain of rigid bodies. Each universal joint is in the middle of an
/// equal piece of the rod and has its stiffness and damping. DART integrates by semi-implicit Euler steps,
/// with implicit joint springs and dampers.
class DartRod {
 public:
  DartRod(const RodSection& section, const Eigen::Vector3d& gravity, int joints, double step);
  ~DartRod();
  DartRod(const DartRod&) = delete;
  DartRod& operator=(const DartRod&) = delete;

  /// Makes the rod straight and at rest.
  void reset();
  void step();
  /// Returns the tip's position in the frame of the base, m.
  [[nodiscard]] Eigen::Vector3d tip() const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace flexura

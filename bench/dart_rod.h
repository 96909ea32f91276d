#pragma once

#include <Eigen/Core>
#include <memory>

#include "flexura/mechanics/rod.h"

namespace flexura {

/// A rod of one section that bends, as DART's chain of rigid bodies: so many universal joints, each in the
/// middle of an equal piece of the rod with the piece's stiffness and damping. DART goes on by its
/// semi-implicit Euler steps, springs and dampers of joints implicit.
class DartRod {
 public:
  DartRod(const RodSection& section, const Eigen::Vector3d& gravity, int joints, double step);
  ~DartRod();
  DartRod(const DartRod&) = delete;
  DartRod& operator=(const DartRod&) = delete;

  /// Straight, and at rest.
  void reset();
  void step();
  /// In the frame of the base.
  [[nodiscard]] Eigen::Vector3d tip() const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace flexura

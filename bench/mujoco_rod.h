#pragma once

#include <Eigen/Core>
#include <memory>

#include "flexura/mechanics/rod.h"

namespace flexura {

/// How MuJoCo goes on in time.
enum class MujocoIntegrator { euler, implicit, runge_kutta };

/// A rod of one section that bends, as MuJoCo's chain of rigid bodies: so many joints, each in the middle of
/// an equal piece of the rod with the piece's stiffness and damping, bend in two directions.
class MujocoRod {
 public:
  MujocoRod(const RodSection& section, const Eigen::Vector3d& gravity, int joints,
            MujocoIntegrator integrator, double step);
  ~MujocoRod();
  MujocoRod(const MujocoRod&) = delete;
  MujocoRod& operator=(const MujocoRod&) = delete;

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

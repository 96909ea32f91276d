#pragma once

#include <Eigen/Core>
#include <memory>

#include "flexura/mechanics/rod.h"

namespace flexura {

/// MuJoCo's time integrators.
enum class MujocoIntegrator { euler, implicit, runge_kutta };

/// A bending rod of one section as MuJoCo's chain of rigid bodies. Each joint bends in two directions. It is
/// in the middle of an equal piece of the rod and has its stiffness and damping.
class MujocoRod {
 public:
  MujocoRod(const RodSection& section, const Eigen::Vector3d& gravity, int joints,
            MujocoIntegrator integrator, double step);
  ~MujocoRod();
  MujocoRod(const MujocoRod&) = delete;
  MujocoRod& operator=(const MujocoRod&) = delete;

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

#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "flexura/kinematics/bounds.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Variables of inverse kinematics as one vector x. For each section: bend_x, bend_y if spatial (rad), and
/// the stretch if its limits differ. Other stretches are constant.
class ArmVariables {
 public:
  /// Variables of one section.
  struct Part {
    double length;    ///< Not stretched, m.
    double max_bend;  ///< In rad; may be infinite.
    std::array<double, 2> stretch_limits;
    Eigen::Index at;      ///< Index of bend_x in x; followed by bend_y and the stretch, if variable.
    bool is_spatial;      ///< bend_y is variable.
    bool is_stretchable;  ///< The stretch is variable.
    /// Returns the index of the stretch in x.
    [[nodiscard]] Eigen::Index stretch_at() const { return at + (is_spatial ? 2 : 1); }
    /// Returns the section's bend from x, rad; components that are not variable are 0.
    [[nodiscard]] Eigen::Vector2d bend(const Eigen::VectorXd& x) const {
      return {x[at], is_spatial ? x[at + 1] : 0.0};
    }
    /// Returns the section's stretch from x, a factor; its constant value if it is not variable.
    [[nodiscard]] double stretch(const Eigen::VectorXd& x) const {
      return is_stretchable ? x[stretch_at()] : stretch_limits[0];
    }
  };

  /// Throws std::invalid_argument if the arm has no sections.
  explicit ArmVariables(const Arm& arm);

  /// Returns the size of x.
  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  /// Returns the limits on x: of bends that have one, and of variable stretches.
  [[nodiscard]] const Bounds& bounds() const { return bounds_; }
  /// Returns the arm's length at maximum stretch, m.
  [[nodiscard]] double max_length() const;

  /// Returns the x nearest to `state` within the limits. Throws std::invalid_argument if the state does not
  /// fit the arm or is not finite.
  [[nodiscard]] Eigen::VectorXd pack(const ArmState& state) const;
  /// Returns the state of x, within the limits or not.
  [[nodiscard]] ArmState state(const Eigen::VectorXd& x) const;
  /// Packs into x, which it resizes if needed; otherwise without allocation.
  void pack(const ArmState& state, Eigen::VectorXd& x) const;
  /// Computes the state of x into `state`, which it resizes if needed.
  void state(const Eigen::VectorXd& x, ArmState& state) const;

 private:
  std::vector<Part> parts_;
  Bounds bounds_;
  Eigen::Index size_ = 0;
};

}  // namespace flexura

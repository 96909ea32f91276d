#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "flexura/kinematics/bounds.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Variables of inverse kinematics as one vector x. For each section, x has bend_x (rad), for spatial arms
/// bend_y (rad), and the stretch if its limits differ. Other stretches are constant.
class ArmVariables {
 public:
  /// Variables of one section.
  struct Part {
    double length;    ///< Length at stretch 1, m.
    double max_bend;  ///< Largest |bend|, rad; may be infinite.
    std::array<double, 2> stretch_limits;
    Eigen::Index at;      ///< Index of bend_x in x; bend_y and stretch, if variable, follow in x.
    bool is_spatial;      ///< Whether bend_y is variable.
    bool is_stretchable;  ///< Whether the stretch is variable.
    /// Returns the index of the stretch in x.
    [[nodiscard]] Eigen::Index stretch_at() const { return at + (is_spatial ? 2 : 1); }
    /// Returns the section's bend vector in x, rad; bend_y is 0 if not variable.
    [[nodiscard]] Eigen::Vector2d bend(const Eigen::VectorXd& x) const {
      return {x[at], is_spatial ? x[at + 1] : 0.0};
    }
    /// Returns the section's stretch in x, or the constant stretch if not variable.
    [[nodiscard]] double stretch(const Eigen::VectorXd& x) const {
      return is_stretchable ? x[stretch_at()] : stretch_limits[0];
    }
  };

  /// Throws std::invalid_argument if the arm has no sections.
  explicit ArmVariables(const Arm& arm);

  /// Returns the size of x.
  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  /// Returns the limits on x: limits on the bends of sections with a finite max_bend, and on variable
  /// stretches.
  [[nodiscard]] const Bounds& bounds() const { return bounds_; }
  /// Returns the arm's length at its largest stretches, m.
  [[nodiscard]] double max_length() const;

  /// Returns the x nearest to `state` within the limits. Throws std::invalid_argument unless the state is
  /// finite and has one bend and one stretch per section.
  [[nodiscard]] Eigen::VectorXd pack(const ArmState& state) const;
  /// Returns the state that x describes, without applying limits.
  [[nodiscard]] ArmState state(const Eigen::VectorXd& x) const;
  /// Writes the result of pack(state) to x. Resizes x if needed; otherwise allocates nothing.
  void pack(const ArmState& state, Eigen::VectorXd& x) const;
  /// Writes the result of state(x) to `state`. Resizes `state` if needed.
  void state(const Eigen::VectorXd& x, ArmState& state) const;

 private:
  std::vector<Part> parts_;
  Bounds bounds_;
  Eigen::Index size_ = 0;
};

}  // namespace flexura

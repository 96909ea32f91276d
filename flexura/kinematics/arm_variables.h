#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "flexura/kinematics/bounds.h"
#include "flexura/model/arm.h"

namespace flexura {

/// What inverse kinematics may change of an arm, as one vector x: for each section bend_x, bend_y when
/// spatial (rad), and its stretch where the limits leave it free. Stretches without freedom keep their one
/// value.
class ArmVariables {
 public:
  /// One section's.
  struct Part {
    double length;    ///< Not stretched, m.
    double max_bend;  ///< rad; may be infinite.
    std::array<double, 2> stretch_limits;
    Eigen::Index at;      ///< Of bend_x in x; bend_y and the stretch follow, where they vary.
    bool is_spatial;      ///< bend_y varies.
    bool is_stretchable;  ///< The stretch varies.
    /// Where the stretch stands in x.
    [[nodiscard]] Eigen::Index stretch_at() const { return at + (is_spatial ? 2 : 1); }
    /// The part's bends out of x, rad; one that does not vary is 0.
    [[nodiscard]] Eigen::Vector2d bend(const Eigen::VectorXd& x) const {
      return {x[at], is_spatial ? x[at + 1] : 0.0};
    }
    /// Its stretch out of x, a factor; where that does not vary its one value.
    [[nodiscard]] double stretch(const Eigen::VectorXd& x) const {
      return is_stretchable ? x[stretch_at()] : stretch_limits[0];
    }
  };

  /// std::invalid_argument for an arm without sections.
  explicit ArmVariables(const Arm& arm);

  /// Numbers in x.
  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  /// The limits on x: of bends that have one, and of stretches that vary.
  [[nodiscard]] const Bounds& bounds() const { return bounds_; }
  /// The arm's length when stretched as far as it goes, m.
  [[nodiscard]] double max_length() const;

  /// The x nearest to `state` within the limits. std::invalid_argument when it does not fit the arm or is not
  /// finite.
  [[nodiscard]] Eigen::VectorXd pack(const ArmState& state) const;
  /// The state that x means; x is taken as it is, within the limits or not.
  [[nodiscard]] ArmState state(const Eigen::VectorXd& x) const;
  /// The same, into what is made to fit: without allocation where it fits already.
  void pack(const ArmState& state, Eigen::VectorXd& x) const;
  /// The same, into what is made to fit.
  void state(const Eigen::VectorXd& x, ArmState& state) const;

 private:
  std::vector<Part> parts_;
  Bounds bounds_;
  Eigen::Index size_ = 0;
};

}  // namespace flexura

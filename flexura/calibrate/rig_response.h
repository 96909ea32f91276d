#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/model/arm.h"
#include "flexura/port/rig_model.h"

namespace flexura {

/// Linear model of the errors of an arm's response to commands (docs/calibration.md, "An arm unlike its
/// model"). The error of an arc's bend is a sum of inputs, each multiplied by an unknown share. Inputs are
/// the commanded bends of all driven sections, and the section's own bend without a command (its sag). Inputs
/// are vectors, but shares are scalars, because a section of a round arm has equal stiffness in all
/// directions.
class RigResponse {
 public:
  /// Model without errors: inputs() and sections() are 0.
  RigResponse() = default;
  /// `commands`: commanded poses. Throws std::invalid_argument if a command does not fit the arm.
  RigResponse(const RigModel& model, const std::vector<ArmState>& commands);

  /// Returns the number of inputs of each arc.
  [[nodiscard]] std::size_t inputs() const { return sections_ > 0 ? sections_ + 1 : 0; }
  /// Returns the number of driven sections.
  [[nodiscard]] std::size_t sections() const { return sections_; }
  /// Returns the driven section of an arc.
  [[nodiscard]] std::size_t section_of(std::size_t arc) const { return section_of_[arc]; }
  /// Returns an arc's share of its section's change of bend: 1 / number of the section's arcs.
  [[nodiscard]] double share(std::size_t arc) const { return shares_[arc]; }
  /// Returns the name of an input, such as "command 2".
  [[nodiscard]] std::string name(std::size_t input) const;
  /// Returns whether an input can differ from 0.
  [[nodiscard]] bool acts(std::size_t input) const { return input < sections_ || sags_; }
  /// Returns an input of an arc in a pose, multiplied by the arc's share, rad.
  [[nodiscard]] Eigen::Vector2d input(std::size_t pose, std::size_t arc, std::size_t input) const {
    const Eigen::Vector2d& whole = input < sections_ ? commands_[pose].bends[input] : sag_[section_of_[arc]];
    return shares_[arc] * whole;
  }
  /// Returns the first pose whose command equals that of `pose` within 2 mrad.
  [[nodiscard]] std::size_t first_like(std::size_t pose) const { return first_like_[pose]; }

  /// Principal directions of the inputs of a pose.
  struct Axes {
    Eigen::Matrix2d directions = Eigen::Matrix2d::Identity();  ///< Unit vectors, as columns.
    /// Square root of the inputs' sum of squares along each direction, rad.
    std::array<double, 2> sizes = {0, 0};
  };
  /// Returns the axes of first_like(pose).
  [[nodiscard]] const Axes& axes(std::size_t pose) const { return axes_[first_like_[pose]]; }

 private:
  [[nodiscard]] Axes axes_of(const ArmState& command) const;

  std::size_t sections_ = 0;
  std::vector<std::size_t> section_of_;
  std::vector<double> shares_;
  std::vector<ArmState> commands_;
  std::vector<Eigen::Vector2d> sag_;  // Bend of each driven section without a command, rad.
  bool sags_ = false, is_planar_ = false;
  std::vector<std::size_t> first_like_;
  std::vector<Axes> axes_;
};

}  // namespace flexura

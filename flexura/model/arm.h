#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "flexura/math/pose.h"
#include "flexura/model/material.h"

namespace flexura {

/// Largest bend of a section accepted in a file, rad. Larger values are refused as mistakes.
inline constexpr double largest_bend = 1000;

/// `planar`: the arm bends only in one plane; for the paper's arm, the world's XOY plane. `spatial`: the arm
/// bends in any direction.
enum class ArmKind { planar, spatial };

/// An independently bent part of the arm (the paper's "segment").
struct Section {
  double length = 1.0;                          ///< Arc length without stretch, m; > 0.
  std::array<double, 2> radius = {0.02, 0.02};  ///< Radius of the tube at the section's base and end, m; > 0.
  double max_bend = std::numeric_limits<double>::infinity();       ///< Largest |bend|, rad.
  double max_bend_rate = std::numeric_limits<double>::infinity();  ///< Largest |d bend/dt|, rad/s.
  std::array<double, 2> stretch_limits = {1.0, 1.0};  ///< Smallest and largest factor on `length`.
  double max_stretch_rate = std::numeric_limits<double>::infinity();  ///< Largest |d stretch/dt|, 1/s.
  /// Distribution of the bend along the section (Actuation). The section consists of one arc for each number.
  /// These arcs have equal lengths, and bends in proportion to the numbers. Numbers are at least 0, and at
  /// least one is above 0. Default: one arc.
  std::optional<std::vector<double>> bend_profile = {};
  /// Material of the section's elastic rod. Default: no rod; the section bends as commanded.
  std::optional<MaterialConfig> material = {};

  /// Returns whether the stretch limits allow more than one length.
  [[nodiscard]] bool can_stretch() const { return stretch_limits[0] < stretch_limits[1]; }
};

/// Configuration of the arm: bend vector and stretch of each section, base first. A bend vector is theta (cos
/// phi, sin phi), rad: the section bends by theta towards the direction at the angle phi from x to y in its
/// base frame. For a planar arm, bend_y = 0, and a counter-clockwise arching b is the bend (-2 b, 0).
struct ArmState {
  std::vector<Eigen::Vector2d> bends;  ///< Bend vector of each section, rad.
  std::vector<double> stretches;       ///< Factor on the length of each section.

  /// Returns a straight, unstretched arm of `count` sections.
  [[nodiscard]] static ArmState straight(std::size_t count) {
    return {std::vector<Eigen::Vector2d>(count, Eigen::Vector2d::Zero()), std::vector<double>(count, 1.0)};
  }

  /// Compares exactly, except for the signs of zeros.
  bool operator==(const ArmState&) const = default;
};

/// Returns the default pose X_WB of the base frame B: at W's origin, with the straight arm along W's +Y. B's
/// z is W's +Y; B's x is W's +X.
[[nodiscard]] Pose default_base_pose();

/// An arm as described by a file.
struct Arm {
  ArmKind kind = ArmKind::planar;
  Pose X_WB = default_base_pose();  ///< Pose of the base frame in W, position in m.
  std::vector<Section> sections;    ///< Sections from base to tip; at least one.
  /// For planar arms: approximate angle of the base's tangent from +X, rad. Angles that differ by full turns
  /// describe the same tangent; the angle nearest to this value is used. Thus 270 degrees in a file does not
  /// become -90 degrees. Chord angles are computed from the base's tangent.
  double near_tangent = 0;

  /// Returns the sum of the unstretched section lengths, m.
  [[nodiscard]] double length() const;
};

/// Throws std::invalid_argument unless `state` has one bend and one stretch for each section of `arm`.
void require_fit(const Arm& arm, const ArmState& state);
/// Throws std::invalid_argument unless `state` has one bend and one stretch for each of `sections` sections.
void require_fit(std::size_t sections, const ArmState& state);

}  // namespace flexura

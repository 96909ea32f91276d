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

/// Largest bend of a section, rad: hundreds of turns are a mistake.
inline constexpr double largest_bend = 1000;

/// Planar: bends in one plane only, the world's XOY plane for the paper's arm. Spatial: bends in any
/// direction.
enum class ArmKind { planar, spatial };

/// An independently bent part of the arm (the paper's "segment").
struct Section {
  double length = 1.0;                          ///< Arc length without stretch, m; > 0.
  std::array<double, 2> radius = {0.02, 0.02};  ///< Radius of the tube at the section's base and end, m; > 0.
  double max_bend = std::numeric_limits<double>::infinity();       ///< Largest |bend|, rad.
  double max_bend_rate = std::numeric_limits<double>::infinity();  ///< Largest |d bend/dt|, rad/s.
  std::array<double, 2> stretch_limits = {1.0, 1.0};  ///< Smallest and largest factor on `length`.
  double max_stretch_rate = std::numeric_limits<double>::infinity();  ///< Largest |d stretch/dt|, 1/s.
  /// Distribution of the bend along the section (Actuation): one arc of equal length per number, bent in
  /// these proportions, each at least 0, one above. Default: one arc.
  std::optional<std::vector<double>> bend_profile = {};
  /// Material of its elastic rod. Default: it bends as commanded.
  std::optional<MaterialConfig> material = {};

  /// Returns true if its limits allow more than one length.
  [[nodiscard]] bool can_stretch() const { return stretch_limits[0] < stretch_limits[1]; }
};

/// Variables of the arm: each section's bend vector and stretch, base first. bend = theta (cos phi, sin phi),
/// rad, towards the x and y of the section's base frame. A planar arm has bend_y = 0; a planar arching b
/// (counter-clockwise) is the bend (-2 b, 0).
struct ArmState {
  std::vector<Eigen::Vector2d> bends;  ///< rad, one per section.
  std::vector<double> stretches;       ///< Factor on each section's length, one per section.

  /// Returns a straight, unstretched arm of `count` sections.
  [[nodiscard]] static ArmState straight(std::size_t count) {
    return {std::vector<Eigen::Vector2d>(count, Eigen::Vector2d::Zero()), std::vector<double>(count, 1.0)};
  }

  /// Compares exactly, except for the signs of zeros.
  bool operator==(const ArmState&) const = default;
};

/// Returns the default pose of B: in W's origin, with the straight arm along W's +Y. B's z is W's +Y, B's x
/// is W's +X.
[[nodiscard]] Pose default_base_pose();

/// An arm as described by a file.
struct Arm {
  ArmKind kind = ArmKind::planar;
  Pose X_WB = default_base_pose();  ///< Position in m.
  std::vector<Section> sections;    ///< Base first; at least one.
  /// Planar arms: cord angles are relative to the base's tangent. Its angle from +X is the one nearest to
  /// this, rad, so that 270 degrees in a file is not read as -90.
  double near_tangent = 0;

  /// Returns the sum of the unstretched section lengths, m.
  [[nodiscard]] double length() const;
};

/// Throws std::invalid_argument unless `state` has one bend and one stretch for each section of `arm`.
void require_fit(const Arm& arm, const ArmState& state);
/// Throws std::invalid_argument unless `state` has one bend and one stretch for each of `sections` sections.
void require_fit(std::size_t sections, const ArmState& state);

}  // namespace flexura

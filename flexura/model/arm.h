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

/// No section bends by more, rad: hundreds of turns are a mistake.
inline constexpr double largest_bend = 1000;

/// Planar: bends in one plane only, the world's XOY plane for the paper's arm. Spatial: in any direction.
enum class ArmKind { planar, spatial };

/// One independently bent part of the arm (the paper's "segment").
struct Section {
  double length = 1.0;                          ///< Arc length when not stretched, m; > 0.
  std::array<double, 2> radius = {0.02, 0.02};  ///< Of the tube at the section's base and end, m; > 0.
  double max_bend = std::numeric_limits<double>::infinity();       ///< Largest |bend|, rad.
  double max_bend_rate = std::numeric_limits<double>::infinity();  ///< Largest |d bend/dt|, rad/s.
  std::array<double, 2> stretch_limits = {1.0, 1.0};  ///< Smallest and largest factor on `length`.
  double max_stretch_rate = std::numeric_limits<double>::infinity();  ///< Largest |d stretch/dt|, 1/s.
  /// How its bend is spread along it (Actuation): so many arcs of equal length, bent in these proportions,
  /// each at least 0, one above. None: one arc.
  std::optional<std::vector<double>> bend_profile = {};
  /// Of the elastic rod in it. None: it bends as it is commanded.
  std::optional<MaterialConfig> material = {};

  /// Whether its limits leave it more than one length.
  [[nodiscard]] bool can_stretch() const { return stretch_limits[0] < stretch_limits[1]; }
};

/// What changes when the arm moves: each section's bend vector and stretch, base first.
/// bend = theta (cos phi, sin phi), rad, towards the x and y of the section's own base frame; a planar arm
/// has bend_y = 0, and a planar arching b (counter-clockwise) is the bend (-2 b, 0).
struct ArmState {
  std::vector<Eigen::Vector2d> bends;  ///< rad, one a section.
  std::vector<double> stretches;       ///< Factor on each section's length, one a section.

  /// A straight, unstretched arm of `count` sections.
  [[nodiscard]] static ArmState straight(std::size_t count) {
    return {std::vector<Eigen::Vector2d>(count, Eigen::Vector2d::Zero()), std::vector<double>(count, 1.0)};
  }

  /// Bit for bit, but for the signs of zeros.
  bool operator==(const ArmState&) const = default;
};

/// B standing on W's origin with the straight arm along W's +Y: B's z is W's +Y, B's x is W's +X.
[[nodiscard]] Pose default_base_pose();

/// An arm as the file describes it.
struct Arm {
  ArmKind kind = ArmKind::planar;
  Pose X_WB = default_base_pose();  ///< m
  std::vector<Section> sections;    ///< Base first; one at least.
  /// Planar arms: cord angles count from the base's tangent, whose angle from +X is the one nearest to this,
  /// rad. A file that says 270 degrees means 270 and not -90.
  double near_tangent = 0;

  /// Sum of the unstretched section lengths, m.
  [[nodiscard]] double length() const;
};

/// std::invalid_argument unless `state` has one bend and one stretch for each section of `arm`.
void require_fit(const Arm& arm, const ArmState& state);
/// The same of an arm of so many sections.
void require_fit(std::size_t sections, const ArmState& state);

}  // namespace flexura

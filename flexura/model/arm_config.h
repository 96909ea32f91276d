#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/field.h"
#include "flexura/base/fields.h"
#include "flexura/model/arm.h"
#include "flexura/model/arm_mechanics.h"
#include "flexura/model/arm_model.h"
#include "flexura/model/look.h"
#include "flexura/model/surroundings_config.h"

namespace flexura {

/// Range of angles in files and requests, rad: many turns, and small enough that their sums stay exact.
inline constexpr NumberRange angle_range = {.min = -1e4, .max = 1e4};
/// Ranges of angles that a section can bend by: of each component of a bend, and of its arching.
inline constexpr NumberRange bend_range = {.min = -largest_bend, .max = largest_bend};
inline constexpr NumberRange arching_range = {.min = -largest_bend / 2, .max = largest_bend / 2};

/// A shape of the arm as given by a user: bends in one of three forms, and stretches. `kinematics/shape.h`
/// converts it for a given arm. By default the straight, unstretched arm.
struct ShapeConfig {
  std::optional<std::vector<double>> cord_angles;           ///< From +X, rad; planar arms.
  std::optional<std::vector<double>> archings;              ///< Counter-clockwise, rad; planar arms.
  std::optional<std::vector<std::array<double, 2>>> bends;  ///< (bend_x, bend_y) each, rad.
  std::optional<std::vector<double>> stretches;             ///< Factors on the sections' lengths.
};

/// Pose of the arm's base.
struct BaseConfig {
  std::array<double, 3> position = {0, 0, 0};  ///< p_WB, m.
  std::optional<double> tangent;  ///< Planar arms: angle of the base's tangent from +X, rad; default pi/2.
  std::optional<std::array<double, 4>> rotation;  ///< Spatial arms: quaternion (w, x, y, z) of R_WB.
};

/// The table [arm] of a file.
struct ArmConfig {
  ArmKind kind = ArmKind::planar;
  BaseConfig base;
  ShapeConfig initial;           ///< Shape at the start.
  std::vector<Section> section;  ///< Base first.
  LookConfig look;
  ArmMechanics mechanics = ArmMechanics::kinematic;
  std::array<double, 3> gravity = {0, 0, 0};  ///< In the world's frame, m/s^2.
  std::vector<TendonRouteConfig> tendon;      ///< Empty: the drive's tendons, if there is a drive.
  std::vector<LoadConfig> load;
  double time_step = 0.005;              ///< Of rods in motion, s; the next fields are for those too.
  double spectral_radius = 0.1;          ///< Of the integration at high frequencies, 0 to 1.
  std::optional<ContactConfig> contact;  ///< Missing: the arm touches nothing.
  std::optional<DragConfig> drag;        ///< Missing: no fluid.
  std::vector<PayloadConfig> payload;

  /// Returns the arm as its drives see it.
  [[nodiscard]] Arm arm() const;
  /// Returns the arm with the arcs of its sections.
  [[nodiscard]] ArmModel model() const { return ArmModel(arm()); }
};

const std::vector<std::string>& names_of(const ArmKind*);
const Table<Section>& fields_of(const Section*);
const Table<ShapeConfig>& fields_of(const ShapeConfig*);
const Table<BaseConfig>& fields_of(const BaseConfig*);
const Table<ArmConfig>& fields_of(const ArmConfig*);

/// Reports to `reader` the errors of the shape at `path` ("initial"; "" is the current place) for an arm of
/// this kind and number of sections. Errors are two forms at once, wrong counts, planar keys for a spatial
/// arm, and bends out of the plane.
void check_shape(const ShapeConfig& shape, ArmKind kind, std::size_t sections, const std::string& path,
                 Reader& reader);

}  // namespace flexura

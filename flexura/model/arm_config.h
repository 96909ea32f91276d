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

/// Range of angles in files and requests, rad. It allows many turns. Sums of such angles have negligible
/// rounding errors.
inline constexpr NumberRange angle_range = {.min = -1e4, .max = 1e4};
/// Range of each component of a section's bend vector, and range of a section's arching, rad.
inline constexpr NumberRange bend_range = {.min = -largest_bend, .max = largest_bend};
inline constexpr NumberRange arching_range = {.min = -largest_bend / 2, .max = largest_bend / 2};

/// A shape of the arm as a user gives it: bends in one of three forms, and stretches. `kinematics/shape.h`
/// converts the shape for a given arm. Default: the straight, unstretched arm.
struct ShapeConfig {
  std::optional<std::vector<double>>
      cord_angles;  ///< Planar arms: angle of each section's chord from +X, rad.
  std::optional<std::vector<double>>
      archings;  ///< Planar arms: arching of each section, counter-clockwise, rad.
  std::optional<std::vector<std::array<double, 2>>>
      bends;                                     ///< Bend vector (bend_x, bend_y) of each section, rad.
  std::optional<std::vector<double>> stretches;  ///< Factor on the length of each section.
};

/// Pose of the arm's base.
struct BaseConfig {
  std::array<double, 3> position = {0, 0, 0};  ///< Position p_WB of the base, m.
  std::optional<double> tangent;  ///< Planar arms: angle of the base's tangent from +X, rad; default: pi/2.
  std::optional<std::array<double, 4>> rotation;  ///< Spatial arms: quaternion (w, x, y, z) of R_WB.
};

/// The table [arm] of a file.
struct ArmConfig {
  ArmKind kind = ArmKind::planar;
  BaseConfig base;
  ShapeConfig initial;           ///< Shape at the start.
  std::vector<Section> section;  ///< Sections from base to tip.
  LookConfig look;
  ArmMechanics mechanics = ArmMechanics::kinematic;
  std::array<double, 3> gravity = {0, 0, 0};  ///< Gravity in the world's frame, m/s^2.
  std::vector<TendonRouteConfig>
      tendon;  ///< Routes of tendons. Empty: the tendons of the drive, if there is a drive.
  std::vector<LoadConfig> load;
  /// Integration step of a dynamic arm, s. This field and the following fields are for dynamic arms.
  double time_step = 0.005;
  double spectral_radius = 0.1;  ///< Spectral radius of the time integration at high frequencies, 0 to 1.
  /// Contact with obstacles and with itself; missing: no contact forces.
  std::optional<ContactConfig> contact;
  std::optional<DragConfig> drag;  ///< Fluid around the arm; missing: no fluid.
  std::vector<PayloadConfig> payload;

  /// Returns the arm in terms of the sections that the drives bend.
  [[nodiscard]] Arm arm() const;
  /// Returns the arm together with the arcs of its sections.
  [[nodiscard]] ArmModel model() const { return ArmModel(arm()); }
};

const std::vector<std::string>& names_of(const ArmKind*);
const Table<Section>& fields_of(const Section*);
const Table<ShapeConfig>& fields_of(const ShapeConfig*);
const Table<BaseConfig>& fields_of(const BaseConfig*);
const Table<ArmConfig>& fields_of(const ArmConfig*);

/// Reports errors of a shape to `reader`, for an arm of this kind and number of sections. `path`: path of the
/// shape in the document, such as "initial"; "" for the current table. Errors are: bends in more than one
/// form, wrong numbers of values, keys for planar arms in a spatial arm, and bends out of a planar arm's
/// plane.
void check_shape(const ShapeConfig& shape, ArmKind kind, std::size_t sections, const std::string& path,
                 Reader& reader);

}  // namespace flexura

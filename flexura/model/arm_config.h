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

/// The angles that files and requests take, rad: many turns, and small enough that their sums stay exact.
inline constexpr NumberRange angle_range = {.min = -1e4, .max = 1e4};
/// Of those, the ones that a section can bend by, each component of a bend and its arching.
inline constexpr NumberRange bend_range = {.min = -largest_bend, .max = largest_bend};
inline constexpr NumberRange arching_range = {.min = -largest_bend / 2, .max = largest_bend / 2};

/// A shape of the arm as a person writes it: one of three ways to say the bends, and the stretches. What it
/// means for a given arm is `kinematics/shape.h`'s to say. Nothing written is the straight, unstretched arm.
struct ShapeConfig {
  std::optional<std::vector<double>> cord_angles;           ///< rad, from +X; planar arms.
  std::optional<std::vector<double>> archings;              ///< rad, counter-clockwise; planar arms.
  std::optional<std::vector<std::array<double, 2>>> bends;  ///< rad, (bend_x, bend_y) each.
  std::optional<std::vector<double>> stretches;             ///< Factors on the sections' lengths.
};

/// Where the arm stands.
struct BaseConfig {
  std::array<double, 3> position = {0, 0, 0};  ///< p_WB, m.
  std::optional<double>
      tangent;  ///< Planar arms: angle of the base's tangent from +X, rad; pi/2 when left out.
  std::optional<std::array<double, 4>> rotation;  ///< Spatial arms: quaternion (w, x, y, z) of R_WB.
};

/// The table [arm] of a file.
struct ArmConfig {
  ArmKind kind = ArmKind::planar;
  BaseConfig base;
  ShapeConfig initial;           ///< Where and how it starts.
  std::vector<Section> section;  ///< Base first.
  LookConfig look;
  ArmMechanics mechanics = ArmMechanics::kinematic;
  std::array<double, 3> gravity = {0, 0, 0};  ///< In the world's frame, m/s^2.
  std::vector<TendonRouteConfig> tendon;      ///< None: the drive's, if there is one.
  std::vector<LoadConfig> load;
  double time_step = 0.005;              ///< Of rods in motion, s; so the next.
  std::optional<ContactConfig> contact;  ///< None: it touches nothing.
  std::optional<DragConfig> drag;        ///< None: it moves in nothing.
  std::vector<PayloadConfig> payload;

  /// The arm it describes, as its drives see it.
  [[nodiscard]] Arm arm() const;
  /// And the arcs that its sections are made of.
  [[nodiscard]] ArmModel model() const { return ArmModel(arm()); }
};

const std::vector<std::string>& names_of(const ArmKind*);
const Table<Section>& fields_of(const Section*);
const Table<ShapeConfig>& fields_of(const ShapeConfig*);
const Table<BaseConfig>& fields_of(const BaseConfig*);
const Table<ArmConfig>& fields_of(const ArmConfig*);

/// Reports to `reader` what keeps the shape at `path` ("initial"; "" is the current place) from fitting an
/// arm of this kind and number of sections: two ways at once, wrong counts, planar words for a spatial arm,
/// bends out of the plane.
void check_shape(const ShapeConfig& shape, ArmKind kind, std::size_t sections, const std::string& path,
                 Reader& reader);

}  // namespace flexura

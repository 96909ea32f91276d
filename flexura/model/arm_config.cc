#include "flexura/model/arm_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "flexura/base/table.h"
#include "flexura/math/arrays.h"

namespace flexura {
namespace {

// Above the number of sections of any robot. Prevents an incorrect file from exhausting memory.
constexpr std::size_t max_sections = 1000;
constexpr std::size_t max_arcs = 100;  // Per section.
constexpr std::size_t max_routes = 1000;
constexpr std::size_t max_loads = 1000;

// One micrometre, in m. Doubles can distinguish such lengths even at the largest coordinates.
constexpr NumberRange size_range = {.min = 1e-6, .max = 1e6};

void check_count(std::size_t given, std::size_t sections, const std::string& path, Reader& reader) {
  if (given == sections) return;
  reader.problem_at(path, fmt::format("{} given: expected {} values, one per section", given, sections));
}

void check_arm(const ArmConfig& config, Reader& reader) {
  const bool is_planar = config.kind == ArmKind::planar;
  if (is_planar && config.base.rotation) {
    reader.problem_at("base.rotation", "is for spatial arms: expected base.tangent_deg for a planar arm");
  }
  if (!is_planar && config.base.tangent) {
    reader.problem_at("base.tangent", "is for planar arms: expected base.rotation for a spatial arm");
  }
  std::size_t arcs = 0;
  for (const Section& section : config.section)
    arcs += section.bend_profile ? section.bend_profile->size() : 1;
  if (arcs > max_sections)
    reader.problem_at("section",
                      fmt::format("has {} arcs in total: expected at most {}", arcs, max_sections));
  check_shape(config.initial, config.kind, config.section.size(), "initial", reader);
  check_mechanics(config, reader);
  check_look(config.look, config.arm(), "look", reader);
}

}  // namespace

const std::vector<std::string>& names_of(const ArmKind*) {
  static const std::vector<std::string> names{"planar", "spatial"};
  return names;
}

const Table<Section>& fields_of(const Section*) {
  static const auto table =
      Table<Section>("section", "One independently bent part of the arm.")
          .field("length", &Section::length,
                 {.meaning = "Length of the section's backbone at stretch 1.",
                  .unit = Unit::metre,
                  .range = size_range,
                  .required = true})
          .field(
              "radius", &Section::radius,
              {.meaning = "Radius of the tube. Two numbers, at the section's base and end, describe a taper.",
               .unit = Unit::metre,
               .range = size_range,
               .one_for_all = true})
          .field("max_bend", &Section::max_bend,
                 {.meaning = "Largest bend angle of the section (twice its largest arching).",
                  .unit = Unit::radian,
                  .range = above(0),
                  .default_text = "no limit"})
          .field("max_bend_rate", &Section::max_bend_rate,
                 {.meaning = "Largest bend rate.",
                  .unit = Unit::radian_per_second,
                  .range = above(0),
                  .default_text = "no limit"})
          .field("stretch_limits", &Section::stretch_limits,
                 {.meaning = "Smallest and largest stretch.", .range = above_up_to(0, 100)})
          .field("max_stretch_rate", &Section::max_stretch_rate,
                 {.meaning = "Largest stretch rate, 1/s.", .range = above(0), .default_text = "no limit"})
          .field("bend_profile", &Section::bend_profile,
                 {.meaning = "The section consists of arcs of equal length, one per number. The arcs' bends "
                             "are in proportion to the numbers. For a static arm, the arcs approximate the "
                             "rod, and each number is a factor on the computed bend of its arc.",
                  .range = between(0, 1e6),
                  .count = {1, max_arcs},
                  .default_text = "one arc; three if static"})
          .field("material", &Section::material,
                 {.meaning = "Elastic rod in the section.", .default_text = "none"})
          .check([](const Section& section, Reader& reader) {
            const auto& profile = section.bend_profile;
            if (profile && std::ranges::all_of(*profile, [](double part) { return part == 0; }))
              reader.problem_at("bend_profile", "is all 0: expected at least one number above 0");
            if (section.stretch_limits[0] > section.stretch_limits[1]) {
              reader.problem_at("stretch_limits", "expected the smaller factor first");
            }
            if (section.material) check_material(*section.material, section.radius, "material", reader);
          });
  return table;
}

const Table<ShapeConfig>& fields_of(const ShapeConfig*) {
  static const auto table =
      Table<ShapeConfig>("shape",
                         "Shape of the arm: bends in one of three forms, and stretches. Omitted bends are 0.")
          .field("cord_angles", &ShapeConfig::cord_angles,
                 {.meaning = "Planar arms: angle of each section's chord from +X, counter-clockwise.",
                  .unit = Unit::radian,
                  .range = angle_range,
                  .default_text = "not set"})
          .field("archings", &ShapeConfig::archings,
                 {.meaning = "Planar arms: arching of each section, half its bend, counter-clockwise.",
                  .unit = Unit::radian,
                  .range = arching_range,
                  .default_text = "not set"})
          .field(
              "bends", &ShapeConfig::bends,
              {.meaning = "Bend vector of each section: bends towards x and y of the section's base frame.",
               .unit = Unit::radian,
               .range = bend_range,
               .default_text = "not set"})
          .field("stretches", &ShapeConfig::stretches,
                 {.meaning = "Factor on the length of each section, one per section.",
                  .range = above_up_to(0, 100),
                  .default_text = "1 each"});
  return table;
}

const Table<BaseConfig>& fields_of(const BaseConfig*) {
  static const auto table =
      Table<BaseConfig>("base", "Pose of the arm's base in the world.")
          .field(
              "position", &BaseConfig::position,
              {.meaning = "Position of the base: X, Y, Z.", .unit = Unit::metre, .range = between(-1e6, 1e6)})
          .field("tangent", &BaseConfig::tangent,
                 {.meaning = "Planar arms: angle of the straight arm from +X, counter-clockwise.",
                  .unit = Unit::radian,
                  .range = angle_range,
                  .default_text = "pi/2"})
          .field("rotation", &BaseConfig::rotation,
                 {.meaning = "Spatial arms: unit quaternion (w, x, y, z) from the base's axes to the world. "
                             "The straight arm points along the base's z.",
                  .range = between(-2, 2),
                  .default_text = "z along +Y, x along +X"})
          .check([](const BaseConfig& base, Reader& reader) {
            const std::string problem = base.rotation ? quaternion_problem(*base.rotation) : "";
            if (!problem.empty()) reader.problem_at("rotation", problem);
          });
  return table;
}

const Table<ArmConfig>& fields_of(const ArmConfig*) {
  static const auto table =
      Table<ArmConfig>("arm", "The arm: sections, base, initial shape and mechanical model.")
          .field("kind", &ArmConfig::kind,
                 {.meaning = "`planar`: the arm bends only in the XOY plane, as in the paper. `spatial`: the "
                             "arm bends in any direction."})
          .field("base", &ArmConfig::base, {.meaning = "Pose of the base."})
          .field("initial", &ArmConfig::initial, {.meaning = "Initial shape."})
          .field("section", &ArmConfig::section,
                 {.meaning = "Sections from base to tip, as tables [[arm.section]].",
                  .count = {1, max_sections},
                  .required = true})
          .field("look", &ArmConfig::look, {.meaning = "Appearance in the cameras' pictures."})
          .field(
              "model", &ArmConfig::mechanics,
              {.meaning = "Model of the arm. `kinematic`: shapes follow commands exactly. `static`: sections "
                          "are elastic rods in equilibrium with tendons, gravity and loads; each needs a "
                          "material. `dynamic`: the rods have inertia and oscillate. Tasks use the "
                          "equilibrium of the rods, and servos also their slowest vibration modes. A model "
                          "in [truth.arm] applies only to the simulated arm; tasks use the model of [arm]."})
          .field("gravity", &ArmConfig::gravity,
                 {.meaning = "Gravity in the world's frame: X, Y, Z; [0, -9.81, 0] if +Y is up. Gravity "
                             "affects only elastic rods.",
                  .unit = Unit::metre_per_second_squared,
                  .range = between(-1e6, 1e6)})
          .field("tendon", &ArmConfig::tendon,
                 {.meaning = "Routes of the tendons, as tables [[arm.tendon]].",
                  .count = {0, max_routes},
                  .default_text = "the tendons of [drive], if any"})
          .field("load", &ArmConfig::load,
                 {.meaning = "Loads at the ends of sections, as tables [[arm.load]].",
                  .count = {0, max_loads},
                  .default_text = "none"})
          .field("time_step", &ArmConfig::time_step,
                 {.meaning = "Integration time step of a dynamic arm.",
                  .unit = Unit::second,
                  .range = between(1e-6, 0.1)})
          .field("spectral_radius", &ArmConfig::spectral_radius,
                 {.meaning = "Numerical damping of a dynamic arm: spectral radius of the integration at high "
                             "frequencies. 0 damps fast vibrations in one step; 1 conserves the energy of an "
                             "undamped arm.",
                  .range = between(0, 1)})
          .field("contact", &ArmConfig::contact,
                 {.meaning = "Contacts of a dynamic arm with obstacles and with itself.",
                  .default_text = "no contact"})
          .field("drag", &ArmConfig::drag, {.meaning = "Fluid around a dynamic arm.", .default_text = "none"})
          .field("payload", &ArmConfig::payload,
                 {.meaning = "Masses that a dynamic arm carries temporarily, as tables [[arm.payload]].",
                  .count = {0, max_loads},
                  .default_text = "none"})
          .check(check_arm);
  return table;
}

void check_shape(const ShapeConfig& shape, ArmKind kind, std::size_t sections, const std::string& path,
                 Reader& reader) {
  const std::string prefix = path.empty() ? "" : path + ".";
  const int ways = (shape.cord_angles ? 1 : 0) + (shape.archings ? 1 : 0) + (shape.bends ? 1 : 0);
  if (ways > 1) {
    reader.problem_at(path,
                      "gives the bends in more than one way: expected one of cord_angles, archings, bends");
  }
  for (const auto& [name, values] :
       {std::pair{"cord_angles", &shape.cord_angles}, std::pair{"archings", &shape.archings}}) {
    if (!*values) continue;
    const std::string place = prefix + name;
    if (kind == ArmKind::spatial)
      reader.problem_at(place, "is for planar arms: expected bends for a spatial arm");
    check_count((*values)->size(), sections, place, reader);
  }
  if (shape.bends) {
    check_count(shape.bends->size(), sections, prefix + "bends", reader);
    for (std::size_t i = 0; kind == ArmKind::planar && i < shape.bends->size(); ++i) {
      if ((*shape.bends)[i][1] == 0.0) continue;
      reader.problem_at(fmt::format("{}bends[{}]", prefix, i),
                        "leaves the plane: expected bend_y = 0 for a planar arm");
    }
  }
  if (shape.stretches) check_count(shape.stretches->size(), sections, prefix + "stretches", reader);
}

Arm ArmConfig::arm() const {
  Arm arm;
  arm.kind = kind;
  arm.sections = section;
  arm.X_WB.position = vector(base.position);
  if (kind == ArmKind::planar && base.tangent) {
    const double c = std::cos(*base.tangent);
    const double s = std::sin(*base.tangent);
    // The columns are B's axes: z along the tangent, x to the right of the tangent in the plane, y along -Z.
    arm.X_WB.rotation << s, 0, c, -c, 0, s, 0, -1, 0;
    arm.near_tangent = *base.tangent;
  } else if (base.rotation) {
    arm.X_WB.rotation = rotation_of(*base.rotation);
  }
  return arm;
}

}  // namespace flexura

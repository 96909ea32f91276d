#include "flexura/model/arm_mechanics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "flexura/base/table.h"
#include "flexura/model/arm_config.h"

namespace flexura {
namespace {

// Number of points per section at which a tendon is checked to be in the tube.
constexpr int places_looked_at = 50;
constexpr double rounding = 1e-9;
constexpr std::size_t max_coefficients = 20;

Spec route(const char* direction) {
  return {.meaning = fmt::format(
              "Offset towards {}, m, added to the position given by `radius` and `angle`. The numbers "
              "are coefficients of a polynomial in the unstretched arc length from the base, m.",
              direction),
          .range = between(-1e9, 1e9),
          .count = {0, max_coefficients},
          .default_text = "0"};
}

double polynomial(const std::vector<double>& coefficients, double s) {
  double sum = 0;
  for (std::size_t i = coefficients.size(); i-- > 0;) sum = sum * s + coefficients[i];
  return sum;
}

double end_of(const ArmConfig& arm, std::int64_t section) {
  double end = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(section); ++i) end += arm.section[i].length;
  return end;
}

bool ends_on_arm(std::int64_t section, const ArmConfig& arm, const std::string& path, Reader& reader) {
  const auto sections = static_cast<std::int64_t>(arm.section.size());
  if (section <= sections) return true;
  reader.problem_at(path, fmt::format("{}: expected a section of the arm, 1 to {}", section, sections));
  return false;
}

void check_in_tube(const TendonRouteConfig& tendon, const ArmConfig& arm, const std::string& path,
                   Reader& reader) {
  const double end = end_of(arm, tendon.section);
  double base = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(tendon.section); ++i) {
    const Section& section = arm.section[i];
    for (int k = 0; k <= places_looked_at; ++k) {
      const double t = static_cast<double>(k) / places_looked_at, s = base + t * section.length;
      const double radius = section.radius[0] + (section.radius[1] - section.radius[0]) * t;
      const double distance = tendon.offset(s, end).norm();
      if (distance <= radius * (1 + rounding)) continue;
      reader.problem_at(path, fmt::format("leaves the tube: expected at most {:.6g} m from the backbone in "
                                          "section {}, {:.6g} m from the base, not {:.6g} m",
                                          radius, i + 1, s, distance));
      return;
    }
    base += section.length;
  }
}

// Checks that moving rods have a mass.
void check_motion(const ArmConfig& arm, Reader& reader) {
  for (std::size_t i = 0; i < arm.section.size(); ++i) {
    const MaterialConfig& material = *arm.section[i].material;
    if (material.mass_per_length.value_or(material.density) == 0)
      reader.problem_at(fmt::format("section[{}].material", i),
                        "has no mass: expected density or mass_per_length, because the arm's model is "
                        "\"dynamic\"");
  }
  if (!arm.contact || !arm.contact->spacing) return;
  constexpr double most_places = 10000;
  double length = 0;
  for (const Section& section : arm.section) length += section.length;
  if (length / *arm.contact->spacing > most_places)
    reader.problem_at("contact.spacing",
                      fmt::format("{:.6g} m: expected at least {:.6g} m, which gives {} contact points",
                                  *arm.contact->spacing, length / most_places, most_places));
  double thinnest = std::numeric_limits<double>::infinity();
  for (const Section& section : arm.section)
    thinnest = std::min({thinnest, section.radius[0], section.radius[1]});
  if (*arm.contact->spacing > 2 * thinnest)
    reader.problem_at("contact.spacing",
                      fmt::format("{:.6g} m: expected at most {:.6g} m, the smallest diameter of the tube; "
                                  "otherwise obstacles could pass between two contact points",
                                  *arm.contact->spacing, 2 * thinnest));
}

}  // namespace

Eigen::Vector2d TendonRouteConfig::offset(double s, double end) const {
  const double part = s / end, r = radius + (end_radius.value_or(radius) - radius) * part;
  const double a = angle + 2 * std::numbers::pi * turns * part;
  return {polynomial(x, s) + r * std::cos(a), polynomial(y, s) + r * std::sin(a)};
}

const std::vector<std::string>& names_of(const ArmMechanics*) {
  static const std::vector<std::string> names = {"kinematic", "static", "dynamic"};
  return names;
}

const Table<TendonRouteConfig>& fields_of(const TendonRouteConfig*) {
  static const auto table =
      Table<TendonRouteConfig>("tendon",
                               "Route of a tendon in the tube, from the arm's base to the end of one "
                               "section: parallel to the backbone, converging, helical or polynomial.")
          .field("section", &TendonRouteConfig::section,
                 {.meaning = "Section at the end of which the tendon ends, counted from 1 at the base.",
                  .range = between(1, 1e6),
                  .required = true})
          .field("radius", &TendonRouteConfig::radius,
                 {.meaning = "Distance from the backbone at the arm's base.",
                  .unit = Unit::metre,
                  .range = between(0, 1e3)})
          .field("angle", &TendonRouteConfig::angle,
                 {.meaning = "Angle around the backbone at the arm's base, from x towards y.",
                  .unit = Unit::radian,
                  .range = angle_range})
          .field("end_radius", &TendonRouteConfig::end_radius,
                 {.meaning = "Distance from the backbone at the tendon's end. Between base and end, the "
                             "distance changes linearly.",
                  .unit = Unit::metre,
                  .range = between(0, 1e3),
                  .default_text = "radius"})
          .field("turns", &TendonRouteConfig::turns,
                 {.meaning = "Number of turns around the backbone from the arm's base to the tendon's end, "
                             "from x towards y. The turns are uniform.",
                  .range = between(-1e3, 1e3)})
          .field("x", &TendonRouteConfig::x, route("x"))
          .field("y", &TendonRouteConfig::y, route("y"))
          .field("compliance", &TendonRouteConfig::compliance,
                 {.meaning = "Elongation of the tendon per newton of tension, m/N. The compliance affects "
                             "only commands of tendon displacements.",
                  .range = between(0, 1e6)})
          .field("friction", &TendonRouteConfig::friction,
                 {.meaning = "Coulomb friction coefficient mu along the tendon. After a total wrap angle "
                             "theta from the base (rad), the fraction exp(-mu theta) of the tension remains.",
                  .range = between(0, 10)})
          .field(
              "breaks_at", &TendonRouteConfig::breaks_at,
              {.meaning = "Time at which the tendon breaks. After the break, the tension of the tendon is 0.",
               .unit = Unit::second,
               .range = between(0, 1e9),
               .default_text = "never"});
  return table;
}

const Table<LoadConfig>& fields_of(const LoadConfig*) {
  static const auto table =
      Table<LoadConfig>("load", "A force and a moment at the end of a section.")
          .field("section", &LoadConfig::section,
                 {.meaning = "Section with the loaded end, counted from 1 at the base.",
                  .range = between(1, 1e6),
                  .required = true})
          .field("force", &LoadConfig::force,
                 {.meaning = "Force in the world's frame, N: X, Y, Z.", .range = between(-1e9, 1e9)})
          .field("moment", &LoadConfig::moment,
                 {.meaning = "Moment in the world's frame, N m: X, Y, Z.", .range = between(-1e9, 1e9)})
          .field("following", &LoadConfig::following,
                 {.meaning = "Whether force and moment are given in the frame of the section's end (z along "
                             "the backbone) and rotate with this frame."});
  return table;
}

void check_mechanics(const ArmConfig& arm, Reader& reader) {
  for (std::size_t i = 0; i < arm.tendon.size(); ++i) {
    const std::string path = fmt::format("tendon[{}]", i);
    if (ends_on_arm(arm.tendon[i].section, arm, path + ".section", reader))
      check_in_tube(arm.tendon[i], arm, path, reader);
  }
  for (std::size_t i = 0; i < arm.load.size(); ++i)
    ends_on_arm(arm.load[i].section, arm, fmt::format("load[{}].section", i), reader);
  for (std::size_t i = 0; i < arm.payload.size(); ++i)
    ends_on_arm(arm.payload[i].section, arm, fmt::format("payload[{}].section", i), reader);
  if (arm.mechanics != ArmMechanics::dynamics) {
    const auto refuse = [&](bool is_there, const char* what) {
      if (is_there)
        reader.problem_at(
            what, "is only for dynamic arms: expected model = \"dynamic\", or this table to be absent");
    };
    refuse(arm.contact.has_value(), "contact");
    refuse(arm.drag.has_value(), "drag");
    refuse(!arm.payload.empty(), "payload");
  }
  if (arm.mechanics == ArmMechanics::kinematic) return;
  const std::string& model = names_of(&arm.mechanics)[static_cast<std::size_t>(arm.mechanics)];
  for (std::size_t i = 0; i < arm.section.size(); ++i) {
    if (arm.section[i].material) continue;
    reader.problem_at(fmt::format("section[{}]", i),
                      fmt::format("has no material: expected material.youngs_modulus or "
                                  "material.stiffness, because the arm's model is \"{}\"",
                                  model));
    return;
  }
  if (arm.mechanics == ArmMechanics::dynamics) check_motion(arm, reader);
}

}  // namespace flexura

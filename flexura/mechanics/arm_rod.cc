#include "flexura/mechanics/arm_rod.h"

#include <fmt/format.h>

#include <numbers>
#include <stdexcept>

#include "flexura/math/arrays.h"
#include "flexura/math/quadrature.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

Vector6d diagonal(const StiffnessConfig& stiffness) {
  Vector6d k;
  // A bend towards x is a curvature about y.
  k << stiffness.shear[0], stiffness.shear[1], stiffness.stretch, stiffness.bend[1], stiffness.bend[0],
      stiffness.twist;
  return k;
}

StrainModes modes_of(const ModesConfig& modes, ArmKind kind) {
  return {.shear = static_cast<int>(modes.shear),
          .stretch = static_cast<int>(modes.stretch),
          .bend = static_cast<int>(modes.bend),
          .twist = static_cast<int>(modes.twist),
          .planar = kind == ArmKind::planar};
}

RodSection section_of(const Section& section, ArmKind kind) {
  const MaterialConfig& material = *section.material;
  RodSection result;
  result.length = section.length;
  result.radius = material.radius.value_or(section.radius);
  result.inner_radius = material.inner_radius;
  result.youngs_modulus = material.youngs_modulus.value_or(0);
  result.shear_modulus = material.shear_modulus.value_or(
      result.youngs_modulus / (2 * (1 + material.poisson.value_or(common_poisson))));
  result.density = material.density;
  if (material.stiffness) result.stiffness = diagonal(*material.stiffness);
  result.mass_per_length = material.mass_per_length;
  const Eigen::Vector3d turn(-material.rest_bend[1], material.rest_bend[0], material.rest_twist);
  if (!turn.isZero(0)) result.rest_curvature = {turn / section.length};
  for (const BodyConfig& body : material.mass)
    result.masses.push_back({.at = body.at, .mass = body.mass, .offset = vector(body.offset)});
  result.disks = static_cast<int>(material.disks.value_or(0));
  result.modes = modes_of(material.modes, kind);
  result.nodes = static_cast<int>(material.nodes);
  return result;
}

TendonRoute route_of(const TendonRouteConfig& tendon, const ArmConfig& arm) {
  const auto section = static_cast<std::size_t>(tendon.section - 1);
  double end = 0;
  for (std::size_t i = 0; i <= section; ++i) end += arm.section[i].length;
  return {.section = section,
          .radius = tendon.radius,
          .radius_slope = (tendon.end_radius.value_or(tendon.radius) - tendon.radius) / end,
          .angle = tendon.angle,
          .angle_slope = 2 * std::numbers::pi * tendon.turns / end,
          .x = tendon.x,
          .y = tendon.y,
          .compliance = tendon.compliance,
          .friction = tendon.friction};
}

}  // namespace

Rod rod_of(const ArmConfig& arm, const std::optional<DriveConfig>& drive) {
  Rod rod;
  for (std::size_t i = 0; i < arm.section.size(); ++i) {
    if (!arm.section[i].material)
      throw std::invalid_argument(fmt::format(
          "arm.section[{}]: has no material: expected material.youngs_modulus or material.stiffness", i));
    rod.sections.push_back(section_of(arm.section[i], arm.kind));
  }
  for (const TendonRouteConfig& tendon : arm.tendon) rod.tendons.push_back(route_of(tendon, arm));
  if (!arm.tendon.empty() || !drive) return rod;
  const Drive driven = drive->drive();
  for (const Tendon& tendon : driven.tendons)
    rod.tendons.push_back({.section = tendon.section, .radius = tendon.radius, .angle = tendon.angle});
  if (!driven.disks) return rod;
  for (std::size_t i = 0; i < arm.section.size(); ++i)
    if (!arm.section[i].material->disks) rod.sections[i].disks = static_cast<int>(*driven.disks);
  return rod;
}

Rod rod_of(const ArmConfig& arm) { return rod_of(arm, std::nullopt); }

RodLoads loads_of(const ArmConfig& arm) {
  const Eigen::Matrix3d R_BW = arm.arm().X_WB.rotation.transpose();
  RodLoads loads{.gravity = R_BW * vector(arm.gravity)};
  for (const LoadConfig& load : arm.load) {
    EndLoad end{.section = static_cast<std::size_t>(load.section - 1),
                .force = vector(load.force),
                .moment = vector(load.moment),
                .following = load.following};
    if (!load.following) {
      end.force = R_BW * end.force;
      end.moment = R_BW * end.moment;
    }
    loads.ends.push_back(end);
  }
  return loads;
}

TendonDisplacements arc_displacements(const Rod& rod, const ArmState& state) {
  require_fit(rod.sections.size(), state);
  static const Quadrature rule = gauss_legendre(12);
  const ArmState straight = ArmState::straight(rod.sections.size());
  const auto length = [&](const TendonRoute& tendon, const ArmState& shape) {
    double sum = 0, s_base = 0;
    for (std::size_t i = 0; i <= tendon.section; ++i) {
      const RodSection& section = rod.sections[i];
      const Eigen::Vector2d& bend = shape.bends[i];
      const Eigen::Vector3d curvature(-bend.y() / section.length, bend.x() / section.length, 0);
      if (section.disks == 0) {
        sum += integrate(
            rule,
            [&](double s) {
              const TendonRoute::Offset offset = tendon.at(s);
              return (Eigen::Vector3d(0, 0, shape.stretches[i]) + curvature.cross(offset.value) +
                      offset.slope)
                  .norm();
            },
            s_base, s_base + section.length);
      } else {
        Eigen::Vector3d before = tendon.at(s_base).value;
        for (int piece = 1; piece <= section.disks; ++piece) {
          const double t = static_cast<double>(piece) / section.disks;
          const Eigen::Vector3d hole = arc_pose(t * bend, t * section.length * shape.stretches[i]) *
                                       tendon.at(s_base + t * section.length).value;
          sum += (hole - before).norm();
          before = hole;
        }
      }
      s_base += section.length;
    }
    return sum;
  };
  TendonDisplacements displacements;
  for (const TendonRoute& tendon : rod.tendons)
    displacements.pulled.push_back(length(tendon, straight) - length(tendon, state));
  return displacements;
}

}  // namespace flexura

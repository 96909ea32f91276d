#include "flexura/mechanics/arm_rod.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "flexura/kinematics/arc_motion.h"
#include "flexura/math/arrays.h"
#include "flexura/math/quadrature.h"
#include "flexura/mechanics/rod_response.h"

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
  result.damping_time = material.damping_time;
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

namespace {

// Least component of a tendon's path along the rod, per metre of rod. A tendon with a smaller component is
// near the centre of the bend or beyond the centre, where no rod can be. There the path length continues
// linearly, so that it does not grow again.
constexpr double least_along = 0.02;

// Length of a piece with the path `way`, of which `along` is the part along the rod and `piece` the rod's
// length; and its derivative by three numbers of a section.
struct PieceLength {
  double length = 0;
  Eigen::RowVector3d slope = Eigen::RowVector3d::Zero();
};

PieceLength piece_length(const Eigen::Vector3d& way, const Eigen::Matrix3d& path_by_state, double along,
                         const Eigen::RowVector3d& along_by_state, double piece) {
  const double least = least_along * piece;
  if (along >= least) return {way.norm(), way.transpose() / way.norm() * path_by_state};
  const double aside = std::max(0.0, way.squaredNorm() - along * along),
               edge = std::sqrt(aside + least * least);
  const Eigen::RowVector3d aside_by_state = 2 * (way.transpose() * path_by_state - along * along_by_state);
  const double beyond = (along - least) * least / edge;
  return {edge + beyond, (0.5 - 0.5 * beyond / edge) / edge * aside_by_state + least / edge * along_by_state};
}

// Length of a tendon if the sections are arcs, m, and its derivative by each section's (bend_x, bend_y,
// stretch).
class TendonOnArcs {
 public:
  TendonOnArcs(const Rod& rod, const TendonRoute& tendon, const ArmState& state)
      : slopes(Eigen::RowVectorXd::Zero(3 * static_cast<Eigen::Index>(rod.sections.size()))),
        tendon_(tendon) {
    double s_base = 0;
    for (std::size_t i = 0; i <= tendon.section; ++i) {
      const RodSection& section = rod.sections[i];
      const auto columns = 3 * static_cast<Eigen::Index>(i);
      const Eigen::RowVector3d change =
          section.disks == 0 ? in_channel(section.length, s_base, state.bends[i], state.stretches[i])
                             : between_disks(section, s_base, state.bends[i], state.stretches[i]);
      slopes.segment<3>(columns) = change;
      s_base += section.length;
    }
  }

  double length = 0;
  Eigen::RowVectorXd slopes;

 private:
  Eigen::RowVector3d in_channel(double of_section, double s_base, const Eigen::Vector2d& bend,
                                double stretch) {
    static const Quadrature rule = gauss_legendre(12);
    const Eigen::Vector3d curvature(-bend.y() / of_section, bend.x() / of_section, 0);
    Eigen::RowVector3d change = Eigen::RowVector3d::Zero();
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const double weight = 0.5 * of_section * rule.weights[k];
      const TendonRoute::Offset offset = tendon_.at(s_base + 0.5 * of_section * (1 + rule.nodes[k]));
      const Eigen::Vector3d way =
          Eigen::Vector3d(0, 0, stretch) + curvature.cross(offset.value) + offset.slope;
      Eigen::Matrix3d by_state;
      by_state.col(0) = Eigen::Vector3d(0, 1 / of_section, 0).cross(offset.value);
      by_state.col(1) = Eigen::Vector3d(-1 / of_section, 0, 0).cross(offset.value);
      by_state.col(2) = Eigen::Vector3d(0, 0, 1);
      const PieceLength piece = piece_length(way, by_state, way.z(), by_state.row(2), 1);
      length += weight * piece.length;
      change += weight * piece.slope;
    }
    return change;
  }

  Eigen::RowVector3d between_disks(const RodSection& section, double s_base, const Eigen::Vector2d& bend,
                                   double stretch) {
    Eigen::RowVector3d change = Eigen::RowVector3d::Zero();
    Eigen::Vector3d before = tendon_.at(s_base).value;
    Eigen::Matrix3d before_by_state = Eigen::Matrix3d::Zero();
    for (int piece = 1; piece <= section.disks; ++piece) {
      const double t = static_cast<double>(piece) / section.disks;
      const ArcMotion disk = arc_motion(t * bend, t * section.length * stretch);
      const Eigen::Vector3d arm = disk.rotation * tendon_.at(s_base + t * section.length).value;
      const Eigen::Vector3d hole = disk.position + arm;
      Eigen::Matrix3d by_state;
      for (int c = 0; c < 2; ++c)
        by_state.col(c) = t * (disk.linear.col(c) + Eigen::Vector3d(disk.angular.col(c)).cross(arm));
      by_state.col(2) = disk.position / stretch;
      const Eigen::Vector3d way = hole - before;
      const Eigen::Matrix3d path_by_state = by_state - before_by_state;
      // Direction along the rod halfway between the disks.
      const double halfway = t - 0.5 / section.disks;
      const ArcMotion middle = arc_motion(halfway * bend, halfway * section.length * stretch);
      const Eigen::Vector3d z = middle.rotation.col(2);
      Eigen::RowVector3d along_by_state = z.transpose() * path_by_state;
      for (int c = 0; c < 2; ++c)
        along_by_state[c] += halfway * way.dot(Eigen::Vector3d(middle.angular.col(c)).cross(z));
      const PieceLength piece_of_path =
          piece_length(way, path_by_state, way.dot(z), along_by_state, section.length / section.disks);
      length += piece_of_path.length;
      change += piece_of_path.slope;
      before = hole;
      before_by_state = by_state;
    }
    return change;
  }

  const TendonRoute& tendon_;
};

}  // namespace

TendonDisplacements arc_displacements(const Rod& rod, const ArmState& state) {
  require_fit(rod.sections.size(), state);
  const ArmState straight = ArmState::straight(rod.sections.size());
  TendonDisplacements displacements;
  for (const TendonRoute& tendon : rod.tendons)
    displacements.pulled.push_back(TendonOnArcs(rod, tendon, straight).length -
                                   TendonOnArcs(rod, tendon, state).length);
  return displacements;
}

Eigen::MatrixXd arc_displacement_slopes(const Rod& rod, const ArmState& state) {
  require_fit(rod.sections.size(), state);
  Eigen::MatrixXd slopes(static_cast<Eigen::Index>(rod.tendons.size()),
                         3 * static_cast<Eigen::Index>(rod.sections.size()));
  for (std::size_t i = 0; i < rod.tendons.size(); ++i)
    slopes.row(static_cast<Eigen::Index>(i)) = -TendonOnArcs(rod, rod.tendons[i], state).slopes;
  return slopes;
}

std::vector<double> pretension_displacements(RodStatics& statics, double tension) {
  const std::vector<double> tensions(statics.rest_lengths().size(), tension);
  const Equilibrium tight = statics.solve({.tensions = tensions}, {});
  if (!tight.converged()) throw std::invalid_argument("the arm has no equilibrium under its pretension");
  return tight.displacements;
}

ArmModel arm_model_of(const ArmConfig& arm, const std::optional<DriveConfig>& drive) {
  Arm driven = arm.arm();
  if (arm.mechanics == ArmMechanics::kinematic) return ArmModel(driven);
  for (Section& section : driven.sections)
    if (!section.bend_profile) section.bend_profile.emplace(arcs_of_rod_section, 1.0);
  const Actuation actuation(
      driven, std::make_shared<RodResponse>(driven, rod_of(arm, drive), loads_of(arm),
                                            drive ? std::optional(drive->drive()) : std::nullopt,
                                            arm.mechanics == ArmMechanics::dynamics));
  return {driven, actuation, shaped_arm(driven, actuation)};
}

}  // namespace flexura

#include "flexura/sim/tendon_pull.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "flexura/math/dense.h"
#include "flexura/mechanics/arm_rod.h"

namespace flexura {
namespace {

// What of an arm's state arcs may vary: bends, and stretches that have a range.
class Variables {
 public:
  explicit Variables(const Arm& arm) {
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      add(i, 0);
      if (arm.kind == ArmKind::spatial) add(i, 1);
      const auto [least, most] = arm.sections[i].stretch_limits;
      if (most > least) add(i, 2);
    }
  }
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(places_.size()); }
  [[nodiscard]] bool is_bend_of(Eigen::Index k, std::size_t section) const {
    const Place& place = places_[static_cast<std::size_t>(k)];
    return place.section == section && place.part < 2;
  }
  double& at(ArmState& state, Eigen::Index k) const {
    const Place& place = places_[static_cast<std::size_t>(k)];
    return place.part < 2 ? state.bends[place.section][place.part] : state.stretches[place.section];
  }
  // Of each, so that tendons are pulled in about as far by one unit of any.
  [[nodiscard]] Eigen::VectorXd units(const Rod& rod, const Arm& arm) const {
    double radius = 0;
    for (const TendonRoute& tendon : rod.tendons) radius = std::max(radius, tendon.at(0).value.norm());
    Eigen::VectorXd units = Eigen::VectorXd::Ones(count());
    for (Eigen::Index k = 0; k < count(); ++k) {
      const Place& place = places_[static_cast<std::size_t>(k)];
      if (place.part == 2 && radius > 0) units[k] = radius / arm.sections[place.section].length;
    }
    return units;
  }

 private:
  struct Place {
    std::size_t section = 0;
    int part = 0;
  };
  void add(std::size_t section, int part) { places_.push_back({section, part}); }
  std::vector<Place> places_;
};

Eigen::VectorXd pulled_by(const Rod& rod, const ArmState& state) {
  const std::vector<double> pulled = arc_displacements(rod, state).pulled;
  return Eigen::Map<const Eigen::VectorXd>(pulled.data(), static_cast<Eigen::Index>(pulled.size()));
}

// A row for each tendon, m/rad and m.
Eigen::MatrixXd slopes(const Rod& rod, const ArmState& state, const Variables& variables) {
  constexpr double step = 1e-5;
  Eigen::MatrixXd J(static_cast<Eigen::Index>(rod.tendons.size()), variables.count());
  for (Eigen::Index k = 0; k < variables.count(); ++k) {
    ArmState more = state, less = state;
    variables.at(more, k) += step, variables.at(less, k) -= step;
    J.col(k) = (pulled_by(rod, more) - pulled_by(rod, less)) / (2 * step);
  }
  return J;
}

// Of a tendon's offset over a section, m.
double largest_offset(const TendonRoute& tendon, double from, double to) {
  constexpr int pieces = 32;
  double most = 0;
  for (int i = 0; i <= pieces; ++i)
    most = std::max(most, tendon.at(from + (to - from) * i / pieces).value.norm());
  return most;
}

std::array<double, 2> range_by_bends(const TendonRoute& tendon, const Arm& arm) {
  constexpr double a_turn = 2 * std::numbers::pi;
  std::array<double, 2> range{};
  double s = 0;
  for (std::size_t i = 0; i <= tendon.section; ++i) {
    const Section& section = arm.sections[i];
    const double bend = largest_offset(tendon, s, s + section.length) * std::min(section.max_bend, a_turn);
    range[0] += -bend - section.length * (section.stretch_limits[1] - 1);
    range[1] += bend - section.length * (section.stretch_limits[0] - 1);
    s += section.length;
  }
  return range;
}

std::vector<std::array<double, 3>> route_of(const TendonRoute& tendon, const Rod& rod) {
  constexpr int pieces = 24;
  double end = 0;
  for (std::size_t i = 0; i <= tendon.section; ++i) end += rod.sections[i].length;
  std::vector<std::array<double, 3>> route;
  for (int i = 0; i <= pieces; ++i) {
    const double s = end * i / pieces;
    const Eigen::Vector3d offset = tendon.at(s).value;
    route.push_back({s, offset.x(), offset.y()});
  }
  return route;
}

// The least step that meets `desired` best, but for ways of which it says next to nothing.
Eigen::VectorXd least_step(const Eigen::MatrixXd& J, const Eigen::VectorXd& desired) {
  constexpr double next_to_nothing = 0.01;
  const SymmetricEigen normal = symmetric_eigen(J.transpose() * J);
  const double least = next_to_nothing * next_to_nothing * normal.values[normal.values.size() - 1];
  Eigen::VectorXd along = normal.vectors.transpose() * (J.transpose() * desired);
  for (Eigen::Index i = 0; i < along.size(); ++i)
    along[i] = normal.values[i] > least ? along[i] / normal.values[i] : 0;
  return normal.vectors * along;
}

}  // namespace

ArmState nearest_arcs(const Rod& rod, const Arm& arm, const std::vector<double>& displacements) {
  constexpr int most_steps = 20;
  constexpr double rounding = 1e-10;  // rad, and of a length
  if (displacements.size() != rod.tendons.size() ||
      !std::ranges::all_of(displacements, [](double each) { return std::isfinite(each); }))
    throw std::invalid_argument(
        fmt::format("expected {} finite displacements of tendons", rod.tendons.size()));
  const Eigen::Map<const Eigen::VectorXd> desired(displacements.data(),
                                                  static_cast<Eigen::Index>(displacements.size()));
  const Variables variables(arm);
  const Eigen::VectorXd units = variables.units(rod, arm);
  ArmState state = ArmState::straight(arm.sections.size());
  for (int turn = 0; turn < most_steps; ++turn) {
    const Eigen::MatrixXd J = slopes(rod, state, variables) * units.asDiagonal();
    const Eigen::VectorXd change = units.cwiseProduct(least_step(J, desired - pulled_by(rod, state)));
    if (!change.allFinite()) break;
    for (Eigen::Index k = 0; k < variables.count(); ++k) variables.at(state, k) += change[k];
    if (change.cwiseAbs().maxCoeff() < rounding) break;
  }
  return state;
}

std::vector<PulledTendon> pulled_tendons(const ArmSetup& setup) {
  if (!setup.rod) return {};
  const Rod& rod = setup.rod->rod;
  const Variables variables(setup.arm);
  const Eigen::MatrixXd J = slopes(rod, ArmState::straight(setup.arm.sections.size()), variables);
  std::vector<PulledTendon> tendons;
  for (std::size_t i = 0; i < rod.tendons.size(); ++i) {
    PulledTendon tendon{rod.tendons[i].section, range_by_bends(rod.tendons[i], setup.arm),
                        std::vector<double>(rod.tendons.size(), 0.0), route_of(rod.tendons[i], rod)};
    if (setup.drive) {
      const Axis& axis = setup.drive->axes.at(i);
      const double most = axis.motor.max_position / axis.microsteps_a_metre();
      tendon.range = {std::max(tendon.range[0], -most), std::min(tendon.range[1], most)};
    }
    Eigen::VectorXd way = J.row(static_cast<Eigen::Index>(i));
    for (Eigen::Index k = 0; k < way.size(); ++k)
      if (!variables.is_bend_of(k, tendon.section)) way[k] = 0;
    constexpr double least = 1e-6;  // m/rad: it hardly bends anything, and goes alone
    const Eigen::VectorXd others =
        way.norm() > least ? Eigen::VectorXd(J * way / way.squaredNorm()) : Eigen::VectorXd::Zero(J.rows());
    for (std::size_t j = 0; j < tendon.together.size(); ++j)
      tendon.together[j] = others[static_cast<Eigen::Index>(j)];
    tendon.together[i] = 1;
    tendons.push_back(std::move(tendon));
  }
  return tendons;
}

bool has_loads(const RodLoads& loads) {
  return !loads.gravity.isZero(0) || !loads.per_length.isZero(0) || !loads.ends.empty();
}

}  // namespace flexura

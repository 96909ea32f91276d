#include "flexura/kinematics/tendons.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "flexura/math/dense.h"
#include "flexura/math/series.h"

namespace flexura {
namespace {

void require_fit(const Arm& arm, const Drive& drive, std::size_t bends, std::size_t stretches) {
  const std::size_t count = arm.sections.size();
  if (bends != count || stretches != count) {
    throw std::invalid_argument(
        fmt::format("an arm of {} sections cannot take {} bends and {} stretches", count, bends, stretches));
  }
  for (const Tendon& tendon : drive.tendons) {
    if (tendon.section >= count) {
      throw std::invalid_argument(
          fmt::format("a tendon ends at section {}, but the arm has {} sections", tendon.section, count));
    }
  }
}

// Ratio of the length of straight pieces between disks to the length of the channel. Each straight piece is
// the chord of an offset arc that turns by |bend| / n.
struct Chords {
  double ratio = 1;                                 // 1 in a channel.
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  // Of the ratio by the bend, 1/rad.
};

Chords chords(const Drive& drive, const Eigen::Vector2d& bend) {
  if (!drive.disks) return {};
  const double per_angle = 0.5 / static_cast<double>(*drive.disks);
  const double half_turn = per_angle * bend.norm();
  return {sinc(half_turn), sinc_slope(half_turn) * per_angle * per_angle * bend};
}

// The passage of a tendon through a section: a tendon at `offset` has the length `centre` - offset . `turn`
// in the section.
struct Passage {
  double centre = 0;                               // m.
  Eigen::Vector2d turn = Eigen::Vector2d::Zero();  // rad.
};

Passage passage(const Drive& drive, const Section& section, const Eigen::Vector2d& bend, double stretch) {
  const double ratio = chords(drive, bend).ratio;
  return {ratio * section.length * stretch, ratio * bend};
}

// Returns the sums of the passages up to and including each section.
std::vector<Passage> passages(const Arm& arm, const Drive& drive, const ArmState& state) {
  std::vector<Passage> sums;
  Passage sum;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const Passage one = passage(drive, arm.sections[i], state.bends[i], state.stretches[i]);
    sum = {sum.centre + one.centre, sum.turn + one.turn};
    sums.push_back(sum);
  }
  return sums;
}

// Returns the length to the end of each section of the straight arm, m.
std::vector<double> straight_lengths(const Arm& arm) {
  std::vector<double> sums;
  sums.reserve(arm.sections.size());
  for (const Section& section : arm.sections)
    sums.push_back((sums.empty() ? 0.0 : sums.back()) + section.length);
  return sums;
}

// Returns the derivative of one section's contribution to the displacement with respect to its (bend_x,
// bend_y, stretch).
Eigen::RowVector3d displacement_slope(const Drive& drive, const Section& section, const Eigen::Vector2d& bend,
                                      double stretch, const Eigen::Vector2d& offset) {
  const auto [ratio, slope] = chords(drive, bend);
  const double channel = section.length * stretch - offset.dot(bend);
  const Eigen::Vector2d by_bend = ratio * offset - channel * slope;
  return {by_bend.x(), by_bend.y(), -ratio * section.length};
}

// A section with unknown bend and, if it may stretch, unknown stretch.
struct Unknown {
  const Drive& drive;
  const Section& section;
  ArmKind kind;
  std::vector<Eigen::Vector2d> offsets;   // Of the tendons that end there, m.
  std::vector<double> pulled;             // Their displacements, m.
  double shortened_below = 0;             // By the sections below, along the centre, m.
  Eigen::Vector2d turned_below = {0, 0};  // rad.
};

// Gauss-Newton; in a channel the first step is exact up to rounding.
bool solve(const Unknown& unknown, Eigen::Vector2d& bend, double& stretch) {
  const auto rows = static_cast<Eigen::Index>(unknown.offsets.size());
  const Eigen::Index bend_columns = unknown.kind == ArmKind::planar ? 1 : 2;
  const bool stretching = unknown.section.can_stretch();
  constexpr int max_steps = 100;
  for (int step = 0; step < max_steps && rows > 0; ++step) {
    Eigen::MatrixXd J(rows, bend_columns + (stretching ? 1 : 0));
    Eigen::VectorXd missing(rows);
    const Passage now = passage(unknown.drive, unknown.section, bend, stretch);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const auto index = static_cast<std::size_t>(i);
      const Eigen::Vector2d& offset = unknown.offsets[index];
      missing(i) = unknown.pulled[index] - unknown.shortened_below - (unknown.section.length - now.centre) -
                   offset.dot(unknown.turned_below + now.turn);
      const Eigen::RowVector3d slope =
          displacement_slope(unknown.drive, unknown.section, bend, stretch, offset);
      J.row(i).head(bend_columns) = slope.head(bend_columns);
      if (stretching) J(i, bend_columns) = slope(2);
    }
    const Eigen::VectorXd change = least_norm_solution(J, missing);
    bend.head(bend_columns) += change.head(bend_columns);
    if (stretching) stretch += change(bend_columns);
    if (!bend.allFinite() || !std::isfinite(stretch)) return false;
    // Near a solution convergence is quadratic, so that the next step would be negligible.
    constexpr double small = 1e-10;
    if (change.norm() <= small * (1 + bend.norm())) return true;
  }
  return rows == 0;
}

}  // namespace

TendonDisplacements tendon_displacements(const Arm& arm, const Drive& drive, const ArmState& state) {
  require_fit(arm, drive, state.bends.size(), state.stretches.size());
  const std::vector<Passage> sums = passages(arm, drive, state);
  const std::vector<double> straight = straight_lengths(arm);
  TendonDisplacements result;
  result.pulled.reserve(drive.tendons.size());
  for (const Tendon& tendon : drive.tendons) {
    const Passage& sum = sums[tendon.section];
    result.pulled.push_back((straight[tendon.section] - sum.centre) + tendon.offset().dot(sum.turn));
  }
  if (drive.loses_travel()) result.wraps = tendon_wraps(arm, drive, state);
  return result;
}

std::vector<double> tendon_wraps(const Arm& arm, const Drive& drive, const ArmState& state) {
  require_fit(arm, drive, state.bends.size(), state.stretches.size());
  std::vector<double> sums;
  sums.reserve(state.bends.size());
  for (const Eigen::Vector2d& bend : state.bends)
    sums.push_back((sums.empty() ? 0.0 : sums.back()) + bend.norm());
  std::vector<double> wraps;
  wraps.reserve(drive.tendons.size());
  for (const Tendon& tendon : drive.tendons) wraps.push_back(sums[tendon.section]);
  return wraps;
}

Eigen::MatrixXd tendon_jacobian(const Arm& arm, const Drive& drive, const ArmState& state) {
  require_fit(arm, drive, state.bends.size(), state.stretches.size());
  const auto columns = static_cast<Eigen::Index>(3 * arm.sections.size());
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(drive.tendons.size()), columns);
  for (Eigen::Index row = 0; row < J.rows(); ++row) {
    const Tendon& tendon = drive.tendons[static_cast<std::size_t>(row)];
    for (std::size_t i = 0; i <= tendon.section; ++i) {
      J.block<1, 3>(row, static_cast<Eigen::Index>(3 * i)) =
          displacement_slope(drive, arm.sections[i], state.bends[i], state.stretches[i], tendon.offset());
    }
  }
  return J;
}

TendonFit fit_state(const Arm& arm, const Drive& drive, const TendonDisplacements& displacements) {
  require_fit(arm, drive, arm.sections.size(), arm.sections.size());
  if (displacements.pulled.size() != drive.tendons.size()) {
    throw std::invalid_argument(fmt::format("{} tendons cannot take {} displacements", drive.tendons.size(),
                                            displacements.pulled.size()));
  }
  std::vector<Unknown> unknowns;
  unknowns.reserve(arm.sections.size());
  for (const Section& section : arm.sections) unknowns.push_back({drive, section, arm.kind, {}, {}});
  for (std::size_t t = 0; t < drive.tendons.size(); ++t) {
    Unknown& unknown = unknowns[drive.tendons[t].section];
    unknown.offsets.push_back(drive.tendons[t].offset());
    unknown.pulled.push_back(displacements.pulled[t]);
  }
  TendonFit fit{ArmState::straight(arm.sections.size()), displacements, true};
  double shortened = 0;
  Eigen::Vector2d turned = {0, 0};
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    unknowns[i].shortened_below = shortened;
    unknowns[i].turned_below = turned;
    fit.converged = solve(unknowns[i], fit.state.bends[i], fit.state.stretches[i]) && fit.converged;
    const Section& section = arm.sections[i];
    const Passage own = passage(drive, section, fit.state.bends[i], fit.state.stretches[i]);
    shortened += section.length - own.centre;
    turned += own.turn;
  }
  const TendonDisplacements found = tendon_displacements(arm, drive, fit.state);
  for (std::size_t t = 0; t < found.pulled.size(); ++t) fit.residual.pulled[t] -= found.pulled[t];
  return fit;
}

std::vector<double> tendon_speed_bounds(const Arm& arm, const Drive& drive,
                                        std::span<const SectionRates> rates) {
  require_fit(arm, drive, rates.size(), rates.size());
  // Maxima of |sinc'(h)| and |h sinc'(h)| = |cos h - sinc h| over all h: the contribution of disks
  // (docs/drives.md).
  constexpr double max_slope = 0.4363;
  constexpr double max_scaled_slope = 1.0632;
  std::vector<double> bend_speeds;    // Sum of the bend rates up to each section, rad/s.
  std::vector<double> centre_speeds;  // Contribution of the lengths along the centre, m/s.
  double bend = 0;
  double centre = 0;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const Section& section = arm.sections[i];
    bend += rates[i].bend;
    centre += section.length * rates[i].stretch;
    if (drive.disks) {
      const double per_angle = 0.5 / static_cast<double>(*drive.disks);
      centre += max_slope * per_angle * rates[i].bend * section.length * section.stretch_limits[1];
    }
    bend_speeds.push_back(bend);
    centre_speeds.push_back(centre);
  }
  std::vector<double> bounds;
  for (const Tendon& tendon : drive.tendons) {
    const double turned = drive.disks ? 1 + max_scaled_slope : 1.0;
    bounds.push_back(centre_speeds[tendon.section] + turned * tendon.radius * bend_speeds[tendon.section]);
  }
  return bounds;
}

}  // namespace flexura

#include <algorithm>
#include <array>
#include <cmath>

#include "flexura/mechanics/rod_matrix.h"

namespace flexura {
namespace {

// Part of a tie's matrix added to its diagonal, so that it has a root.
constexpr double of_a_root = 1e-14;

using PointNumber = RodMotion<double>::Number;
constexpr std::size_t point_lanes = lanes_of<PointNumber>;

void set_lane_of(Triple<PointNumber>& to, const Triple<double>& from, std::size_t lane) {
  to.x[lane] = from.x, to.y[lane] = from.y, to.z[lane] = from.z;
}

}  // namespace

void RodMatrix::add_pull(Block& H, const NodePull& pull, const Factors& factors) {
  Matrix6d more;
  if (pull.is_held)
    more = -factors.stiffness * pull.stiffness - factors.damping * pull.damping;
  else
    more = factors.stiffness * pull.by_pose + factors.damping * pull.by_twist;
  for (std::size_t r = 0; r < 6; ++r) {
    for (std::size_t c = 0; c < 6; ++c) {
      const auto i = static_cast<Eigen::Index>(r), j = static_cast<Eigen::Index>(c);
      H[6 * r + c] -= 0.5 * (more(i, j) + more(j, i));
    }
  }
}

// Computes point columns: those of the node where the interval begins, plus the effect of the modes in the
// part of the interval.
void RodMatrix::find_point_columns(const RodMotion<double>& motion) {
  const RodPoints& points = *motion.points();
  std::size_t size = 0;
  for (std::size_t i = 0; i < motion.chosen().size(); ++i) {
    if (motion.point_pulls()[i].is_idle) continue;
    const std::size_t point = motion.chosen()[i], section = points.points[point].section;
    pulled_.push_back({.chosen = i, .point = point, .section = section, .first = size});
    size += 6 * parts_[section].stride;
  }
  if (point_columns_.size() < size) point_columns_.resize(size);
  // Points side by side, as they were placed.
  std::size_t done = point_lanes, next = 0;
  std::array<std::array<std::array<std::array<double, 6>, 3>, 3>, point_lanes> along{};
  for (const Pulled& pulled : pulled_) {
    const RodPoints::Point& point = points.points[pulled.point];
    const RodLayout::Section& section = layout_.sections[point.section];
    const Part& part = parts_[point.section];
    double* to = point_columns_.data() + pulled.first;
    const double* from = part.columns.data() + (point.node - section.first_node) * 6 * part.stride;
    std::copy(from, from + 6 * part.stride, to);
    if (point.is_node) continue;
    if (done == point_lanes || pulled.chosen / point_lanes != next) {
      next = pulled.chosen / point_lanes;
      done = 0;
      Placement<PointNumber> X{};
      for (std::size_t lane = 0; lane < point_lanes; ++lane) {
        const std::size_t i = std::min(next * point_lanes + lane, motion.chosen().size() - 1);
        const Placement<double>& at = motion.nodes()[points.points[motion.chosen()[i]].node];
        set_lane_of(X.x, at.x, lane), set_lane_of(X.y, at.y, lane), set_lane_of(X.z, at.z, lane),
            set_lane_of(X.position, at.position, lane);
      }
      const RodInterval<PointNumber> interval = still(motion.parts()[next]);
      // As for whole intervals: a unit moment acts as the unit force does, one half of the strains further.
      for (std::size_t r = 0; r < 3; ++r) {
        Screw<PointNumber> unit{};
        if (r == 0) unit.linear.x += 1.0;
        if (r == 1) unit.linear.y += 1.0;
        if (r == 2) unit.linear.z += 1.0;
        const auto wide = interval.along_moments(X.fetch(unit));
        for (std::size_t lane = 0; lane < point_lanes; ++lane) {
          for (std::size_t m = 0; m < 3; ++m) {
            const auto [linear, angular] = wide[m];
            along[lane][r][m] = {linear.x[lane],  linear.y[lane],  linear.z[lane],
                                 angular.x[lane], angular.y[lane], angular.z[lane]};
          }
        }
      }
    }
    const double* of_mode = motion.points()->moments.data() + point.first_moment;
    for (std::size_t r = 0; r < 3; ++r) {
      const auto& row = along[pulled.chosen % point_lanes][r];
      for (std::size_t j = 0; j < section.modes; ++j) {
        const std::size_t c = section.strain[j];
        for (std::size_t m = 0; m < 3; ++m) {
          const double amount = of_mode[m * section.modes + j];
          to[r * part.stride + j] += amount * row[m][c];
          if (c >= 3) to[(r + 3) * part.stride + j] += amount * row[m][c - 3];
        }
      }
    }
  }
}

bool RodMatrix::has_columns_of(const RodMotion<double>& motion) const {
  std::size_t found = 0;
  for (std::size_t i = 0; i < motion.chosen().size(); ++i) {
    if (motion.point_pulls()[i].is_idle) continue;
    if (found == pulled_.size() || pulled_[found].point != motion.chosen()[i] || pulled_[found].chosen != i)
      return false;
    ++found;
  }
  return found == pulled_.size();
}

bool RodMatrix::factor_ties(const RodMotion<double>& motion, const Factors& factors) {
  motion.find_ties(ties_);
  const auto n = static_cast<Eigen::Index>(layout_.modes),
             count = 3 * static_cast<Eigen::Index>(ties_.size());
  if (rows_.rows() < count || rows_.cols() != n) {
    rows_.resize(2 * count, n);
    answers_.resize(n, 2 * count);
    tensions_.resize(2 * count);
  }
  std::vector<const Pulled*> of_chosen(motion.chosen().size(), nullptr);
  for (const Pulled& pulled : pulled_) of_chosen[pulled.chosen] = &pulled;
  Eigen::Matrix<double, 3, Eigen::Dynamic> row(3, n);
  for (std::size_t t = 0; t < ties_.size(); ++t) {
    const PointTie& tie = ties_[t];
    row.setZero();
    for (std::size_t i = 0; i < PointTie::most; ++i) {
      const Pulled* pulled = of_chosen[tie.points[i]];
      if (pulled == nullptr) continue;
      for (std::size_t s = 0; s <= pulled->section; ++s) {
        const RodLayout::Section& section = layout_.sections[s];
        const Part& part = parts_[s];
        const double* A = s == pulled->section ? point_columns_.data() + pulled->first
                                               : part.columns.data() + section.intervals * 6 * part.stride;
        for (std::size_t j = 0; j < section.modes; ++j) {
          Vector6d column;
          for (std::size_t r = 0; r < 6; ++r) column[static_cast<Eigen::Index>(r)] = A[r * part.stride + j];
          row.col(static_cast<Eigen::Index>(section.first_mode + j)) += tie.rows[i] * column;
        }
      }
    }
    Eigen::Matrix3d H = factors.stiffness * tie.stiffness + factors.damping * tie.damping;
    H.diagonal().array() += of_a_root * H.trace();
    const Eigen::LLT<Eigen::Matrix3d> root(H);
    if (root.info() != Eigen::Success) {
      if (H.trace() > 0 || !H.allFinite()) return false;
      row.setZero();
    }
    rows_.middleRows<3>(3 * static_cast<Eigen::Index>(t)) = root.matrixU() * row;
  }
  const auto rows = rows_.topRows(count);
  auto answers = answers_.leftCols(count);
  answers = rows.transpose();
  for (Eigen::Index i = 0; i < count; ++i) solve_sections(answers.col(i).data());
  Eigen::MatrixXd gram = rows * answers;
  gram.diagonal().array() += 1;
  tied_.compute(gram);
  return tied_.info() == Eigen::Success && gram.allFinite();
}

void RodMatrix::solve(double* x) const {
  solve_sections(x);
  if (ties_.empty()) return;
  const auto count = 3 * static_cast<Eigen::Index>(ties_.size());
  Eigen::Map<Eigen::VectorXd> answer(x, static_cast<Eigen::Index>(layout_.modes));
  auto pulls = tensions_.head(count);
  pulls.noalias() = rows_.topRows(count) * answer;
  tied_.solveInPlace(pulls);
  answer.noalias() -= answers_.leftCols(count) * pulls;
}

void RodMatrix::add_pull_change(const RodMotion<double>& motion, double stretch, const double* x,
                                double* force) const {
  // First the relative motion of the sections, then the change of forces, from the tip on.
  Vector6d moved = Vector6d::Zero(), beyond = Vector6d::Zero();
  for (std::size_t s = 0; s + 1 < parts_.size(); ++s)
    moved += node_twist(s, layout_.sections[s].intervals, x);
  std::size_t points_left = pulled_.size();
  for (std::size_t s = parts_.size(); s-- > 0;) {
    const RodLayout::Section& section = layout_.sections[s];
    const std::size_t stride = parts_[s].stride;
    const auto add = [&](const double* A, const Vector6d& wrench) {
      for (std::size_t r = 0; r < 6; ++r)
        for (std::size_t j = 0; j < section.modes; ++j)
          force[section.first_mode + j] += A[r * stride + j] * wrench[static_cast<Eigen::Index>(r)];
    };
    add(parts_[s].columns.data() + section.intervals * 6 * stride, beyond);
    const auto add_change = [&](const double* A, const NodePull& pull) {
      const Vector6d twist = moved + twist_of(s, A, x);
      const Vector6d wrench = pull.by_twist * twist + stretch * (pull.by_pose * twist);
      add(A, wrench);
      beyond += wrench;
    };
    for (std::size_t k = 0; k <= section.intervals; ++k) {
      const NodePull& pull = motion.pulls()[section.first_node + k];
      if (!pull.is_idle) add_change(parts_[s].columns.data() + k * 6 * stride, pull);
    }
    for (; points_left > 0 && pulled_[points_left - 1].section == s; --points_left)
      add_change(point_columns_.data() + pulled_[points_left - 1].first,
                 motion.point_pulls()[pulled_[points_left - 1].chosen]);
    if (s > 0) moved -= node_twist(s - 1, layout_.sections[s - 1].intervals, x);
  }
}

Vector6d RodMatrix::twist_of(std::size_t s, const double* columns, const double* x) const {
  const RodLayout::Section& section = layout_.sections[s];
  Vector6d twist = Vector6d::Zero();
  for (std::size_t r = 0; r < 6; ++r)
    for (std::size_t j = 0; j < section.modes; ++j)
      twist[static_cast<Eigen::Index>(r)] += columns[r * parts_[s].stride + j] * x[section.first_mode + j];
  return twist;
}

Vector6d RodMatrix::node_twist(std::size_t s, std::size_t node, const double* x) const {
  return twist_of(s, parts_[s].columns.data() + node * 6 * parts_[s].stride, x);
}

}  // namespace flexura

#include "flexura/mechanics/rod_matrix.h"

#include <algorithm>
#include <cmath>

namespace flexura {
namespace {

constexpr std::size_t step_of_rows = 4;

// Six rows of numbers: sums[r] += the sum over c of H[r][c] rows[c].
void multiply(const std::array<double, 36>& H, const double* rows, double* sums, std::size_t stride) {
  for (std::size_t r = 0; r < 6; ++r) {
    const double* h = H.data() + 6 * r;
    double* sum = sums + r * stride;
    const double *a0 = rows, *a1 = rows + stride, *a2 = rows + 2 * stride, *a3 = rows + 3 * stride,
                 *a4 = rows + 4 * stride, *a5 = rows + 5 * stride;
    for (std::size_t j = 0; j < stride; ++j)
      sum[j] =
          ((h[0] * a0[j] + h[1] * a1[j]) + (h[2] * a2[j] + h[3] * a3[j])) + (h[4] * a4[j] + h[5] * a5[j]);
  }
}

}  // namespace

RodMatrix::RodMatrix(const RodLayout& layout) : layout_(layout), by_moments_(54 * layout.intervals) {
  for (const RodLayout::Section& section : layout.sections) {
    Part& part = parts_.emplace_back();
    part.stride = (section.modes + step_of_rows - 1) / step_of_rows * step_of_rows;
    part.columns.resize((section.intervals + 1) * 6 * part.stride);
    part.matrix.resize(part.stride * part.stride);
    part.by_base.resize(6 * part.stride);
    part.space.resize(6 * part.stride);
    part.inverse.resize(part.stride);
  }
}

void RodMatrix::find_columns(const RodMotion<double>& motion) {
  using Number = RodMotion<double>::Number;
  constexpr std::size_t width = lanes_of<Number>;
  // First node of each interval.
  std::array<const Placement<double>*, width> at{};
  std::size_t s = 0;
  for (std::size_t first = 0; first < layout_.intervals; first += width) {
    Placement<Number> X{};
    for (std::size_t lane = 0; lane < width; ++lane) {
      const std::size_t i = std::min(first + lane, layout_.intervals - 1);
      std::size_t section = s;
      while (i >= layout_.sections[section].first_interval + layout_.sections[section].intervals) ++section;
      if (lane == 0) s = section;
      at[lane] =
          &motion
               .nodes()[layout_.sections[section].first_node + i - layout_.sections[section].first_interval];
      const auto set = [&](Triple<Number>& to, const Triple<double>& from) {
        to.x[lane] = from.x, to.y[lane] = from.y, to.z[lane] = from.z;
      };
      set(X.x, at[lane]->x), set(X.y, at[lane]->y), set(X.z, at[lane]->z),
          set(X.position, at[lane]->position);
    }
    const RodInterval<Number> interval = still(motion.intervals()[first / width]);
    // Unit forces, in the interval's frame. A unit moment acts on the angular strains as the unit force acts
    // on the linear ones. It does not act on the linear strains, since brackets are those of dual numbers.
    for (std::size_t r = 0; r < 3; ++r) {
      Screw<Number> unit{};
      if (r == 0) unit.linear.x += 1.0;
      if (r == 1) unit.linear.y += 1.0;
      if (r == 2) unit.linear.z += 1.0;
      const auto along = interval.along_moments(X.fetch(unit));
      for (std::size_t lane = 0; lane < width && first + lane < layout_.intervals; ++lane) {
        double* to = by_moments_.data() + 54 * (first + lane) + r;
        for (std::size_t m = 0; m < 3; ++m, to += 18) {
          to[0] = along[m].linear.x[lane], to[3] = along[m].linear.y[lane], to[6] = along[m].linear.z[lane];
          to[9] = along[m].angular.x[lane], to[12] = along[m].angular.y[lane],
          to[15] = along[m].angular.z[lane];
        }
      }
    }
  }
  for (std::size_t section_index = 0; section_index < parts_.size(); ++section_index) {
    const RodLayout::Section& section = layout_.sections[section_index];
    Part& part = parts_[section_index];
    for (std::size_t i = 0; i < section.intervals; ++i) {
      const double* before = part.columns.data() + i * 6 * part.stride;
      double* after = part.columns.data() + (i + 1) * 6 * part.stride;
      const double* by = by_moments_.data() + 54 * (section.first_interval + i);
      const auto column = static_cast<Eigen::Index>(i);
      const double *m1 = section.grid.moments[0].col(column).data(),
                   *m2 = section.grid.moments[1].col(column).data(),
                   *m3 = section.grid.moments[2].col(column).data();
      for (std::size_t c = 0; c < 6; ++c) {
        const auto first = static_cast<std::size_t>(section.grid.first[c]),
                   last = first + static_cast<std::size_t>(section.grid.count[c]);
        if (first == last) continue;
        const auto add = [&](std::size_t row, std::size_t number) {
          const double y1 = by[number], y2 = by[18 + number], y3 = by[36 + number];
          const double* from = before + row * part.stride;
          double* to = after + row * part.stride;
          for (std::size_t j = first; j < last; ++j) to[j] = from[j] + (m1[j] * y1 + m2[j] * y2 + m3[j] * y3);
        };
        for (std::size_t r = 0; r < 3; ++r) add(r, 3 * c + r);
        // Linear strains do not turn distal nodes; these column rows stay 0.
        if (c < 3) continue;
        for (std::size_t r = 0; r < 3; ++r) add(r + 3, 3 * (c - 3) + r);
      }
    }
  }
}

RodMatrix::Block RodMatrix::block_of(const RodLayout::Body& body, const Placement<double>& at) {
  const Triple<double> c = at.position + at.turn(body.centre);
  const double m = body.mass;
  // R inertia R^T.
  const auto times = [&](const Triple<double>& row) {
    return row.x * body.inertia[0] + row.y * body.inertia[1] + row.z * body.inertia[2];
  };
  const Triple<double> ix = times(at.x), iy = times(at.y), iz = times(at.z);
  const double xx = dot(ix, at.x) + m * (c.y * c.y + c.z * c.z),
               yy = dot(iy, at.y) + m * (c.x * c.x + c.z * c.z),
               zz = dot(iz, at.z) + m * (c.x * c.x + c.y * c.y), xy = dot(ix, at.y) - m * c.x * c.y,
               xz = dot(ix, at.z) - m * c.x * c.z, yz = dot(iy, at.z) - m * c.y * c.z;
  const double mx = m * c.x, my = m * c.y, mz = m * c.z;
  return {m,   0,   0,   0,   mz,  -my,  //
          0,   m,   0,   -mz, 0,   mx,   //
          0,   0,   m,   my,  -mx, 0,    //
          0,   -mz, my,  xx,  xy,  xz,   //
          mz,  0,   -mx, xy,  yy,  yz,   //
          -my, mx,  0,   xz,  yz,  zz};
}

// Adds the lower triangle of A^T H A, and H A for the base.
void RodMatrix::add_product(Part& part, const double* A, const Block& H, bool has_base) {
  const std::size_t stride = part.stride;
  multiply(H, A, part.space.data(), stride);
  const double *b0 = part.space.data(), *b1 = b0 + stride, *b2 = b1 + stride, *b3 = b2 + stride,
               *b4 = b3 + stride, *b5 = b4 + stride;
  for (std::size_t j = 0; j < stride; ++j) {
    const double a0 = A[j], a1 = A[stride + j], a2 = A[2 * stride + j], a3 = A[3 * stride + j],
                 a4 = A[4 * stride + j], a5 = A[5 * stride + j];
    double* row = part.matrix.data() + j * stride;
    // Up to the end of the instruction that holds the diagonal.
    const std::size_t last = std::min(stride, (j / step_of_rows + 1) * step_of_rows);
    for (std::size_t l = 0; l < last; ++l)
      row[l] += ((a0 * b0[l] + a1 * b1[l]) + (a2 * b2[l] + a3 * b3[l])) + (a4 * b4[l] + a5 * b5[l]);
  }
  if (!has_base) return;
  for (std::size_t l = 0; l < 6 * stride; ++l) part.by_base[l] += part.space[l];
}

// Adds the tendons' geometric stiffness at a node: the second derivative of their lengths by its strains,
// times tension.
void RodMatrix::add_tendons(std::size_t s, const RodMotion<double>& motion, const double* tensions,
                            double factor) {
  const RodLayout::Section& section = layout_.sections[s];
  Part& part = parts_[s];
  for (std::size_t k = 0; k <= section.intervals; ++k) {
    const double run = layout_.run[section.first_node + k];
    if (run == 0) continue;
    const Matrix6d by_strain = motion.tendon_stiffness(section, k, tensions);
    const auto at = section.grid.at_node.col(static_cast<Eigen::Index>(k));
    for (std::size_t j = 0; j < section.modes; ++j) {
      const double by = factor * run * at[static_cast<Eigen::Index>(j)];
      for (std::size_t l = 0; l <= j; ++l)
        part.matrix[j * part.stride + l] += by * at[static_cast<Eigen::Index>(l)] *
                                            by_strain(static_cast<Eigen::Index>(section.strain[j]),
                                                      static_cast<Eigen::Index>(section.strain[l]));
    }
  }
}

// Cholesky decomposition by rows, and L^-1 of the coupling to the base.
bool RodMatrix::factor_part(Part& part, std::size_t modes, bool has_base) {
  const std::size_t stride = part.stride;
  for (std::size_t i = 0; i < modes; ++i) {
    double* row = part.matrix.data() + i * stride;
    for (std::size_t j = 0; j < i; ++j) {
      const double* other = part.matrix.data() + j * stride;
      double sum = row[j];
      for (std::size_t k = 0; k < j; ++k) sum -= row[k] * other[k];
      row[j] = sum * part.inverse[j];
    }
    double sum = row[i];
    for (std::size_t k = 0; k < i; ++k) sum -= row[k] * row[k];
    if (!(sum > 0) || !std::isfinite(sum)) return false;
    part.inverse[i] = 1 / std::sqrt(sum);
  }
  if (!has_base) return true;
  for (std::size_t r = 0; r < 6; ++r) {
    double* y = part.by_base.data() + r * stride;
    for (std::size_t i = 0; i < modes; ++i) {
      const double* row = part.matrix.data() + i * stride;
      double sum = y[i];
      for (std::size_t k = 0; k < i; ++k) sum -= row[k] * y[k];
      y[i] = sum * part.inverse[i];
    }
  }
  return true;
}

bool RodMatrix::factor(const RodMotion<double>& motion, const Factors& factors, const double* tensions,
                       bool is_surrounded) {
  ties_.clear();
  pulled_.clear();
  if (is_surrounded && !motion.chosen().empty()) find_point_columns(motion);
  std::size_t points_left = pulled_.size();
  Block beyond{};
  for (std::size_t s = parts_.size(); s-- > 0;) {
    const RodLayout::Section& section = layout_.sections[s];
    Part& part = parts_[s];
    const bool has_base = s > 0;
    std::ranges::fill(part.matrix, 0.0);
    std::ranges::fill(part.by_base, 0.0);
    Block all{};
    for (std::size_t k = section.intervals + 1; k-- > 0;) {
      const std::size_t node = section.first_node + k;
      Block H = block_of(layout_.bodies[node], motion.nodes()[node]);
      if (is_surrounded && !motion.pulls()[node].is_idle) add_pull(H, motion.pulls()[node], factors);
      if (k == section.intervals)
        for (std::size_t i = 0; i < 36; ++i) H[i] += beyond[i];
      if (has_base)
        for (std::size_t i = 0; i < 36; ++i) all[i] += H[i];
      if (k > 0) add_product(part, part.columns.data() + k * 6 * part.stride, H, has_base);
    }
    for (; points_left > 0 && pulled_[points_left - 1].section == s; --points_left) {
      const Pulled& point = pulled_[points_left - 1];
      Block H{};
      add_pull(H, motion.point_pulls()[point.chosen], factors);
      if (has_base)
        for (std::size_t i = 0; i < 36; ++i) all[i] += H[i];
      add_product(part, point_columns_.data() + point.first, H, has_base);
    }
    if (factors.damping != 0 || factors.stiffness != 0) {
      const double *K = section.stiffness.data(), *D = section.damping.data();
      for (std::size_t j = 0; j < section.modes; ++j)
        for (auto l = static_cast<std::size_t>(section.grid.first[section.strain[j]]); l <= j; ++l)
          part.matrix[j * part.stride + l] +=
              factors.stiffness * K[j * section.modes + l] + factors.damping * D[j * section.modes + l];
    }
    if (tensions != nullptr && section.disks.empty() && !section.tendons.empty())
      add_tendons(s, motion, tensions, factors.stiffness);
    if (!factor_part(part, section.modes, has_base)) return false;
    if (!has_base) break;
    for (std::size_t r = 0; r < 6; ++r) {
      for (std::size_t c = 0; c <= r; ++c) {
        const double *a = part.by_base.data() + r * part.stride, *b = part.by_base.data() + c * part.stride;
        double sum = 0;
        for (std::size_t j = 0; j < section.modes; ++j) sum += a[j] * b[j];
        beyond[6 * r + c] = all[6 * r + c] - sum;
        beyond[6 * c + r] = beyond[6 * r + c];
      }
    }
  }
  return !is_surrounded || !motion.is_coupled() || factor_ties(motion, factors);
}

void RodMatrix::solve_sections(double* x) const {
  std::array<double, 6> along{};
  for (std::size_t s = parts_.size(); s-- > 0;) {
    const RodLayout::Section& section = layout_.sections[s];
    const Part& part = parts_[s];
    double* y = x + section.first_mode;
    const double* end = part.columns.data() + section.intervals * 6 * part.stride;
    if (s + 1 < parts_.size())
      for (std::size_t r = 0; r < 6; ++r)
        for (std::size_t j = 0; j < section.modes; ++j) y[j] += end[r * part.stride + j] * along[r];
    for (std::size_t i = 0; i < section.modes; ++i) {
      const double* row = part.matrix.data() + i * part.stride;
      double sum = y[i];
      for (std::size_t k = 0; k < i; ++k) sum -= row[k] * y[k];
      y[i] = sum * part.inverse[i];
    }
    if (s == 0) break;
    for (std::size_t r = 0; r < 6; ++r)
      for (std::size_t j = 0; j < section.modes; ++j) along[r] -= part.by_base[r * part.stride + j] * y[j];
  }
  along = {};
  for (std::size_t s = 0; s < parts_.size(); ++s) {
    const RodLayout::Section& section = layout_.sections[s];
    const Part& part = parts_[s];
    double* y = x + section.first_mode;
    if (s > 0)
      for (std::size_t r = 0; r < 6; ++r)
        for (std::size_t j = 0; j < section.modes; ++j) y[j] -= part.by_base[r * part.stride + j] * along[r];
    for (std::size_t i = section.modes; i-- > 0;) {
      y[i] *= part.inverse[i];
      const double* row = part.matrix.data() + i * part.stride;
      for (std::size_t k = 0; k < i; ++k) y[k] -= row[k] * y[i];
    }
    const double* end = part.columns.data() + section.intervals * 6 * part.stride;
    for (std::size_t r = 0; r < 6 && s + 1 < parts_.size(); ++r)
      for (std::size_t j = 0; j < section.modes; ++j) along[r] += end[r * part.stride + j] * y[j];
  }
}

Eigen::MatrixXd RodMatrix::node_columns(std::size_t node) const {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(6, static_cast<Eigen::Index>(layout_.modes));
  for (std::size_t s = 0; s < parts_.size() && layout_.sections[s].first_node <= node; ++s) {
    const RodLayout::Section& section = layout_.sections[s];
    const double* A = parts_[s].columns.data() +
                      std::min(node - section.first_node, section.intervals) * 6 * parts_[s].stride;
    for (std::size_t r = 0; r < 6; ++r)
      for (std::size_t j = 0; j < section.modes; ++j)
        J(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(section.first_mode + j)) =
            A[r * parts_[s].stride + j];
  }
  return J;
}

Eigen::MatrixXd RodMatrix::dense_mass(const RodMotion<double>& motion) const {
  const auto n = static_cast<Eigen::Index>(layout_.modes);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
  for (const RodLayout::Section& section : layout_.sections) {
    // Nodes move with the modes of their section and those before.
    const auto moving = static_cast<Eigen::Index>(section.first_mode + section.modes);
    for (std::size_t i = 0; i <= section.intervals; ++i) {
      const std::size_t node = section.first_node + i;
      const Block block = block_of(layout_.bodies[node], motion.nodes()[node]);
      const Eigen::MatrixXd J = node_columns(node).leftCols(moving);
      const Eigen::MatrixXd pushed = Eigen::Map<const Matrix6d>(block.data()) * J;
      M.topLeftCorner(moving, moving).noalias() += J.transpose() * pushed;
    }
  }
  return M;
}

Vector6d RodMatrix::tip_change(const double* x) const {
  Vector6d twist = Vector6d::Zero();
  for (std::size_t s = 0; s < parts_.size(); ++s) {
    const RodLayout::Section& section = layout_.sections[s];
    const double* A = parts_[s].columns.data() + section.intervals * 6 * parts_[s].stride;
    for (std::size_t r = 0; r < 6; ++r)
      for (std::size_t j = 0; j < section.modes; ++j)
        twist[static_cast<Eigen::Index>(r)] += A[r * parts_[s].stride + j] * x[section.first_mode + j];
  }
  return twist;
}

}  // namespace flexura

#include "flexura/control/angle_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <stdexcept>

#include "flexura/math/quadrature.h"

namespace flexura {
namespace {

// The polynomial that is 1 at nodes[i] and 0 at the others, and its slope.
double cardinal(const Eigen::VectorXd& nodes, Eigen::Index i, double s) {
  double value = 1;
  for (Eigen::Index k = 0; k < nodes.size(); ++k)
    if (k != i) value *= (s - nodes[k]) / (nodes[i] - nodes[k]);
  return value;
}
double cardinal_slope(const Eigen::VectorXd& nodes, Eigen::Index i, double s) {
  double slope = 0;
  for (Eigen::Index left_out = 0; left_out < nodes.size(); ++left_out) {
    if (left_out == i) continue;
    double part = 1 / (nodes[i] - nodes[left_out]);
    for (Eigen::Index k = 0; k < nodes.size(); ++k)
      if (k != i && k != left_out) part *= (s - nodes[k]) / (nodes[i] - nodes[k]);
    slope += part;
  }
  return slope;
}

// The function that is 1 at nodes[i] and falls linearly to 0 at its neighbours, and its slope.
double hat(const Eigen::VectorXd& nodes, Eigen::Index i, double s) {
  const bool rises = s <= nodes[i];
  const Eigen::Index other = rises ? i - 1 : i + 1;
  if (other < 0 || other >= nodes.size()) return s == nodes[i] ? 1 : 0;
  return std::max(0.0, 1 - std::abs((s - nodes[i]) / (nodes[other] - nodes[i])));
}
double hat_slope(const Eigen::VectorXd& nodes, Eigen::Index i, double s) {
  if (i > 0 && s > nodes[i - 1] && s < nodes[i]) return 1 / (nodes[i] - nodes[i - 1]);
  if (i + 1 < nodes.size() && s > nodes[i] && s < nodes[i + 1]) return -1 / (nodes[i + 1] - nodes[i]);
  return 0;
}

// Returns the nodes with the base first, whether it is one of the numbers or clamped.
Eigen::VectorXd with_base(const AngleShapes& shapes) {
  if (!shapes.is_clamped) return shapes.nodes;
  Eigen::VectorXd all(shapes.nodes.size() + 1);
  all << 0, shapes.nodes;
  return all;
}

Eigen::VectorXd node_places(const AngleShapes& shapes, int nodes) {
  const double length = std::accumulate(shapes.lengths.begin(), shapes.lengths.end(), 0.0);
  if (shapes.basis == AngleBasis::polynomial) {
    const Quadrature rule = gauss_legendre(nodes);
    Eigen::VectorXd places(nodes);
    for (Eigen::Index i = 0; i < nodes; ++i)
      places[i] = 0.5 * length * (1 + rule.nodes[static_cast<std::size_t>(i)]);
    std::ranges::sort(places);
    return places;
  }
  const auto count = static_cast<Eigen::Index>(shapes.lengths.size());
  Eigen::VectorXd ends(count + 1);
  ends[0] = 0;
  for (Eigen::Index i = 0; i < count; ++i)
    ends[i + 1] = ends[i] + shapes.lengths[static_cast<std::size_t>(i)];
  if (shapes.is_clamped) return ends.tail(count);
  return ends;
}

// Computes points, weights and running integrals, section by section.
void place_points(AngleShapes& shapes, int points) {
  const Quadrature rule = gauss_legendre(points);
  const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(rule.nodes.data(), points);
  const Eigen::VectorXd w = Eigen::Map<const Eigen::VectorXd>(rule.weights.data(), points);
  Eigen::MatrixXd inner(points, points);  // Integrals of the cardinal polynomials from -1 to x_j.
  for (Eigen::Index j = 0; j < points; ++j)
    for (Eigen::Index i = 0; i < points; ++i)
      inner(j, i) = integrate(rule, [&](double at) { return cardinal(x, i, at); }, -1, x[j]);
  const auto sections = static_cast<Eigen::Index>(shapes.lengths.size());
  const Eigen::Index count = sections * points;
  shapes.s.resize(count), shapes.weights.resize(count);
  shapes.running = Eigen::MatrixXd::Zero(count, count);
  double start = 0;
  for (Eigen::Index k = 0; k < sections; ++k) {
    const double half = 0.5 * shapes.lengths[static_cast<std::size_t>(k)];
    shapes.s.segment(k * points, points).array() = start + half * (1 + x.array());
    shapes.weights.segment(k * points, points) = half * w;
    shapes.section.insert(shapes.section.end(), static_cast<std::size_t>(points),
                          static_cast<std::size_t>(k));
    shapes.running.block(k * points, k * points, points, points) = half * inner;
    for (Eigen::Index j = (k + 1) * points; j < count; ++j)
      shapes.running.row(j).segment(k * points, points) = half * w.transpose();
    start += 2 * half;
  }
}

}  // namespace

Eigen::RowVectorXd AngleShapes::at(double at) const {
  const Eigen::VectorXd all = with_base(*this);
  const Eigen::Index first = is_clamped ? 1 : 0;
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(nodes.size() + 1);
  for (Eigen::Index i = 0; i < all.size(); ++i) {
    const double value = basis == AngleBasis::polynomial ? cardinal(all, i, at) : hat(all, i, at);
    row[i < first ? nodes.size() : i - first] = value;
  }
  return row;
}

AngleShapes angle_shapes(const std::vector<double>& lengths, AngleBasis basis, bool is_clamped, int nodes,
                         int points) {
  if (lengths.empty() || nodes < 1 || points < 1)
    throw std::invalid_argument("a distributed arm needs sections, nodes and points");
  for (const double length : lengths)
    if (!(length > 0) || !std::isfinite(length))
      throw std::invalid_argument("a section's length must be finite and above 0");
  AngleShapes shapes;
  shapes.lengths = lengths, shapes.basis = basis, shapes.is_clamped = is_clamped;
  shapes.nodes = node_places(shapes, nodes);
  place_points(shapes, points);
  const Eigen::VectorXd all = with_base(shapes);
  const Eigen::Index count = shapes.s.size(), numbers = shapes.nodes.size(), first = is_clamped ? 1 : 0;
  shapes.values.resize(count, numbers), shapes.slopes.resize(count, numbers);
  shapes.base = Eigen::VectorXd::Zero(count), shapes.base_slopes = Eigen::VectorXd::Zero(count);
  const bool is_polynomial = basis == AngleBasis::polynomial;
  for (Eigen::Index j = 0; j < count; ++j) {
    for (Eigen::Index i = 0; i < all.size(); ++i) {
      const double s = shapes.s[j];
      const double value = is_polynomial ? cardinal(all, i, s) : hat(all, i, s);
      const double slope = is_polynomial ? cardinal_slope(all, i, s) : hat_slope(all, i, s);
      (i < first ? shapes.base[j] : shapes.values(j, i - first)) = value;
      (i < first ? shapes.base_slopes[j] : shapes.slopes(j, i - first)) = slope;
    }
  }
  return shapes;
}

}  // namespace flexura

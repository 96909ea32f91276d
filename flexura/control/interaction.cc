#include "flexura/control/interaction.h"

#include <cmath>
#include <stdexcept>

namespace flexura {

PixelFeature chord_angle(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Eigen::Vector2d way = to - from;
  const double square = way.squaredNorm();
  if (!(square > 0)) throw std::domain_error("the image of a chord has no direction: its ends coincide");
  PixelFeature angle;
  angle.value = std::atan2(way.y(), way.x());
  const Eigen::RowVector2d across = Eigen::RowVector2d(-way.y(), way.x()) / square;
  angle.by_pixels << -across, across;
  return angle;
}

CurveMoments curve_moments(const Eigen::Matrix2Xd& polygon) {
  CurveMoments moments;
  curve_moments(polygon, moments);
  return moments;
}

// For a straight piece from a to b, with m = (a + b)/2, d = b - a and length l: integrals l m and l (m m^T +
// d d^T/12).
void curve_moments(const Eigen::Ref<const Eigen::Matrix2Xd>& polygon, CurveMoments& moments) {
  const Eigen::Index count = polygon.cols();
  // Sums over the pieces: of l, l m_u, l m_v, and the three second moments about the origin.
  Eigen::Vector<double, 6> sums = Eigen::Vector<double, 6>::Zero();
  auto& by_pixels = moments.by_pixels;
  by_pixels.setZero(6, 2 * count);
  // Relative to the first pixel, which preserves digits far from the image's corner.
  const Eigen::Vector2d origin = count > 0 ? Eigen::Vector2d(polygon.col(0)) : Eigen::Vector2d::Zero();
  for (Eigen::Index i = 0; i + 1 < count; ++i) {
    const Eigen::Vector2d m = 0.5 * (polygon.col(i) + polygon.col(i + 1)) - origin,
                          d = polygon.col(i + 1) - polygon.col(i);
    const double l = d.norm();
    if (!(l > 0)) continue;
    Eigen::Vector<double, 6> piece;
    piece << 1, m.x(), m.y(), m.x() * m.x() + d.x() * d.x() / 12, m.x() * m.y() + d.x() * d.y() / 12,
        m.y() * m.y() + d.y() * d.y() / 12;
    sums += l * piece;
    Eigen::Matrix<double, 6, 2> by_m = Eigen::Matrix<double, 6, 2>::Zero(), by_d = by_m;
    by_m.row(1) << l, 0;
    by_m.row(2) << 0, l;
    by_m.row(3) << 2 * l * m.x(), 0;
    by_m.row(4) << l * m.y(), l * m.x();
    by_m.row(5) << 0, 2 * l * m.y();
    by_d.row(3) << l * d.x() / 6, 0;
    by_d.row(4) << l * d.y() / 12, l * d.x() / 12;
    by_d.row(5) << 0, l * d.y() / 6;
    by_d += piece * (d / l).transpose();
    by_pixels.middleCols<2>(2 * i) += 0.5 * by_m - by_d;
    by_pixels.middleCols<2>(2 * i + 2) += 0.5 * by_m + by_d;
  }
  const double length = sums[0];
  if (!(length > 0))
    throw std::domain_error("the image of a curve has no length, so that its moments are undefined");
  const double u = sums[1] / length, v = sums[2] / length;
  moments.values << length, u, v, sums[3] / length - u * u, sums[4] / length - u * v,
      sums[5] / length - v * v;
  for (Eigen::Index row = 1; row < 6; ++row)
    by_pixels.row(row) = (by_pixels.row(row) - sums[row] / length * by_pixels.row(0)) / length;
  by_pixels.row(3) -= 2 * u * by_pixels.row(1);
  by_pixels.row(4) -= u * by_pixels.row(2) + v * by_pixels.row(1);
  by_pixels.row(5) -= 2 * v * by_pixels.row(2);
  // Moves the values back to the image's origin; the derivatives kept it fixed.
  moments.values[1] += origin.x(), moments.values[2] += origin.y();
}

}  // namespace flexura

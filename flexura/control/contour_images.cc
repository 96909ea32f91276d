#include "flexura/control/contour_images.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

constexpr double no_contour = std::numeric_limits<double>::quiet_NaN();

// The middle of opposite normals is undefined: such an edge gives no information.
Eigen::Vector2d halfway(const Eigen::Vector2d& one, const Eigen::Vector2d& other) {
  const Eigen::Vector2d both = one + other;
  return both / both.norm();
}

}  // namespace

ContourImages::ContourImages(Arm arm, const std::vector<double>& shares) : arm_(std::move(arm)) {
  for (const double share : shares) {
    const bool is_on_the_arm = share >= 0 && share <= 1;
    if (!is_on_the_arm) throw std::invalid_argument("a contour's share of the arm must be in [0, 1]");
    points_.push_back(material_point(arm_, share * arm_.length()));
  }
  rings_.resize(points_.size());
  by_.resize(6, columns());
}

void ContourImages::set(const ArmState& state) {
  backbone_.set(arm_, state);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const MaterialPoint& point = points_[i];
    const BackboneJacobian::Part& part = backbone_.parts()[point.section];
    const auto& [from, to] = arm_.sections[point.section].radius;
    const double length = part.stretch * part.rest_length;
    Ring& ring = rings_[i];
    ring.X_WS = backbone_.pose(point);
    ring.radius = from + point.fraction * (to - from);
    ring.widening = (to - from) / length;
    ring.curvature_W = ring.X_WS.rotation.leftCols<2>() * part.bend / length;
  }
}

// Let c be the ring's middle seen from the camera, t the tangent and n the direction outwards to the skin.
// The skin's normal is n - w t, with w = r'/(1 - r curvature . n). Rays touch where it is perpendicular to c
// + r n:
//   n . c = -r + w (t . c).
// w depends little on n, so a few iterations from w = r' converge.
bool ContourImages::touch(const Ring& ring, const View& view, double side, Eigen::Vector3d& arm,
                          Eigen::Vector3d& normal) {
  const auto R_CW = view.X_WC.rotation.transpose();
  const Eigen::Vector3d c = R_CW * (ring.X_WS.position - view.X_WC.position),
                        t = R_CW * ring.X_WS.rotation.col(2);
  const double along = t.dot(c);
  Eigen::Vector3d away = c - along * t;
  const double reach = away.norm();
  if (!(reach > 0)) return false;
  away /= reach;
  const Eigen::Vector3d aside = side * away.cross(t), curvature = R_CW * ring.curvature_W;
  const int rounds = ring.widening == 0 ? 1 : 12;
  double w = ring.widening;
  Eigen::Vector3d n = away;
  for (int k = 0; k < rounds; ++k) {
    const double level = (w * along - ring.radius) / reach;
    if (!(std::abs(level) < 1)) return false;
    n = level * away + std::sqrt(1 - level * level) * aside;
    if (k + 1 < rounds) w = ring.widening / (1 - ring.radius * curvature.dot(n));
  }
  arm = ring.radius * n;
  normal = n - w * t;
  return true;
}

// The skin's point has three directions of motion. Motion along the ray is invisible, and motion along the
// skin across the ray slides the curve along itself. So only motion along the skin's normal is visible.
bool ContourImages::see(const Ring& ring, const View& view, Eigen::Index i, ContourImage& image) {
  Eigen::Vector3d arm, normal;
  if (!touch(ring, view, i % 2 == 0 ? 1 : -1, arm, normal)) {
    image.pixels.col(i).setConstant(no_contour), image.normals.col(i).setConstant(no_contour);
    image.places.col(i).setConstant(no_contour), image.arms.col(i).setConstant(no_contour);
    image.slopes.col(i).setConstant(no_contour), image.slides.col(i).setConstant(no_contour);
    return true;
  }
  const Eigen::Vector3d p_CP =
      view.X_WC.rotation.transpose() * (ring.X_WS.position - view.X_WC.position) + arm;
  PointProjection projection;
  if (!view.lens.project_by_point(p_CP, projection)) return false;
  const Eigen::Vector2d way = projection.by_point * normal.cross(p_CP);
  Eigen::Vector2d across = Eigen::Vector2d(-way.y(), way.x()).normalized();
  if (across.dot(projection.by_point * normal) < 0) across = -across;
  image.pixels.col(i) = projection.pixel, image.normals.col(i) = across;
  image.places.col(i) = p_CP, image.arms.col(i) = arm;
  image.slopes.col(i) = projection.by_point.transpose() * across;
  image.slides.col(i) = projection.by_point.transpose() * Eigen::Vector2d(across.y(), -across.x());
  return true;
}

bool ContourImages::see(const View& view, ContourImage& image) const {
  image.pixels.resize(2, count()), image.normals.resize(2, count());
  image.places.resize(3, count()), image.arms.resize(3, count()), image.slopes.resize(3, count());
  image.slides.resize(3, count());
  for (std::size_t k = 0; k < rings_.size(); ++k)
    for (const Eigen::Index side : {0, 1})
      if (!see(rings_[k], view, 2 * static_cast<Eigen::Index>(k) + side, image)) return false;
  return true;
}

// NOLINTBEGIN(performance-unnecessary-value-param): an Eigen::Ref is written through.
void ContourImages::derive(const View& view, const ContourImage& image,
                           Eigen::Ref<Eigen::MatrixXd> by_state) {
  derive(view, image, image.normals, by_state);
}
// NOLINTEND(performance-unnecessary-value-param)

void ContourImages::derive(const View& view, const ContourImage& image,
                           const Eigen::Ref<const Eigen::Matrix2Xd>& directions,
                           Eigen::Ref<Eigen::MatrixXd> by_state) {
  for (std::size_t k = 0; k < points_.size(); ++k) {
    backbone_.at(points_[k], by_);
    for (const Eigen::Index side : {0, 1}) {
      const Eigen::Index i = 2 * static_cast<Eigen::Index>(k) + side;
      const Eigen::Vector2d normal = image.normals.col(i), way = directions.col(i);
      const double out = normal.dot(way), along = normal.y() * way.x() - normal.x() * way.y();
      if (!image.has(i) || !std::isfinite(out)) {
        by_state.row(i).setZero();
        continue;
      }
      const Eigen::Vector3d slope = view.X_WC.rotation *
                                    (out * image.slopes.col(i) + along * image.slides.col(i)),
                            arm = view.X_WC.rotation * image.arms.col(i);
      const Eigen::Vector3d lever = arm.cross(slope);
      for (Eigen::Index column = 0; column < by_state.cols(); ++column)
        by_state(i, column) = slope.dot(by_.block<3, 1>(0, column)) + lever.dot(by_.block<3, 1>(3, column));
    }
  }
}

void contour_error(const ContourImage& at, const Eigen::Ref<const Eigen::Matrix2Xd>& seen,
                   const Eigen::Ref<const Eigen::Matrix2Xd>& desired,
                   const Eigen::Ref<const Eigen::Matrix2Xd>& desired_normals,
                   Eigen::Ref<Eigen::VectorXd> error) {
  const Eigen::Index count = at.pixels.cols();
  if (seen.cols() != count || desired.cols() != count || desired_normals.cols() != count ||
      error.size() != count)
    throw std::invalid_argument("contours with different numbers of points cannot be compared");
  for (Eigen::Index i = 0; i < count; ++i) {
    const double off = halfway(at.normals.col(i), desired_normals.col(i)).dot(seen.col(i) - desired.col(i));
    error[i] = std::isfinite(off) ? off : 0;
  }
}

void halfway_normals(const Eigen::Ref<const Eigen::Matrix2Xd>& one,
                     const Eigen::Ref<const Eigen::Matrix2Xd>& other, Eigen::Ref<Eigen::Matrix2Xd> middle) {
  if (one.cols() != other.cols() || one.cols() != middle.cols())
    throw std::invalid_argument("normals at different numbers of points cannot be averaged");
  for (Eigen::Index i = 0; i < one.cols(); ++i) middle.col(i) = halfway(one.col(i), other.col(i));
}

}  // namespace flexura

#include "flexura/control/point_images.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "flexura/kinematics/spatial.h"

namespace flexura {
namespace {

// Power series are used below this bend of a section, rad. Beyond it the closed forms lose no significant
// digit, because terms with cancellation are multiplied by the bend.
constexpr double series_bend = 0.3;
constexpr std::size_t series_terms = 6;  // The next one is below 1e-16 of the first.
using Series = std::array<double, series_terms>;

constexpr double factorial_of(std::size_t n) {
  return n < 2 ? 1.0 : static_cast<double>(n) * factorial_of(n - 1);
}
// Coefficients of u^2k, u = ft, of the four functions of an arc over f^2, f, f^4 and f^3.
constexpr Series series_of(int which) {
  Series c{};
  for (std::size_t k = 0; k < series_terms; ++k) {
    const double sign = k % 2 == 0 ? 1 : -1;
    const auto n = static_cast<double>(2 * k + 2);
    if (which == 0) c[k] = sign / factorial_of(2 * k + 2);
    if (which == 1) c[k] = sign / factorial_of(2 * k + 1);
    if (which == 2) c[k] = -sign * n / factorial_of(2 * k + 4);
    if (which == 3) c[k] = -sign * n / factorial_of(2 * k + 3);
  }
  return c;
}
constexpr Series across_series = series_of(0), along_series = series_of(1),
                 across_slope_series = series_of(2), along_slope_series = series_of(3);

double sum_of(const Series& c, double square) {
  double sum = c.back();
  for (std::size_t k = series_terms - 1; k-- > 0;) sum = c[k] + square * sum;
  return sum;
}

using Columns23 = Eigen::Matrix<double, 2, 3>;

// Returns P with P w = G (w x p).
[[gnu::always_inline]] inline Columns23 turned(const Columns23& G, const Eigen::Vector3d& p) {
  Columns23 M;
  M.col(0) = p.y() * G.col(2) - p.z() * G.col(1);
  M.col(1) = p.z() * G.col(0) - p.x() * G.col(2);
  M.col(2) = p.x() * G.col(1) - p.y() * G.col(0);
  return M;
}

// Term by term: two rows fit into one register.
[[gnu::always_inline]] inline Eigen::Vector2d times(const Columns23& G, const Eigen::Vector3d& v) {
  return G.col(0) * v.x() + G.col(1) * v.y() + G.col(2) * v.z();
}

}  // namespace

PointImages::PointImages(Arm arm, const std::vector<double>& shares) : arm_(std::move(arm)) {
  for (const double share : shares) {
    const bool is_on_the_arm = share >= 0 && share <= 1;
    if (!is_on_the_arm) throw std::invalid_argument("a feature's share of the arm must be in [0, 1]");
    const MaterialPoint point = material_point(arm_, share * arm_.length());
    points_.push_back({point.section, point.fraction});
  }
  seen_.resize(arm_.sections.size());
}

void PointImages::place_in(Point& point, double bend) {
  const double f = point.fraction, u = f * bend;
  if (bend < series_bend) {
    const double square = u * u;
    point.across = f * f * sum_of(across_series, square);
    point.along = f * sum_of(along_series, square);
    point.across_slope = f * f * f * f * sum_of(across_slope_series, square);
    point.along_slope = f * f * f * sum_of(along_slope_series, square);
    return;
  }
  const double s = std::sin(0.5 * u), c = std::cos(0.5 * u), over = 1 / bend, over_square = over * over;
  const double versine = 2 * s * s, sine = 2 * s * c;
  point.across = versine * over_square;
  point.along = sine * over;
  point.across_slope = (u * sine - 2 * versine) * over_square * over_square;
  point.along_slope = (u * (1 - versine) - sine) * over_square * over;
}

void PointImages::set(const ArmState& state) {
  backbone_.set(arm_, state);
  std::size_t section = 0;
  double bend = backbone_.parts().front().bend.norm();
  for (Point& point : points_) {
    if (point.section != section) section = point.section, bend = backbone_.parts()[section].bend.norm();
    place_in(point, bend);
  }
}

PointImages::SeenSection PointImages::seen_base(const View& view, const BackboneJacobian::Part& part) {
  const Eigen::Matrix3d R = view.X_WC.rotation.transpose() * part.X_WS.rotation;
  SeenSection seen;
  seen.origin = view.X_WC.rotation.transpose() * (part.X_WS.position - view.X_WC.position);
  seen.x = R.col(0), seen.y = R.col(1), seen.z = R.col(2);
  return seen;
}

Eigen::Vector3d PointImages::place_in(const SeenSection& seen, const Point& point) const {
  const BackboneJacobian::Part& part = backbone_.parts()[point.section];
  const double length = part.stretch * part.rest_length, aside = length * point.across;
  return seen.origin + aside * part.bend.x() * seen.x + aside * part.bend.y() * seen.y +
         length * point.along * seen.z;
}

Eigen::Vector3d PointImages::place(Eigen::Index i) const {
  const Point& point = points_[static_cast<std::size_t>(i)];
  const Pose& X_WS = backbone_.parts()[point.section].X_WS;
  SeenSection base;
  base.origin = X_WS.position;
  base.x = X_WS.rotation.col(0), base.y = X_WS.rotation.col(1), base.z = X_WS.rotation.col(2);
  return place_in(base, point);
}

bool PointImages::see(const View& view, Eigen::Matrix2Xd& pixels) const {
  pixels.resize(2, count());
  SeenSection base;
  std::size_t section = arm_.sections.size();
  for (Eigen::Index i = 0; i < count(); ++i) {
    const Point& point = points_[static_cast<std::size_t>(i)];
    if (point.section != section) section = point.section, base = seen_base(view, backbone_.parts()[section]);
    const auto pixel = view.lens.project(place_in(base, point));
    if (!pixel) return false;
    pixels.col(i) = *pixel;
  }
  return true;
}

bool PointImages::see(const View& view, Eigen::Matrix2Xd& pixels, Eigen::Ref<Eigen::MatrixXd> by_state) {
  const auto& parts = backbone_.parts();
  const Eigen::Matrix3d R_CW = view.X_WC.rotation.transpose();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const BackboneJacobian::Part& part = parts[k];
    SeenSection& seen = seen_[k] = seen_base(view, part);
    const Eigen::Vector3d end = R_CW * (part.p_end - view.X_WC.position);
    seen.turn_x = R_CW * part.V_end.block<3, 1>(3, 0), seen.turn_y = R_CW * part.V_end.block<3, 1>(3, 1);
    seen.shift_x = R_CW * part.V_end.block<3, 1>(0, 0) - seen.turn_x.cross(end);
    seen.shift_y = R_CW * part.V_end.block<3, 1>(0, 1) - seen.turn_y.cross(end);
    seen.stretch = R_CW * part.V_end.block<3, 1>(0, 2);
  }
  pixels.resize(2, count());
  PointProjection projection;
  for (Eigen::Index i = 0; i < count(); ++i) {
    const Point& point = points_[static_cast<std::size_t>(i)];
    const BackboneJacobian::Part& part = parts[point.section];
    const SeenSection& own = seen_[point.section];
    const Eigen::Vector3d p_CP = place_in(own, point);
    if (!view.lens.project_by_point(p_CP, projection)) return false;
    pixels.col(i) = projection.pixel;
    const Columns23 &G = projection.by_point, M = turned(G, p_CP);
    Eigen::Index column = 0;
    for (std::size_t k = 0; k < point.section; ++k, column += 3) {
      const SeenSection& seen = seen_[k];
      by_state.block<2, 1>(2 * i, column) = times(G, seen.shift_x) + times(M, seen.turn_x);
      by_state.block<2, 1>(2 * i, column + 1) = times(G, seen.shift_y) + times(M, seen.turn_y);
      by_state.block<2, 1>(2 * i, column + 2) = times(G, seen.stretch);
    }
    const double length = part.stretch * part.rest_length;
    const Eigen::Vector2d by_x = times(G, own.x), by_y = times(G, own.y), by_z = times(G, own.z);
    const Eigen::Vector2d aside = part.bend.x() * by_x + part.bend.y() * by_y;
    const Eigen::Vector2d slope = length * (point.across_slope * aside + point.along_slope * by_z);
    by_state.block<2, 1>(2 * i, column) = length * point.across * by_x + part.bend.x() * slope;
    by_state.block<2, 1>(2 * i, column + 1) = length * point.across * by_y + part.bend.y() * slope;
    by_state.block<2, 1>(2 * i, column + 2) = part.rest_length * (point.across * aside + point.along * by_z);
    for (column += 3; column < by_state.cols(); ++column) by_state.block<2, 1>(2 * i, column).setZero();
  }
  return true;
}

}  // namespace flexura

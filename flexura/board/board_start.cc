#include "flexura/board/board_start.h"

#include <Eigen/LU>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/math/dense.h"

namespace flexura {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Normalises points to mean 0 and a mean square distance of 2.
Matrix3d normalization(std::span<const Vector2d> points) {
  Vector2d middle = Vector2d::Zero();
  for (const Vector2d& point : points) middle += point / static_cast<double>(points.size());
  double square = 0;
  for (const Vector2d& point : points)
    square += (point - middle).squaredNorm() / static_cast<double>(points.size());
  const double scale = square > 0 ? std::sqrt(2 / square) : 1;
  Matrix3d result;
  result << scale, 0, -scale * middle.x(), 0, scale, -scale * middle.y(), 0, 0, 1;
  return result;
}

// Returns the focal lengths for this principal point that make the homographies' columns most nearly
// orthogonal and of equal length (Zhang's constraints in 1/fx^2 and 1/fy^2).
std::optional<Vector2d> focal_lengths(std::span<const Matrix3d> homographies,
                                      const Vector2d& principal_point) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Vector2d right = Vector2d::Zero();
  Matrix3d shift = Matrix3d::Identity();
  shift.col(2).head<2>() = -principal_point;
  for (const Matrix3d& H : homographies) {
    const Matrix3d G = shift * H;
    const Vector3d sum = (G.col(0) + G.col(1)).normalized(), difference = (G.col(0) - G.col(1)).normalized(),
                   first = G.col(0).normalized(), second = G.col(1).normalized();
    for (const auto& [a, b] : {std::pair(first, second), std::pair(sum, difference)}) {
      const Vector2d row(a.x() * b.x(), a.y() * b.y());
      normal += row * row.transpose();
      right -= row * (a.z() * b.z());
    }
  }
  if (std::abs(normal.determinant()) < 1e-12 * normal.squaredNorm()) return std::nullopt;
  const Vector2d inverse_squares = normal.inverse() * right;
  if (!(inverse_squares.minCoeff() > 0) || !inverse_squares.allFinite()) return std::nullopt;
  return inverse_squares.cwiseSqrt().cwiseInverse();
}

// Returns the principal point from the image of the absolute conic without skew, B11, B22, B13, B23, B33.
std::optional<Vector2d> principal_point(std::span<const Matrix3d> homographies, const Matrix3d& scale) {
  Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
  for (const Matrix3d& H : homographies) {
    const Matrix3d G = scale * H;
    const auto product = [](const Vector3d& a, const Vector3d& b) {
      Eigen::Vector<double, 5> row;
      row << a.x() * b.x(), a.y() * b.y(), a.x() * b.z() + a.z() * b.x(), a.y() * b.z() + a.z() * b.y(),
          a.z() * b.z();
      return row;
    };
    const double size = G.col(0).norm() * G.col(1).norm();
    for (const Eigen::Vector<double, 5>& row :
         {Eigen::Vector<double, 5>(product(G.col(0), G.col(1)) / size),
          Eigen::Vector<double, 5>((product(G.col(0), G.col(0)) - product(G.col(1), G.col(1))) / size)})
      normal += row * row.transpose();
  }
  const auto [values, vectors] = symmetric_eigen(normal);
  const Eigen::Vector<double, 5> conic = vectors.col(0);
  // Two directions are equally good: the boards do not determine the principal point.
  if (values[1] < 1e-9 * values[4]) return std::nullopt;
  if (!(conic[0] * conic[1] > 0)) return std::nullopt;
  const Vector3d normalized(-conic[2] / conic[0], -conic[3] / conic[1], 1);
  return (scale.inverse() * normalized).hnormalized();
}

}  // namespace

std::optional<Matrix3d> board_homography(std::span<const Vector2d> all_points,
                                         std::span<const Vector2d> all_pixels) {
  std::vector<Vector2d> points, pixels;
  for (std::size_t i = 0; i < all_pixels.size(); ++i)
    if (all_pixels[i].allFinite()) points.push_back(all_points[i]), pixels.push_back(all_pixels[i]);
  constexpr std::size_t least = 4;
  if (points.size() < least) return std::nullopt;
  const Matrix3d from = normalization(points), to = normalization(pixels);
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d p = from * points[i].homogeneous(), q = to * pixels[i].homogeneous();
    Eigen::Matrix<double, 2, 9> rows;
    rows << p.transpose(), Vector3d::Zero().transpose(), -q.x() * p.transpose(),  //
        Vector3d::Zero().transpose(), p.transpose(), -q.y() * p.transpose();
    normal += rows.transpose() * rows;
  }
  const auto [values, vectors] = symmetric_eigen(normal);
  if (!(values[1] > 1e-10 * values[8])) return std::nullopt;
  const Eigen::Vector<double, 9> h = vectors.col(0);
  Matrix3d normalized;
  normalized << h.head<3>().transpose(), h.segment<3>(3).transpose(), h.tail<3>().transpose();
  Matrix3d H = to.inverse() * normalized * from;
  H /= H.norm();
  // The first point is in front of the camera.
  if (H.row(2).dot(points.front().homogeneous()) < 0) H = -H;
  if (!H.allFinite()) return std::nullopt;
  return H;
}

Intrinsics start_lens(std::span<const Matrix3d> homographies, int width, int height) {
  const double size = std::max(width, height);
  const Vector2d middle(0.5 * (width - 1), 0.5 * (height - 1));
  Matrix3d scale = Matrix3d::Identity() / size;
  scale.col(2) = Vector3d(-middle.x() / size, -middle.y() / size, 1);
  std::optional<Vector2d> focal;
  Vector2d center = middle;
  // Distortion and noise shift a weakly determined principal point far away: it must be in the middle half.
  const auto determined = principal_point(homographies, scale);
  if (determined && std::abs(determined->x() - middle.x()) < 0.25 * width &&
      std::abs(determined->y() - middle.y()) < 0.25 * height) {
    focal = focal_lengths(homographies, *determined);
    if (focal) center = *determined;
  }
  if (!focal) focal = focal_lengths(homographies, middle);
  constexpr double widest = 0.2, longest = 50;  // In the image's size.
  if (!focal || focal->minCoeff() < widest * size || focal->maxCoeff() > longest * size) {
    const double guess = 0.5 * size / std::tan(25 * degree);
    return {.fx = guess, .fy = guess, .cx = middle.x(), .cy = middle.y()};
  }
  return {.fx = focal->x(), .fy = focal->y(), .cx = center.x(), .cy = center.y()};
}

std::optional<Pose> start_pose(const Lens& lens, std::span<const Vector2d> points,
                               std::span<const Vector2d> pixels) {
  std::vector<Vector2d> normalized;
  for (const Vector2d& pixel : pixels) {
    if (!pixel.allFinite()) {
      normalized.push_back(pixel);
      continue;
    }
    const auto direction = lens.unproject(pixel);
    if (!direction) return std::nullopt;
    normalized.push_back(*direction);
  }
  const auto H = board_homography(points, normalized);
  if (!H) return std::nullopt;
  const double scale = 2 / (H->col(0).norm() + H->col(1).norm());
  Matrix3d axes;
  axes << scale * H->col(0), scale * H->col(1), (scale * H->col(0)).cross(scale * H->col(1));
  constexpr double parallel = 1e-6;  // A board seen as a line; its rotation about it is arbitrary.
  if (!(axes.col(2).norm() > parallel)) return std::nullopt;
  const Matrix3d R_CB = nearest_rotation(axes);
  if (!R_CB.allFinite()) return std::nullopt;
  return Pose{R_CB, scale * H->col(2)};
}

}  // namespace flexura

#include "flexura/board/board_bundle.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "flexura/math/dense.h"
#include "flexura/math/levenberg_marquardt.h"
#include "flexura/math/small_cholesky.h"
#include "flexura/math/so3.h"

namespace flexura {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

using Vector6 = Eigen::Vector<double, 6>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Pose moved(const Pose& pose, const Vector6& twist) {
  return {so3_exp(twist.tail<3>()) * pose.rotation, pose.position + twist.head<3>()};
}

// Moves the first values of a lens by a step.
Intrinsics moved(const Intrinsics& lens, const VectorXd& step) {
  const auto part = [&](Index i) { return i < step.size() ? step[i] : 0.0; };
  Intrinsics result = lens;
  result.fx += part(0), result.fy += part(1), result.cx += part(2), result.cy += part(3);
  for (std::size_t i = 0; i < result.distortion.size(); ++i)
    result.distortion[i] += part(4 + static_cast<Index>(i));
  return result;
}

// Returns lenses ready to project; empty if a value is invalid.
std::optional<std::vector<Lens>> lenses_of(const BoardBundle& bundle) {
  std::vector<Lens> lenses;
  for (const Intrinsics& lens : bundle.lenses) {
    const bool is_lens =
        lens.fx > 0 && lens.fy > 0 && std::isfinite(lens.fx + lens.fy + lens.cx + lens.cy) &&
        std::ranges::all_of(lens.distortion, [](double part) { return std::isfinite(part); });
    if (!is_lens) return std::nullopt;
    lenses.emplace_back(lens);
  }
  return lenses;
}

// The unknowns of all views and their normal equations: of the cameras (A), of each board (D), and between
// the two (B).
class NormalEquations {
 public:
  NormalEquations(std::span<const Vector2d> points, std::span<const BoardView> views,
                  const BundleConfig& config, std::size_t cameras)
      : points_(points),
        views_(views),
        lens_size_(config.cameras ? 4 + config.distortion : 0),
        pose_size_(config.cameras ? 6 : 0) {
    const auto count = static_cast<Index>(cameras);
    const Index size = count * lens_size_ + (count - 1) * pose_size_;
    A_.resize(size, size), cameras_right_.resize(size);
    B_.assign(views.size(), MatrixXd(size, 6));
    D_.resize(views.size()), boards_right_.resize(views.size());
  }

  [[nodiscard]] Index lens_size() const { return lens_size_; }
  [[nodiscard]] Index lens_at(std::size_t camera) const { return static_cast<Index>(camera) * lens_size_; }
  // Of a camera other than the first.
  [[nodiscard]] Index pose_at(std::size_t camera, std::size_t cameras) const {
    return lens_at(cameras) + (static_cast<Index>(camera) - 1) * pose_size_;
  }

  // Returns false if a lens does not show a point.
  bool linearize(const BoardBundle& bundle) {
    const auto lenses = lenses_of(bundle);
    if (!lenses) return false;
    A_.setZero(), cameras_right_.setZero();
    for (std::size_t view = 0; view < views_.size(); ++view) {
      B_[view].setZero(), D_[view].setZero(), boards_right_[view].setZero();
      for (std::size_t camera = 0; camera < lenses->size(); ++camera)
        if (!views_[view].pixels[camera].empty() && !add(bundle, (*lenses)[camera], camera, view))
          return false;
    }
    return true;
  }

  // Computes the steps of the cameras' unknowns and of each board's, with Marquardt's damping; returns false
  // on failure.
  bool solve(double damping, VectorXd& cameras, std::vector<Vector6>& boards) {
    reduced_ = A_;
    reduced_.diagonal() *= 1 + damping;
    // Unknowns that no view determines stay fixed.
    for (double& entry : reduced_.diagonal())
      if (entry == 0) entry = 1;
    cameras = cameras_right_;
    boards.resize(views_.size());
    for (std::size_t view = 0; view < views_.size(); ++view) {
      Matrix6 D = D_[view];
      D.diagonal() *= 1 + damping;
      const Cholesky factor(D);
      if (!factor.is_definite()) return false;
      boards[view] = factor.solve(boards_right_[view]);
      if (cameras.size() == 0) continue;
      const Eigen::Matrix<double, 6, Eigen::Dynamic> through = factor.solve(B_[view].transpose());
      reduced_.noalias() -= B_[view] * through;
      cameras.noalias() -= B_[view] * boards[view];
    }
    if (cameras.size() == 0) return true;
    const Cholesky factor(reduced_);
    if (!factor.is_definite()) return false;
    factor.solve_in_place(cameras);
    for (std::size_t view = 0; view < views_.size(); ++view) {
      Matrix6 D = D_[view];
      D.diagonal() *= 1 + damping;
      boards[view] -= solve_definite<6>(D, B_[view].transpose() * cameras);
    }
    return cameras.allFinite();
  }

  // Infinite if a lens does not show a point.
  [[nodiscard]] double square_sum(const BoardBundle& bundle) const {
    constexpr double nowhere = std::numeric_limits<double>::infinity();
    if (!lenses_of(bundle)) return nowhere;
    double sum = 0;
    for (std::size_t view = 0; view < views_.size(); ++view) {
      for (std::size_t camera = 0; camera < bundle.lenses.size(); ++camera) {
        const auto part = flexura::square_sum(points_, views_[view], bundle, camera, bundle.boards[view]);
        if (!part) return nowhere;
        sum += *part;
      }
    }
    return std::isfinite(sum) ? sum : nowhere;
  }

  // Of the last linearisation, undamped.
  [[nodiscard]] MatrixXd information() const {
    MatrixXd result = A_;
    for (std::size_t view = 0; result.size() > 0 && view < views_.size(); ++view)
      result -= B_[view] * Cholesky(D_[view]).solve(B_[view].transpose());
    return result;
  }

 private:
  bool add(const BoardBundle& bundle, const Lens& lens, std::size_t camera, std::size_t view) {
    const auto rows = 2 * static_cast<Index>(points_.size());
    const Index own = lens_size_ + (camera > 0 ? pose_size_ : 0);
    J_.resize(rows, own + 6), error_.resize(rows);
    const Pose &X_1B = bundle.boards[view], &X_1C = bundle.cameras[camera];
    const Eigen::Matrix3d R_C1 = X_1C.rotation.transpose();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto row = 2 * static_cast<Index>(i);
      if (!is_seen(views_[view].pixels[camera][i])) {
        J_.middleRows<2>(row).setZero(), error_.segment<2>(row).setZero();
        continue;
      }
      const Vector3d arm = X_1B.rotation.leftCols<2>() * points_[i],
                     p_CP_1 = X_1B.position + arm - X_1C.position;
      const auto projection = lens.project_with_derivatives(R_C1 * p_CP_1);
      if (!projection) return false;
      const Eigen::Matrix<double, 2, 3> by_point = projection->by_point * R_C1;
      J_.block(row, 0, 2, lens_size_) = projection->by_intrinsics.leftCols(lens_size_);
      if (own > lens_size_) {
        J_.block<2, 3>(row, lens_size_) = -by_point;
        J_.block<2, 3>(row, lens_size_ + 3).noalias() = by_point * skew(p_CP_1);
      }
      J_.block<2, 3>(row, own) = by_point;
      J_.block<2, 3>(row, own + 3).noalias() = -by_point * skew(arm);
      error_.segment<2>(row) = views_[view].pixels[camera][i] - projection->pixel;
    }
    normal_.setZero(own + 6, own + 6);
    normal_.selfadjointView<Eigen::Upper>().rankUpdate(J_.transpose());
    normal_.triangularView<Eigen::StrictlyLower>() = normal_.transpose();
    right_.noalias() = J_.transpose() * error_;
    scatter(camera, view, bundle.cameras.size(), own);
    return true;
  }

  // Adds one camera's part of one view.
  void scatter(std::size_t camera, std::size_t view, std::size_t cameras, Index own) {
    std::array<std::array<Index, 3>, 2> parts{};  // From, to, size.
    std::size_t count = 0;
    if (lens_size_ > 0) parts[count++] = {0, lens_at(camera), lens_size_};
    if (own > lens_size_) parts[count++] = {lens_size_, pose_at(camera, cameras), pose_size_};
    for (std::size_t i = 0; i < count; ++i) {
      const auto [from, to, size] = parts[i];
      for (std::size_t j = 0; j < count; ++j)
        A_.block(to, parts[j][1], size, parts[j][2]) += normal_.block(from, parts[j][0], size, parts[j][2]);
      B_[view].middleRows(to, size) += normal_.block(from, own, size, 6);
      cameras_right_.segment(to, size) += right_.segment(from, size);
    }
    D_[view] += normal_.bottomRightCorner<6, 6>();
    boards_right_[view] += right_.tail<6>();
  }

  std::span<const Vector2d> points_;
  std::span<const BoardView> views_;
  Index lens_size_, pose_size_;
  MatrixXd A_, reduced_, J_, normal_;
  VectorXd cameras_right_, error_, right_;
  std::vector<MatrixXd> B_;
  std::vector<Matrix6> D_;
  std::vector<Vector6> boards_right_;
};

BoardBundle moved(const BoardBundle& bundle, const NormalEquations& equations, const VectorXd& cameras,
                  const std::vector<Vector6>& boards) {
  BoardBundle result = bundle;
  for (std::size_t i = 0; i < bundle.lenses.size() && cameras.size() > 0; ++i) {
    result.lenses[i] = moved(bundle.lenses[i], cameras.segment(equations.lens_at(i), equations.lens_size()));
    if (i > 0)
      result.cameras[i] =
          moved(bundle.cameras[i], cameras.segment<6>(equations.pose_at(i, bundle.lenses.size())));
  }
  for (std::size_t i = 0; i < boards.size(); ++i) result.boards[i] = moved(bundle.boards[i], boards[i]);
  return result;
}

}  // namespace

std::size_t seen_points(std::span<const Vector2d> pixels) {
  return static_cast<std::size_t>(std::ranges::count_if(pixels, is_seen));
}

std::optional<double> square_sum(std::span<const Vector2d> points, const BoardView& view,
                                 const BoardBundle& bundle, std::size_t camera, const Pose& X_1B) {
  if (view.pixels[camera].empty()) return 0;
  const Lens lens(bundle.lenses[camera]);
  const Pose X_CB = bundle.cameras[camera].inverse() * X_1B;
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_seen(view.pixels[camera][i])) continue;
    const auto pixel = lens.project(X_CB.position + X_CB.rotation.leftCols<2>() * points[i]);
    if (!pixel) return std::nullopt;
    sum += (*pixel - view.pixels[camera][i]).squaredNorm();
  }
  return sum;
}

BundleFit fit_bundle(std::span<const Vector2d> points, std::span<const BoardView> views,
                     const BoardBundle& start, const BundleConfig& config) {
  BundleFit fit;
  fit.bundle = start;
  NormalEquations equations(points, views, config, start.lenses.size());
  const double first = equations.square_sum(start);
  if (!std::isfinite(first) || !equations.linearize(start)) return fit;
  fit.square_sum = first, fit.steps = 1;
  for (const BoardView& view : views)
    for (const auto& pixels : view.pixels) fit.points += seen_points(pixels);
  bool is_shown = true;  // Whether the equations are those of fit.bundle.
  BoardBundle tried;
  VectorXd cameras;
  std::vector<Vector6> boards;
  const auto try_step = [&](double damping) -> TriedStep {
    ++fit.steps;
    if (!equations.solve(damping, cameras, boards)) return {};
    tried = moved(fit.bundle, equations, cameras, boards);
    return {.cost = equations.square_sum(tried)};
  };
  const auto keep = [&](const TriedStep& step, double& cost) {
    const bool is_small = cost - step.cost <= config.least_gain * cost ||
                          step.cost < config.exact * static_cast<double>(fit.points);
    std::swap(fit.bundle, tried);
    cost = fit.square_sum = step.cost;
    is_shown = equations.linearize(fit.bundle);
    fit.is_converged = is_small && is_shown;
    return is_small || !is_shown;
  };
  // When only rounding is left, no step is better.
  const auto leave = [&](const TriedStep& step, double cost) {
    return fit.is_converged = step.cost <= cost * (1 + config.least_gain);
  };
  const auto eased = [](double damping, double) { return std::max(0.01 * damping, 1e-9); };
  levenberg_marquardt(first, {.eased = eased}, config.most_steps - 1, try_step, keep, leave);
  if (!is_shown) return fit;
  fit.information = equations.information();
  fit.unknowns = static_cast<std::size_t>(fit.information.rows()) + 6 * views.size();
  return fit;
}

}  // namespace flexura

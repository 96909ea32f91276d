#include "flexura/calibrate/arc_fit.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "flexura/kinematics/spatial.h"
#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

constexpr double bend_sigma = 0.01, length_sigma = 0.005;

Eigen::Matrix3d cross_of(const Eigen::Vector3d& p) {
  Eigen::Matrix3d m;
  m << 0, -p.z(), p.y(), p.z(), 0, -p.x(), -p.y(), p.x(), 0;
  return m;
}

// x: of each mount a motion [v; w] in its own frame since the pose held here, then each section's bend gain
// and length: the logarithms of their factors.
class ArcProblem {
 public:
  ArcProblem(const Arm& arm, const std::array<Intrinsics, 2>& lenses, const std::vector<ArcPicture>& pictures,
             const std::array<Pose, 2>& start)
      : arm_(arm),
        lenses_{Lens(lenses[0]), Lens(lenses[1])},
        pictures_(pictures),
        poses_(start),
        wrong_(Eigen::VectorXd::Zero(2 * sections())) {}

  [[nodiscard]] Eigen::Index sections() const { return static_cast<Eigen::Index>(arm_.sections.size()); }
  [[nodiscard]] Eigen::Index size() const { return 12 + 2 * sections(); }
  [[nodiscard]] const std::array<Pose, 2>& poses() const { return poses_; }

  void move(const Eigen::VectorXd& x) {
    for (std::size_t i = 0; i < 2; ++i) {
      const auto part = x.segment<6>(6 * static_cast<Eigen::Index>(i));
      Pose& pose = poses_[i];
      pose.position += pose.rotation * part.head<3>();
      pose.rotation = pose.rotation * so3_exp(part.tail<3>());
    }
    wrong_ += x.tail(2 * sections());
  }

  // Half the robust sum of squares, and where asked for its gradient and normal matrix. `bound` in px.
  double sum(double bound, Eigen::VectorXd* gradient, Eigen::MatrixXd* normal,
             std::vector<double>* misses = nullptr) const {
    if (gradient != nullptr) *gradient = Eigen::VectorXd::Zero(size()), normal->setZero(size(), size());
    double total = 0;
    for (const ArcPicture& picture : pictures_) {
      for (const SeenMarker& marker : picture.markers) {
        const Eigen::Vector3d p_W = point(picture.state, marker.s, wrong_);
        const Pose& pose = poses_[picture.camera];
        const Eigen::Vector3d p_M = pose.inverse() * p_W;
        const Eigen::Vector3d p_C = picture.X_MC.inverse() * p_M;
        const auto seen = lenses_[picture.camera].project_with_derivatives(p_C);
        constexpr double nowhere = 1e3;  // px
        if (!seen) {
          total += nowhere * bound;
          continue;
        }
        const Eigen::Vector2d miss = seen->pixel - marker.pixel;
        const double size_of = miss.norm();
        if (misses != nullptr) misses->push_back(size_of);
        const double weight = size_of <= bound ? 1 : bound / size_of;
        total += size_of <= bound ? 0.5 * size_of * size_of : bound * (size_of - 0.5 * bound);
        if (gradient == nullptr) continue;
        const Eigen::MatrixXd row =
            derivative(picture, marker.s, pose, p_M, seen->by_point * picture.X_MC.rotation.transpose());
        *gradient += weight * row.transpose() * miss;
        *normal += weight * row.transpose() * row;
      }
    }
    // What is wrong with the arm, in units of a marker's standard deviation.
    for (Eigen::Index j = 0; j < 2 * sections(); ++j) {
      const double scale = marker_sigma / (j < sections() ? bend_sigma : length_sigma);
      total += 0.5 * scale * scale * wrong_[j] * wrong_[j];
      if (gradient == nullptr) continue;
      (*gradient)[12 + j] += scale * scale * wrong_[j];
      (*normal)(12 + j, 12 + j) += scale * scale;
    }
    return total;
  }
  static constexpr double marker_sigma = 0.2;  // px

 private:
  [[nodiscard]] Eigen::Vector3d point(const ArmState& commanded, double s,
                                      const Eigen::VectorXd& wrong) const {
    Arm arm = arm_;
    ArmState state = commanded;
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      const auto j = static_cast<Eigen::Index>(i);
      state.bends[i] *= factor(wrong[j]);
      arm.sections[i].length *= factor(wrong[sections() + j]);
    }
    const MaterialPoint place = material_point(arm_, s);
    return Backbone(arm, state).pose(arc_length_of(arm, state, place)).position;
  }
  // Steps of a descent may be wild; an arm that is wrong by more is none that was asked about.
  static double factor(double wrong) {
    constexpr double most = 0.3;
    return std::exp(std::clamp(wrong, -most, most));
  }
  [[nodiscard]] Eigen::MatrixXd derivative(const ArcPicture& picture, double s, const Pose& pose,
                                           const Eigen::Vector3d& p_M,
                                           const Eigen::Matrix<double, 2, 3>& by_point) const {
    Eigen::MatrixXd row = Eigen::MatrixXd::Zero(2, size());
    const auto first = 6 * static_cast<Eigen::Index>(picture.camera);
    row.middleCols<3>(first) = -by_point;
    row.middleCols<3>(first + 3) = by_point * cross_of(p_M);
    constexpr double step = 1e-6;
    for (Eigen::Index j = 0; j < 2 * sections(); ++j) {
      Eigen::VectorXd more = wrong_, less = wrong_;
      more[j] += step, less[j] -= step;
      const Eigen::Vector3d by = (point(picture.state, s, more) - point(picture.state, s, less)) / (2 * step);
      row.col(12 + j) = by_point * (pose.rotation.transpose() * by);
    }
    return row;
  }

  const Arm& arm_;
  std::array<Lens, 2> lenses_;
  const std::vector<ArcPicture>& pictures_;
  std::array<Pose, 2> poses_;
  Eigen::VectorXd wrong_;
};

// Descends; whether it came to rest.
bool descend(ArcProblem& problem, double bound, Eigen::MatrixXd& normal) {
  constexpr int most = 60;
  double damping = 1e-3;
  Eigen::VectorXd gradient;
  double at = problem.sum(bound, &gradient, &normal);
  for (int i = 0; i < most; ++i) {
    Eigen::MatrixXd damped = normal;
    damped.diagonal() *= 1 + damping;
    const Eigen::VectorXd x = -damped.ldlt().solve(gradient);
    ArcProblem moved = problem;
    moved.move(x);
    const double next = moved.sum(bound, nullptr, nullptr);
    constexpr double rest = 1e-10, stiffest = 1e12;
    if (next <= at) {
      // Copied part by part: the problem holds references.
      problem.move(x);
      const bool is_at_rest = at - next <= rest * at || x.norm() < rest;
      at = problem.sum(bound, &gradient, &normal);
      damping = std::max(1e-9, 0.2 * damping);
      if (is_at_rest) return true;
    } else {
      damping *= 8;
      if (damping > stiffest) return true;
    }
  }
  return false;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

ArcFit fit_arcs(const Arm& arm, const std::array<Intrinsics, 2>& lenses,
                const std::vector<ArcPicture>& pictures, const std::array<Pose, 2>& start) {
  ArcFit fit;
  ArcProblem problem(arm, lenses, pictures, start);
  Eigen::MatrixXd normal;
  constexpr std::size_t fewest = 8;  // Markers that make two poses.
  // What is far off at first is not wrong; later on it is.
  for (const double least : {20.0, 3.0, 1.0}) {
    std::vector<double> misses;
    (void)problem.sum(least, nullptr, nullptr, &misses);
    if (misses.size() < fewest) break;
    (void)descend(problem, std::max(least, 2 * median_of(std::move(misses))), normal);
  }
  std::vector<double> misses;
  (void)problem.sum(1, nullptr, nullptr, &misses);
  if (misses.size() < fewest || normal.size() == 0) {
    fit.reason = fmt::format("only {} markers are seen in all pictures", misses.size());
    return fit;
  }
  double squares = 0;
  for (const double miss : misses) squares += miss * miss;
  fit.rms = std::sqrt(squares / static_cast<double>(misses.size()));
  constexpr double wrong = 3;  // px
  if (median_of(misses) > wrong)
    fit.reason = fmt::format("no two cameras explain the markers: half of them are more than {:.1f} px off",
                             median_of(misses));
  fit.X_WM = problem.poses();
  const Eigen::MatrixXd covariance =
      normal.ldlt().solve(Eigen::MatrixXd::Identity(normal.rows(), normal.cols())) *
      (ArcProblem::marker_sigma * ArcProblem::marker_sigma);
  for (std::size_t i = 0; i < 2; ++i) {
    // A turn about W's Y is the mount's own about that axis in its frame.
    const Eigen::Vector3d axis = fit.X_WM[i].rotation.transpose() * Eigen::Vector3d::UnitY();
    const auto block =
        covariance.block<3, 3>(6 * static_cast<Eigen::Index>(i) + 3, 6 * static_cast<Eigen::Index>(i) + 3);
    fit.turn_sigma[i] = std::sqrt(axis.dot(block * axis));
  }
  return fit;
}

}  // namespace flexura

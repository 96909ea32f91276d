#include "flexura/calibrate/rig_calibration.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "flexura/calibrate/rig_descent.h"
#include "flexura/math/arrays.h"
#include "flexura/math/dense.h"
#include "flexura/math/median.h"
#include "flexura/math/so3.h"

namespace flexura {
namespace {

// Returns the observations without axis points, since the others are already identified. Returns all if there
// are no others.
RigObservations marked(const RigObservations& seen) {
  RigObservations marked = seen;
  std::size_t count = 0;
  for (RigImage& image : marked.images) image.points.clear(), count += image.things();
  return count > 0 ? marked : seen;
}

// Frees or holds the columns of `count` slots from `first` on, for all cameras.
void free_slots(const RigVariables& variables, Eigen::Index first, Eigen::Index count,
                std::vector<bool>& is_free, bool free = true) {
  for (std::size_t camera = 0; camera < variables.guess().cameras.size(); ++camera) {
    for (Eigen::Index i = first; i < first + count; ++i) {
      const Eigen::Index column =
          variables.column(variables.camera_slots(camera) + static_cast<std::size_t>(i));
      if (column >= 0) is_free[static_cast<std::size_t>(column)] = free;
    }
  }
}

// A changed guess: each camera's distance from the arm base is scaled by `nearer`. The camera is rotated
// about the vertical through the base by `turn`, facing it as before.
struct Detour {
  double nearer = 1, turn = 0;
};

Eigen::VectorXd start_of(const RigVariables& variables, const Detour& detour) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(variables.count());
  const Eigen::Vector3d turn(0, detour.turn, 0);
  for (std::size_t i = 0; i < variables.guess().cameras.size(); ++i) {
    const Eigen::Vector3d& base = variables.guess().arm.X_WB.position;
    const Eigen::Vector3d way = vector(variables.guess().cameras[i].mount.position) - base;
    const Eigen::Vector3d move = detour.nearer * (so3_exp(turn) * way) - way;
    for (Eigen::Index j = 0; j < 3; ++j) {
      const auto set = [&](Eigen::Index slot, double value) {
        const Eigen::Index column =
            variables.column(variables.camera_slots(i) + static_cast<std::size_t>(slot + j));
        if (column >= 0) x[column] = value;
      };
      set(mount_position_slot, move[j]), set(mount_rotation_slot, turn[j]);
    }
  }
  return x;
}

// Fits first where the cameras look, then their positions, then their focal lengths, then everything. Coarse
// errors go first, so that the arm is not bent to compensate for a camera.
RigDescent approach(RigProblem& coarse, RigProblem& problem, const Detour& detour,
                    const RigCalibrationConfig& config) {
  const RigVariables& variables = problem.variables();
  RigDescentConfig descent;
  descent.bound = config.linear_beyond, descent.most_iterations = config.most_iterations;
  RigDescent result{.x = start_of(variables, detour)};
  int iterations = 0;
  const auto go = [&](RigProblem& on) {
    result = descend(on, result.x, descent);
    iterations += result.iterations;
  };
  descent.is_free.assign(static_cast<std::size_t>(variables.count()), false);
  constexpr std::array<std::array<Eigen::Index, 2>, 3> stages = {
      {{mount_rotation_slot, 3}, {mount_position_slot, 3}, {focal_slot, 1}}};
  constexpr int enough = 15;  // Iterations towards an intermediate minimum.
  descent.most_iterations = std::min(enough, config.most_iterations);
  for (const auto& [first, count] : stages) {
    free_slots(variables, first, count, descent.is_free);
    go(coarse);
  }
  descent.most_iterations = config.most_iterations;
  // A few markers may fit a distortion that makes the lens unable to show the arm outside the picture.
  descent.is_free.assign(static_cast<std::size_t>(variables.count()), true);
  constexpr auto of_distortion = static_cast<Eigen::Index>(Distortion::most);
  free_slots(variables, distortion_slot, of_distortion, descent.is_free, false);
  go(coarse);
  descent.is_free.clear();
  go(problem);
  descent.does_bound_rise = false;
  go(problem);
  result.iterations = iterations;
  return result;
}

Eigen::MatrixXd covariance_of(const RigProblem& problem, double bound) {
  const RigVariables& variables = problem.variables();
  Eigen::VectorXd gradient, scales(variables.count());
  Eigen::MatrixXd normal;
  problem.normal(bound, gradient, normal);
  for (Eigen::Index i = 0; i < scales.size(); ++i) scales[i] = variables.variable(i).scale;
  const Eigen::MatrixXd whole = normal.selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd scaled = scales.asDiagonal() * whole * scales.asDiagonal();
  const Cholesky factors(scaled);
  constexpr double dependent = 1e-13;
  Eigen::MatrixXd inverse;
  if (factors.is_definite() && factors.rcond() > dependent) {
    inverse = factors.inverse();
  } else {
    // Undetermined directions get a variance larger than all others.
    const auto [values, vectors] = symmetric_eigen(scaled);
    const double least = dependent * values.maxCoeff();
    const auto unknown = [&](double value) { return value > least ? 1 / value : 1 / (dependent * least); };
    inverse = vectors * values.unaryExpr(unknown).asDiagonal() * vectors.transpose();
  }
  return scales.asDiagonal() * inverse * scales.asDiagonal();
}

double scale_of(const RigProblem& problem, const Eigen::VectorXd& x) {
  double sum = problem.rms() * problem.rms() * static_cast<double>(problem.entries());
  auto freedom = static_cast<double>(problem.entries());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double off = x[i] / problem.variables().variable(i).sigma;
    sum += off * off;
    freedom -= std::isfinite(problem.variables().variable(i).sigma) ? 0 : 1;
  }
  return freedom > 0 ? std::max(1.0, std::sqrt(sum / freedom)) : 1.0;
}

void judge(const RigProblem& problem, const RigDescent& descent, const RigCalibrationConfig& config,
           RigCalibration& result) {
  constexpr double max_outlier_share = 0.3;
  const auto outlier_count = static_cast<double>(result.outliers.size());
  const double all = outlier_count + static_cast<double>(problem.sizes().size());
  if (!(all > 0)) {
    result.reason = "there are no observations";
  } else if (!std::isfinite(descent.cost)) {
    result.reason = "from the initially assumed poses, no camera could see the observed points";
  } else if (!(outlier_count <= max_outlier_share * all)) {
    result.reason = fmt::format("no rig near the initial guess explains {:.0f} % of the observations",
                                100 * outlier_count / all);
  } else if (!(result.rms <= config.most_rms)) {
    result.reason = fmt::format("the residuals of the observations are {:.1f} times their noise", result.rms);
  } else if (!descent.is_settled) {
    result.reason = fmt::format("the fit did not converge in {} iterations", result.iterations);
  }
  result.is_found = result.reason.empty();
}

// Excludes outliers and fits again, until they no longer change.
RigDescent without_outliers(RigProblem& problem, RigDescent found, const RigCalibrationConfig& config) {
  RigDescentConfig descent;
  descent.bound = config.linear_beyond, descent.most_iterations = config.most_iterations;
  descent.does_bound_rise = false;
  constexpr int most = 8;
  for (int round = 0; round < most && std::isfinite(found.cost); ++round) {
    if (!problem.exclude_beyond(config.outlier_beyond)) break;
    const int before = found.iterations;
    found = descend(problem, found.x, descent);
    found.iterations += before;
  }
  return found;
}

// Up to half of the observations may be outliers if the fit is still clearly the right one.
bool is_clear(const RigProblem& problem, const RigDescent& found, const RigCalibrationConfig& config) {
  std::vector<double> sizes = problem.sizes();
  if (!std::isfinite(found.cost) || sizes.empty()) return false;
  return median(std::span(sizes)) < config.most_rms;
}

}  // namespace

RigCalibration calibrate_rig(RigProblem& problem, const RigCalibrationConfig& config) {
  constexpr std::array<Detour, 7> detours = {
      {{}, {0.8, 0}, {1.25, 0}, {1, 0.3}, {1, -0.3}, {0.8, 0.15}, {0.8, -0.15}}};
  const RigVariables& variables = problem.variables();
  RigProblem coarse(variables.guess(), problem.prior(), marked(problem.observations()));
  RigCalibration result;
  RigDescent best;
  problem.include_all();
  for (const Detour& detour : detours) {
    RigDescent found = approach(coarse, problem, detour, config);
    ++result.starts, result.iterations += found.iterations;
    const bool is_last = is_clear(problem, found, config);
    if (result.starts == 1 || found.cost < best.cost) best = std::move(found);
    if (is_last) break;
  }
  (void)problem.choose_rims(best.x);
  (void)problem.linearise(best.x);
  best = without_outliers(problem, std::move(best), config);
  result.x = best.x, result.outliers = problem.outliers();
  result.model = variables.model(result.x);
  for (std::size_t i = 0; i < variables.commanded().size(); ++i)
    result.poses.push_back(variables.pose(result.x, i));
  for (std::size_t i = 0; i < variables.read().size(); ++i)
    result.stances.push_back(variables.stance(result.x, i));
  if (std::isfinite(best.cost)) {
    result.rms = problem.rms(), result.scale = scale_of(problem, result.x);
    result.covariance = result.scale * result.scale * covariance_of(problem, config.linear_beyond);
  }
  judge(problem, best, config, result);
  return result;
}

}  // namespace flexura

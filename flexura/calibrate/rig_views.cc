#include "flexura/calibrate/rig_views.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "flexura/calibrate/rig_aim.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/math/dense.h"

namespace flexura {
namespace {

// Predicts what a candidate would show for the estimated rig, without noise: only the positions along the arm
// matter. Empty if the arm is not in view.
class Forecast {
 public:
  Forecast(const RigProblem& problem, const RigCalibration& found, const ViewConfig& config)
      : problem_(problem), found_(found), config_(config) {}

  // Returns the information on the rig's own variables after the candidate.
  [[nodiscard]] std::optional<Eigen::MatrixXd> information(const Eigen::MatrixXd& before,
                                                           const ViewCandidate& candidate) const {
    RigObservations next;
    next.poses = {candidate.pose}, next.stances = candidate.stances;
    next.etalon = problem_.observations().etalon;
    const RigModel& guess = problem_.variables().guess();
    const RigVariables bare(guess, problem_.prior(), next);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(bare.count());
    x.head(bare.globals()) = found_.x.head(bare.globals());
    for (std::size_t i = 0; i < next.stances.size(); ++i) {
      const RigStance& where = bare.read()[i];
      const ZoomTable lens = Camera(guess.cameras[where.camera]).lens();
      if (where.head.zoom < lens.first() || where.head.zoom > lens.last()) return std::nullopt;
      const auto image = next.etalon ? etalon_picture(bare, x, i) : picture(bare, x, i);
      if (!image) return std::nullopt;
      next.images.push_back(*image);
    }
    RigProblem ahead(guess, problem_.prior(), std::move(next));
    if (!ahead.linearise(x)) return std::nullopt;
    return marginal(before, ahead, x);
  }

 private:
  [[nodiscard]] std::optional<RigImage> etalon_picture(const RigVariables& bare, const Eigen::VectorXd& x,
                                                       std::size_t stance) const {
    auto points = EtalonFigure(*problem_.observations().etalon)
                      .expected(RigProjector(bare, x).view(stance), config_.margin);
    if (!points) return std::nullopt;
    for (EtalonPoint& point : *points) point.sigma = config_.sigma;
    return RigImage{.stance = stance, .etalon = std::move(*points)};
  }
  [[nodiscard]] std::optional<RigImage> picture(const RigVariables& bare, const Eigen::VectorXd& x,
                                                std::size_t stance) const {
    RigProjector projector(bare, x);
    const View view = projector.view(stance);
    RigImage image{.stance = stance};
    const auto look = [&](double share) -> std::optional<Eigen::Vector2d> {
      const auto shown =
          projector.show(0, stance, material_point(bare.guess().arm, share * bare.guess().arm.length()));
      if (!shown) return std::nullopt;
      const Eigen::Vector2d& pixel = shown->pixel;
      const double margin = config_.margin;
      const bool is_inside = pixel.minCoeff() >= margin && pixel.x() <= view.width - 1 - margin &&
                             pixel.y() <= view.height - 1 - margin;
      return is_inside ? std::optional(pixel) : std::nullopt;
    };
    for (std::size_t i = 0; i < config_.markers; ++i) {
      const double share =
          static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(config_.markers, 2) - 1);
      if (const auto pixel = look(share))
        image.markers.push_back({*pixel, share * bare.guess().arm.length(), config_.sigma});
    }
    for (std::size_t i = 0; i < config_.points; ++i) {
      const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(config_.points);
      if (const auto pixel = look(share)) image.points.push_back({*pixel, config_.sigma});
    }
    if (image.markers.size() < config_.fewest) return std::nullopt;
    return image;
  }

  // The rig's own variables keep their information; those of the candidate's pictures are eliminated. The
  // prior of the rig's own variables is subtracted, as the new problem contains it again.
  [[nodiscard]] static Eigen::MatrixXd marginal(const Eigen::MatrixXd& before, const RigProblem& ahead,
                                                const Eigen::VectorXd& x) {
    constexpr double all = 1e300;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd normal;
    ahead.normal(all, gradient, normal);
    const Eigen::Index own = before.rows(), rest = x.size() - own;
    for (Eigen::Index i = 0; i < own; ++i) {
      const double sigma = ahead.variables().variable(i).sigma;
      normal(i, i) -= 1 / (sigma * sigma);
    }
    Eigen::MatrixXd sum = before;
    sum += normal.topLeftCorner(own, own).selfadjointView<Eigen::Lower>().toDenseMatrix();
    if (rest == 0) return sum;
    const Eigen::MatrixXd coupling = normal.bottomLeftCorner(rest, own);
    const Eigen::MatrixXd solved = Cholesky(normal.bottomRightCorner(rest, rest)).solve_lower(coupling);
    return sum - solved.transpose() * solved;
  }

  const RigProblem& problem_;
  const RigCalibration& found_;
  const ViewConfig& config_;
};

// One row per goal: its gradient by the rig's own variables, in units of the wanted standard deviation.
Eigen::MatrixXd goal_rows(std::span<const ViewGoal> goals, Eigen::Index own) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(goals.size()), own);
  for (std::size_t i = 0; i < goals.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) =
        goals[i].quantity.gradient.head(own).transpose() / goals[i].desired;
  return rows;
}

}  // namespace

std::optional<ViewChoice> next_best_view(const RigProblem& problem, const RigCalibration& found,
                                         std::span<const ViewCandidate> candidates,
                                         std::span<const ViewGoal> goals, const ViewConfig& config) {
  const Eigen::Index own = problem.variables().globals();
  const Eigen::MatrixXd rows = goal_rows(goals, own);
  const Eigen::MatrixXd before = Cholesky(found.covariance.topLeftCorner(own, own)).inverse();
  const Forecast forecast(problem, found, config);
  std::optional<ViewChoice> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto after = forecast.information(before, candidates[i]);
    if (!after) continue;
    const Eigen::MatrixXd variances = rows * Cholesky(*after).solve(rows.transpose());
    const double value = variances.trace();
    if (!std::isfinite(value) || (best && !(value < best->after))) continue;
    best = ViewChoice{i, value, {}};
    for (std::size_t j = 0; j < goals.size(); ++j)
      best->sigmas.push_back(goals[j].desired *
                             std::sqrt(variances.diagonal()[static_cast<Eigen::Index>(j)]));
  }
  return best;
}

RigStance looking_at(const RigModel& model, std::size_t number, const Eigen::Vector3d& slide, double ratio,
                     const Eigen::Vector3d& target, const Eigen::Vector2d& place) {
  const CameraConfig& camera = model.cameras[number];
  const Camera optics(camera);
  RigStance stance = commanded(optics, {number, {0, 0, zoom_at(optics, ratio)}, {slide}});
  stance.head = aimed(camera, stance, target);
  // Points to the right and below the middle move there by turning left and up.
  const Intrinsics lens = optics.lens().at(stance.head.zoom);
  stance.head.pan += std::atan(0.5 * place.x() * static_cast<double>(camera.sensor.width) / lens.fx);
  stance.head.tilt += std::atan(0.5 * place.y() * static_cast<double>(camera.sensor.height) / lens.fy);
  return commanded(optics, stance);
}

std::vector<ViewCandidate> view_candidates(const RigModel& model, const ViewGrid& grid) {
  constexpr std::array<std::array<double, 2>, 5> places = {{{0, 0}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};
  std::vector<ViewCandidate> candidates;
  for (const ArmState& pose : grid.poses) {
    const Eigen::Vector3d target = grid.target ? *grid.target : arm_middle(model, pose);
    for (const double zoom : grid.zooms) {
      for (const Eigen::Vector3d& slide : grid.slides) {
        for (const auto& [across, down] : places) {
          ViewCandidate& candidate = candidates.emplace_back(ViewCandidate{pose, {}});
          for (std::size_t i = 0; i < model.cameras.size(); ++i) {
            const auto [ratio, spread] = grid.own ? grid.own(i, zoom) : std::array{zoom, grid.spread};
            candidate.stances.push_back(
                looking_at(model, i, slide, ratio, target, spread * Eigen::Vector2d(across, down)));
          }
        }
      }
    }
  }
  return candidates;
}

}  // namespace flexura

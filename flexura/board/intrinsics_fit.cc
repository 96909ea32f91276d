#include "flexura/board/intrinsics_fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "flexura/base/bounded_text.h"
#include "flexura/base/degree.h"
#include "flexura/board/board_alone.h"
#include "flexura/board/board_certainty.h"
#include "flexura/board/board_order.h"
#include "flexura/board/board_start.h"

namespace flexura {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using Size = std::array<int, 2>;

constexpr const char* untilted =
    "focal length and principal point are not observable: they cannot be separated from the board's poses; "
    "expected boards "
    "tilted to different sides";

constexpr double best_noise = 0.05;  // px, of the best pictures.

// Undetermined unknowns diverge although the fit explains the views.
std::string why_not_converged(const BundleFit& fit, const LensMisfit& misfit, const FittedLens& lens) {
  constexpr double good = 2;  // px
  const bool is_explained = fit.points > 0 && rms_of(fit.square_sum, fit.points) < good;
  if (is_explained) return untilted;
  return misfit.is_systematic() ? misfit.reason(lens) : "no lens of this model fits the views";
}

bool is_seen_only_by(std::size_t camera, const BoardView& view) {
  for (std::size_t i = 0; i < view.pixels.size(); ++i)
    if (i != camera && !view.pixels[i].empty()) return false;
  return true;
}

class Calibration {
 public:
  Calibration(std::span<const Vector2d> points, std::span<const BoardView> views, std::span<const Size> sizes,
              const IntrinsicsConfig& config)
      : points_(points),
        views_(views),
        sizes_(sizes),
        config_(config),
        lens_{config.model, config.distortion.value_or(static_cast<int>(Distortion::size_of(config.model)))} {
    if (config_.orders.empty()) {
      config_.orders.emplace_back(points.size());
      std::iota(config_.orders[0].begin(), config_.orders[0].end(), std::size_t{0});
    }
    check();
    result_.is_held_out.assign(views.size(), false);
    result_.boards.resize(views.size());
    int count = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
      const bool is_seen =
          std::ranges::any_of(views[i].pixels, [](const auto& pixels) { return !pixels.empty(); });
      if (!is_seen) continue;
      const bool is_held_out = config.hold_out > 0 && ++count % config.hold_out == 0;
      result_.is_held_out[i] = is_held_out;
      if (!is_held_out) numbers_.push_back(i), fitted_.push_back(views[i]);
    }
  }

  IntrinsicsFit run() {
    BoardBundle start;
    if (!find_start(start)) return std::move(result_);
    const BundleFit fit = fit_bundle(points_, fitted_, start, bundle_config(1e-12));
    if (std::string reason = why_apart(fit); !reason.empty()) return fail(std::move(reason));
    if (!fit.is_converged)
      return fail(why_not_converged(fit, worst_misfit(points_, fitted_, fit.bundle), lens_));
    if (std::string reason = why_ambiguous(fit); !reason.empty()) return fail(std::move(reason));
    take(fit);
    report_views();
    predict();
    judge();
    return std::move(result_);
  }

 private:
  void check() const {
    for (const BoardView& view : views_) {
      if (view.pixels.size() != sizes_.size())
        throw std::invalid_argument("a view has a wrong number of cameras");
      for (const auto& pixels : view.pixels)
        if (!pixels.empty() && pixels.size() != points_.size())
          throw std::invalid_argument("the number of points in a view differs from that of the board");
    }
    if (lens_.distortion < 0 || lens_.distortion > static_cast<int>(Distortion::size_of(lens_.model)))
      throw std::invalid_argument(
          fmt::format("the number of estimated distortion coefficients must be 0 to {}",
                      Distortion::size_of(lens_.model)));
    for (const PointOrder& order : config_.orders)
      if (order.size() != points_.size())
        throw std::invalid_argument("an order of the board's points has a wrong number of points");
  }

  [[nodiscard]] BundleConfig bundle_config(double least_gain) const {
    BundleConfig config{.distortion = lens_.distortion, .least_gain = least_gain};
    if (lens_.model != LensModel::rational) return config;
    // Its coefficients make up for each other, so that the minimum is flat.
    config.most_steps = 500, config.least_gain = std::max(1e-8, least_gain), config.exact = 1e-8;
    return config;
  }
  [[nodiscard]] std::string camera_text(std::size_t camera) const {
    return sizes_.size() == 1 ? "" : fmt::format("camera {}: ", camera + 1);
  }
  IntrinsicsFit fail(std::string reason) {
    result_.reason = std::move(reason);
    return std::move(result_);
  }

  bool find_start(BoardBundle& start) {
    constexpr double start_gain = 1e-7;  // The joint fit continues from there.
    std::vector<CameraAlone> alone;
    for (std::size_t camera = 0; camera < sizes_.size(); ++camera) {
      alone.push_back(
          fit_alone(points_, fitted_, camera, sizes_[camera], lens_.model, bundle_config(start_gain)));
      const CameraAlone& own = alone.back();
      if (own.views.size() < 2) {
        result_.reason = camera_text(camera) +
                         fmt::format("{} to fit: expected at least two views, from different directions",
                                     own.views.empty() ? "no view of the board" : "one view of the board");
      } else if (!own.fit.is_converged) {
        result_.reason =
            camera_text(camera) + why_not_converged(own.fit, misfit_of_alone(own, camera), lens_);
      }
      if (!result_.reason.empty()) return false;
      start.lenses.push_back(own.fit.bundle.lenses.front());
      if (camera > 0) choose_order(camera, alone.front(), own);
      const auto pose = camera == 0 ? std::optional(Pose{}) : start_camera(steps_.back());
      if (!pose) {
        result_.reason = camera_text(camera) + "no view of the board together with camera 1";
        return false;
      }
      start.cameras.push_back(*pose);
      CameraFit& fit = result_.cameras.emplace_back();
      fit.rms_alone = rms_of(own.fit.square_sum, own.fit.points);
    }
    for (std::size_t view = 0; view < fitted_.size(); ++view) {
      for (std::size_t camera = 0; camera < alone.size() && start.boards.size() == view; ++camera) {
        const auto& seen = alone[camera].views;
        const auto at = std::ranges::find(seen, view);
        if (at == seen.end()) continue;
        start.boards.push_back(start.cameras[camera] *
                               alone[camera].fit.bundle.boards[static_cast<std::size_t>(at - seen.begin())]);
        if (camera > 0)
          put_in_best_order(points_, config_.orders, start, camera, start.boards.back(), fitted_[view]);
      }
      // Pixels on a line: no camera determines the pose of that board.
      if (start.boards.size() == view) {
        result_.reason = "the points of a view lie on a line";
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] LensMisfit misfit_of_alone(const CameraAlone& own, std::size_t camera) const {
    if (own.fit.bundle.lenses.empty()) return {};
    std::vector<BoardView> views;
    views.reserve(own.views.size());
    for (const std::size_t view : own.views) views.push_back({{fitted_[view].pixels[camera]}});
    return lens_misfit(points_, views, own.fit.bundle, 0);
  }

  // Brings a camera's points into the first camera's order, as the common views agree.
  void choose_order(std::size_t camera, const CameraAlone& first, const CameraAlone& own) {
    auto choices = order_choices(points_, first, own, config_.orders);
    if (choices.size() > 1) {
      Doubt& doubt = doubts_.emplace_back(camera, std::move(choices[1].steps));
      doubt.views = fitted_;
      reorder(camera, doubt.steps, choices[1].orders, doubt.views);
    }
    if (!choices.empty()) reorder(camera, choices[0].steps, choices[0].orders, fitted_);
    steps_.push_back(choices.empty() ? std::vector<CameraStep>{} : std::move(choices[0].steps));
  }

  void reorder(std::size_t camera, std::span<const CameraStep> steps, std::span<const std::size_t> orders,
               std::vector<BoardView>& views) const {
    for (std::size_t i = 0; i < steps.size(); ++i)
      put_in_order(config_.orders[orders[i]], views[steps[i].view].pixels[camera]);
  }

  // Returns why the order of a camera's points stays unknown; "" if the views determine it.
  [[nodiscard]] std::string why_ambiguous(const BundleFit& fit) const {
    constexpr double clearly_worse = 2;
    const double rms = rms_of(fit.square_sum, fit.points);
    for (const Doubt& doubt : doubts_) {
      std::vector<BoardView> views = fitted_;
      for (std::size_t i = 0; i < views.size(); ++i)
        views[i].pixels[doubt.camera] = doubt.views[i].pixels[doubt.camera];
      BoardBundle other = fit.bundle;
      const auto pose = start_camera(doubt.steps);
      if (!pose) continue;
      // Boards that only this camera saw move with it.
      for (std::size_t i = 0; i < views.size(); ++i)
        if (is_seen_only_by(doubt.camera, views[i]))
          other.boards[i] = *pose * other.cameras[doubt.camera].inverse() * other.boards[i];
      other.cameras[doubt.camera] = *pose;
      const BundleFit second = fit_bundle(points_, views, other, bundle_config(1e-7));
      const double second_rms = rms_of(second.square_sum, second.points);
      if (second.points == 0 || second_rms > clearly_worse * std::max(rms, best_noise)) continue;
      return fmt::format(
          "{}the board looks the same upside down: its points fit in two orders, with residuals of {:.2g} "
          "and {:.2g} px: expected more views with the board at other places and tilts, or a board with one "
          "even and "
          "one odd number of corners",
          camera_text(doubt.camera), rms, second_rms);
    }
    return "";
  }

  // Returns why cameras that fit well alone have no relative poses that explain all views; "" if they do.
  [[nodiscard]] std::string why_apart(const BundleFit& fit) const {
    constexpr double much_worse = 5, visible = 1;  // px
    std::vector<std::string> rms_alone;
    double bound = visible;
    for (const CameraFit& own : result_.cameras) {
      rms_alone.push_back(fmt::format("{:.2g}", own.rms_alone));
      bound = std::max(bound, much_worse * own.rms_alone);
    }
    const double rms = rms_of(fit.square_sum, fit.points);
    if (steps_.empty() || (fit.points > 0 && rms <= bound)) return "";
    std::size_t camera = 0;
    StepSpread spread;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const StepSpread own = step_spread(steps_[i]);
      if (i == 0 || own.turn > spread.turn) spread = own, camera = i + 1;
    }
    return fmt::format(
        "{}its pictures do not match those of camera 1: the residuals are {} px for each camera alone and {} "
        "for both together, and view {} gives a pose that differs by {:.0f} degrees and {} m from most "
        "views: expected pictures "
        "taken at the same time, in the same order, by cameras fixed to each other",
        camera_text(camera), fmt::join(rms_alone, " and "),
        fit.points > 0 ? fmt::format("{:.3g} px", rms) : "unknown", numbers_[spread.view] + 1,
        spread.turn / degree, bounded_text(spread.distance, 100));
  }

  // The unknowns' order is that of BundleFit::information.
  void take(const BundleFit& fit) {
    bundle_ = fit.bundle;
    result_.rms = rms_of(fit.square_sum, fit.points);
    result_.points = fit.points, result_.steps = fit.steps;
    const double freedom = 2 * static_cast<double>(fit.points) - static_cast<double>(fit.unknowns);
    result_.noise = freedom > 0 ? std::sqrt(fit.square_sum / freedom) : 0;
    const auto cameras = static_cast<Index>(sizes_.size());
    const Index lens_size = 4 + lens_.distortion;
    VectorXd scale(fit.information.rows());
    for (Index i = 0; i < cameras; ++i) {
      const auto camera = static_cast<std::size_t>(i);
      const Intrinsics& lens = bundle_.lenses[camera];
      scale.segment(i * lens_size, lens_size) = intrinsics_effects(lens, seen_by(camera)).head(lens_size);
      if (i == 0) continue;
      const double depth = bundle_.boards.front().position.norm();
      scale.segment<3>(pose_at(camera)).setConstant(lens.fx / std::max(depth, 1e-6));
      scale.segment<3>(pose_at(camera) + 3).setConstant(lens.fx);
    }
    unit_covariance_ = covariance_of(fit.information, scale);
    const double variance = result_.noise * result_.noise;
    for (std::size_t camera = 0; camera < sizes_.size(); ++camera) {
      CameraFit& own = result_.cameras[camera];
      own.lens = bundle_.lenses[camera];
      own.covariance.setZero();
      const Index at = static_cast<Index>(camera) * lens_size;
      own.covariance.topLeftCorner(lens_size, lens_size) =
          variance * unit_covariance_.block(at, at, lens_size, lens_size);
      result_.poses.push_back(bundle_.cameras[camera]);
      Eigen::Matrix<double, 6, 6>& pose = result_.pose_covariance.emplace_back();
      pose.setZero();
      if (camera > 0) pose = variance * unit_covariance_.block<6, 6>(pose_at(camera), pose_at(camera));
    }
  }

  [[nodiscard]] Index pose_at(std::size_t camera) const {
    return static_cast<Index>(sizes_.size()) * (4 + lens_.distortion) + 6 * (static_cast<Index>(camera) - 1);
  }

  void report_views() {
    for (std::size_t i = 0; i < numbers_.size(); ++i) result_.boards[numbers_[i]] = bundle_.boards[i];
    for (std::size_t camera = 0; camera < sizes_.size(); ++camera) {
      CameraFit& own = result_.cameras[camera];
      own.view_rms.resize(views_.size());
      double sum = 0;
      std::size_t count = 0;
      for (std::size_t i = 0; i < fitted_.size(); ++i) {
        if (fitted_[i].pixels[camera].empty()) continue;
        const double part = square_sum(points_, fitted_[i], bundle_, camera, bundle_.boards[i]).value_or(0);
        const std::size_t seen = seen_points(fitted_[i].pixels[camera]);
        own.view_rms[numbers_[i]] = rms_of(part, seen);
        sum += part, count += seen;
      }
      own.rms = rms_of(sum, count);
      own.misfit = lens_misfit(points_, fitted_, bundle_, camera);
    }
  }

  // Fits the boards of held-out views and computes the cameras' prediction errors.
  void predict() {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t view = 0; view < views_.size(); ++view) {
      if (!result_.is_held_out[view]) continue;
      BoardBundle start{bundle_.lenses, bundle_.cameras, {}};
      std::vector<BoardView> own = {views_[view]};
      for (std::size_t camera = 0; camera < sizes_.size() && start.boards.empty(); ++camera) {
        if (views_[view].pixels[camera].empty()) continue;
        const auto pose = start_pose(Lens(bundle_.lenses[camera]), points_, views_[view].pixels[camera]);
        if (!pose) continue;
        start.boards.push_back(bundle_.cameras[camera] * *pose);
        put_in_best_order(points_, config_.orders, bundle_, camera, start.boards.back(), own.front());
      }
      if (start.boards.empty()) continue;
      const BundleFit fit = fit_bundle(points_, own, start, {.cameras = false});
      if (!fit.is_converged) continue;
      result_.boards[view] = fit.bundle.boards.front();
      sum += fit.square_sum, count += fit.points;
      for (std::size_t camera = 0; camera < sizes_.size(); ++camera) {
        if (views_[view].pixels[camera].empty()) continue;
        const auto part = square_sum(points_, own.front(), bundle_, camera, fit.bundle.boards.front());
        if (part)
          result_.cameras[camera].view_rms[view] = rms_of(*part, seen_points(views_[view].pixels[camera]));
      }
    }
    if (count > 0) result_.held_out_rms = rms_of(sum, count);
  }

  [[nodiscard]] std::vector<Vector2d> seen_by(std::size_t camera) const {
    std::vector<Vector2d> all;
    for (const BoardView& view : fitted_)
      std::ranges::copy_if(view.pixels[camera], std::back_inserter(all), is_seen);
    return all;
  }

  void judge() {
    for (std::size_t camera = 0; camera < sizes_.size(); ++camera) {
      judge(camera);
      constexpr double useless = 2;  // px
      const LensMisfit& misfit = result_.cameras[camera].misfit;
      if (misfit.is_systematic() && misfit.rms > useless)
        result_.reason = camera_text(camera) + misfit.reason(lens_);
      const auto& undetermined = result_.cameras[camera].undetermined;
      if (result_.reason.empty() && !undetermined.empty() && undetermined.front() < 4)
        result_.reason = camera_text(camera) + untilted;
    }
    result_.is_found = result_.reason.empty();
  }

  void judge(std::size_t camera) {
    constexpr double largest_share = 0.01;
    CameraFit& own = result_.cameras[camera];
    const auto [width, height] = sizes_[camera];
    const double largest = largest_share * std::hypot(width, height);
    own.corner_sigma = corner_sigma(own.lens, own.covariance, width, height);
    // Without noise, all unknowns would seem to be determined.
    const double grown = result_.noise < best_noise ? best_noise / std::max(result_.noise, 1e-12) : 1;
    const auto seen = intrinsics_effects(own.lens, seen_by(camera)),
               corners = intrinsics_effects(own.lens, image_corners(width, height));
    const bool are_corners_known = grown * own.corner_sigma <= largest;
    for (int i = 0; i < 4 + lens_.distortion; ++i) {
      const double sigma = grown * own.sigma(i);
      const bool is_determined =
          seen[i] * sigma <= largest && (are_corners_known || corners[i] * sigma <= largest);
      if (!is_determined) own.undetermined.push_back(i);
    }
  }

  std::span<const Vector2d> points_;
  std::span<const BoardView> views_;
  std::span<const Size> sizes_;
  IntrinsicsConfig config_;
  FittedLens lens_;
  std::vector<std::size_t> numbers_;  // Of the fitted views.
  std::vector<BoardView> fitted_;
  std::vector<std::vector<CameraStep>> steps_;  // Of each camera except the first.
  // A second order of a camera's points, which the views may not rule out.
  struct Doubt {
    std::size_t camera = 0;
    std::vector<CameraStep> steps;
    std::vector<BoardView> views = {};
  };
  std::vector<Doubt> doubts_;
  BoardBundle bundle_;
  MatrixXd unit_covariance_;
  IntrinsicsFit result_;
};

}  // namespace

double CameraFit::sigma(int parameter) const { return std::sqrt(covariance(parameter, parameter)); }

IntrinsicsFit fit_intrinsics(std::span<const Vector2d> points, std::span<const BoardView> views,
                             std::span<const Size> sizes, const IntrinsicsConfig& config) {
  return Calibration(points, views, sizes, config).run();
}

}  // namespace flexura

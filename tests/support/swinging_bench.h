#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/servo/servo_session.h"
#include "tests/support/rig_bench.h"

// What a servo did to the true arm, from the simulated truth.
namespace flexura {

/// Totals of a servo's motion, from the simulated truth.
struct MotionTotals {
  double energy = 0;        ///< Work of the motors that pull, J.
  double most_tension = 0;  ///< N
  int bend_violations = 0;  ///< Steps with a section bent further than its limit.
  int rate_violations = 0;  ///< Commands faster than the sections' bend rates.
  int view_violations = 0;  ///< Steps with a part of the arm outside a picture.
  int contacts = 0;         ///< Steps with a contact.

  [[nodiscard]] int violations() const {
    return bend_violations + rate_violations + view_violations + contacts;
  }
};

/// Samples the true arm of a bench at each step of a servo, and pushes it once if asked to.
class TruthWatcher : public ServoSessionWatcher {
 public:
  explicit TruthWatcher(RigBench& bench, Arm driven, const ServoConfig& config)
      : bench_(bench), driven_(std::move(driven)), config_(config) {}

  /// Pushes the arm's tip with this force, N, world frame, from `from` to `until`, s of the rig's clock.
  void push_tip(const Eigen::Vector3d& force, double from, double until) { push_ = Push{force, from, until}; }

  void arm_sent(double, const ArmState& state, double duration) override {
    if (!sent_.bends.empty())
      for (std::size_t i = 0; i < state.bends.size(); ++i)
        if ((state.bends[i] - sent_.bends[i]).norm() > driven_.sections[i].max_bend_rate * duration * slack) {
          ++totals_.rate_violations;
          break;
        }
    sent_ = state;
  }
  void stepped(const ServoStep&) override {
    const double now = bench_.rig().clock().now();
    Plant& plant = bench_.rig().arm().plant();
    give_push(plant, now);
    const std::vector<double> tensions = plant.tensions(now), pulled = plant.pulled(now);
    for (std::size_t i = 0; i < tensions.size(); ++i) {
      totals_.most_tension = std::max(totals_.most_tension, tensions[i]);
      if (i < pulled_.size()) totals_.energy += std::max(0.0, tensions[i] * (pulled[i] - pulled_[i]));
    }
    pulled_ = pulled;
    const Backbone backbone = plant.backbone(now);
    if (is_overbent(backbone)) ++totals_.bend_violations;
    samples_.push_back({now, points_of(backbone)});
    if (!is_in_view(backbone, now)) ++totals_.view_violations;
    if (!plant.contacts(now).empty()) ++totals_.contacts;
  }
  void reported(double time, const std::string& what) override {
    reports_.push_back(fmt::format("{:.2f} s: {}", time, what));
  }
  /// Returns points along the true backbone at each step, one column each, m.
  struct Sample {
    double time = 0;  ///< s of the rig's clock.
    Eigen::Matrix3Xd points;
  };
  [[nodiscard]] const std::vector<Sample>& samples() const { return samples_; }
  /// Returns points along a backbone, at equal shares of its length.
  static Eigen::Matrix3Xd points_of(const Backbone& backbone) {
    constexpr int places = 20;
    Eigen::Matrix3Xd points(3, places);
    for (int k = 0; k < places; ++k)
      points.col(k) = backbone.pose(backbone.length() * (k + 1) / places).position;
    return points;
  }
  /// Returns the events of the servo, with their times.
  [[nodiscard]] const std::vector<std::string>& reports() const { return reports_; }
  [[nodiscard]] const MotionTotals& totals() const { return totals_; }

 private:
  static constexpr double slack = 1 + 1e-9;
  struct Push {
    Eigen::Vector3d force;
    double from = 0, until = 0;
    int stage = 0;
  };
  void give_push(Plant& plant, double now) {
    if (!push_) return;
    if (push_->stage == 0 && now >= push_->from) {
      plant.push(now, PlantPush{.s_rest = driven_.length(), .force = push_->force});
      push_->stage = 1;
    } else if (push_->stage == 1 && now >= push_->until) {
      plant.push(now, std::nullopt);
      push_->stage = 2;
    }
  }
  [[nodiscard]] bool is_overbent(const Backbone& backbone) const {
    double s = 0;
    Eigen::Vector3d before = backbone.pose(0).rotation * Eigen::Vector3d::UnitZ();
    for (const Section& section : driven_.sections) {
      s += section.length;
      const Eigen::Vector3d tangent =
          backbone.pose(backbone.s_at_rest(s)).rotation * Eigen::Vector3d::UnitZ();
      if (std::atan2(before.cross(tangent).norm(), before.dot(tangent)) > section.max_bend * slack)
        return true;
      before = tangent;
    }
    return false;
  }
  [[nodiscard]] bool is_in_view(const Backbone& backbone, double now) {
    for (const std::size_t camera : config_.cameras) {
      const View view = bench_.rig().camera(camera).view(now);
      constexpr int places = 40;
      for (int k = 0; k <= places; ++k) {
        const auto pixel = view.project(backbone.pose(backbone.length() * k / places).position);
        if (!pixel || pixel->x() < -0.5 || pixel->y() < -0.5 || pixel->x() > view.width - 0.5 ||
            pixel->y() > view.height - 0.5)
          return false;
      }
    }
    return true;
  }

  RigBench& bench_;
  Arm driven_;
  const ServoConfig& config_;
  std::optional<Push> push_;
  MotionTotals totals_;
  ArmState sent_;
  std::vector<double> pulled_;
  std::vector<std::string> reports_;
  std::vector<Sample> samples_;
};

}  // namespace flexura

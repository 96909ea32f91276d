#include "flexura/servo/predictive_limits.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "flexura/kinematics/jacobian.h"
#include "flexura/safety/clearance_slope.h"
#include "flexura/safety/motion_check.h"

namespace flexura {
namespace {

// Part of a motor's pull-out torque that may be used.
constexpr double safe_torque = 0.8;
// Clearance to keep, and the one below which an object counts, shares of the arm's length.
constexpr double margin = 0.005, near = 0.2;
// Distance of the backbone from the borders of a picture, px.
constexpr double border = 8;
constexpr int places_an_arc = 4;

// Computes the derivative of a point's pixel with respect to its position, px/m. Returns false where the lens
// cannot image it.
bool pixel_slope(const View& view, const Eigen::Vector3d& position,
                 Eigen::Matrix<double, 2, 3>& by_position) {
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double small = 1e-5;  // m
    const auto ahead = view.project(position + small * Eigen::Vector3d::Unit(axis)),
               behind = view.project(position - small * Eigen::Vector3d::Unit(axis));
    if (!ahead || !behind) return false;
    by_position.col(axis) = (*ahead - *behind) / (2 * small);
  }
  return true;
}

}  // namespace

PredictiveLimits::PredictiveLimits(ArmModel model, const ServoConfig& config)
    : model_(std::move(model)), keeps_view_(!config.follow) {
  if (config.drive)
    for (const Axis& axis : config.drive->axes)
      most_tension_.push_back(safe_torque * axis.motor.pull_out_torque(0) / axis.torque(1));
  contacts_.emplace_back(model_.shaped());
  for (const Obstacle& obstacle : config.obstacles) contacts_.emplace_back(model_.shaped(), obstacle);
}

std::vector<PredictiveLimit> PredictiveLimits::find(const ArmState& sent, const ArmState& rest,
                                                    const Eigen::MatrixXd& by_command,
                                                    const std::array<View, 2>& views) const {
  std::vector<PredictiveLimit> limits;
  if (!by_command.allFinite() || !is_possible(rest)) return limits;
  add_tensions(sent, limits);
  add_clearances(rest, by_command, limits);
  for (std::size_t i = 0; keeps_view_ && i < 2; ++i) add_borders(rest, by_command, i, views[i], limits);
  return limits;
}

void PredictiveLimits::add_tensions(const ArmState& sent, std::vector<PredictiveLimit>& limits) const {
  bool is_limited = false;
  for (const double most : most_tension_) is_limited = is_limited || std::isfinite(most);
  if (!is_limited) return;
  const TendonTensions now = model_.actuation().tensions(sent);
  for (Eigen::Index i = 0; i < now.tensions.size(); ++i) {
    const double most = most_tension_[static_cast<std::size_t>(i)];
    if (std::isfinite(most) && now.by_command.row(i).allFinite())
      limits.push_back(
          {now.by_command.row(i), most - now.tensions[i], fmt::format("the tension of tendon {}", i + 1)});
  }
}

void PredictiveLimits::add_clearances(const ArmState& rest, const Eigen::MatrixXd& by_command,
                                      std::vector<PredictiveLimit>& limits) const {
  const double length = model_.shaped().length();
  for (const ContactWatch& watch : contacts_)
    if (const auto slope = clearance_slope(watch, model_.shaped(), rest, near * length);
        slope && slope->by_state.allFinite())
      limits.push_back({-slope->by_state * by_command, slope->clearance - margin * length,
                        watch.hazard() == Hazard::obstacle
                            ? fmt::format("the clearance from {}", watch.obstacle_name())
                            : std::string("the clearance of the arm from itself")});
}

// Of the backbone's points, only the one limits that reaches a border first. Points that hardly move do not
// count.
void PredictiveLimits::add_borders(const ArmState& rest, const Eigen::MatrixXd& by_command,
                                   std::size_t camera, const View& view,
                                   std::vector<PredictiveLimit>& limits) const {
  const BackboneJacobian jacobian(model_.shaped(), rest);
  Jacobian J(6, 3 * static_cast<Eigen::Index>(rest.bends.size()));
  std::array<std::optional<PredictiveLimit>, 4> first;  // Left, right, upper and lower border.
  std::array<double, 4> ways{};                         // Change of the command to the border, rad.
  ways.fill(std::numeric_limits<double>::infinity());
  for (std::size_t arc = 0; arc < rest.bends.size(); ++arc)
    for (int k = 1; k <= places_an_arc; ++k) {
      const MaterialPoint point{arc, static_cast<double>(k) / places_an_arc};
      const Eigen::Vector3d position = jacobian.pose(point).position;
      const auto pixel = view.project(position);
      Eigen::Matrix<double, 2, 3> by_position;
      if (!pixel || !pixel_slope(view, position, by_position)) return;
      J.setZero();
      jacobian.at(point, J);
      const Eigen::MatrixXd pixel_by_command = by_position * J.topRows<3>() * by_command;
      const std::array<double, 4> rooms = {pixel->x() - border, view.width - 1 - border - pixel->x(),
                                           pixel->y() - border, view.height - 1 - border - pixel->y()};
      for (std::size_t side = 0; side < 4; ++side) {
        const double sign = side % 2 == 0 ? -1 : 1;  // A pixel that grows leaves less room right and below.
        const Eigen::RowVectorXd row = sign * pixel_by_command.row(side < 2 ? 0 : 1);
        const double norm = row.norm(), way = rooms[side] / norm;
        constexpr double far = 0.5;  // rad
        if (!(norm > 0) || !std::isfinite(way) || way < -far || !(way < ways[side])) continue;
        ways[side] = way;
        first[side] = PredictiveLimit{row, rooms[side]};
      }
    }
  constexpr std::array sides = {"left", "right", "upper", "lower"};
  for (std::size_t side = 0; side < 4; ++side) {
    if (!first[side]) continue;
    first[side]->name = fmt::format("the {} border of the {} camera's picture", sides[side],
                                    camera == 0 ? "first" : "second");
    limits.push_back(*first[side]);
  }
}

}  // namespace flexura

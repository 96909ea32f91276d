#include "flexura/calibrate/rig_response.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace flexura {
namespace {

bool are_alike(const ArmState& a, const ArmState& b) {
  constexpr double apart = 0.002;  // rad
  for (std::size_t i = 0; i < a.bends.size(); ++i)
    if ((a.bends[i] - b.bends[i]).norm() > apart || a.stretches[i] != b.stretches[i]) return false;
  return true;
}

}  // namespace

RigResponse::RigResponse(const RigModel& model, const std::vector<ArmState>& commands)
    : sections_(model.sections()),
      section_of_(model.actuation.section_of()),
      commands_(commands),
      sag_(sections_, Eigen::Vector2d::Zero()),
      is_planar_(model.arm.kind == ArmKind::planar) {
  const std::size_t arcs = model.arm.sections.size();
  if (section_of_.empty()) {
    section_of_.resize(arcs);
    std::iota(section_of_.begin(), section_of_.end(), std::size_t{0});
  }
  std::vector<double> counts(sections_, 0);
  for (const std::size_t section : section_of_) ++counts[section];
  for (const std::size_t section : section_of_) shares_.push_back(1 / counts[section]);
  const ArmState still = model.actuation.shape(ArmState::straight(sections_));
  for (std::size_t i = 0; i < arcs; ++i) sag_[section_of_[i]] += still.bends[i];
  constexpr double least = 1e-6;  // rad
  sags_ = std::ranges::any_of(sag_, [](const Eigen::Vector2d& bend) { return bend.norm() > least; });
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    std::size_t first = 0;
    while (first < i && !are_alike(commands_[first], commands_[i])) ++first;
    first_like_.push_back(first);
    axes_.push_back(axes_of(commands_[i]));
  }
}

std::string RigResponse::name(std::size_t input) const {
  return input < sections_ ? fmt::format("command {}", input + 1) : "its sag";
}

RigResponse::Axes RigResponse::axes_of(const ArmState& command) const {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& bend : command.bends) sum += bend * bend.transpose();
  for (const Eigen::Vector2d& bend : sag_) sum += bend * bend.transpose();
  Axes axes;
  if (is_planar_) {
    axes.sizes = {std::sqrt(sum(0, 0)), 0};
    return axes;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solved(sum);
  axes.directions = solved.eigenvectors();
  // Below the smallest size an input counts as 0, as rounding would leave a variable that changes nothing.
  constexpr double least = 1e-6;  // rad
  for (std::size_t i = 0; i < 2; ++i) {
    const double size = std::sqrt(std::max(0.0, solved.eigenvalues()[static_cast<Eigen::Index>(i)]));
    axes.sizes[i] = size > least ? size : 0;
  }
  return axes;
}

}  // namespace flexura

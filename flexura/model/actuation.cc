#include "flexura/model/actuation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace flexura {
namespace {

std::vector<double> shares_of(const Section& section, std::size_t index) {
  std::vector<double> shares = section.bend_profile.value_or(std::vector<double>{1});
  double sum = 0;
  for (const double part : shares) sum += part >= 0 ? part : std::nan("");
  if (!(sum > 0) || !std::isfinite(sum))
    throw std::invalid_argument(
        fmt::format("section {}: a bend profile is of numbers from 0 on, one of them above", index + 1));
  // One arc has all of the bend, to the last bit.
  for (double& part : shares) part = shares.size() == 1 ? 1 : part / sum;
  return shares;
}

// Arc `i` of the `count` that a section is cut into.
Section arc_of(const Section& section, std::size_t i, std::size_t count) {
  if (count == 1) return section;
  const auto [from, to] = section.radius;
  const auto radius = [from, to, count](std::size_t end) {
    return from + (to - from) * static_cast<double>(end) / static_cast<double>(count);
  };
  Section arc = section;
  arc.length = section.length / static_cast<double>(count);
  arc.radius = {radius(i), radius(i + 1)};
  arc.max_bend = arc.max_bend_rate = std::numeric_limits<double>::infinity();
  arc.bend_profile.reset();
  return arc;
}

}  // namespace

Actuation::Actuation(const Arm& driven) : sections_(driven.sections.size()) {
  for (std::size_t i = 0; i < sections_; ++i) {
    for (const double share : shares_of(driven.sections[i], i)) {
      section_of_.push_back(i);
      shares_.push_back(share);
    }
  }
}

Actuation Actuation::with_gains(const std::vector<double>& gains) const {
  Actuation actuation = *this;
  if (gains.empty()) return actuation;
  if (gains.size() != arcs()) throw std::invalid_argument("gains are one for each arc");
  for (std::size_t k = 0; k < arcs(); ++k) actuation.shares_[k] *= gains[k];
  return actuation;
}

ArmState Actuation::shape(const ArmState& command) const {
  if (sections_ > 0) require_fit(sections_, command);
  if (is_one_to_one()) return command;
  ArmState shape = ArmState::straight(arcs());
  for (std::size_t k = 0; k < arcs(); ++k) {
    shape.bends[k] = shares_[k] * command.bends[section_of_[k]];
    shape.stretches[k] = command.stretches[section_of_[k]];
  }
  return shape;
}

ArmState Actuation::command(const ArmState& shape) const {
  if (sections_ > 0) require_fit(arcs(), shape);
  if (is_one_to_one()) return shape;
  ArmState command = ArmState::straight(sections_);
  std::vector<double> squares(sections_, 0), counts(sections_, 0);
  command.stretches.assign(sections_, 0);
  for (std::size_t k = 0; k < arcs(); ++k) {
    const std::size_t section = section_of_[k];
    command.bends[section] += shares_[k] * shape.bends[k], squares[section] += shares_[k] * shares_[k];
    command.stretches[section] += shape.stretches[k], counts[section] += 1;
  }
  for (std::size_t i = 0; i < sections_; ++i)
    command.bends[i] /= squares[i], command.stretches[i] /= counts[i];
  return command;
}

void Actuation::by_command(const Eigen::MatrixXd& by_shape, Eigen::MatrixXd& by_command) const {
  if (sections_ == 0) {
    by_command = by_shape;
    return;
  }
  if (by_shape.cols() != 3 * static_cast<Eigen::Index>(arcs()))
    throw std::invalid_argument("a derivative by a shape has three columns an arc");
  by_command.resize(by_shape.rows(), 3 * static_cast<Eigen::Index>(sections_));
  by_command.setZero();
  for (std::size_t k = 0; k < arcs(); ++k) {
    const auto from = 3 * static_cast<Eigen::Index>(k), to = 3 * static_cast<Eigen::Index>(section_of_[k]);
    by_command.middleCols<2>(to) += shares_[k] * by_shape.middleCols<2>(from);
    by_command.col(to + 2) += by_shape.col(from + 2);
  }
}

Arm shaped_arm(const Arm& driven, const Actuation& actuation) {
  Arm shaped = driven;
  if (actuation.is_one_to_one()) return shaped;
  shaped.sections.clear();
  const auto& section_of = actuation.section_of();
  for (std::size_t k = 0; k < section_of.size(); ++k) {
    const auto first = std::ranges::lower_bound(section_of, section_of[k]);
    const auto count = static_cast<std::size_t>(std::ranges::count(section_of, section_of[k]));
    const auto i = k - static_cast<std::size_t>(first - section_of.begin());
    shaped.sections.push_back(arc_of(driven.sections[section_of[k]], i, count));
  }
  return shaped;
}

}  // namespace flexura

#include "flexura/model/actuation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "flexura/model/arm_difference.h"

namespace flexura {
namespace {

// Largest number of correction steps from a shape to its command. The first step reduces the error by a
// factor of about ten, later ones by more.
constexpr int max_steps = 20;

// Returns the section's profile. Throws std::invalid_argument if it is invalid.
std::vector<double> profile_of(const Section& section, std::size_t index) {
  std::vector<double> shares = section.bend_profile.value_or(std::vector<double>{1});
  double sum = 0;
  for (const double part : shares) sum += part >= 0 ? part : std::nan("");
  if (!(sum > 0) || !std::isfinite(sum))
    throw std::invalid_argument(fmt::format(
        "section {}: the numbers of a bend profile must be at least 0, and one of them above 0", index + 1));
  return shares;
}

std::vector<double> shares_of(const Section& section, std::size_t index) {
  std::vector<double> shares = profile_of(section, index);
  double sum = 0;
  for (const double part : shares) sum += part;
  // A single arc gets exactly the whole bend.
  for (double& part : shares) part = shares.size() == 1 ? 1 : part / sum;
  return shares;
}

// Returns arc `i` of the `count` arcs of a section.
Section arc_of(const Section& section, std::size_t i, std::size_t count) {
  const auto [from, to] = section.radius;
  const auto radius = [from, to, count](std::size_t end) {
    return from + (to - from) * static_cast<double>(end) / static_cast<double>(count);
  };
  Section arc = section;
  if (count > 1) {
    arc.length = section.length / static_cast<double>(count);
    arc.radius = {radius(i), radius(i + 1)};
  }
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

Actuation::Actuation(const Arm& driven, std::shared_ptr<const ArmResponse> response)
    : sections_(driven.sections.size()), response_(std::move(response)) {
  for (std::size_t i = 0; i < sections_; ++i) {
    for (const double factor : profile_of(driven.sections[i], i)) {
      section_of_.push_back(i);
      shares_.push_back(factor);
    }
  }
}

Actuation Actuation::with_gains(const std::vector<double>& gains) const {
  Actuation actuation = *this;
  if (gains.empty()) return actuation;
  if (gains.size() != arcs()) throw std::invalid_argument("expected one gain for each arc");
  for (std::size_t k = 0; k < arcs(); ++k) actuation.shares_[k] *= gains[k];
  return actuation;
}

ArmState Actuation::shape(const ArmState& command) const {
  if (sections_ > 0) require_fit(sections_, command);
  if (is_identity()) return command;
  if (response_) {
    ArmState shape = response_->shape(command);
    for (std::size_t k = 0; k < arcs(); ++k) shape.bends[k] *= shares_[k];
    return shape;
  }
  ArmState shape = ArmState::straight(arcs());
  for (std::size_t k = 0; k < arcs(); ++k) {
    shape.bends[k] = shares_[k] * command.bends[section_of_[k]];
    shape.stretches[k] = command.stretches[section_of_[k]];
  }
  return shape;
}

ArmState Actuation::command(const ArmState& shape) const {
  if (sections_ > 0) require_fit(arcs(), shape);
  if (is_identity()) return shape;
  if (!response_) return linear_command(shape);
  ArmState command = ArmState::straight(sections_);
  for (std::size_t k = 0; k < arcs(); ++k) {
    command.bends[section_of_[k]] += shape.bends[k];
    command.stretches[section_of_[k]] = shape.stretches[k];
  }
  // Solves for equal sums of the bends by Broyden's method. The derivative of the sums by the command is near
  // the identity.
  const auto count = 2 * static_cast<Eigen::Index>(sections_);
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(count, count);
  Eigen::VectorXd missed(count), before, change;
  ArmState best = command;
  double least = std::numeric_limits<double>::infinity();
  for (int step = 0; step < max_steps; ++step) {
    const ArmState made = this->shape(command);
    missed.setZero();
    for (std::size_t k = 0; k < arcs(); ++k)
      missed.segment<2>(2 * static_cast<Eigen::Index>(section_of_[k])) += shape.bends[k] - made.bends[k];
    const double square = missed.squaredNorm();
    if (square < least) best = command, least = square;
    const bool goes_on = square > 1e-24 && square < 100 * least;
    if (!goes_on) break;
    if (step > 0) {
      const Eigen::VectorXd predicted = inverse * (before - missed);
      const double length = change.dot(predicted);
      // A small or negative part along the last change is of a slack tendon, which Broyden's update would
      // turn into large steps.
      if (length > 0.1 * change.squaredNorm())
        inverse += (change - predicted) * (change.transpose() * inverse) / length;
    }
    before = missed;
    change = inverse * missed;
    for (std::size_t i = 0; i < sections_; ++i)
      command.bends[i] += change.segment<2>(2 * static_cast<Eigen::Index>(i));
  }
  return best;
}

// Uses only the shares of the arcs, not the response.
ArmState Actuation::linear_command(const ArmState& shape) const {
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

void Actuation::slopes(const ArmState& command, Eigen::MatrixXd& by_command) const {
  require_fit(sections_, command);
  if (response_) {
    response_->slopes(command, by_command);
    for (std::size_t k = 0; k < arcs(); ++k)
      by_command.middleRows<2>(3 * static_cast<Eigen::Index>(k)) *= shares_[k];
    return;
  }
  by_command.setZero(3 * static_cast<Eigen::Index>(arcs()), 3 * static_cast<Eigen::Index>(sections_));
  for (std::size_t k = 0; k < arcs(); ++k) {
    const auto to = 3 * static_cast<Eigen::Index>(k), from = 3 * static_cast<Eigen::Index>(section_of_[k]);
    by_command(to, from) = by_command(to + 1, from + 1) = shares_[k];
    by_command(to + 2, from + 2) = 1;
  }
}

std::vector<SwingMode> Actuation::swing(const ArmState& command, std::size_t most) const {
  if (!response_) return {};
  std::vector<SwingMode> modes = response_->swing(command, most);
  for (SwingMode& mode : modes)
    for (std::size_t k = 0; k < arcs(); ++k)
      mode.shape.segment<2>(3 * static_cast<Eigen::Index>(k)) *= shares_[k];
  return modes;
}

std::vector<ArmState> Actuation::released(const ArmState& command) const {
  if (!response_) return {};
  std::vector<ArmState> shapes = response_->released(command);
  for (ArmState& shape : shapes)
    for (std::size_t k = 0; k < arcs(); ++k) shape.bends[k] *= shares_[k];
  return shapes;
}

void Actuation::by_command(const Eigen::MatrixXd& by_shape, const ArmState& command,
                           Eigen::MatrixXd& by_command) const {
  if (sections_ == 0) {
    by_command = by_shape;
    return;
  }
  if (by_shape.cols() != 3 * static_cast<Eigen::Index>(arcs()))
    throw std::invalid_argument("a derivative with respect to a shape must have three columns per arc");
  if (response_) {
    Eigen::MatrixXd slopes_here;
    slopes(command, slopes_here);
    by_command.noalias() = by_shape * slopes_here;
    return;
  }
  // Multiplies block by block, because the matrix would be mostly zeros.
  by_command.setZero(by_shape.rows(), 3 * static_cast<Eigen::Index>(sections_));
  for (std::size_t k = 0; k < arcs(); ++k) {
    const auto from = 3 * static_cast<Eigen::Index>(k), to = 3 * static_cast<Eigen::Index>(section_of_[k]);
    by_command.middleCols<2>(to) += shares_[k] * by_shape.middleCols<2>(from);
    by_command.col(to + 2) += by_shape.col(from + 2);
  }
}

Arm shaped_arm(const Arm& driven, const Actuation& actuation) {
  Arm shaped = driven;
  if (actuation.is_identity()) return shaped;
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

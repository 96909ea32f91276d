#include "flexura/mechanics/rod_response.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "flexura/kinematics/tendons.h"
#include "flexura/math/dense.h"
#include "flexura/mechanics/arm_rod.h"
#include "flexura/model/actuation.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

// Number of Gauss-Newton steps that fit arcs to a rod.
constexpr int max_fit_steps = 20;
constexpr double stretch_secant = 0.005;

std::size_t arcs_of(const Section& section) {
  return section.bend_profile ? section.bend_profile->size() : 1;
}

// Sample places of each arc; enough for a single arc to represent its section.
std::size_t samples_an_arc(const Section& section) {
  return std::max<std::size_t>(4, (12 + arcs_of(section) - 1) / arcs_of(section));
}

// Place of sample `k` of arc `arc` of a section, as a part of the section's length.
double place_of(const Section& section, std::size_t arc, std::size_t k) {
  const std::size_t count = samples_an_arc(section);
  return static_cast<double>(arc * count + k + 1) / static_cast<double>(arcs_of(section) * count);
}

template <typename Function>
void for_places(const Arm& driven, Function&& f) {
  for (std::size_t i = 0; i < driven.sections.size(); ++i)
    for (std::size_t arc = 0; arc < arcs_of(driven.sections[i]); ++arc)
      for (std::size_t k = 0; k < samples_an_arc(driven.sections[i]); ++k) f(i, arc, k);
}

std::vector<RodPlace> rod_places(const Arm& driven) {
  std::vector<RodPlace> places;
  for_places(driven, [&](std::size_t i, std::size_t arc, std::size_t k) {
    places.push_back({i, place_of(driven.sections[i], arc, k)});
  });
  return places;
}

Arm in_its_frame(Arm arm) {
  arm.X_WB = Pose();
  return arm;
}

Rod fitting(const Arm& driven, const Rod& rod, const std::optional<Drive>& drive) {
  if (rod.sections.size() != driven.sections.size())
    throw std::invalid_argument("the rod and the arm have different numbers of sections");
  if (drive && drive->tendons.size() != rod.tendons.size())
    throw std::invalid_argument("the drive and the rod have different numbers of tendons");
  return rod;
}

Rod without_friction(Rod rod) {
  for (TendonRoute& tendon : rod.tendons) tendon.friction = 0;
  return rod;
}

}  // namespace

RodResponse::RodResponse(const Arm& driven, const Rod& rod, RodLoads loads, std::optional<Drive> drive,
                         bool swings)
    : driven_(in_its_frame(driven)),
      shaped_(shaped_arm(driven_, Actuation(driven_, nullptr))),
      loads_(std::move(loads)),
      drive_(std::move(drive)),
      variables_(shaped_),
      slots_(2, Slot{.statics = RodStatics(fitting(driven, rod, drive_))}),
      dynamics_(swings ? std::make_unique<RodDynamics>(without_friction(rod)) : nullptr),
      fine_(rod, rod_places(driven)) {
  std::size_t first = 0;
  for_places(driven_, [&](std::size_t i, std::size_t arc, std::size_t k) {
    const std::size_t count = samples_an_arc(driven_.sections[i]);
    if (arc == 0 && k == 0 && i > 0) first += arcs_of(driven_.sections[i - 1]);
    places_.push_back({i,
                       fine_.node_of({i, place_of(driven_.sections[i], arc, k)}),
                       {first + arc, static_cast<double>(k + 1) / static_cast<double>(count)}});
    if (k + 1 == count) ends_.push_back(places_.size() - 1);
  });
  has_driven_lengths_ = !drive_ && std::ranges::any_of(driven_.sections, &Section::can_stretch);
  std::vector<MaterialPoint> on_arcs;
  on_arcs.reserve(places_.size());
  for (const Place& place : places_) on_arcs.push_back(place.on_arcs);
  for (Slot& slot : slots_) slot.fit.emplace(variables_, on_arcs);
  tight_.assign(rod.tendons.size(), 0.0);
  if (drive_ && drive_->pretension > 0) tight_ = pretension_displacements(now().statics, drive_->pretension);
  const ArmState straight = ArmState::straight(driven_.sections.size());
  straight_ = solved(straight, {});
  if (!straight_.converged())
    throw std::invalid_argument("the arm has no equilibrium under its weight and loads");
}

std::vector<double> RodResponse::displacements(const ArmState& command) const {
  std::vector<double> pulled = drive_ ? tendon_displacements(driven_, *drive_, command).pulled
                                      : arc_displacements(fine_.rod(), command).pulled;
  for (std::size_t i = 0; i < pulled.size(); ++i) pulled[i] += tight_[i];
  return pulled;
}

Eigen::MatrixXd RodResponse::displacement_slopes(const ArmState& command) const {
  return drive_ ? tendon_jacobian(driven_, *drive_, command) : arc_displacement_slopes(fine_.rod(), command);
}

Equilibrium RodResponse::solved(const ArmState& command, const Equilibrium& near) const {
  const auto is_length = [](double stretch) { return stretch > 0 && std::isfinite(stretch); };
  if (!std::ranges::all_of(command.stretches, is_length)) {
    Equilibrium none;
    none.end = StaticsEnd::bad_input;
    return none;
  }
  if (!drive_) now().statics.stretch_rest(command.stretches);
  return now().statics.solve({.displacements = displacements(command)}, loads_, near);
}

const RodResponse::Answer& RodResponse::answer(const ArmState& command) const {
  require_fit(driven_, command);
  const auto known = std::ranges::find_if(
      slots_, [&](const Slot& slot) { return slot.last && slot.last->command == command; });
  if (known != slots_.end()) {
    slot_ = static_cast<std::size_t>(known - slots_.begin());
    return *now().last;
  }
  slot_ = (slot_ + 1) % slots_.size();
  now().last.reset();
  Answer next{command, solved(command, straight_), {}};
  next.shape = fitted(next.at, command);
  now().last = std::move(next);
  return *now().last;
}

// Returns arcs whose ends have the rod's tangents: start of the fit. The rod must be placed.
ArmState RodResponse::along_tangents(const ArmState& command) const {
  ArmState shape = ArmState::straight(ends_.size());
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (std::size_t k = 0; k < ends_.size(); ++k) {
    const Place& end = places_[ends_[k]];
    const Eigen::Vector3d z = R.transpose() * fine_.pose(end.node).rotation.col(2);
    const double across = z.head<2>().norm();
    shape.bends[k] = across > 0 ? Eigen::Vector2d(z.head<2>() * (std::atan2(across, z.z()) / across))
                                : Eigen::Vector2d::Zero();
    if (driven_.kind == ArmKind::planar) shape.bends[k].y() = 0;
    shape.stretches[k] = command.stretches[end.section];
    R = R * arc_pose(shape.bends[k], 1).rotation;
  }
  return shape;
}

ArmState RodResponse::fitted(const Equilibrium& at, const ArmState& command) const {
  if (!at.converged()) {
    ArmState none = ArmState::straight(ends_.size());
    none.bends.assign(ends_.size(), Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
    return none;
  }
  if (!drive_) fine_.stretch_rest(command.stretches);
  fine_.place(at.q);
  ArmState shape = along_tangents(command);
  const double length = driven_.length();
  Eigen::MatrixXd missed(3 * static_cast<Eigen::Index>(places_.size()), 1), reached;
  for (int step = 0; step < max_fit_steps; ++step) {
    now().fit->set(shaped_, shape);
    for (std::size_t p = 0; p < places_.size(); ++p) {
      const Place& place = places_[p];
      missed.col(0).segment<3>(3 * static_cast<Eigen::Index>(p)) =
          fine_.pose(place.node).position - now().fit->position(p);
    }
    const Eigen::VectorXd change = now().fit->solve(missed, &reached);
    for (std::size_t k = 0; k < ends_.size(); ++k) {
      const ArmVariables::Part& part = variables_.parts()[k];
      shape.bends[k] += part.bend(change);
      if (part.is_stretchable) shape.stretches[k] += change[part.stretch_at()];
    }
    if (change.norm() < 1e-12 || reached.norm() < 1e-13 * length) break;
  }
  return shape;
}

// A control step asks for the shapes of the same few commands several times.
ArmState RodResponse::shape(const ArmState& command) const {
  const std::lock_guard lock(mutex_);
  const auto known = std::ranges::find(shapes_, command, &KnownShape::command);
  if (known != shapes_.end()) return known->shape;
  const ArmState shape = answer(command).shape;
  if (shapes_.size() == most_shapes) shapes_.pop_front();
  shapes_.push_back({command, shape});
  return shape;
}

Equilibrium RodResponse::equilibrium(const ArmState& command) const {
  const std::lock_guard lock(mutex_);
  return answer(command).at;
}

void RodResponse::slopes(const ArmState& command, Eigen::MatrixXd& by_command) const {
  const std::lock_guard lock(mutex_);
  by_command.setZero(3 * static_cast<Eigen::Index>(ends_.size()),
                     3 * static_cast<Eigen::Index>(driven_.sections.size()));
  const Answer& here = answer(command);
  if (!here.at.converged()) {
    by_command.setConstant(std::numeric_limits<double>::quiet_NaN());
  } else if (!has_driven_lengths_) {
    // Solver and fit are at this command.
    analytic_slopes(RodStatics::Slack::hangs, by_command);
    if (std::ranges::any_of(here.at.tensions, [](double tension) { return tension == 0; }))
      go_beyond_slack(by_command);
  } else {
    secant_slopes(here, by_command);
  }
}

RodResponse::~RodResponse() = default;

// Returns the changes of the nearest arcs' (bend_x, bend_y, stretch) by changes of the modes, one column
// each, at the last answer.
Eigen::MatrixXd RodResponse::arcs_along(const Eigen::MatrixXd& dq) const {
  if (!drive_) fine_.stretch_rest(now().last->command.stretches);
  fine_.place_with_columns(now().last->at.q);
  Eigen::MatrixXd places(3 * static_cast<Eigen::Index>(places_.size()), dq.cols());
  RodElement::Columns twists(6, fine_.size());
  for (std::size_t p = 0; p < places_.size(); ++p) {
    const Place& place = places_[p];
    fine_.columns_at(place.node.element, place.node.node, twists);
    const Eigen::Vector3d at = fine_.pose(place.node).position;
    const Eigen::MatrixXd moved = twists * dq;
    for (Eigen::Index c = 0; c < moved.cols(); ++c)
      places.block<3, 1>(3 * static_cast<Eigen::Index>(p), c) =
          moved.col(c).head<3>() + moved.col(c).tail<3>().cross(at);
  }
  const Eigen::MatrixXd arcs = now().fit->solve(places);
  Eigen::MatrixXd changes = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(ends_.size()), dq.cols());
  for (std::size_t k = 0; k < ends_.size(); ++k) {
    const ArmVariables::Part& part = variables_.parts()[k];
    const auto row = 3 * static_cast<Eigen::Index>(k);
    changes.row(row) = arcs.row(part.at);
    if (part.is_spatial) changes.row(row + 1) = arcs.row(part.at + 1);
    if (part.is_stretchable) changes.row(row + 2) = arcs.row(part.stretch_at());
  }
  return changes;
}

void RodResponse::analytic_slopes(RodStatics::Slack slack, Eigen::MatrixXd& by_command) const {
  // mutex_ is held, so no other thread has changed the last answer.
  by_command = arcs_along(now().statics.slopes(slack).q_by_input * displacement_slopes(now().last->command));
}

TendonTensions RodResponse::tensions(const ArmState& command) const {
  const std::lock_guard lock(mutex_);
  const Answer& here = answer(command);
  if (!here.at.converged() || has_driven_lengths_) return {};
  return {.tensions = Eigen::Map<const Eigen::VectorXd>(here.at.tensions.data(),
                                                        static_cast<Eigen::Index>(here.at.tensions.size())),
          .by_command = now().statics.slopes(RodStatics::Slack::hangs).tensions_by_input *
                        displacement_slopes(command)};
}

std::vector<ArmState> RodResponse::released(const ArmState& command) const {
  const std::lock_guard lock(mutex_);
  const Equilibrium near = answer(command).at;
  if (!drive_ && near.converged()) now().statics.stretch_rest(command.stretches);
  std::vector<ArmState> shapes;
  for (std::size_t i = 0; i < tight_.size(); ++i) {
    std::vector<double> pulled = displacements(command);
    pulled[i] = -driven_.length();
    Equilibrium at;
    if (near.converged()) at = now().statics.solve({.displacements = std::move(pulled)}, loads_, near);
    shapes.push_back(fitted(at, command));
  }
  now().last.reset();  // Solver and fit are at another equilibrium now.
  return shapes;
}

// With M = L L^T, the modes are the eigenvectors of L^-1 K L^-T, and a command that accelerates the
// equilibrium q_e acts as the force -M q_e''.
std::vector<SwingMode> RodResponse::swing(const ArmState& command, std::size_t most) const {
  const std::lock_guard lock(mutex_);
  const Answer& here = answer(command);
  if (!dynamics_ || has_driven_lengths_ || !here.at.converged()) return {};
  const RodDynamicsSlopes by =
      dynamics_->slopes(dynamics_->rest(here.at), {.displacements = displacements(command)}, loads_);
  const Eigen::LLT<Eigen::MatrixXd> mass(by.mass);
  const auto across = [&](const Eigen::MatrixXd& form) {
    const Eigen::MatrixXd half = mass.matrixL().solve(form);
    return Eigen::MatrixXd(mass.matrixL().solve(half.transpose()));
  };
  const Eigen::MatrixXd K = across(-0.5 * (by.force_by_q + by.force_by_q.transpose()));
  const SymmetricEigen eigen = symmetric_eigen(K);
  const Eigen::MatrixXd D = eigen.vectors.transpose() * across(-by.force_by_v) * eigen.vectors;
  const Eigen::MatrixXd shapes = mass.matrixU().solve(eigen.vectors);  // In q.
  const Eigen::MatrixXd arcs = arcs_along(shapes);
  const Eigen::MatrixXd kicks = -shapes.transpose() * by.mass *
                                now().statics.slopes(RodStatics::Slack::hangs).q_by_input *
                                displacement_slopes(command);
  std::vector<SwingMode> modes;
  for (Eigen::Index j = 0; j < eigen.values.size() && modes.size() < most; ++j) {
    const double size = arcs.col(j).cwiseAbs().maxCoeff();
    if (!(eigen.values[j] > 0) || !(size > 0)) continue;
    const double frequency = std::sqrt(eigen.values[j]);
    modes.push_back({.frequency = frequency,
                     .damping = 0.5 * D(j, j) / frequency,
                     .shape = arcs.col(j) / size,
                     .kick = size * kicks.row(j).transpose()});
  }
  return modes;
}

// Some commands only take up slack, and the derivative is singular. These are the commands with less than
// half the response of an arm whose tendons are all taut. Along them the derivative is that of the taut arm.
void RodResponse::go_beyond_slack(Eigen::MatrixXd& by_command) const {
  constexpr double least_part = 0.5;
  Eigen::MatrixXd taut(by_command.rows(), by_command.cols());
  taut.setZero();
  analytic_slopes(RodStatics::Slack::is_taut, taut);
  std::vector<Eigen::Index> bends;
  for (Eigen::Index c = 0; c < by_command.cols(); ++c) {
    if (c % 3 == 2)
      by_command.col(c) = taut.col(c);
    else
      bends.push_back(c);
  }
  const Eigen::MatrixXd as_taut = taut(Eigen::all, bends), as_is = by_command(Eigen::all, bends);
  const Eigen::MatrixXd part = pseudo_inverse(as_taut) * as_is;
  const SymmetricEigen answers = symmetric_eigen(part.transpose() * part);
  const Eigen::Index dead = (answers.values.array() < least_part * least_part).count();
  const auto along = answers.vectors.leftCols(dead);
  by_command(Eigen::all, bends) = as_is + (as_taut - as_is) * along * along.transpose();
}

void RodResponse::secant_slopes(const Answer& kept, Eigen::MatrixXd& by_command) const {
  const ArmVariables varied(driven_);
  const auto column = [&](Eigen::Index c, double step, auto&& moved) {
    ArmState sides[2];
    for (int side = 0; side < 2; ++side) {
      ArmState command = kept.command;
      moved(command) += side == 0 ? step : -step;
      sides[side] = fitted(solved(command, kept.at), command);
    }
    for (std::size_t k = 0; k < ends_.size(); ++k) {
      const auto row = 3 * static_cast<Eigen::Index>(k);
      by_command.block<2, 1>(row, c) = (sides[0].bends[k] - sides[1].bends[k]) / (2 * step);
      by_command(row + 2, c) = (sides[0].stretches[k] - sides[1].stretches[k]) / (2 * step);
    }
  };
  for (std::size_t i = 0; i < driven_.sections.size(); ++i) {
    const ArmVariables::Part& part = varied.parts()[i];
    const auto c = 3 * static_cast<Eigen::Index>(i);
    column(c, secant, [i](ArmState& state) -> double& { return state.bends[i].x(); });
    if (part.is_spatial)
      column(c + 1, secant, [i](ArmState& state) -> double& { return state.bends[i].y(); });
    if (part.is_stretchable)
      column(c + 2, stretch_secant, [i](ArmState& state) -> double& { return state.stretches[i]; });
  }
  // Solver and fit are at another command now.
  now().last.reset();
}

}  // namespace flexura

// Moves of clients in a live session, and their safety checks.
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "flexura/math/arrays.h"
#include "flexura/port/camera_moves.h"
#include "flexura/view/answers.h"
#include "flexura/view/live_session.h"

namespace flexura {

// Checks one move at a time; of those arriving meanwhile the newest counts.
void LiveSession::move(Move move) {
  if (!is_looking_) {
    look_at(std::move(move));
    return;
  }
  std::optional<Move> overtaken = std::exchange(waiting_, std::move(move));
  if (!overtaken) return;
  InverseResult unknown;
  const bool is_tip = std::holds_alternative<TipRequest>(overtaken->target);
  overtaken->reply({is_tip ? tip_answer(unknown, "replaced by a newer request") : nothing(), ""});
}

LiveSession::Judged LiveSession::judge(const ViewedRig& rig, const ArmState& from, const Move& move) {
  Judged judged;
  if (const auto* tip = std::get_if<TipRequest>(&move.target)) {
    judged.found = shape_for_tip(rig.model, from, *tip);
    judged.state = judged.found->state;
  } else if (const auto* pull = std::get_if<TendonPull>(&move.target)) {
    judged.state = nearest_arcs(rig, *pull);
  } else {
    judged.state = std::get<ArmState>(move.target);
  }
  judged.danger = danger_on_path(rig.model, rig.forbidden, from, judged.state);
  return judged;
}

void LiveSession::look_at(Move move) {
  is_looking_ = true;
  background().run(
      Lane::checks,
      [this, rig = viewed(), from = rig_.nominal(), move = std::move(move), generation = generation_,
       alive = this->alive()]() -> Background::After {
        Judged judged;
        try {
          judged = judge(*rig, from, move);
        } catch (const std::exception& error) {
          judged.danger = error.what();
        }
        return [this, move, judged, generation, alive] {
          if (alive.expired()) return;
          is_looking_ = false;
          if (generation == generation_) {
            finish(move, judged);
          } else {
            move.reply({nothing(), "cancelled before the motion's start: the arm was stopped or reset"});
          }
          if (waiting_ && !is_looking_) look_at(*std::exchange(waiting_, std::nullopt));
        };
      });
}

void LiveSession::finish(const Move& move, const Judged& judged) {
  if (!judged.danger.empty()) {
    warn("the arm does not move there: " + judged.danger);
    move.reply(judged.found ? ViewAnswer{tip_answer(*judged.found, judged.danger), ""}
                            : ViewAnswer{nothing(), "unsafe: " + judged.danger});
    return;
  }
  double duration = move.duration;
  if (judged.found) {
    // Follows a hand at once, and moves at a limited rate over long distances.
    constexpr double shortest = 0.05, rate = 4;  // s, rad/s
    const ArmState from = rig_.nominal();
    duration = shortest;
    for (std::size_t i = 0; i < from.bends.size(); ++i)
      duration = std::max(duration, (judged.state.bends[i] - from.bends[i]).norm() / rate);
  }
  const auto* pull = std::get_if<TendonPull>(&move.target);
  const CommandOutcome sent =
      pull != nullptr ? rig_.pull(*pull, duration) : rig_.ports().arm->command(judged.state, duration);
  const auto fault = sent.fault();
  if (!fault) left_.reset();
  move.reply({judged.found ? tip_answer(*judged.found, "") : nothing(), fault ? text(*fault) : ""});
}

// Warns at most twice a second while a hand drags against an obstacle.
void LiveSession::warn(const std::string& text) {
  constexpr double between = 0.5;  // s
  if (rig_.now() - warned_ < between) return;
  warned_ = rig_.now();
  event("warning", "safety", text);
}

void LiveSession::halt() {
  cancel();
  release();
  ++generation_;
  if (waiting_)
    std::exchange(waiting_, std::nullopt)
        ->reply({nothing(), "cancelled before the motion's start: the arm was stopped or reset"});
  const RigPorts ports = rig_.ports();
  // The simulated rig's links are never interrupted: a fault here is a program error.
  (void)ports.arm->halt().value();
  for (const CameraPorts& camera : ports.cameras) (void)halt_camera(camera).value();
  aim_at_readings();
  left_ = {Condition::halted, "everything was stopped"};
}

// Takes the readings of the cameras as their commanded positions, to which further commands are relative.
void LiveSession::aim_at_readings() {
  head_targets_.clear();
  stage_targets_.clear();
  const RigPorts ports = rig_.ports();
  for (std::size_t i = 0; i < ports.cameras.size(); ++i) {
    const CameraStance stands = measured_stance(ports.cameras[i], viewed()->nominal[i]).value();
    head_targets_.push_back(stands.head);
    stage_targets_.push_back(stands.stage);
  }
}

void LiveSession::reset() {
  ++generation_;
  pushing_client_.reset();
  warning_.clear();
  if (waiting_)
    std::exchange(waiting_, std::nullopt)
        ->reply({nothing(), "cancelled before the motion's start: the arm was stopped or reset"});
  ++leaps_;
  rig_.restart(clock_ - config_.start);
  aim_at_readings();
  left_.reset();
  is_touching_ = !touched(rig_.backbone(rig_.now()), viewed()->forbidden).empty();
}

// Switches weight and loads on or off. They change at once, since they have no inertia.
void LiveSession::weigh(bool on) {
  if (!viewed()->has_weight)
    throw ViewRefusal("weight: this arm has neither weight nor loads that can be switched off");
  try {
    rig_.weigh(on);
  } catch (const std::runtime_error& error) {
    throw ViewRefusal(fmt::format("weight: nothing was changed: {}", error.what()));
  }
  const std::string text = touched(rig_.backbone(rig_.now()), viewed()->forbidden);
  if (!text.empty() && !is_touching_) notice("error", "safety", text);
  is_touching_ = !text.empty();
}

void LiveSession::push(ClientId client, const PushRequest& request) {
  const std::optional<PushScale>& scale = viewed()->push;
  if (!scale)
    throw ViewRefusal("push: forces do not move this arm: expected [arm] model = \"static\" or \"dynamic\"");
  constexpr double rounding = 1e-6;  // A page has positions from states in single precision.
  if (request.s > (1 + rounding) * scale->length)
    throw ViewRefusal(fmt::format("s = {:.6g}: expected 0 to {:.6g} m", request.s, scale->length));
  PlantPush push{.s_rest = std::min(request.s, scale->length), .most = scale->most};
  if (request.force) {
    push.force = vector(*request.force);
    if (push.force.norm() > scale->most)
      throw ViewRefusal(
          fmt::format("force: {:.4g} N: expected at most {:.4g} N", push.force.norm(), scale->most));
  } else {
    constexpr double stiffest = 100;  // Multiple of the default stiffness.
    push.to = vector(*request.to);
    push.stiffness = request.stiffness.value_or(scale->stiffness);
    if (push.stiffness > stiffest * scale->stiffness)
      throw ViewRefusal(fmt::format("stiffness = {:.6g}: expected at most {:.4g} N/m", push.stiffness,
                                    stiffest * scale->stiffness));
  }
  try {
    rig_.push(push);
  } catch (const std::exception& error) {
    throw ViewRefusal(fmt::format("push: nothing was changed: {}", error.what()));
  }
  pushing_client_ = client;
  left_.reset();
}

void LiveSession::release() {
  pushing_client_.reset();
  if (!rig_.is_pushed()) return;
  try {
    rig_.push(std::nullopt);
  } catch (const std::runtime_error& error) {
    notice("error", "safety", std::string("everything is reset to the start: ") + error.what());
    reset();
  }
}

// An arm that is pushed or swings moves without drive motion: reports what it touches.
void LiveSession::watch_yielding() {
  if (rig_.is_arm_moving() || !rig_.is_yielding()) return;
  const std::string text = touched(rig_.backbone(rig_.now()), viewed()->forbidden);
  const bool was_touching = std::exchange(is_touching_, !text.empty());
  if (!text.empty() && !was_touching) notice("warning", "safety", text);
}

// Reports once when the rig becomes slow.
void LiveSession::report_pace() {
  const std::optional<double> pace = rig_.pace();
  if (pace && !is_slow_)
    event("warning", "clock", "the simulation is slower than real time: the arm moves more slowly");
  is_slow_ = pace.has_value();
}

// Reports a new warning once.
void LiveSession::report_warning() {
  if (!viewed()->is_rod) return;
  std::string warning = rig_.warning();
  if (!warning.empty() && warning != warning_) notice("warning", "statics", warning);
  warning_ = std::move(warning);
}

// Stops the arm before a step in which it would touch an obstacle.
void LiveSession::keep_clear(double next) {
  if (!rig_.is_arm_moving()) return;
  const std::string text = touched(rig_.backbone(next), viewed()->forbidden);
  const bool was_touching = std::exchange(is_touching_, !text.empty());
  if (text.empty() || was_touching) return;
  ++generation_;
  (void)rig_.ports().arm->halt().value();
  is_touching_ = false;
  left_ = {Condition::halted, "stopped before " + text};
  event("error", "safety", left_->text);
}

// A rod may reach a state without equilibrium.
void LiveSession::move_on(double next) {
  // A run has a rig of its own, and takes what the machine can give.
  if (is_run_shown()) {
    rig_.rest_until(next);
    return;
  }
  rig_.skip_to(next);
  try {
    keep_clear(next);
    rig_.go_to(next);
    watch_yielding();
  } catch (const std::runtime_error& error) {
    notice("error", "safety", std::string("everything is reset to the start: ") + error.what());
    reset();
  }
}

// Returns what is unsafe in the present state of a run, or "".
std::string LiveSession::run_danger() {
  const std::string limit = beyond_limits(viewed()->model.driven(), news_.state);
  return limit.empty() ? touched(shown_backbone(), viewed()->forbidden) : limit;
}

Conditioned LiveSession::condition() {
  if (run_ != nullptr) {
    const std::string danger = news_.time ? run_danger() : "";
    return danger.empty() ? Conditioned{Condition::running, news_.what}
                          : Conditioned{Condition::unsafe, danger};
  }
  if (is_touching_) return {Condition::unsafe, touched(rig_.backbone(rig_.now()), viewed()->forbidden)};
  if (left_) return *left_;
  return {rig_.is_arm_moving() || rig_.is_yielding() ? Condition::moving : Condition::idle, ""};
}

// Reports the condition to the clients if it has changed.
void LiveSession::report_condition() {
  const Conditioned now = condition();
  const bool is_new = now.condition != reported_.condition ||
                      (now.condition != Condition::running && now.text != reported_.text);
  if (!is_new) return;
  reported_ = now;
  const std::string text = condition_message(reported_);
  for (const ClientId client : clients_) messenger().send(client, text);
}

}  // namespace flexura

#include "flexura/equipment/onvif_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "flexura/base/degree.h"
#include "flexura/base/one_line.h"
#include "flexura/equipment/onvif_http.h"

namespace flexura {
namespace {

bool are_equal(const OnvifPlace& a, const OnvifPlace& b) {
  return a.pan == b.pan && a.tilt == b.tilt && a.zoom == b.zoom;
}

}  // namespace

OnvifHead::OnvifHead(OnvifPorts ports, const OnvifConfig& config, std::string password)
    : ports_(std::move(ports)),
      config_(config),
      login_(std::make_shared<OnvifLogin>(config.user, std::move(password))),
      name_(onvif_name(config)) {
  if (const std::string problem = onvif_problem(config); !problem.empty())
    throw std::invalid_argument("ONVIF head: " + problem);
  working_.client.emplace(ports_, config_, login_);
  halting_.client.emplace(ports_, config_, login_);
}

PortFault OnvifHead::refusal(std::string_view what) const {
  return {FaultKind::refused, fmt::format("{}: {}", name_, what)};
}

std::string OnvifHead::text_of_place(const OnvifPlace& place) const {
  const HeadState state = onvif_state(config_, place);
  return fmt::format("pan {:.2f} deg, tilt {:.2f} deg, zoom {:g} (positions {:g}, {:g}, {:g})",
                     state.pan / degree, state.tilt / degree, state.zoom, place.pan, place.tilt,
                     place.zoom.value_or(0));
}

CommandOutcome OnvifHead::start() {
  {
    const std::scoped_lock working(working_.mutex);
    for (const auto& step : {&OnvifHead::find_services, &OnvifHead::find_profile, &OnvifHead::find_ranges})
      if (const auto done = (this->*step)(); !done) return done;
  }
  const auto first = read();
  if (!first) return *first.fault();
  if (share_stop_) return share_stop_(stop_request());
  return Accepted{};
}

CommandOutcome OnvifHead::find_services() {
  OnvifClient& client = *working_.client;
  if (const auto asked = client.ask_clock(); !asked) return asked;
  auto answer = client.call({"GetServices", config_.path, onvif_ask_services()});
  // Older cameras do not have this request.
  if (!answer && answer.fault()->kind == FaultKind::refused)
    answer = client.call({"GetCapabilities", config_.path, onvif_ask_capabilities()});
  if (!answer) return *answer.fault();
  services_ = parse_onvif_services(answer.value().soap).value_or(OnvifServices{});
  if (services_.ptz.empty())
    return refusal("the camera has no PTZ service: it has no head, or the port is wrong");
  if (services_.media.empty()) return refusal("the camera has no media service (ver10)");
  return Accepted{};
}

CommandOutcome OnvifHead::find_profile() {
  const auto answer = working_.client->call({"GetProfiles", services_.media, onvif_ask_profiles()});
  if (!answer) return *answer.fault();
  std::string names;
  for (const OnvifProfile& one :
       parse_onvif_profiles(answer.value().soap).value_or(std::vector<OnvifProfile>{})) {
    if (one.has_head && (config_.profile.empty() || one.token == config_.profile)) {
      profile_ = one.token, node_ = one.node;
      return Accepted{};
    }
    names += (names.empty() ? "" : ", ") + one_line(one.token) + (one.has_head ? "" : " (without a head)");
  }
  return refusal(fmt::format("no media profile{} with a head; the camera has: {}",
                             config_.profile.empty() ? "" : " \"" + config_.profile + "\"",
                             names.empty() ? "none" : names));
}

CommandOutcome OnvifHead::find_range(const OnvifRange& own, const OnvifTurnConfig& axis, const char* name,
                                     OnvifRange& range) const {
  range = own;
  if (!axis.limits) return Accepted{};
  const auto& [low, high] = *axis.limits;
  if (low < own.min || high > own.max)
    return refusal(fmt::format("{}.limits: {:g} to {:g} is outside the head's range, {:g} to {:g}", name, low,
                               high, own.min, own.max));
  range = {low, high};
  return Accepted{};
}

CommandOutcome OnvifHead::find_ranges() {
  const auto answer = working_.client->call({"GetNodes", services_.ptz, onvif_ask_nodes()});
  if (!answer) return *answer.fault();
  const auto nodes = parse_onvif_nodes(answer.value().soap).value_or(std::vector<OnvifNode>{});
  const auto node = std::ranges::find(nodes, node_, &OnvifNode::token);
  if (node == nodes.end()) return refusal("the camera does not describe the head of its profile");
  const auto turn = std::ranges::find(node->turn, onvif_space(config_), &OnvifSpace::uri);
  if (turn == node->turn.end()) {
    std::string others;
    for (const OnvifSpace& one : node->turn) others += (others.empty() ? "" : ", ") + one_line(one.uri);
    return refusal(fmt::format("no absolute moves in the position space \"{}\"; the head has: {}",
                               config_.space == OnvifPositions::degrees ? "degrees" : "generic",
                               others.empty() ? "none" : others));
  }
  if (const auto pan = find_range(turn->x, config_.pan, "pan", ranges_.pan); !pan) return pan;
  if (const auto tilt = find_range(turn->y, config_.tilt, "tilt", ranges_.tilt); !tilt) return tilt;
  const auto zoom = std::ranges::find(node->zoom, onvif_zoom_space, &OnvifSpace::uri);
  ranges_.has_zoom = zoom != node->zoom.end();
  if (ranges_.has_zoom &&
      (config_.zoom.points.front() < zoom->x.min || config_.zoom.points.back() > zoom->x.max))
    return refusal(fmt::format("zoom.points: {:g} to {:g} is outside the head's range, {:g} to {:g}",
                               config_.zoom.points.front(), config_.zoom.points.back(), zoom->x.min,
                               zoom->x.max));
  return Accepted{};
}

std::string OnvifHead::stop_request() const {
  return http_post(onvif_host(config_), services_.ptz,
                   soap_message(onvif_stop(profile_), login_->token(ports_.now())), false);
}

// Under working_.
Outcome<OnvifHead::Sample> OnvifHead::sample() {
  const auto answer = working_.client->call({"GetStatus", services_.ptz, onvif_ask_status(profile_)});
  if (!answer) return *answer.fault();
  const auto status = parse_onvif_status(answer.value().soap);
  if (!status || !status->place) return refusal("reports no position: its moves could not be verified");
  if (ranges_.has_zoom && !status->place->zoom)
    return refusal("reports no zoom position: its moves could not be verified");
  if (!status->turn_space.empty() && status->turn_space != onvif_space(config_))
    return refusal(
        fmt::format("reports positions in the space {}, not in {}: set space, or the head's default space",
                    one_line(status->turn_space), onvif_space(config_)));
  Sample taken{answer.value().time, *status->place, status->is_moving, status->error};
  if (!ranges_.has_zoom) taken.place.zoom.reset();
  return taken;
}

CommandOutcome OnvifHead::command(const HeadState& state) {
  if (!std::isfinite(state.pan) || !std::isfinite(state.tilt) || !std::isfinite(state.zoom))
    return refusal("a position is not a finite number");
  const std::scoped_lock working(working_.mutex);
  const OnvifPlace place = onvif_place(config_, ranges_, state);
  std::uint64_t order = 0;
  {
    const std::scoped_lock lock(state_mutex_);
    order = ++order_;
    ++move_;
    goal_.reset();
    is_newly_ordered_ = true;
    halted_ = std::nullopt;
  }
  const auto sent = send(order, place);
  const std::scoped_lock lock(state_mutex_);
  if (sent && order_ == order) goal_ = Goal{.place = place, .failure = {}};
  return sent;
}

// Under working_.
CommandOutcome OnvifHead::send(std::uint64_t order, const OnvifPlace& place) {
  const auto is_newest = [this, order] { return order_ == order; };
  if (share_stop_)
    if (const auto shared = share_stop_(stop_request()); !shared) return shared;
  const std::string body = onvif_move(profile_, place, onvif_space(config_), config_.speed);
  const auto sent = working_.client->call({"AbsoluteMove", services_.ptz, body}, is_newest);
  if (is_newest()) {
    if (!sent) return *sent.fault();
    return Accepted{};
  }
  // The camera may have taken the halt before the move.
  const std::string stop_body = onvif_stop(profile_);
  const auto stopped = working_.client->call({"Stop", services_.ptz, stop_body});
  if (!stopped) return *stopped.fault();
  return refusal("the command was replaced by a halt");
}

CommandOutcome OnvifHead::halt() {
  std::uint64_t move = 0;
  {
    const std::scoped_lock lock(state_mutex_);
    ++order_;
    move = move_;
    goal_.reset();
    is_newly_ordered_ = true;
    halted_ = ports_.now();
  }
  return stop([this, move] { return move_ == move; });
}

CommandOutcome OnvifHead::stop(const std::function<bool()>& is_wanted) {
  const std::scoped_lock halting(halting_.mutex);
  if (profile_.empty()) return Accepted{};  // Nothing was moved.
  const auto stopped = halting_.client->call({"Stop", services_.ptz, onvif_stop(profile_)}, is_wanted);
  // A newer command has replaced the halt.
  if (stopped || !is_wanted()) return Accepted{};
  return *stopped.fault();
}

// Under state_mutex_.
void OnvifHead::judge(const Sample& now) {
  const bool is_same = last_ && are_equal(last_->place, now.place);
  if (!standing_ || is_newly_ordered_ || !are_near(config_, *standing_, now.place))
    standing_ = now.place, standing_since_ = now.time;
  is_moving_ = now.is_moving.value_or(last_ && !is_same);
  if (halted_ && is_same && !is_newly_ordered_ && !is_moving_) halted_ = std::nullopt;
  if (halted_) is_moving_ = true;
  is_newly_ordered_ = false;
  last_ = now;
  if (!goal_) return;
  if (are_near(config_, now.place, goal_->place)) {
    if (is_same || now.is_moving == false) goal_->is_reached = true;
  } else if (goal_->is_reached && is_same) {
    // Someone else has moved the head.
    is_moving_ = false;
    return;
  }
  if (!goal_->is_reached) is_moving_ = true;
}

Outcome<HeadReading> OnvifHead::read() {
  const std::scoped_lock working(working_.mutex);
  {
    const std::scoped_lock lock(state_mutex_);
    if (goal_ && !goal_->failure.empty()) return refusal(goal_->failure);
  }
  const auto taken = sample();
  if (!taken) return *taken.fault();
  const Sample& now = taken.value();
  std::optional<OnvifPlace> again;
  std::uint64_t order = 0, move = 0;
  bool is_stop_lost = false;
  HeadReading reading;
  {
    const std::scoped_lock lock(state_mutex_);
    const auto before = last_;
    judge(now);
    reading = {now.time, onvif_state(config_, now.place), is_moving_};
    order = order_, move = move_;
    const bool is_stalled = now.time - standing_since_ >= config_.stall_time;
    if (goal_ && !goal_->is_reached && is_stalled && !are_near(config_, now.place, goal_->place)) {
      if (goal_->repeats + 1 >= config_.tries) {
        goal_->failure = fmt::format(
            "accepted a move to {} but stands at {}{}: check its limits, its power and that nothing blocks "
            "it",
            text_of_place(goal_->place), text_of_place(now.place),
            now.error.empty() ? std::string() : " and reported \"" + one_line(now.error) + "\"");
        return refusal(goal_->failure);
      }
      ++goal_->repeats;
      again = goal_->place;
      is_newly_ordered_ = true;
    }
    is_stop_lost = halted_ && before && before->time - *halted_ > config_.stall_time &&
                   !are_equal(before->place, now.place);
  }
  if (again)
    if (const auto sent = send(order, *again); !sent && order_ == order) return *sent.fault();
  if (is_stop_lost) {
    (void)stop([this, move] { return move_ == move; });
    return refusal(
        "still moves after a halt, and was stopped again: if it does not stand still, cut its power");
  }
  return reading;
}

Outcome<std::unique_ptr<OnvifHead>> open_onvif_head(
    const OnvifConfig& config, const ClockPort& clock,
    std::function<CommandOutcome(const std::string& request)> share_stop,
    std::function<Outcome<std::unique_ptr<Link>>()> connect) {
  std::string password;
  if (!config.password_file.empty()) {
    std::ifstream file(config.password_file);
    if (!std::getline(file, password))
      return PortFault{FaultKind::refused, fmt::format("{}: {}: no password can be read from this file",
                                                       onvif_name(config), one_line(config.password_file))};
    if (password.ends_with('\r')) password.pop_back();
  }
  if (!connect)
    connect = [address = parse_link_address(config.link), timeout = config.reply_timeout] {
      return open_link(address, timeout);
    };
  auto head = std::make_unique<OnvifHead>(OnvifPorts{std::move(connect), [&clock] { return clock.now(); }},
                                          config, std::move(password));
  head->share_stop(std::move(share_stop));
  if (const auto started = head->start(); !started) return *started.fault();
  return head;
}

}  // namespace flexura

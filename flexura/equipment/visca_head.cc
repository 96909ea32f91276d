#include "flexura/equipment/visca_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "flexura/base/degree.h"

namespace flexura {
namespace {

bool is_between(std::int64_t a, std::int64_t b, std::int64_t c) {
  return std::min(a, c) <= b && b <= std::max(a, c);
}

// Returns what to do about an error.
std::string visca_hint(int code) {
  switch (static_cast<ViscaError>(code)) {
    case ViscaError::length:
    case ViscaError::syntax:
      return "set pan.digits, tilt.digits, pan.speed and tilt.speed as in its manual";
    case ViscaError::buffer_full:
      return "switch it off and on";
    case ViscaError::not_executable:
      return "switch it on, close its menu, and check that nothing blocks it";
    default:
      return "see its manual";
  }
}

}  // namespace

ViscaHead::ViscaHead(std::shared_ptr<ViscaBus> bus, const ViscaConfig& config)
    : bus_(std::move(bus)), config_(config), address_(static_cast<int>(config.address)) {
  if (const std::string problem = visca_problem(config); !problem.empty())
    throw std::invalid_argument("VISCA head: " + problem);
  confirms_ = config.confirm.value_or(visca_framing(config.bus) != ViscaFraming::sony);
}

PortFault ViscaHead::refusal(std::string_view what) const {
  return {FaultKind::refused, fmt::format("{}: {}", bus_->name_of(address_), what)};
}

std::string ViscaHead::place(const ViscaCounts& counts) const {
  const HeadState state = visca_state(config_, counts);
  return fmt::format("pan {:.2f} deg, tilt {:.2f} deg, zoom {:g} (counts {}, {}, {})", state.pan / degree,
                     state.tilt / degree, state.zoom, counts.pan, counts.tilt, counts.zoom);
}

Outcome<ViscaVersion> ViscaHead::start() {
  const std::scoped_lock working(working_);
  if (const int heads = bus_->heads(); heads > 0 && address_ > heads)
    return PortFault{FaultKind::link_lost,
                     fmt::format("{}: only {} heads are on the chain", bus_->name_of(address_), heads)};
  constexpr std::size_t version_size = 7;
  const auto answer = bus_->inquire(address_, visca_ask_version(), version_size);
  // Some heads report their positions, but no version.
  const auto first = confirmed_sample(std::nullopt);
  if (!first) return *first.fault();
  {
    const std::scoped_lock lock(state_mutex_);
    judge(first.value());
  }
  const auto version = answer ? parse_visca_version(answer.value().data) : std::nullopt;
  return version.value_or(ViscaVersion{});
}

Outcome<ViscaHead::Sample> ViscaHead::sample() const {
  const ViscaDigits digits = visca_digits(config_);
  // Fields of an answer that are not digits are damage.
  for (std::int64_t i = 0; i < config_.bus.tries; ++i) {
    const auto turn =
        bus_->inquire(address_, visca_ask_move(),
                      static_cast<std::size_t>(digits.pan) + static_cast<std::size_t>(digits.tilt));
    if (!turn) return *turn.fault();
    const auto zoom = bus_->inquire(address_, visca_ask_zoom(), 4);
    if (!zoom) return *zoom.fault();
    const auto angles = parse_visca_place(turn.value().data, digits);
    const auto count = parse_visca_zoom(zoom.value().data);
    if (angles && count) return Sample{turn.value().time, {angles->pan, angles->tilt, *count}};
  }
  return PortFault{FaultKind::link_lost,
                   bus_->name_of(address_) + ": its positions arrive damaged: check the cable"};
}

// A position counts if two samples agree, or if it is between those before and after, as in a move.
Outcome<ViscaHead::Sample> ViscaHead::confirmed_sample(const std::optional<Sample>& last) const {
  auto newest = sample();
  if (!newest) return newest;
  std::optional<Sample> before, middle = last, after = newest.value();
  const std::int64_t most = 4 + 2 * config_.bus.tries;
  for (std::int64_t i = 0; i < most; ++i) {
    const ViscaCounts& b = (middle ? *middle : *after).counts;
    if (middle && b == after->counts) return *after;
    if (before) {
      const ViscaCounts &a = before->counts, &c = after->counts;
      if (is_between(a.pan, b.pan, c.pan) && is_between(a.tilt, b.tilt, c.tilt) &&
          is_between(a.zoom, b.zoom, c.zoom))
        return Sample{middle->time, middle->counts, true};
    }
    // The last reading may be old: a position since then need not be near it.
    before = i == 0 ? std::nullopt : middle;
    middle = after;
    auto next = sample();
    if (!next) return next;
    after = next.value();
  }
  return PortFault{FaultKind::link_lost,
                   bus_->name_of(address_) + ": its answers contradict each other: check the cable"};
}

CommandOutcome ViscaHead::command(const HeadState& state) {
  if (!std::isfinite(state.pan) || !std::isfinite(state.tilt) || !std::isfinite(state.zoom))
    return refusal("a position is not a finite number");
  const std::scoped_lock working(working_);
  Goal goal;
  std::uint64_t order = 0;
  {
    const std::scoped_lock lock(state_mutex_);
    order = ++order_;
    ++move_;
    goal.counts = visca_counts(config_, state);
    previous_ = std::exchange(goal_, std::nullopt);
    // A command that the head already executes is not sent again: it would fill the head's buffer.
    if (previous_ && previous_->failure.empty()) {
      const ViscaCounts &old = previous_->counts, &wanted = goal.counts;
      if (old.pan == wanted.pan && old.tilt == wanted.tilt) goal.turn = previous_->turn;
      if (old.zoom == wanted.zoom) goal.zoom = previous_->zoom;
    }
    goal_ = goal;
    is_newly_ordered_ = true;
    halted_ = std::nullopt;
  }
  return send(order, goal);
}

CommandOutcome ViscaHead::send(std::uint64_t order, const Goal& goal) {
  const auto keep = [&](std::uint64_t Goal::* number, const Outcome<std::uint64_t>& sent) {
    const std::scoped_lock lock(state_mutex_);
    if (order_ != order || !goal_) return;
    if (sent) {
      (*goal_).*number = sent.value();
    } else {
      goal_.reset();
    }
  };
  const std::uint64_t old_turn = previous_ ? previous_->turn : 0, old_zoom = previous_ ? previous_->zoom : 0;
  if (goal.turn == 0) {
    const auto sent =
        send_command(order,
                     visca_move(static_cast<int>(config_.pan.speed), static_cast<int>(config_.tilt.speed),
                                goal.counts.pan, goal.counts.tilt, visca_digits(config_)),
                     old_turn, false);
    keep(&Goal::turn, sent);
    if (!sent) return *sent.fault();
  }
  const auto is_zoomed = [&] {
    const std::scoped_lock lock(state_mutex_);
    return goal_ && goal_->zoom != 0;
  };
  if (!is_zoomed()) {
    const auto sent = send_command(order, visca_zoom(goal.counts.zoom), old_zoom, true);
    keep(&Goal::zoom, sent);
    if (!sent) return *sent.fault();
  }
  return Accepted{};
}

Outcome<std::uint64_t> ViscaHead::send_command(std::uint64_t order, const std::string& body,
                                               std::uint64_t previous, bool is_zoom) {
  const auto is_newest = [this, order] { return order_ == order; };
  int code = 0;
  for (std::int64_t i = 0; i < config_.bus.tries; ++i) {
    const ViscaResult result = bus_->command(address_, body, is_newest);
    switch (result.kind) {
      case ViscaResult::Kind::accepted:
        return result.number;
      case ViscaResult::Kind::revoked:
        return refusal("the command was replaced by a halt");
      case ViscaResult::Kind::lost:
        return PortFault{FaultKind::link_lost, result.what};
      case ViscaResult::Kind::refused:
        code = result.code;
    }
    make_room(order, code, previous, is_zoom);
  }
  return refusal(fmt::format("refuses a move ({}): {}", visca_error_text(code), visca_hint(code)));
}

// Ends what may be the reason of a refusal. A head has two sockets: a move and a zoom fill them.
void ViscaHead::make_room(std::uint64_t order, int code, std::uint64_t previous, bool is_zoom) {
  const auto is_newest = [this, order] { return order_ == order; };
  if (code == static_cast<int>(ViscaError::buffer_full)) {
    if (const auto socket = bus_->socket(previous)) {
      (void)bus_->command(address_, visca_cancel(*socket), is_newest);
      return;
    }
    // The answer with the socket's number was lost. A zoom command must not end its own goal's move.
    std::optional<int> kept;
    {
      const std::scoped_lock lock(state_mutex_);
      if (goal_ && is_zoom) kept = bus_->socket(goal_->turn);
      if (goal_ && !is_zoom) goal_->zoom = 0;
    }
    for (const int socket : {1, 2})
      if (socket != kept) (void)bus_->command(address_, visca_cancel(socket), is_newest);
  } else if (code == static_cast<int>(ViscaError::not_executable)) {
    (void)bus_->command(
        address_,
        is_zoom ? visca_zoom_stop()
                : visca_move_stop(static_cast<int>(config_.pan.speed), static_cast<int>(config_.tilt.speed)),
        is_newest);
  }
}

CommandOutcome ViscaHead::halt() {
  std::uint64_t move = 0;
  {
    const std::scoped_lock lock(state_mutex_);
    ++order_;
    move = move_;
    goal_.reset();
    is_newly_ordered_ = true;
    halted_ = bus_->now();
  }
  if (const auto fault = stop(move)) return *fault;
  return Accepted{};
}

std::optional<PortFault> ViscaHead::stop(std::uint64_t move) {
  const auto turn = stop_by(
      move, visca_move_stop(static_cast<int>(config_.pan.speed), static_cast<int>(config_.tilt.speed)));
  const auto zoom = stop_by(move, visca_zoom_stop());
  return turn ? turn : zoom;
}

std::optional<PortFault> ViscaHead::stop_by(std::uint64_t move, const std::string& body) {
  const auto is_wanted = [this, move] { return move_ == move; };
  int code = 0;
  for (std::int64_t i = 0; i < config_.bus.tries; ++i) {
    const ViscaResult result = bus_->command(address_, body, is_wanted, true);
    if (result.kind == ViscaResult::Kind::accepted || result.kind == ViscaResult::Kind::revoked)
      return std::nullopt;
    if (result.kind == ViscaResult::Kind::lost) return PortFault{FaultKind::link_lost, result.what};
    code = result.code;
    if (code == static_cast<int>(ViscaError::buffer_full))
      for (const int socket : {1, 2}) (void)bus_->command(address_, visca_cancel(socket), is_wanted, true);
  }
  return refusal(fmt::format("refuses to stop ({}): cut its power", visca_error_text(code)));
}

bool ViscaHead::is_at(const ViscaCounts& counts, const ViscaCounts& goal) const {
  return std::abs(counts.pan - goal.pan) <= config_.pan.tolerance &&
         std::abs(counts.tilt - goal.tilt) <= config_.tilt.tolerance &&
         std::abs(counts.zoom - goal.zoom) <= config_.zoom.tolerance;
}

void ViscaHead::judge(const Sample& now) {
  const bool is_same = last_ && last_->counts == now.counts;
  if (!is_same || is_newly_ordered_) standing_since_ = now.time;
  is_moving_ = now.is_changing || (last_ && !is_same);
  if (halted_ && is_same && !is_newly_ordered_) halted_ = std::nullopt;
  if (halted_) is_moving_ = true;
  is_newly_ordered_ = false;
  last_ = now;
  if (!goal_) return;
  const auto has_ended = [&](std::uint64_t number) {
    return number != 0 && bus_->progress(number) == ViscaBus::Progress::ended;
  };
  for (const std::uint64_t number : {goal_->turn, goal_->zoom})
    if (const int code = bus_->failure(number); code != 0) goal_->code = code;
  if (is_at(now.counts, goal_->counts)) {
    if (is_same || (has_ended(goal_->turn) && has_ended(goal_->zoom))) goal_->is_reached = true;
  } else if (goal_->is_reached && is_same) {
    // Someone else has moved the head.
    is_moving_ = false;
    return;
  }
  if (!goal_->is_reached) is_moving_ = true;
}

Outcome<HeadReading> ViscaHead::read() {
  const std::scoped_lock working(working_);
  std::optional<Sample> last, standing;
  {
    const std::scoped_lock lock(state_mutex_);
    if (goal_ && !goal_->failure.empty()) return refusal(goal_->failure);
    last = last_;
    // While the head moves, a late copy of its last answer would agree with the last reading.
    if (!is_moving_ && !is_newly_ordered_) standing = last_;
  }
  const auto taken = last && !confirms_ ? sample() : confirmed_sample(standing);
  if (!taken) return *taken.fault();
  const Sample now = taken.value();
  std::optional<Goal> again;
  std::uint64_t order = 0, move = 0;
  bool is_stop_lost = false;
  HeadReading reading;
  {
    const std::scoped_lock lock(state_mutex_);
    judge(now);
    reading = {now.time, visca_state(config_, now.counts), is_moving_};
    order = order_, move = move_;
    const bool is_stalled = now.time - standing_since_ >= config_.stall_time;
    if (goal_ && !goal_->is_reached && is_stalled && !is_at(now.counts, goal_->counts)) {
      if (goal_->repeats >= config_.bus.tries) {
        const int code = goal_->code;
        goal_->failure = fmt::format(
            "accepted a move to {} but stands at {}{}: check its limits, its power and that nothing blocks "
            "it",
            place(goal_->counts), place(now.counts),
            code == 0 ? std::string() : fmt::format(" and reported \"{}\"", visca_error_text(code)));
        return refusal(goal_->failure);
      }
      ++goal_->repeats;
      goal_->turn = goal_->zoom = 0;
      again = goal_;
      previous_ = goal_;
      is_newly_ordered_ = true;
    }
    is_stop_lost =
        halted_ && last && last->time - *halted_ > config_.stall_time && !(last->counts == now.counts);
  }
  if (again) {
    if (const auto fault = send(order, *again).fault(); fault && order_ == order) {
      // Otherwise later readings would not know that the head is in the wrong place.
      const std::scoped_lock lock(state_mutex_);
      if (order_ == order) goal_ = again;
      return *fault;
    }
  }
  if (is_stop_lost) {
    (void)stop(move);
    return refusal(
        "still moves after a halt, and was stopped again: if it does not stand still, cut its power");
  }
  return reading;
}

std::optional<ViscaCounts> ViscaHead::counts() const {
  const std::scoped_lock lock(state_mutex_);
  if (!last_) return std::nullopt;
  return last_->counts;
}

}  // namespace flexura

#include "flexura/equipment/cia402_bus.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace flexura {
namespace {

// A bus at 1 Mbit/s carries no more frames in the longest wait of this many frames.
constexpr int most_frames = 20'000;

}  // namespace

CanopenBus::CanopenBus(Link& link, const ClockPort& clock, const std::vector<std::uint8_t>& nodes,
                       double timeout, int tries)
    : link_(link), clock_(clock), timeout_(timeout), tries_(tries) {
  for (const std::uint8_t node : nodes) nodes_.push_back({.number = node});
}

PortFault CanopenBus::fault(std::size_t i, FaultKind kind, const std::string& what) const {
  return fault(kind, fmt::format("axis {} (node {}) {}", i + 1, nodes_[i].number, what));
}

void CanopenBus::take(const CanFrame& frame) {
  if (frame.is_error) {
    if (std::string text = can_error_text(frame); !text.empty()) trouble_ = std::move(text);
    return;
  }
  if (frame.is_extended || frame.is_remote) return;
  if (transfer_ != nullptr && transfer_->take(frame)) has_advanced_ = true;
  for (CanopenNode& node : nodes_) {
    if (frame.id == cob::tpdo1 + node.number && frame.size == 6) {
      node.round = round_;
      node.statusword = static_cast<std::uint16_t>(number_at(frame, 0, 2));
      node.position = static_cast<std::int32_t>(number_at(frame, 2, 4));
    } else if (frame.id == cob::emergency + node.number && frame.size >= 3) {
      node.emergency = emergency_in(frame);
    } else if (frame.id == cob::heartbeat + node.number && frame.size == 1) {
      node.state = static_cast<NmtState>(frame.data[0] & 0x7F);
      node.heard = clock_.now();
      node.has_restarted = node.has_restarted || node.state == NmtState::boot_up;
    }
  }
}

Outcome<bool> CanopenBus::wait(const std::function<bool()>& is_done, double end) {
  for (int frames = 0; frames < most_frames; ++frames) {
    if (is_done()) return true;
    if (interrupt_()) return fault(FaultKind::refused, "halted while waiting for an answer");
    const double left = end - clock_.now();
    if (!(left > 0)) return false;
    const auto bytes = link_.read(std::min(left, 0.01));
    if (!bytes) return *bytes.fault();
    if (const auto frame = parse_can_frame(bytes.value())) take(*frame);
  }
  return fault(FaultKind::link_lost, "a device floods the bus");
}

CommandOutcome CanopenBus::drain() {
  for (int frames = 0; frames < most_frames; ++frames) {
    const auto bytes = link_.read(0);
    if (!bytes) return *bytes.fault();
    if (bytes.value().empty()) return Accepted{};
    if (const auto frame = parse_can_frame(bytes.value())) take(*frame);
  }
  return fault(FaultKind::link_lost, "a device floods the bus");
}

CommandOutcome CanopenBus::pause(double duration) {
  const auto waited = wait([] { return false; }, clock_.now() + duration);
  if (!waited) return *waited.fault();
  return Accepted{};
}

PortFault CanopenBus::missing() const {
  const auto found =
      std::ranges::find_if(nodes_, [&](const CanopenNode& node) { return node.round != round_; });
  const auto i = static_cast<std::size_t>(found - nodes_.begin());
  const CanopenNode& node = nodes_[i];
  if (node.state == NmtState::stopped)
    return fault(i, FaultKind::link_lost, "does not answer because it is stopped; start the drives again");
  if (node.state == NmtState::pre_operational)
    return fault(
        i, FaultKind::link_lost,
        "does not answer because it is pre-operational and has probably restarted; check its supply, start "
        "the drives and home them again");
  const double age = clock_.now() - node.heard;
  const std::string heard = node.heard < 0 ? "it has sent no heartbeat"
                                           : fmt::format("its last heartbeat arrived {:.1f} s ago", age);
  return fault(i, FaultKind::link_lost,
               fmt::format("does not answer ({}); {}", heard,
                           trouble_.empty() ? "check its supply, the wiring and the speed of the bus"
                                            : "the bus reports: " + trouble_));
}

Outcome<double> CanopenBus::synchronise() {
  if (const auto drained = drain(); !drained) return *drained.fault();
  for (int i = 0; i < tries_; ++i) {
    ++round_;
    if (const auto sent = send(sync_frame()); !sent) return *sent.fault();
    const double time = clock_.now();
    const auto is_done = [&] {
      return std::ranges::all_of(nodes_, [&](const CanopenNode& node) { return node.round == round_; });
    };
    const auto waited = wait(is_done, time + timeout_);
    if (!waited) return *waited.fault();
    if (waited.value()) return time;
  }
  PortFault lost = missing();
  // A late answer must not count as the answer to the next SYNC.
  if (const auto paused = pause(timeout_); !paused) return *paused.fault();
  return lost;
}

Outcome<SdoTransfer> CanopenBus::run(std::size_t i, const SdoTransfer& transfer, ObjectAddress object) {
  for (int tried = 0; tried < tries_; ++tried) {
    SdoTransfer running = transfer;
    bool is_answered = true;
    while (!running.is_over() && is_answered) {
      if (const auto sent = send(running.request()); !sent) return *sent.fault();
      transfer_ = &running, has_advanced_ = false;
      const auto waited = wait([&] { return has_advanced_; }, clock_.now() + timeout_);
      transfer_ = nullptr;
      if (!waited) return *waited.fault();
      is_answered = waited.value();
    }
    if (running.is_over() && running.request().data[0] == 0x80) {
      // This side has found an error: the transfer is ended, and tried again.
      if (const auto sent = send(running.request()); !sent) return *sent.fault();
      if (tried + 1 == tries_) return running;
    } else if (running.is_over()) {
      return running;
    }
  }
  return fault(
      i, FaultKind::link_lost,
      fmt::format("does not answer a request for object {}; {}", text(object),
                  trouble_.empty() ? "check its number, its supply and the wiring and speed of the bus"
                                   : "the bus reports: " + trouble_));
}

Outcome<SdoTransfer> CanopenBus::read(std::size_t i, ObjectAddress object) {
  auto done = run(i, SdoTransfer::reading(nodes_[i].number, object), object);
  if (done && done.value().abort_code() != 0)
    return fault(i, FaultKind::refused,
                 fmt::format("refuses to read object {}: {}", text(object),
                             sdo_abort_text(done.value().abort_code())));
  return done;
}

CommandOutcome CanopenBus::write(std::size_t i, ObjectAddress object, std::uint32_t value, int size) {
  const auto done = run(i, SdoTransfer::writing(nodes_[i].number, object, value, size), object);
  if (!done) return *done.fault();
  if (done.value().abort_code() != 0)
    return fault(i, FaultKind::refused,
                 fmt::format("refuses {} for object {}: {}", static_cast<std::int32_t>(value), text(object),
                             sdo_abort_text(done.value().abort_code())));
  return Accepted{};
}

}  // namespace flexura

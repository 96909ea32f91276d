#include "flexura/equipment/visca_bus.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ranges>
#include <stdexcept>
#include <utility>

namespace flexura {

ViscaBus::ViscaBus(std::unique_ptr<Link> link, const ViscaBusConfig& config, std::function<double()> now)
    : link_(std::move(link)), config_(config), now_(std::move(now)) {
  if (const std::string problem = visca_problem(config); !problem.empty())
    throw std::invalid_argument("VISCA: " + problem);
  framing_ = visca_framing(config);
  sets_addresses_ = visca_sets_addresses(config) && framing_ == ViscaFraming::stream;
}

// Holds the turn of a head while it exists. Without it, two requests could both wait for the same answer.
class ViscaBus::Turn {
 public:
  Turn(ViscaBus& bus, Lock& lock, int address, bool is_urgent) : bus_(bus), address_(address) {
    bool& is_taken = bus.is_taken_[static_cast<std::size_t>(address)];
    // Each request before this one ends by itself. The limit is for faults of the system alone.
    constexpr double most_requests = 20;
    const double end =
        bus.now_() + most_requests * static_cast<double>(bus.config_.tries) * bus.config_.reply_timeout;
    if (!is_urgent) (void)bus.wait(lock, end, [&] { return !is_taken; });
    holds_ = !is_taken;
    if (holds_) is_taken = true;
  }
  ~Turn() {
    if (holds_) bus_.is_taken_[static_cast<std::size_t>(address_)] = false;
    bus_.changed_.notify_all();
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  ViscaBus& bus_;
  int address_;
  bool holds_ = false;
};

std::optional<PortFault> ViscaBus::wait(Lock& lock, double end, const Condition& is_done) {
  constexpr double slice = 0.05;  // s. Another thread may have answers for this one.
  while (!is_done()) {
    const double left = end - now_();
    if (!(left > 0)) return std::nullopt;
    if (is_reading_) {
      changed_.wait_for(lock, std::chrono::duration<double>(std::min(left, slice)));
      continue;
    }
    is_reading_ = true;
    lock.unlock();
    Outcome<std::string> heard = link_->read(std::min(left, slice));
    lock.lock();
    is_reading_ = false;
    if (heard) take(heard.value());
    changed_.notify_all();
    if (!heard) return heard.fault();
  }
  return std::nullopt;
}

ViscaBus::RequestPtr ViscaBus::add(What what, int address, int socket) {
  constexpr std::size_t most = 64;
  if (requests_.size() >= most) requests_.pop_front();
  auto request = std::make_shared<Request>();
  request->what = what, request->address = address, request->socket = socket;
  request->number = next_number_++;
  request->sequence = next_sequence_++;
  requests_.push_back(request);
  return request;
}

std::optional<PortFault> ViscaBus::try_once(Lock& lock, const RequestPtr& request, std::string_view packet) {
  using Kind = SonyMessage::Kind;
  std::string bytes(packet);
  if (framing_ == ViscaFraming::sony) {
    Kind kind = request->what == What::inquiry ? Kind::inquiry : Kind::command;
    if (request->what == What::reset) kind = Kind::control;
    bytes = bytes_of(SonyMessage{kind, request->sequence, bytes});
  }
  ++request->tries;
  request->sent = now_();
  // Under the lock, so that a stop is always the last command that is sent.
  if (auto fault = link_->write(bytes).fault()) return fault;
  return wait(lock, request->sent + config_.reply_timeout, [&] { return request->state != State::waiting; });
}

std::optional<PortFault> ViscaBus::exchange(Lock& lock, const RequestPtr& request, std::string_view packet,
                                            const Condition& is_allowed) {
  std::optional<PortFault> fault;
  // What has arrived earlier answers nothing that is still to be asked.
  if (!is_reading_ && framing_ != ViscaFraming::sony) {
    bool is_more = true;
    for (int i = 0; is_more && i < 16; ++i) {
      const auto heard = link_->read(0);
      is_more = heard && !heard.value().empty();
      if (is_more) take(heard.value());
    }
  }
  constexpr int most_renumbered = 2;
  int renumbered = 0;
  for (std::int64_t i = 0; i < config_.tries; ++i) {
    if (!is_allowed()) break;
    // A repeated command keeps its number, so that it is not executed twice. An answer to an earlier inquiry
    // would be of an unknown age.
    if (request->what == What::inquiry && i > 0) request->sequence = next_sequence_++, request->tries = 0;
    fault = try_once(lock, request, packet);
    if (request->state == State::renumber) {
      renumber(lock, *request);
      if (++renumbered <= most_renumbered) --i;
      continue;
    }
    if (request->state != State::waiting) return std::nullopt;
    if (request->what == What::inquiry && framing_ != ViscaFraming::sony && !fault) {
      request->state = State::given_up;
      (void)wait(lock, now_() + config_.reply_timeout, [] { return false; });
      request->state = State::waiting;
    }
    // The head may have forgotten the sequence, for example because it was switched off.
    if (framing_ == ViscaFraming::sony && request->what != What::reset && i + 2 == config_.tries)
      renumber(lock, *request);
  }
  request->state = State::given_up;
  if (fault) return PortFault{FaultKind::link_lost, name_of(request->address) + ": " + fault->what};
  // A head that was switched off and on has no address.
  if (request->what != What::addresses) is_chain_changed_ = true;
  return PortFault{FaultKind::link_lost, silence(*request)};
}

std::string ViscaBus::silence(const Request& request) const {
  if (request.others >= config_.tries)
    return fmt::format(
        "{}: answers with {} bytes of data instead of {}: set pan.digits and tilt.digits as in its manual",
        name_of(request.address), request.other, request.size);
  return fmt::format("{}: no answer to {} messages within {:g} s each: check power, cable, {}",
                     name_of(request.address), config_.tries, config_.reply_timeout,
                     framing_ == ViscaFraming::stream ? "the speed of the line and the head's address"
                                                      : "the network address, the port and the framing");
}

void ViscaBus::renumber(Lock& lock, Request& request) {
  // A head that refuses the number of a first try, or is silent, may count otherwise than this program.
  (void)reset_sequence(lock);
  request.sequence = next_sequence_++;
  request.tries = 0;
  request.state = State::waiting;
}

std::optional<PortFault> ViscaBus::reset_sequence(Lock& lock) {
  const RequestPtr request = add(What::reset, visca_everyone);
  auto fault = exchange(lock, request, sony_reset, [] { return true; });
  if (!fault) next_sequence_ = 1;
  return fault;
}

std::optional<PortFault> ViscaBus::set_addresses(Lock& lock) {
  const RequestPtr request = add(What::addresses, visca_everyone);
  auto fault =
      exchange(lock, request, visca_packet(visca_everyone, visca_set_addresses()), [] { return true; });
  if (fault) return fault;
  heads_ = request->code - 1;
  is_chain_changed_ = false;
  return std::nullopt;
}

std::optional<PortFault> ViscaBus::prepare_chain(Lock& lock) {
  if (!is_chain_changed_ || !sets_addresses_) return std::nullopt;
  return set_addresses(lock);
}

CommandOutcome ViscaBus::start() {
  Lock lock(mutex_);
  const Turn turn(*this, lock, visca_everyone, false);
  const auto always = [] { return true; };
  std::optional<PortFault> fault;
  if (framing_ == ViscaFraming::sony) {
    fault = reset_sequence(lock);
  } else if (sets_addresses_) {
    fault = set_addresses(lock);
    if (!fault)
      fault = exchange(lock, add(What::clear, visca_everyone), visca_packet(visca_everyone, visca_clear()),
                       always);
  }
  // Other heads need no preparation, and some do not answer it.
  if (fault) return *fault;
  return Accepted{};
}

ViscaResult ViscaBus::command(int address, std::string_view body, const Condition& is_allowed,
                              bool is_urgent) {
  using Kind = ViscaResult::Kind;
  Lock lock(mutex_);
  const Turn turn(*this, lock, address, is_urgent);
  if (!is_urgent) {
    if (const auto fault = prepare_chain(lock)) return {.kind = Kind::lost, .what = fault->what};
  }
  const unsigned first = static_cast<unsigned char>(body[0]);
  const bool is_cancel = first >> 4 == 2;
  const RequestPtr request =
      add(is_cancel ? What::cancel : What::command, address, is_cancel ? static_cast<int>(first & 0xF) : 0);
  const auto fault = exchange(lock, request, visca_packet(address, body), is_allowed);
  if (!is_allowed()) return {.kind = Kind::revoked, .number = request->number};
  if (fault) return {.kind = Kind::lost, .what = fault->what};
  if (request->state == State::refused) return {.kind = Kind::refused, .code = request->code};
  return {.kind = Kind::accepted, .number = request->number};
}

Outcome<ViscaBus::Answer> ViscaBus::inquire(int address, std::string_view body, std::size_t size) {
  Lock lock(mutex_);
  const Turn turn(*this, lock, address, false);
  if (const auto fault = prepare_chain(lock)) return *fault;
  int code = 0;
  // A head refuses an inquiry that arrived damaged.
  for (std::int64_t i = 0; i < config_.tries; ++i) {
    const RequestPtr request = add(What::inquiry, address);
    request->size = size;
    if (const auto fault = exchange(lock, request, visca_packet(address, body), [] { return true; }))
      return *fault;
    if (request->state == State::answered)
      return Answer{request->data, 0.5 * (request->sent + request->answered)};
    code = request->code;
  }
  return PortFault{FaultKind::refused, fmt::format("{}: refuses to report its position ({})",
                                                   name_of(address), visca_error_text(code))};
}

const ViscaBus::Request* ViscaBus::find(std::uint64_t number) const {
  const auto found =
      std::ranges::find_if(requests_, [&](const RequestPtr& request) { return request->number == number; });
  return found == requests_.end() ? nullptr : found->get();
}

ViscaBus::Progress ViscaBus::progress(std::uint64_t number) const {
  const Lock lock(mutex_);
  const Request* request = find(number);
  if (request == nullptr) return Progress::unknown;
  switch (request->state) {
    case State::waiting:
    case State::accepted:
      return Progress::running;
    case State::ended:
      return Progress::ended;
    case State::failed:
      return Progress::failed;
    default:
      return Progress::unknown;
  }
}

std::optional<int> ViscaBus::socket(std::uint64_t number) const {
  const Lock lock(mutex_);
  const Request* request = find(number);
  if (request == nullptr || request->state != State::accepted || request->socket == 0) return std::nullopt;
  return request->socket;
}

int ViscaBus::failure(std::uint64_t number) const {
  const Lock lock(mutex_);
  const Request* request = find(number);
  return request != nullptr && request->state == State::failed ? request->code : 0;
}

int ViscaBus::heads() const {
  const Lock lock(mutex_);
  return heads_;
}

std::string ViscaBus::name_of(int address) const {
  if (address == visca_everyone) return link_->name() + ", VISCA heads";
  return fmt::format("{}, VISCA head {}", link_->name(), address);
}

Outcome<std::shared_ptr<ViscaBus>> open_visca_bus(const ViscaBusConfig& config,
                                                  const std::function<double()>& now) {
  auto link = open_link(parse_link_address(config.link));
  if (!link) return *link.fault();
  auto bus = std::make_shared<ViscaBus>(std::move(link).value(), config, now);
  if (const auto fault = bus->start().fault()) return *fault;
  return bus;
}

}  // namespace flexura

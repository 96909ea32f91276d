#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "flexura/equipment/link.h"
#include "flexura/equipment/visca_codec.h"
#include "flexura/equipment/visca_config.h"
#include "flexura/equipment/wall_clock.h"
#include "flexura/port/outcome.h"

namespace flexura {

/// Result of a command.
struct ViscaResult {
  /// `accepted`: the head executes the command. `refused`: the head answered with an error. `revoked`:
  /// `is_allowed` returned false. `lost`: there was no answer.
  enum class Kind { accepted, refused, revoked, lost };
  Kind kind = Kind::lost;
  std::uint64_t number = 0;  ///< Number of an accepted command, for ViscaBus::progress().
  int code = 0;              ///< Error code of a refusal.
  std::string what = {};     ///< Error message if the command was lost.
};

/// A link that one or more VISCA heads share. A ViscaBus sends packets, repeats packets without an answer,
/// and assigns each answer to its request.
///
/// All functions may be called from several threads. A thread that waits for an answer also reads the answers
/// for all other threads. A wait lasts at most `tries` times `reply_timeout` for each request that waits for
/// the same head.
class ViscaBus {
 public:
  /// `now`: function that returns the time, s, also for the times of readings. Throws std::invalid_argument
  /// for an invalid configuration.
  ViscaBus(std::unique_ptr<Link> link, const ViscaBusConfig& config,
           std::function<double()> now = steady_seconds);

  /// Prepares the link: numbers the heads of a chain and empties their buffers, or resets sequence numbers.
  [[nodiscard]] CommandOutcome start();

  /// Condition for sending, checked before each try. The function is called while the bus is locked, so it
  /// must not use the bus.
  using Condition = std::function<bool()>;
  /// Sends a command to the head at `address`, and waits until the head accepts it. An urgent command does
  /// not wait for other requests.
  [[nodiscard]] ViscaResult command(int address, std::string_view body, const Condition& is_allowed,
                                    bool is_urgent = false);
  /// An answer to an inquiry.
  struct Answer {
    std::string data;
    double time = 0;  ///< Middle between request and answer, s.
  };
  /// Sends an inquiry and waits for an answer with `size` bytes of data.
  [[nodiscard]] Outcome<Answer> inquire(int address, std::string_view body, std::size_t size);

  /// Progress of an accepted command. `unknown`: the command is too old.
  enum class Progress { running, ended, failed, unknown };
  [[nodiscard]] Progress progress(std::uint64_t number) const;
  /// Returns the head's command buffer (VISCA socket) that holds a running command, if known.
  [[nodiscard]] std::optional<int> socket(std::uint64_t number) const;
  /// Returns the code of the error that ended an accepted command; 0 if there was none.
  [[nodiscard]] int failure(std::uint64_t number) const;

  [[nodiscard]] const Link& link() const { return *link_; }
  [[nodiscard]] const ViscaBusConfig& config() const { return config_; }
  /// Returns the current time, s.
  [[nodiscard]] double now() const { return now_(); }
  /// Returns the number of heads of the chain; 0 if unknown.
  [[nodiscard]] int heads() const;
  /// Returns the name of a head for messages, for example "LINK, VISCA head 2".
  [[nodiscard]] std::string name_of(int address) const;

 private:
  enum class What { command, cancel, inquiry, addresses, clear, reset };
  enum class State { waiting, accepted, ended, answered, refused, failed, renumber, given_up };
  struct Request {
    What what = What::command;
    std::uint64_t number = 0;
    int address = 0;
    int socket = 0;  // 0: unknown.
    std::uint32_t sequence = 0;
    std::size_t size = 0;     // Of the answer's data.
    std::size_t other = 0;    // Size of an answer of another size.
    std::int64_t others = 0;  // Number of such answers.
    int tries = 0;
    State state = State::waiting;
    int code = 0;
    std::string data;
    double sent = 0, answered = 0;
  };
  using RequestPtr = std::shared_ptr<Request>;
  using Lock = std::unique_lock<std::mutex>;

  // Waits until `is_done`, or until the time `end`. Returns a fault of the link.
  std::optional<PortFault> wait(Lock& lock, double end, const Condition& is_done);
  class Turn;
  RequestPtr add(What what, int address, int socket = 0);
  // Sends a request until it is answered.
  std::optional<PortFault> exchange(Lock& lock, const RequestPtr& request, std::string_view packet,
                                    const Condition& is_allowed);
  std::optional<PortFault> try_once(Lock& lock, const RequestPtr& request, std::string_view packet);
  // Resets the sequence and gives a request a new number.
  void renumber(Lock& lock, Request& request);
  [[nodiscard]] std::optional<PortFault> prepare_chain(Lock& lock);
  [[nodiscard]] std::optional<PortFault> set_addresses(Lock& lock);
  [[nodiscard]] std::optional<PortFault> reset_sequence(Lock& lock);
  [[nodiscard]] std::string silence(const Request& request) const;

  void take(std::string_view bytes);
  void take_packet(std::string_view packet, std::optional<std::uint32_t> sequence);
  void take_control(const SonyMessage& message);
  void take_accepted(const ViscaReply& reply, std::optional<std::uint32_t> sequence);
  void take_ended(const ViscaReply& reply, std::optional<std::uint32_t> sequence);
  void take_answer(const ViscaReply& reply, std::optional<std::uint32_t> sequence);
  void take_error(const ViscaReply& reply, std::optional<std::uint32_t> sequence);
  // Returns the oldest request with these properties, or null.
  template <class Property>
  Request* find(Property has);
  [[nodiscard]] const Request* find(std::uint64_t number) const;

  std::unique_ptr<Link> link_;
  ViscaBusConfig config_;
  ViscaFraming framing_;
  bool sets_addresses_;
  std::function<double()> now_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool is_reading_ = false;
  std::array<bool, visca_everyone + 1> is_taken_{};  // Whether a request to this address is on its way.
  std::deque<RequestPtr> requests_;                  // The newest last; bounded.
  std::uint64_t next_number_ = 1;
  std::uint32_t next_sequence_ = 1;
  ViscaSplitter splitter_;
  bool is_chain_changed_ = false;
  int heads_ = 0;
};

/// Opens the link of a configuration and prepares it.
[[nodiscard]] Outcome<std::shared_ptr<ViscaBus>> open_visca_bus(
    const ViscaBusConfig& config, const std::function<double()>& now = steady_seconds);

}  // namespace flexura

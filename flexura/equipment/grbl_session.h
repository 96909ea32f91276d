#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/equipment/grbl_codec.h"
#include "flexura/equipment/link.h"
#include "flexura/port/clock_port.h"

namespace flexura {

/// Answer to a line.
struct GrblAnswer {
  int error = 0;                  ///< N of error:N, 0 for ok.
  std::vector<GrblMessage> said;  ///< Settings and feedback that arrived before it.
};

/// Conversation with a controller: lines and their answers, in order, with at most a window of bytes on the
/// way. All waits end by a timeout. One thread at a time, except interrupt().
class GrblSession {
 public:
  /// `window`: most bytes on the way that are not answered. `answer_timeout`: s. The link and the clock must
  /// outlive this object.
  GrblSession(Link& link, const ClockPort& clock, std::size_t window, double answer_timeout)
      : link_(link), clock_(clock), window_(window), answer_timeout_(answer_timeout) {}

  /// Sends a line, with its end, and waits for its answer for at most `timeout` s.
  Outcome<GrblAnswer> ask(const std::string& line, double timeout);
  Outcome<GrblAnswer> ask(const std::string& line) { return ask(line, answer_timeout_); }
  /// Sends lines, each as soon as it fits into the window, and waits for all answers, each for at most the
  /// answer timeout. Returns the error of the first refused line, or 0.
  Outcome<int> stream(std::span<const std::string> lines);
  /// Asks for a status report that the controller makes after this call. If it is urgent, lines and answers
  /// are not brought together first, so after a loss the report may be an earlier one.
  Outcome<GrblStatus> status(bool is_urgent = false);
  /// Listens for `duration` s.
  CommandOutcome listen(double duration);
  /// Returns true if answers may not belong to their lines until resynchronize().
  [[nodiscard]] bool is_out_of_step() const { return is_out_of_step_; }
  /// Sends bytes that act at once. Any thread.
  CommandOutcome act(char byte);
  /// Resets the controller and waits for its banner for at most `timeout` s.
  CommandOutcome reset(double timeout);
  /// Brings lines and answers together again after a loss: waits until the controller answers a question
  /// whose answer cannot be confused.
  CommandOutcome resynchronize();
  /// Reads what has arrived, without waiting.
  CommandOutcome drain();

  /// Ends the waits of the call in progress, and sends a byte. No line is sent afterwards until begin() is
  /// called. Any thread.
  CommandOutcome interrupt(char byte);
  /// Returns the number of calls of interrupt().
  [[nodiscard]] unsigned interrupts() const { return interrupts_; }
  /// Allows sending after interrupt(), unless the number of its calls is no longer `known`.
  void begin(unsigned known) { begun_ = known, is_stopping_ = false; }
  /// Until begin(), interrupt() sends its byte but does not end waits: they already are those of a stop.
  void begin_stop() { is_stopping_ = true; }
  /// Returns true if interrupt() was called since begin().
  [[nodiscard]] bool is_interrupted() const { return !is_stopping_ && interrupts_ != begun_; }

  /// Returns and forgets the last ALARM:N.
  std::optional<int> take_alarm() { return std::exchange(alarm_, std::nullopt); }
  /// Returns and forgets whether the controller has restarted unasked.
  bool take_restart() { return std::exchange(has_restarted_, false); }
  /// Returns the bytes on the way.
  [[nodiscard]] std::size_t unanswered() const;
  /// Makes the window smaller.
  void limit_window(std::size_t bytes) { window_ = std::min(window_, bytes); }

 private:
  CommandOutcome send(const std::string& line);
  // Reads until `is_done` or for `timeout` s. Returns whether it is done.
  Outcome<bool> wait(double timeout, const std::function<bool()>& is_done);
  void take(std::string_view bytes);
  void take(GrblMessage message);
  [[nodiscard]] PortFault silent(std::string_view what) const;
  [[nodiscard]] PortFault interrupted() const;

  Link& link_;
  const ClockPort& clock_;
  std::size_t window_;
  double answer_timeout_;
  GrblLines lines_;
  std::deque<std::size_t> pending_;  // Lengths of lines that are not answered.
  std::vector<GrblMessage> said_;
  std::deque<int> answers_;
  std::optional<GrblStatus> status_;
  std::optional<int> alarm_;
  bool has_restarted_ = false, is_out_of_step_ = false;
  enum class Mark { none, awaited, seen, answered };  // Of resynchronize().
  Mark mark_ = Mark::none;
  std::mutex sending_;
  std::atomic<unsigned> interrupts_ = 0;
  unsigned begun_ = 0;
  bool is_stopping_ = false;
};

}  // namespace flexura

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
  int error = 0;                  ///< Number N of error:N; 0 for ok.
  std::vector<GrblMessage> said;  ///< Settings and feedback that arrived before the answer.
};

/// Communication with a controller: lines and their answers, in order. The number of bytes that are not yet
/// answered is limited (window). All waits have a timeout. Only one thread at a time may call the functions,
/// except for interrupt().
class GrblSession {
 public:
  /// `window`: largest number of bytes that are sent but not yet answered. `answer_timeout`: longest wait for
  /// an answer, s. Link and clock must outlive this object.
  GrblSession(Link& link, const ClockPort& clock, std::size_t window, double answer_timeout)
      : link_(link), clock_(clock), window_(window), answer_timeout_(answer_timeout) {}

  /// Sends a line, which includes its line end, and waits for the answer for at most `timeout` s.
  Outcome<GrblAnswer> ask(const std::string& line, double timeout);
  Outcome<GrblAnswer> ask(const std::string& line) { return ask(line, answer_timeout_); }
  /// Sends lines, each as soon as it fits into the window. Waits for all answers, for each at most the answer
  /// timeout. Returns the error code of the first refused line, or 0.
  Outcome<int> stream(std::span<const std::string> lines);
  /// Requests a new status report. If answers were lost before, this function first calls resynchronize(). If
  /// `is_urgent` is true, this function does not call resynchronize(), so the result may be an older report.
  Outcome<GrblStatus> status(bool is_urgent = false);
  /// Processes messages of the controller for `duration` s.
  CommandOutcome listen(double duration);
  /// Returns true if answers may have been lost, so that the next answers may belong to other lines.
  /// resynchronize() repairs this.
  [[nodiscard]] bool is_out_of_step() const { return is_out_of_step_; }
  /// Sends a realtime byte. May be called from any thread.
  CommandOutcome act(char byte);
  /// Resets the controller and waits for its banner for at most `timeout` s.
  CommandOutcome reset(double timeout);
  /// After a loss of answers, finds out again which answer belongs to which line. Sends a request whose
  /// answer cannot be confused with any other answer, and waits for the answer.
  CommandOutcome resynchronize();
  /// Reads what has arrived, without waiting.
  CommandOutcome drain();

  /// Sends a realtime byte, and ends the waits of the call in progress. No line is sent until begin() is
  /// called. May be called from any thread.
  CommandOutcome interrupt(char byte);
  /// Returns the number of calls of interrupt(). A caller reads it before it waits for its lock. If a halt
  /// comes during the wait, the number changes and the call ends.
  [[nodiscard]] unsigned interrupts() const { return interrupts_; }
  /// Allows sending again after interrupt(), unless interrupt() has been called more than `known` times.
  void begin(unsigned known) { begun_ = known, is_stopping_ = false; }
  /// From now until begin(), interrupt() sends its byte but does not end waits, because these waits belong to
  /// a stop.
  void begin_stop() { is_stopping_ = true; }
  /// Returns true if interrupt() was called since begin().
  [[nodiscard]] bool is_interrupted() const { return !is_stopping_ && interrupts_ != begun_; }

  /// Returns the number N of the last ALARM:N, and clears it.
  std::optional<int> take_alarm() { return std::exchange(alarm_, std::nullopt); }
  /// Returns whether the controller has restarted unexpectedly, and clears this flag.
  bool take_restart() { return std::exchange(has_restarted_, false); }
  /// Returns the number of bytes that are sent but not yet answered.
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

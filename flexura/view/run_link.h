#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/experiment/run.h"
#include "flexura/view/calibration_extras.h"
#include "flexura/view/servo_extras.h"

namespace flexura {

/// Connects a run on its own thread with its viewers. The run reports, viewers query when they have time, and
/// neither waits for the other. All methods can be called from any thread.
class RunLink : public Progress, public RunWatcher {
 public:
  /// How a run ended.
  struct End {
    std::string outcome;           ///< "done", "unsafe", "cancelled" or "failed".
    std::string text;              ///< Reason, one line; may be "".
    std::filesystem::path folder;  ///< Folder with its results; "" if it left none.
  };
  /// An event, as logged.
  struct Event {
    double time = 0;  ///< s
    std::string level, name, text;
  };
  /// The newest state of everything.
  struct News {
    double fraction = 0;
    std::string what;
    std::optional<double> time;  ///< Time of `state`, s; missing before the first one.
    ArmState state;
    std::shared_ptr<const TrueArm> truth;  ///< The newest true arm reported since the last request; or null.
    std::vector<CameraReading> cameras;    ///< Readings at that time, by camera; empty: as at the start.
    std::optional<ShownServo> servo;       ///< Present while a servo controls the arm.
    std::optional<ShownCalibration> calibration;  ///< Present while a calibration is active.
    std::uint64_t changes = 0;                    ///< Counts the changes of servo and calibration.
    std::optional<End> end;
  };

  /// `also` receives the progress too; may be null.
  explicit RunLink(Progress* also = nullptr) : also_(also) {}

  void update(double fraction, std::string_view what) override;
  [[nodiscard]] bool is_cancelled() const override { return cancelled_; }
  void state(double time, const ArmState& state, std::span<const CameraReading> cameras) override;

  [[nodiscard]] bool needs_truth() override { return is_truth_requested_.exchange(false); }
  void truth(double time, const TrueArm& arm) override;
  void happened(double time, const std::string& level, const std::string& name,
                const std::string& text) override;
  void logged(const LoggedMessage& message) override;
  void task_ended() override;

  void cancel() { cancelled_ = true; }
  /// Requests the true arm with the next news: one report for each call.
  void request_truth() { is_truth_requested_ = true; }
  void finish(End end);
  [[nodiscard]] News news() const;
  /// Returns and removes the oldest events, at most `most`. If there are very many, only the last are kept.
  [[nodiscard]] std::vector<Event> take_events(std::size_t most);

 private:
  void decided(const CalibrationDecisionMessage& decision);

  Progress* also_;
  std::atomic<bool> cancelled_ = false, is_truth_requested_ = false;
  mutable std::mutex mutex_;
  News news_;
  std::vector<ServoPicture> pictures_;  // Newest picture of each camera of a servo.
  std::deque<Event> events_;
};

/// Runs an experiment into an existing empty folder, and reports to `link` how it ends. Never throws.
void run_linked(const Experiment& experiment, const std::filesystem::path& folder, RunLink& link);

}  // namespace flexura

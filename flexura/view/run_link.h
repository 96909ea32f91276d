#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/experiment/run.h"
#include "flexura/sim/simulated_rig.h"
#include "flexura/view/calibration_extras.h"
#include "flexura/view/servo_extras.h"

namespace flexura {

/// Connection between a run on its own thread and its viewers. The run reports its state to this object, and
/// viewers query it. The run never waits for viewers, except after pace_to(). All methods can be called from
/// any thread.
class RunLink : public Progress, public RunWatcher {
 public:
  /// How a run ended.
  struct End {
    std::string outcome;           ///< "done", "unsafe", "cancelled" or "failed".
    std::string text;              ///< Reason, or the result of a run that is done, in one line; may be "".
    std::filesystem::path folder;  ///< Folder with the results; "" if the run has no results.
  };
  /// A logged event.
  struct Event {
    double time = 0;  ///< Time, s.
    std::string level, name, text;
  };
  /// State of a camera and the arm at the camera's last measured picture.
  struct Measured {
    std::string camera;
    std::int64_t frame = 0;  ///< Number of the frame.
    double time = 0;         ///< Middle of the exposure, s.
    ArmState state;          ///< Commanded state of the arm at this time.
    /// Axis positions of the camera that the measurement used; may be missing.
    std::optional<CameraReading> reading;
    std::vector<CameraReading>
        /// Measured axis positions of all cameras at this time, if `reading` is missing; empty: the initial
        /// positions.
        readings;
    std::shared_ptr<const TrueArm> truth;  ///< True arm near this time; null: unknown.
  };
  /// The newest data of a run.
  struct News {
    double fraction = 0;
    std::string what;
    std::optional<double> time;  ///< Time of `state`, s; missing before the first state.
    ArmState state;
    std::shared_ptr<const TrueArm> truth;  ///< Newest true arm since the last request_truth(), or null.
    /// Measured axis positions of the cameras at this time; empty: the initial positions.
    std::vector<CameraReading> cameras;
    std::optional<ShownServo> servo;              ///< State of a servo while it controls the arm.
    std::optional<ShownCalibration> calibration;  ///< State of a calibration while it is active.
    std::vector<Measured>
        measured;  ///< Last measured picture of each camera, while a servo or calibration is active.
    std::uint64_t changes = 0;  ///< Number of changes of `servo` and `calibration` so far.
    std::optional<End> end;
  };

  /// `also`: another receiver of the progress; may be null.
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

  void cancel();
  /// From now on, the run waits before each state that is later than `time` (s).
  void pace_to(double time);
  /// Stores the simulated rig of the run in its final state. A run without a simulated rig does not call this
  /// function.
  void leave(std::unique_ptr<SimulatedRig> rig);
  /// Returns and removes the stored rig; null without a stored rig and before the run's end.
  [[nodiscard]] std::unique_ptr<SimulatedRig> take_rig();
  /// Requests the true arm for the next news. Each call requests the true arm once.
  void request_truth() { is_truth_requested_ = true; }
  void finish(End end);
  [[nodiscard]] News news() const;
  /// Returns and removes the oldest events, at most `most`. If there are very many events, older ones are
  /// lost.
  [[nodiscard]] std::vector<Event> take_events(std::size_t most);

 private:
  void decided(const CalibrationDecisionMessage& decision);
  // Returns the stored step at a time, s; null if there is none.
  struct Step {
    double time = 0;  // Time, s.
    ArmState state;
    std::vector<CameraReading> cameras;
  };
  [[nodiscard]] const Step* step_at(double time) const;
  void measured(Measured seen);

  Progress* also_;
  std::atomic<bool> cancelled_ = false, is_truth_requested_ = false;
  mutable std::mutex mutex_;
  std::condition_variable may_go_;
  double allowed_ = std::numeric_limits<double>::infinity();  // Time up to which the run may advance, s.
  std::unique_ptr<SimulatedRig> rig_;
  News news_;
  std::vector<ServoPicture> pictures_;  // Newest picture of each camera of a servo.
  std::deque<Event> events_;
  std::deque<Step> steps_;  // Steps of the last seconds.
  std::deque<std::pair<double, std::shared_ptr<const TrueArm>>> truths_;
};

/// Runs an experiment, writes its results into an existing empty folder, and reports the run's end to `link`.
/// Never throws.
void run_linked(const Experiment& experiment, const std::filesystem::path& folder, RunLink& link);

}  // namespace flexura

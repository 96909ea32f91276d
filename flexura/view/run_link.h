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

/// What connects a run on its own thread with those who watch: the run reports, they ask when they have time.
/// The run waits for nobody, unless it is paced (pace_to). All methods can be called from any thread.
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
  /// What a camera saw in the picture that was measured last.
  struct Measured {
    std::string camera;
    std::int64_t frame = 0;                ///< Its number.
    double time = 0;                       ///< Middle of its exposure, s.
    ArmState state;                        ///< As commanded then.
    std::optional<CameraReading> reading;  ///< Of the camera then, as the measurement says; may be missing.
    std::vector<CameraReading> readings;   ///< Else of all cameras; empty: they stood as at the start.
    std::shared_ptr<const TrueArm> truth;  ///< Near that time; null: not known.
  };
  /// The newest of everything.
  struct News {
    double fraction = 0;
    std::string what;
    std::optional<double> time;  ///< Time of `state`, s; missing before the first one.
    ArmState state;
    std::shared_ptr<const TrueArm> truth;  ///< The newest that was told since truth was wanted; or null.
    std::vector<CameraReading> cameras;  ///< As read then, by camera; empty where they stand as at the start.
    std::optional<ShownServo> servo;     ///< While one steers the arm.
    std::optional<ShownCalibration> calibration;  ///< While one goes on.
    std::vector<Measured> measured;               ///< While one of them goes on, of each camera one.
    std::uint64_t changes = 0;                    ///< Counts what came of both.
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

  void cancel();
  /// From now on the run waits before each state that is later than `time` s.
  void pace_to(double time);
  /// Keeps the simulated rig of the run as it stands at its end; a run without one leaves none.
  void leave(std::unique_ptr<SimulatedRig> rig);
  /// Returns that rig once; null if there is none, or before the end.
  [[nodiscard]] std::unique_ptr<SimulatedRig> take_rig();
  /// The next news is to have how the arm truly stands: once, for each call.
  void request_truth() { is_truth_requested_ = true; }
  void finish(End end);
  [[nodiscard]] News news() const;
  /// Returns and removes the oldest events, at most `most`. If there are very many, only the last are kept.
  [[nodiscard]] std::vector<Event> take_events(std::size_t most);

 private:
  void decided(const CalibrationDecisionMessage& decision);
  // What stood then, as far as it is remembered; null: nothing is.
  struct Step {
    double time = 0;  // s
    ArmState state;
    std::vector<CameraReading> cameras;
  };
  [[nodiscard]] const Step* step_at(double time) const;
  void measured(Measured seen);

  Progress* also_;
  std::atomic<bool> cancelled_ = false, is_truth_requested_ = false;
  mutable std::mutex mutex_;
  std::condition_variable may_go_;
  double allowed_ = std::numeric_limits<double>::infinity();  // s
  std::unique_ptr<SimulatedRig> rig_;
  News news_;
  std::vector<ServoPicture> pictures_;  // Newest picture of each camera of a servo.
  std::deque<Event> events_;
  std::deque<Step> steps_;  // of the last seconds
  std::deque<std::pair<double, std::shared_ptr<const TrueArm>>> truths_;
};

/// Runs an experiment into an existing empty folder, and reports to `link` how it ends. Never throws.
void run_linked(const Experiment& experiment, const std::filesystem::path& folder, RunLink& link);

}  // namespace flexura

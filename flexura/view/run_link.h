#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/experiment/run.h"

namespace flexura {

/// What connects a run on its own thread with those who watch: the run tells, they ask when they have time,
/// and neither waits for the other. All methods can be called from any thread.
class RunLink : public Progress, public RunWatcher {
 public:
  /// How a run ended.
  struct End {
    std::string outcome;  ///< "done", "unsafe", "cancelled", "failed"
    std::string text;     ///< Why, one line; may be "".
    std::filesystem::path folder;
  };
  /// The newest of everything.
  struct News {
    double fraction = 0;
    std::string what;
    std::optional<double> time;  ///< Of `state`, s; none before the first one.
    ArmState state;
    std::vector<CameraReading> cameras;  ///< As read then, by camera; empty where they stand as at the start.
    std::optional<End> end;
  };

  /// `also` is told of the progress, too; may be null.
  explicit RunLink(Progress* also = nullptr) : also_(also) {}

  void update(double fraction, std::string_view what) override;
  [[nodiscard]] bool cancelled() const override { return cancelled_; }
  void state(double time, const ArmState& state, std::span<const CameraReading> cameras) override;

  void cancel() { cancelled_ = true; }
  void finish(End end);
  [[nodiscard]] News news() const;

 private:
  Progress* also_;
  std::atomic<bool> cancelled_ = false;
  mutable std::mutex mutex_;
  News news_;
};

/// Runs an experiment into a folder that exists and is empty, and tells `link` how it ends. Never throws.
void run_linked(const Experiment& experiment, const std::filesystem::path& folder, RunLink& link);

}  // namespace flexura

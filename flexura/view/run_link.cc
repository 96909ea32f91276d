#include "flexura/view/run_link.h"

#include <exception>
#include <utility>

namespace flexura {

void RunLink::update(double fraction, std::string_view what) {
  if (also_ != nullptr) also_->update(fraction, what);
  const std::lock_guard lock(mutex_);
  news_.fraction = fraction;
  news_.what.assign(what);
}

void RunLink::state(double time, const ArmState& state, std::span<const CameraReading> cameras) {
  const std::lock_guard lock(mutex_);
  news_.time = time;
  news_.state = state;
  news_.cameras.assign(cameras.begin(), cameras.end());
}

void RunLink::finish(End end) {
  const std::lock_guard lock(mutex_);
  news_.end = std::move(end);
}

RunLink::News RunLink::news() const {
  const std::lock_guard lock(mutex_);
  return news_;
}

void run_linked(const Experiment& experiment, const std::filesystem::path& folder, RunLink& link) {
  RunLink::End end{"failed", "", folder};
  try {
    const RunResult result = run_experiment(experiment, folder, link, &link);
    end.outcome = name_of(result.outcome);
    if (!result.reasons.empty()) end.text = result.reasons.front();
  } catch (const std::exception& error) {
    end.text = error.what();
  }
  link.finish(std::move(end));
}

}  // namespace flexura

#include "flexura/tasks/study/study_task.h"

#include <cstdint>
#include <optional>
#include <utility>

#include "flexura/kinematics/motion.h"
#include "flexura/study/image_study.h"
#include "flexura/tasks/study/study_results.h"
#include "flexura/tasks/task_runner.h"

namespace flexura {
namespace {

// Takes no time and moves nothing: computed after the run.
class StudyRunner : public TaskRunner {
 public:
  StudyRunner(const StudyTask& task, const Setup& setup, TaskLabel label)
      : TaskRunner(setup, std::move(label)), task_(task) {}

  [[nodiscard]] TaskPlan plan(const ArmState& from, const MotionPtr& /*done*/) const override {
    return {.motion = hold_motion(from, 0)};
  }

  [[nodiscard]] TaskWork work() const override {
    constexpr double of_value = 0.02, of_picture = 0.15;  // In s.
    return {.finishing = static_cast<double>(task_.points) * (task_.measure ? of_picture : of_value)};
  }

  void finish(const std::filesystem::path& results, bool is_cancelled, Progress& progress) override {
    if (is_cancelled) return;
    study_ = study_images(task_, setup().cameras(), static_cast<std::uint64_t>(setup().seed), &progress);
    if (!results.empty()) write_study_table(*study_, results);
  }

  [[nodiscard]] TaskOutcome outcome(const Motion& /*motion*/) const override {
    return study_ ? study_outcome(*study_) : not_begun(name(), "study", "study", "agree with the renderer");
  }
  [[nodiscard]] std::string_view summary_list() const override { return "studies"; }
  [[nodiscard]] std::optional<Node> summary() const override {
    return study_ ? std::optional(study_node(*study_)) : std::nullopt;
  }
  [[nodiscard]] std::optional<Chapter> chapter(std::size_t /*number*/) const override {
    return study_ ? std::optional(study_chapter(*study_)) : std::nullopt;
  }

 private:
  const StudyTask& task_;
  std::optional<ImageStudy> study_;
};

}  // namespace

void check_keys(const StudyTask& task, const Setup& setup, const std::string& path, Reader& reader) {
  check_study(task, setup.cameras(), path, reader);
}

std::unique_ptr<TaskRunner> runner_of(const StudyTask& task, const Setup& setup, TaskLabel label) {
  return std::make_unique<StudyRunner>(task, setup, std::move(label));
}

}  // namespace flexura

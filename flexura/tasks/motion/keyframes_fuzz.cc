// Any bytes as a CSV file of keyframes must give problems with their places, or a motion through possible
// states. For planar and for spatial arms.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "flexura/base/source.h"
#include "flexura/store/csv_reader.h"
#include "flexura/tasks/motion/keyframes.h"

namespace {

void follow(const flexura::KeyframesTask& task, flexura::ArmKind kind) {
  using namespace flexura;
  const std::size_t sections = 2;
  const auto problems = keyframe_problems(task, kind, sections);
  for (const KeyframeProblem& problem : problems) {
    const bool is_place = problem.row < static_cast<std::ptrdiff_t>(task.rows.size());
    if (problem.what.empty() || !is_place) std::abort();
  }
  if (!problems.empty()) return;
  Arm arm;
  arm.kind = kind;
  arm.sections.resize(sections);
  const MotionPtr motion = keyframes_task_motion(task, arm);
  for (const double part : {0.0, 0.3, 1.0}) {
    const double time = part * motion->duration();
    const ArmState state = motion->at(time);
    for (std::size_t i = 0; i < sections; ++i) {
      if (!state.bends[i].allFinite() || !std::isfinite(state.stretches[i])) std::abort();
      const auto rates = motion->rates(i, 0, time);
      if (!rates || std::isnan(rates->bend) || std::isnan(rates->stretch)) std::abort();
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace flexura;
  KeyframesTask task;
  try {
    NumberTable table = parse_csv({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
    task.columns = std::move(table.columns);
    task.rows = std::move(table.rows);
  } catch (const InputError&) {
    return 0;  // Covered by csv_fuzz.
  }
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::smooth}) {
    task.interpolation = interpolation;
    for (const ArmKind kind : {ArmKind::planar, ArmKind::spatial}) follow(task, kind);
  }
  return 0;
}

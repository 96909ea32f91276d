#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/runs.h"

// Ten minutes of an arm in motion, with its log.

// Sanitizers have an allocator of their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace flexura {
namespace {

constexpr double minute = 60, a_megabyte = 1024 * 1024;

double heap_in_use() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}
double resident() {
  std::ifstream file("/proc/self/statm");
  double all = 0, pages = 0;
  file >> all >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

class Minutes : public RunWatcher {
 public:
  void state(double time, const ArmState&, std::span<const CameraReading>) override {
    if (time < minute * static_cast<double>(heap.size() + 1)) return;
    heap.push_back(heap_in_use());
    memory.push_back(resident());
  }
  std::vector<double> heap, memory;  // Bytes, at the end of each minute.
};

// An arm that is never at rest: its tendons rub, it becomes longer and shorter, and its motors lose nothing.
std::string ten_minutes() {
  std::string text = R"([arm]
kind = "planar"
model = "dynamic"
gravity = [0, -9.81, 0]
time_step = 0.01
[[arm.section]]
length = 0.3
radius = 0.01
stretch_limits = [0.9, 1.2]
max_stretch_rate = 0.2
max_bend_rate_deg = 90
material = { youngs_modulus = 5e6, density = 1000, damping_time = 0.02, modes = { bend = 2 } }
[[arm.tendon]]
section = 1
radius_mm = 8
friction = 0.1
[[arm.tendon]]
section = 1
radius_mm = 8
angle_deg = 180
friction = 0.1
)";
  for (int i = 0; i < 75; ++i) {
    text += "[[task]]\nkind = \"move\"\nduration = 4\nto = { bends = [[0.6, 0]], stretches = [1.1] }\n";
    text += "[[task]]\nkind = \"move\"\nduration = 4\nto = { bends = [[-0.4, 0]], stretches = [0.95] }\n";
  }
  return text;
}

TEST(DynamicEndurance, TenMinutesOfAnArmInMotionKeepTheirMemory) {
  class Run : public Runs {
   public:
    using Runs::run;
  } runs;
  Minutes minutes;
  const RunResult result = runs.run(parse_experiment(ten_minutes(), "x.toml"), &minutes);
  ASSERT_EQ(result.outcome, RunOutcome::done) << (result.reasons.empty() ? "" : result.reasons.front());
  ASSERT_GE(minutes.heap.size(), 10U);
  for (std::size_t i = 0; i < minutes.heap.size(); ++i)
    std::printf("after %zu min: heap %.2f MB, resident %.2f MB\n", i + 1, minutes.heap[i] / a_megabyte,
                minutes.memory[i] / a_megabyte);
  // The report keeps up to 10,000 of the run's states, whatever its length; the log's index of chunks grows
  // by some bytes each.
  EXPECT_LE(minutes.heap[9] - minutes.heap[0], 4 * a_megabyte);
  EXPECT_LE(minutes.memory[9] - minutes.memory[0], 4 * a_megabyte);
}

}  // namespace
}  // namespace flexura

#endif

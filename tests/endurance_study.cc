// Servos one simulated arm for days by wanted shapes that repeat, and prints what each hour of it left and
// took: endurance_study [HOURS] [SEED]. docs/studies/endurance.md
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "flexura/servo/servo_session.h"
#include "tests/support/random_cases.h"
#include "tests/support/servo_bench.h"

namespace flexura {
namespace {

constexpr int slices = 24;  // Rows a part: hours, when it goes on for a day.
// Of the shapes that repeat, s: at rest in one for 3 s, 2 s on the way to the other one, and back.
constexpr double period = 10, rest = 3;

// In use of the heap, and of the machine's memory by the process, bytes.
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

// What an hour came to; errors are the simulated truth's, shares of the length.
struct Hour {
  double rest_squares = 0, rest_most = 0, way_squares = 0, way_most = 0;
  double rests = 0, ways = 0;  // Of these errors.
  long steps = 0, fresh = 0, limited = 0, reported = 0;
  double heap = 0, resident = 0;

  [[nodiscard]] double rest_rms() const { return std::sqrt(rest_squares / std::max(1.0, rests)); }
  [[nodiscard]] double way_rms() const { return std::sqrt(way_squares / std::max(1.0, ways)); }
};

// Counts as the servo goes on, and keeps a row an hour, made before it begins.
class Logbook : public ServoSessionWatcher {
 public:
  Logbook(SimulatedRig& rig, const Arm& arm, double hour) : rig_(rig), arm_(arm), hour_(hour) {
    hours.resize(slices);
  }
  void arm_sent(double, const ArmState&, double) override {}
  void reported(double time, const std::string& what) override {
    ++at(time).reported;
    if (++lines_ <= 10) std::fprintf(stderr, "%.1f s: %s\n", time, what.c_str());
  }
  void stepped(const ServoStep& step) override {
    Hour& hour = at(step.time);
    ++hour.steps;
    hour.limited += step.limited.empty() ? 0 : 1;
    hour.heap = heap_in_use(), hour.resident = resident();
    if (!step.is_fresh) return;
    ++hour.fresh;
    const double off = servo_error(arm_, rig_.arm().truth(*step.seen_at), step.desired).rms;
    const double phase = std::fmod(*step.seen_at - start_, 0.5 * period);
    // At rest, and come to it: the last second of it.
    if (phase > rest - 1.01 && phase <= rest) {
      hour.rest_squares += off * off, hour.rest_most = std::max(hour.rest_most, off), ++hour.rests;
    } else if (phase > rest) {
      hour.way_squares += off * off, hour.way_most = std::max(hour.way_most, off), ++hour.ways;
    }
  }
  void begin(double start) { start_ = start; }

  std::vector<Hour> hours;

 private:
  Hour& at(double time) {
    const auto number = static_cast<std::ptrdiff_t>((time - start_) / hour_);
    return hours[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(number, 0, slices - 1))];
  }
  SimulatedRig& rig_;
  Arm arm_;
  double hour_, start_ = 0;
  int lines_ = 0;
};

std::vector<ServoGoal> repeated(const ArmState& one, const ArmState& other, double seconds) {
  std::vector<ServoGoal> goals;
  for (double time = 0; time < seconds; time += period) {
    goals.push_back({time, one}), goals.push_back({time + rest, one});
    goals.push_back({time + 0.5 * period, other}), goals.push_back({time + 0.5 * period + rest, other});
  }
  return goals;
}

// The slope of a line through what the hours have, by hour, from the second one on: the first one has the
// way to the first shape, and buffers that fill.
template <class Of>
double slope(const std::vector<Hour>& hours, Of of) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = 1; i < hours.size(); ++i) {
    const auto at = static_cast<double>(i);
    ++n, x += at, y += of(hours[i]), xx += at * at, xy += at * of(hours[i]);
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

// The mean of a quarter of the rows: the first one without the first row, or the last.
template <class Of>
double quarter(const std::vector<Hour>& hours, bool is_last, Of of) {
  const std::size_t count = slices / 4, first = is_last ? slices - count : 1, end = is_last ? slices : count;
  double sum = 0;
  for (std::size_t i = first; i < end; ++i) sum += of(hours[i]);
  return sum / static_cast<double>(end - first);
}

// No errors of the last quarter are more than a tenth above the first one's.
template <class Of>
bool is_error_level(const char* what, const std::vector<Hour>& hours, Of of) {
  constexpr double tenth = 1.1;
  const double first = quarter(hours, false, of), last = quarter(hours, true, of);
  const bool is_level = last <= tenth * first;
  fmt::print("- {}: {:.4f} % in the first quarter, {:.4f} % in the last, {:+.1e} a row: {}\n", what, first,
             last, slope(hours, of), is_level ? "level" : "**not level**");
  return is_level;
}

// A number that is kept of each step takes 8 bytes, a block of the heap 32 at least. Half of the first is
// more than tables take that are filled as they are first asked for, once most of them are.
template <class Of>
bool is_memory_level(const char* what, const std::vector<Hour>& hours, double slack, Of of) {
  constexpr double most = 4;  // Bytes a step.
  const std::size_t from = slices - slices / 4 - 1;
  double steps = 0;
  for (std::size_t i = from + 1; i < slices; ++i) steps += static_cast<double>(hours[i].steps);
  const double grown = of(hours.back()) - of(hours[from]);
  const bool is_level = grown <= most * steps + slack;
  fmt::print("- {}: {:+.1f} kB in the last quarter, {:.2f} bytes a step: {}\n", what, grown / 1024,
             grown / std::max(1.0, steps), is_level ? "level" : "**not level**");
  return is_level;
}

bool judge(const std::vector<Hour>& hours) {
  constexpr double pages = 256.0 * 1024;
  bool is_fine = is_error_level("error at rest", hours, [](const Hour& h) { return 100 * h.rest_rms(); });
  is_fine &= is_error_level("error on the way", hours, [](const Hour& h) { return 100 * h.way_rms(); });
  is_fine &= is_memory_level("heap in use", hours, 0, [](const Hour& h) { return h.heap; });
  is_fine &= is_memory_level("resident memory", hours, pages, [](const Hour& h) { return h.resident; });
  return is_fine;
}

void print_hours(const std::vector<Hour>& hours, double seconds) {
  fmt::print(
      "| from, h | steps | with pictures | at rest, rms, % (most) | on the way, rms, % (most) | held back | "
      "told | heap, kB | resident, kB |\n| ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  for (std::size_t i = 0; i < hours.size(); ++i) {
    const Hour& hour = hours[i];
    fmt::print("| {:.4g} | {} | {} | {:.4f} ({:.4f}) | {:.4f} ({:.4f}) | {} | {} | {:.1f} | {:.0f} |\n",
               static_cast<double>(i) * seconds / 3600 / slices, hour.steps, hour.fresh,
               100 * hour.rest_rms(), 100 * hour.rest_most, 100 * hour.way_rms(), 100 * hour.way_most,
               hour.limited, hour.reported, hour.heap / 1024, hour.resident / 1024);
  }
  fmt::print("\n");
}

// One servo of `seconds`, a step each `step` s; whether nothing drifted, grew or went wrong.
bool endure(double seconds, double step, std::uint64_t seed) {
  ServoBench bench(servo_file(servo_target));
  TestRandom random(seed);
  ArmState one = ArmState::straight(3), other = one;
  for (std::size_t i = 0; i < 3; ++i) {
    one.bends[i] = random.vector<2>(-1, 1);
    other.bends[i] = one.bends[i] + random.vector<2>(-0.7, 0.7);
  }
  ServoConfig config = bench.config();
  config.step = step, config.keeps_steps = false;
  config.hold_after = std::max(0.3, 2 * step), config.give_up_after = std::max(3.0, 10 * step);
  config.goals = repeated(one, other, seconds);
  Logbook book(bench.rig(), bench.experiment().arm.arm(), seconds / slices);
  book.begin(bench.rig().clock().now());
  const RigModel model = bench.nominal();
  const ServoResult result = servo_in_session(bench.ports(), model, config, book);
  print_hours(book.hours, seconds);
  fmt::print("- ended: {}; steps missed: {}; fault: {}; steps kept: {}\n",
             result.is_done ? "there" : result.reason, result.missed_steps,
             result.fault ? result.fault->reason : "none", result.steps.size());
  const bool is_level_all = judge(book.hours);
  fmt::print("\n");
  return result.is_done && result.missed_steps == 0 && !result.fault && is_level_all;
}

}  // namespace
}  // namespace flexura

int main(int count, char** arguments) {
  using namespace flexura;
  const double hours = count > 1 ? std::strtod(arguments[1], nullptr) : 24;
  const std::uint64_t seed = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1;
  if (!(hours > 0)) {
    std::fprintf(stderr, "endurance_study: hours: expected a number above 0\n");
    return 2;
  }
  fmt::print("## {:.4g} h, a step and two pictures each second\n\n", hours);
  std::fflush(stdout);
  bool is_fine = endure(3600 * hours, 1, seed);
  std::fflush(stdout);
  fmt::print("## {:.4g} h, 30 a second\n\n", hours / slices);
  is_fine &= endure(3600 * hours / slices, 1.0 / 30, seed);
  fmt::print("{}\n",
             is_fine ? "Nothing drifted, grew or went wrong." : "**Something drifted, grew or went wrong.**");
  return is_fine ? 0 : 1;
}

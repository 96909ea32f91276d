// Calibrates random simulated rigs by each method, including rendering and image processing, and prints the
// accuracy: paper_study TRIALS SEED PRINTED BUNDLES FOLDER [PICTURE] runs TRIALS trials of the paper's
// methods as corrected, PRINTED trials of them as printed in the paper, and BUNDLES trials of the bundles.
// Finished trials are stored in FOLDER and are not run again. PICTURE receives a plot of where the methods as
// printed fail. See docs/studies/calibration.md.
// paper_study --method METHOD SEED FOLDER FIRST[-LAST]... runs these trials of one method. It prints a line
// with the reported reason for each, then the method's row.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/calibration_trials.h"
#include "tests/support/outcome_plot.h"
#include "tests/support/spread_tables.h"
#include "tests/support/study_numbers.h"

namespace flexura {
namespace {

constexpr double in_degrees = 1 / degree;

void run(const std::string& method, const std::vector<std::size_t>& indices, std::uint64_t seed,
         TrialFile& file) {
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < indices.size(); i = next++)
      if (!file.has(indices[i])) file.add(run_trial(method, seed, indices[i]));
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
}

std::string file_of(const std::string& method, std::uint64_t seed, const std::filesystem::path& folder) {
  return (folder / fmt::format("{}-{}.txt", method, seed)).string();
}

std::vector<CalibrationTrial> run_all(const std::string& method, std::size_t count, std::uint64_t seed,
                                      const std::filesystem::path& folder) {
  TrialFile file(file_of(method, seed, folder));
  std::vector<std::size_t> indices(count);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  run(method, indices, seed, file);
  return file.all(indices);
}

double share_of(const std::vector<double>& values, double share) { return quantile(sizes_of(values), share); }

void print_row(const std::string& method, const std::vector<CalibrationTrial>& trials) {
  std::vector<double> pictures, angle, aim, zoom;
  for (const CalibrationTrial& one : trials) {
    if (!one.is_done) continue;
    pictures.push_back(one.pictures), angle.push_back(one.angle), aim.push_back(one.aim),
        zoom.push_back(one.zoom);
  }
  fmt::print("| `{}` | {} of {} |", method, pictures.size(), trials.size());
  if (pictures.empty()) {
    fmt::print(" - | - | - | - | - | - | - | - |\n");
    return;
  }
  constexpr double desired = 0.1;  // Maximum angle error of a good trial, deg.
  const auto good =
      std::ranges::count_if(angle, [](double one) { return std::abs(one) * in_degrees <= desired; });
  fmt::print(" {} | {:.1f} | {:.3f} | {:.3f} | {:.3f} | {:.1f} | {:.1f} | {:.2f} |\n", good,
             share_of(pictures, 0.5), share_of(angle, 0.5) * in_degrees, share_of(angle, 0.95) * in_degrees,
             share_of(angle, 1) * in_degrees, share_of(aim, 0.5) * 1e3, share_of(aim, 0.95) * 1e3,
             share_of(zoom, 0.95) * 100);
}

void print_failures(const std::string& method, const std::vector<CalibrationTrial>& trials) {
  std::map<std::string, int> kinds;
  for (const CalibrationTrial& one : trials)
    if (!one.is_done) ++kinds[one.reason];
  if (kinds.empty()) return;
  fmt::print("Reasons of failures of `{}`:", method);
  const char* before = " ";
  for (const auto& [kind, count] : kinds) fmt::print("{}{} x \"{}\"", before, count, kind), before = ", ";
  fmt::print(".\n\n");
}

void print_head() {
  fmt::print(
      "| method | done | axes within 0.1 deg of 90 deg | pictures per camera, median | deviation of axes "
      "from 90 deg, median, deg | 95 %, deg | largest, deg | distance of axes from the target, median, mm | "
      "95 %, mm | deviation of zoom ratio from 1, 95 %, % |\n"
      "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
}

using Number = std::function<double(const CalibrationTrial&)>;

// Returns the values of the trials that ended with success.
std::vector<double> of_done(const std::vector<CalibrationTrial>& trials, const Number& number) {
  std::vector<double> values;
  for (const CalibrationTrial& one : trials)
    if (one.is_done) values.push_back(number(one));
  return values;
}

double larger(const std::array<double, 2>& values) {
  return std::max(std::abs(values[0]), std::abs(values[1]));
}

void print_bundle(const std::string& method, const std::vector<CalibrationTrial>& trials) {
  fmt::print("Errors of `{}` relative to true values:\n\n", method);
  fmt::print("{}", spread_head);
  const auto row = [&](const std::string& name, double unit, int digits, const Number& number) {
    fmt::print("{}", spread_row(name, of_done(trials, number), unit, digits));
  };
  const auto rows = [&](const std::string& name, const std::string& in, double unit, int digits,
                        const std::function<RigFigure(const BundleFigures&)>& figure) {
    row(name + ": error, " + in, unit, digits, [&](const auto& one) { return figure(one.bundle).error; });
    row(name + ": estimated standard deviation, " + in, unit, digits,
        [&](const auto& one) { return figure(one.bundle).sigma; });
    row(name + ": error / standard deviation", 1, 2,
        [&](const auto& one) { return figure(one.bundle).error / figure(one.bundle).sigma; });
  };
  rows("angle between the axes", "deg", degree, 4, [](const auto& is) { return is.angle; });
  rows("focal length of the front camera", "%", 0.01, 3, [](const auto& is) { return is.focal[0]; });
  rows("focal length of the side camera", "%", 0.01, 3, [](const auto& is) { return is.focal[1]; });
  row("RMS residual / assumed standard deviation", 1, 4, [](const auto& one) { return one.bundle.rms; });
  row("deviation of the true axes from 90 deg, deg", degree, 4, [](const auto& one) { return one.angle; });
  fmt::print("\n");
}

// Prints whether a method reaches its accuracy goals. There are none for the paper's methods as printed.
void print_aims(const std::string& method, const std::vector<CalibrationTrial>& trials) {
  const auto row = [&](Aim aim, const Number& number) {
    aim.values = of_done(trials, number);
    fmt::print("{}", aim_row("`" + method + "`", aim, trials.size()));
  };
  const auto angle = [](const CalibrationTrial& one) { return one.angle; };
  if (method.ends_with("-paper")) return;
  if (!method.starts_with("bundle")) {
    row({"99.9 % have axes within 0.1 deg of 90 deg", 0.1 * degree, degree, {}, 0.999}, angle);
    return;
  }
  Aim done{"all succeed, with 12 pictures per camera", 12, 1, {}};
  done.has_rms = false;
  row(done, [](const auto& one) { return larger(one.bundle.pictures); });
  row({"error of the angle between the axes within 0.01 deg", 0.01 * degree, degree, {}},
      [](const auto& one) { return one.bundle.angle.error; });
  row({"errors of focal lengths within 0.3 %", 0.003, 0.01, {}},
      [](const auto& one) { return larger({one.bundle.focal[0].error, one.bundle.focal[1].error}); });
  row({"RMS residual at most 1.05 of the assumed standard deviation", 1.05, 1, {}},
      [](const auto& one) { return one.bundle.rms; });
  row({"true axes within 0.0375 deg of 90 deg", 0.0375 * degree, degree, {}}, angle);
}

void print_known(const MethodTrials& all) {
  for (const auto& [method, trials] : all)
    if (method.starts_with("bundle")) print_bundle(method, trials);
  fmt::print("{}", aim_head);
  for (const auto& [method, trials] : all) print_aims(method, trials);
  fmt::print("\n");
}

// Parses FIRST or FIRST-LAST.
void add_indices(const std::string& range, std::vector<std::size_t>& indices) {
  const std::size_t dash = range.find('-');
  const std::size_t first = std::stoul(range.substr(0, dash));
  const std::size_t last = dash == std::string::npos ? first : std::stoul(range.substr(dash + 1));
  for (std::size_t i = first; i <= last; ++i) indices.push_back(i);
}

int run_chosen(const std::string& method, std::uint64_t seed, const std::filesystem::path& folder,
               const std::vector<std::size_t>& indices) {
  std::filesystem::create_directories(folder);
  TrialFile file(file_of(method, seed, folder));
  run(method, indices, seed, file);
  const std::vector<CalibrationTrial> trials = file.all(indices);
  for (const CalibrationTrial& one : trials)
    fmt::print("{}: {:.1f} pictures, {:.3f} deg, {:.1f} mm, {:.2f} %, {}\n", one.index, one.pictures,
               one.angle * in_degrees, one.aim * 1e3, one.zoom * 100, one.reason);
  fmt::print("\n");
  print_head();
  print_row(method, trials);
  fmt::print("\n");
  print_failures(method, trials);
  print_known({{method, trials}});
  return 0;
}

}  // namespace
}  // namespace flexura

int main(int argc, char** argv) {
  using namespace flexura;
  constexpr const char* chosen = "--method";
  if (argc > 5 && std::string(argv[1]) == chosen) {
    std::vector<std::size_t> indices;
    for (int i = 5; i < argc; ++i) add_indices(argv[i], indices);
    return run_chosen(argv[2], std::strtoull(argv[3], nullptr, 10), argv[4], indices);
  }
  if (argc < 6) {
    fmt::print(stderr,
               "paper_study TRIALS SEED PRINTED BUNDLES FOLDER [PICTURE]\n"
               "paper_study --method METHOD SEED FOLDER FIRST[-LAST]...\n");
    return 2;
  }
  const auto trials = static_cast<std::size_t>(std::atoi(argv[1]));
  const std::uint64_t seed = std::strtoull(argv[2], nullptr, 10);
  const auto printed = static_cast<std::size_t>(std::atoi(argv[3])),
             bundles = static_cast<std::size_t>(std::atoi(argv[4]));
  const std::filesystem::path folder = argv[5];
  std::filesystem::create_directories(folder);
  print_head();
  MethodTrials all, shown;
  for (const std::string method :
       {"bundle", "bundle-etalon", "etalon", "arcs", "arcs-paper", "etalon-paper"}) {
    const bool is_printed = method.ends_with("-paper"), is_bundle = method.starts_with("bundle");
    const std::size_t corrected = is_bundle ? bundles : trials, count = is_printed ? printed : corrected;
    all.emplace_back(method, run_all(method, count, seed, folder));
    if (is_printed) shown.push_back(all.back());
    print_row(method, all.back().second);
    std::fflush(stdout);
  }
  fmt::print("\n");
  for (const auto& [method, ended] : all) print_failures(method, ended);
  print_known(all);
  if (argc > 6) std::ofstream(argv[6]) << OutcomePlot::draw(shown, all);
  return 0;
}

// The second table of docs/studies/seeing.md: shape_study CASES SEED prints it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "flexura/estimate/picture_sighting.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/vision/picture_file.h"
#include "tests/support/seen_shapes.h"

namespace flexura {
namespace {

struct Tally {
  std::string name;
  std::size_t missing = 0, flagged = 0;
  std::vector<double> errors, flagged_errors, ratios, shares;

  void add(const ShapeEstimate& found, const SeenShape& one, bool has_bends) {
    if (!found.is_found) {
      ++missing;
      return;
    }
    const Backbone truth = one.bent.backbone();
    const double error = relative_shape_error(found.shape, truth);
    if (!found.notes.empty()) {
      ++flagged, flagged_errors.push_back(error);
      return;
    }
    errors.push_back(error);
    double squares = 0;
    for (const double sigma : found.sigma) squares += sigma * sigma / static_cast<double>(found.sigma.size());
    ratios.push_back(error * truth.length() / std::sqrt(squares));
    if (has_bends) shares.push_back(expected_share(found, one.bent.state));
  }
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

double root_mean_square(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(values.size(), 1)));
}

void print(const Tally& tally, int cases) {
  if (tally.errors.empty()) {
    std::printf("| %s | 0 of %d | %zu | | | | %.4f | %.4f | %.3f | | | | |\n", tally.name.c_str(), cases,
                tally.flagged, 100 * quantile(tally.flagged_errors, 0.5),
                100 * root_mean_square(tally.flagged_errors), 100 * quantile(tally.flagged_errors, 0.999));
    return;
  }
  std::printf("| %s | %zu of %d | %zu | %.4f | %.4f | %.4f | %.4f | %.4f | %.3f | %.2f | %.2f |",
              tally.name.c_str(), tally.errors.size(), cases, tally.flagged,
              100 * quantile(tally.errors, 0.5), 100 * root_mean_square(tally.errors),
              100 * quantile(tally.errors, 0.999), 100 * quantile(tally.flagged_errors, 0.5),
              100 * root_mean_square(tally.flagged_errors), 100 * quantile(tally.flagged_errors, 0.999),
              quantile(tally.ratios, 0.5), quantile(tally.ratios, 0.95));
  if (tally.shares.empty()) {
    std::printf(" | |\n");
    return;
  }
  const auto within = [&](double share) {
    const auto count = std::ranges::count_if(tally.shares, [&](double value) { return value < share; });
    return 100.0 * static_cast<double>(count) / static_cast<double>(tally.shares.size());
  };
  std::printf(" %.0f | %.0f |\n", within(0.5), within(0.95));
}

int study(int cases, std::uint64_t seed) {
  std::array<Tally, 5> tallies = {
      Tally{"the arm is known", 0, 0, {}, {}, {}, {}},
      Tally{"base and length are known", 0, 0, {}, {}, {}, {}},
      Tally{"the base is known", 0, 0, {}, {}, {}, {}},
      Tally{"the length is known", 0, 0, {}, {}, {}, {}},
      Tally{"nothing is known", 0, 0, {}, {}, {}, {}},
  };
  const bool is_told = std::getenv("SHAPE_STUDY_TELLS") != nullptr;
  for (int i = 0; i < cases; ++i) {
    TestRandom random(seed + static_cast<std::uint64_t>(i));
    const SeenShape one = random_seen_shape(random);
    const Backbone truth = one.bent.backbone();
    const Eigen::Vector3d base = truth.pose(0).position;
    const std::array<ShapePrior, 5> priors = {
        ShapePrior{.arm = one.bent.arm},
        unknown_arm(base, truth.length()),
        unknown_arm(base, {}),
        unknown_arm({}, truth.length()),
        unknown_arm({}, {}),
    };
    for (std::size_t k = 0; k < tallies.size(); ++k) {
      std::vector<Sighting> sightings;
      for (std::size_t j = 0; j < 2; ++j) {
        ArmFinderConfig config;
        // Which end is the base is told: an unknown arm may lie with it upwards.
        config.base = one.views[j].project(base);
        ArmFinder finder(config);
        sightings.push_back(sighting_of(finder.find(one.pictures[j]), one.views[j]));
      }
      ShapeEstimator estimator(priors[k]);
      const ShapeEstimate found = estimator.estimate(sightings);
      tallies[k].add(found, one, k == 0);
      if (is_told)
        std::fprintf(stderr, "%d %zu %s error %.4f %% rms %.3f px doubted %.2f notes %zu%s\n", i, k,
                     found.is_found ? "found" : "lost",
                     found.is_found ? 100 * relative_shape_error(found.shape, truth) : 0.0, found.rms,
                     found.doubted, found.notes.size(),
                     found.notes.empty() ? found.reason.c_str() : found.notes.front().c_str());
    }
  }
  std::printf(
      "| | trusted | marked | median, %% | rms, %% | 99.9 %%, %% | marked: median, %% | rms, %% | 99.9 %%, "
      "%% | over sigma: median | 95 %% | within 50 %%, %% | within 95 %%, %% |\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Tally& tally : tallies) print(tally, cases);
  return 0;
}

}  // namespace
}  // namespace flexura

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: shape_study CASES SEED\n"), 2;
  return flexura::study(std::stoi(argv[1]), std::stoull(argv[2]));
}

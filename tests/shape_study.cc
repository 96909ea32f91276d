// Prints the second table of docs/studies/seeing.md: shape_study CASES SEED.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "flexura/estimate/picture_observation.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/vision/picture_file.h"
#include "tests/support/seen_shapes.h"
#include "tests/support/study_numbers.h"

namespace flexura {
namespace {

// The noise of the pictures is drawn from 0 to 4 of 255; it is tabulated in steps of 1.
constexpr std::size_t noise_steps = 4;

// Errors of the bends, compared with the estimated covariance.
struct Consistency {
  std::vector<double> shares;       // expected_share()
  double squares = 0, freedom = 0;  // Sums of error_square() and of its degrees of freedom.

  void add(const ShapeEstimate& found, const ArmState& truth) {
    shares.push_back(expected_share(found, truth));
    squares += error_square(found, truth), freedom += static_cast<double>(2 * truth.bends.size());
  }
  // mean_square() is 1 if the covariance is right; deviations of more than chance() occur once in a thousand
  // by chance.
  [[nodiscard]] double mean_square() const { return freedom > 0 ? squares / freedom : NAN; }
  [[nodiscard]] double chance() const { return 3.29 * std::sqrt(2 / freedom); }
};

struct Tally {
  std::string name;
  std::vector<double> errors, flagged_errors, ratios;
  Consistency all;
  std::array<Consistency, noise_steps> by_noise;

  void add(const ShapeEstimate& found, const SeenShape& one, bool has_bends) {
    if (!found.is_found) return;
    const Backbone truth = one.bent.backbone();
    const double error = relative_shape_error(found.shape, truth);
    (found.is_trusted() ? errors : flagged_errors).push_back(error);
    if (!found.is_trusted()) return;
    double squares = 0;
    for (const double sigma : found.sigma) squares += sigma * sigma / static_cast<double>(found.sigma.size());
    ratios.push_back(error * truth.length() / std::sqrt(squares));
    if (!has_bends) return;
    all.add(found, one.bent.state);
    by_noise[std::min(static_cast<std::size_t>(one.noise), noise_steps - 1)].add(found, one.bent.state);
  }
};

// Formats a number; empty if it is NaN.
std::string number(double value, int digits) {
  return std::isnan(value) ? "" : fmt::format("{:.{}f}", value, digits);
}

std::vector<double> joined(std::vector<double> values, const std::vector<double>& others) {
  values.insert(values.end(), others.begin(), others.end());
  return values;
}

// Returns how often the true value lies in the region of probability `share` of the covariance, %.
std::string within(const std::vector<double>& shares, double share) {
  if (shares.empty()) return "";
  const auto count = std::ranges::count_if(shares, [&](double value) { return value < share; });
  return number(100.0 * static_cast<double>(count) / static_cast<double>(shares.size()), 1);
}

void print(const Tally& tally, int cases) {
  const auto &good = tally.errors, &bad = tally.flagged_errors;
  fmt::print("| {} | {} of {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", tally.name,
             good.size(), cases, bad.size(), number(100 * quantile(good, 0.5), 4),
             number(100 * root_mean_square(good), 4), number(100 * quantile(good, 0.999), 4),
             number(100 * quantile(bad, 0.5), 4), number(100 * root_mean_square(bad), 4),
             number(100 * quantile(bad, 0.999), 3), number(quantile(tally.ratios, 0.5), 2),
             number(quantile(tally.ratios, 0.95), 2), within(tally.all.shares, 0.5),
             within(tally.all.shares, 0.95));
}

// Goals: rms and largest error as shares of the length, and chi^2 for the uniformity of the regions (exceeded
// once in a thousand by chance). The mean squared error must agree with the covariance.
constexpr double aimed_rms = 2e-4, aimed_most = 5e-4, rare_unevenness = 27.88;

void print_verdicts(const Tally& tally) {
  const double uneven = tally.all.shares.empty() ? NAN : unevenness(tally.all.shares);
  const auto reported = [](double value, double most, double unit, int digits) {
    const std::string word = verdict(value, most);
    return std::isnan(value) ? word : fmt::format("{} ({:.{}f})", word, unit * value, digits);
  };
  const double mean = tally.all.mean_square();
  const std::string squares = std::isnan(mean) ? verdict(mean, 0)
                                               : fmt::format("{} ({:.3f}, bound {:.3f})",
                                                             verdict(std::abs(mean - 1), tally.all.chance()),
                                                             mean, tally.all.chance());
  fmt::print("| {} | {} | {} | {} | {} | {} |\n", tally.name,
             reported(root_mean_square(tally.errors), aimed_rms, 100, 4),
             reported(root_mean_square(joined(tally.errors, tally.flagged_errors)), aimed_rms, 100, 4),
             reported(quantile(tally.errors, 0.999), aimed_most, 100, 4), squares,
             reported(uneven, rare_unevenness, 1, 0));
}

// Prints the consistency by noise level. Errors of the border model do not decrease with the noise, so they
// dominate where there is little noise.
void print_by_noise(const Tally& tally) {
  fmt::print(
      "\n| noise, of 255 | trusted | mean squared error / expectation | in 50 % region, % | in 95 % region, "
      "% | chi^2 of the confidence regions |\n| --- | --- | --- | --- | --- | --- |\n");
  for (std::size_t k = 0; k < noise_steps; ++k) {
    const Consistency& one = tally.by_noise[k];
    fmt::print("| {} to {} | {} | {} | {} | {} | {} |\n", k, k + 1, one.shares.size(),
               number(one.mean_square(), 3), within(one.shares, 0.5), within(one.shares, 0.95),
               one.shares.empty() ? "" : number(unevenness(one.shares), 0));
  }
}

int study(int cases, std::uint64_t seed) {
  std::array<Tally, 5> tallies;
  constexpr std::array names = {"sections and base", "base and length", "base", "length", "nothing"};
  for (std::size_t k = 0; k < tallies.size(); ++k) tallies[k].name = names[k];
  const bool is_verbose = std::getenv("SHAPE_STUDY_TELLS") != nullptr;
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
    std::vector<Observation> observations;
    for (std::size_t j = 0; j < 2; ++j) {
      ArmFinderConfig config;
      // The base end is given, because an unknown arm may appear upside down.
      config.base = one.views[j].project(base);
      ArmFinder finder(config);
      observations.push_back(observation_of(finder.find(one.pictures[j]), one.views[j]));
    }
    for (std::size_t k = 0; k < tallies.size(); ++k) {
      ShapeEstimator estimator(priors[k]);
      const ShapeEstimate found = estimator.estimate(observations);
      tallies[k].add(found, one, k == 0);
      if (is_verbose)
        std::fprintf(stderr, "%d %zu %s error %.4f %% rms %.3f px outliers %.2f notes %zu%s\n", i, k,
                     found.is_found ? "found" : "lost",
                     found.is_found ? 100 * relative_shape_error(found.shape, truth) : 0.0, found.rms,
                     found.outlier_share, found.notes.size(),
                     found.notes.empty() ? found.reason.c_str()
                                         : fmt::format("{}", fmt::join(found.notes, "; ")).c_str());
    }
  }
  fmt::print(
      "| given | trusted | noted | trusted: median error, % | RMS, % | 99.9 %, % | noted: median error, % | "
      "RMS, % | 99.9 %, % | error / sigma: median | 95 % | in 50 % region, % | in 95 % region, % |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Tally& tally : tallies) print(tally, cases);
  fmt::print(
      "\n| given | RMS of trusted estimates at most {} % | RMS of all estimates at most {} % | 99.9 % of "
      "trusted estimates within {} % | mean squared error / expectation consistent with 1 | chi^2 of the "
      "confidence regions at most {} |\n| --- | --- | --- | --- | --- | --- |\n",
      100 * aimed_rms, 100 * aimed_rms, 100 * aimed_most, rare_unevenness);
  for (const Tally& tally : tallies) print_verdicts(tally);
  print_by_noise(tallies.front());
  return 0;
}

}  // namespace
}  // namespace flexura

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: shape_study CASES SEED\n"), 2;
  return flexura::study(std::stoi(argv[1]), std::stoull(argv[2]));
}

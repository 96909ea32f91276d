// The second table of docs/studies/seeing.md: shape_study CASES SEED prints it.
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "flexura/estimate/picture_sighting.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/vision/picture_file.h"
#include "tests/support/seen_arms.h"

namespace flexura {
namespace {

// An arm, and what two cameras at about a right angle to each other see of it.
struct Case {
  BentArm bent;
  std::array<View, 2> views;
  std::array<Image<std::uint8_t>, 2> pictures;
};

Case random_case(TestRandom& random) {
  SeenArmOptions options;
  options.noise = random.uniform(0, 4), options.psf = random.uniform(0.5, 1.2);
  RandomArm arm = random_arm(random, options);
  Case result{arm.bent, {}, {}};
  const Backbone backbone = arm.bent.backbone();
  const Eigen::Vector3d middle = backbone.pose(0.5 * backbone.length()).position;
  const double turn = random.uniform(0, 2 * std::numbers::pi);
  for (std::size_t i = 0; i < 2; ++i) {
    const double angle =
        turn + static_cast<double>(i) * (0.5 * std::numbers::pi + random.uniform(-0.15, 0.15));
    const Eigen::Vector3d direction(std::cos(angle), random.uniform(-0.2, 0.2), std::sin(angle));
    const Eigen::Vector3d from = middle + direction.normalized() * random.uniform(1.5, 3);
    result.views[i] = pinhole_view(
        look_at(from, middle + random.vector<3>(-0.05, 0.05)), options.width, options.height,
        0.42 * options.height * (from - middle).norm() / (0.55 * backbone.length()) * random.uniform(0.7, 1));
    result.pictures[i] = photograph(arm.scene, result.views[i], options,
                                    static_cast<std::uint64_t>(random.integer(0, 1 << 30)));
  }
  return result;
}

// Root mean square of the distances between points at equal shares of both lengths, of the arm's length.
double shape_error(const Shape& shape, const Backbone& truth) {
  const Backbone found(shape.arm, shape.state);
  constexpr int count = 100;
  double squares = 0;
  for (int i = 0; i <= count; ++i) {
    const double share = static_cast<double>(i) / count;
    squares += (found.pose(share * found.length()).position - truth.pose(share * truth.length()).position)
                   .squaredNorm();
  }
  return std::sqrt(squares / (count + 1)) / truth.length();
}

// Within which share of the errors that it expects the covariance of the bends has the true ones: evenly from
// 0 to 1 where it is right. By E. B. Wilson's and M. M. Hilferty's cube root of chi^2, good to 0.01.
double expected_share(const ShapeEstimate& found, const ArmState& truth) {
  const auto count = static_cast<Eigen::Index>(2 * truth.bends.size());
  Eigen::VectorXd off(count);
  for (std::size_t i = 0; i < truth.bends.size(); ++i)
    off.segment<2>(static_cast<Eigen::Index>(2 * i)) = found.shape.state.bends[i] - truth.bends[i];
  const double square = off.dot(found.covariance.topLeftCorner(count, count).ldlt().solve(off));
  const double spread = 2 / (9.0 * static_cast<double>(count));
  const double normal = (std::cbrt(square / static_cast<double>(count)) - (1 - spread)) / std::sqrt(spread);
  return 0.5 * std::erfc(-normal / std::numbers::sqrt2);
}

struct Tally {
  std::string name;
  std::size_t missing = 0, flagged = 0;
  std::vector<double> errors, flagged_errors, ratios, shares;

  void add(const ShapeEstimate& found, const Case& one, bool has_bends) {
    if (!found.is_found) {
      ++missing;
      return;
    }
    const Backbone truth = one.bent.backbone();
    const double error = shape_error(found.shape, truth);
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
    std::printf("| %s | 0 of %d | %zu | | | | %.4f | | | | |\n", tally.name.c_str(), cases, tally.flagged,
                100 * quantile(tally.flagged_errors, 0.5));
    return;
  }
  std::printf("| %s | %zu of %d | %zu | %.4f | %.4f | %.4f | %.4f | %.2f | %.2f |", tally.name.c_str(),
              tally.errors.size(), cases, tally.flagged, 100 * quantile(tally.errors, 0.5),
              100 * root_mean_square(tally.errors), 100 * quantile(tally.errors, 0.999),
              100 * quantile(tally.flagged_errors, 0.5), quantile(tally.ratios, 0.5),
              quantile(tally.ratios, 0.95));
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
  std::array<Tally, 3> tallies = {
      Tally{"the arm is known", 0, 0, {}, {}, {}, {}},
      Tally{"base and length are known", 0, 0, {}, {}, {}, {}},
      Tally{"nothing is known", 0, 0, {}, {}, {}, {}},
  };
  const bool is_told = std::getenv("SHAPE_STUDY_TELLS") != nullptr;
  for (int i = 0; i < cases; ++i) {
    TestRandom random(seed + static_cast<std::uint64_t>(i));
    const Case one = random_case(random);
    const Backbone truth = one.bent.backbone();
    const Eigen::Vector3d base = truth.pose(0).position;
    const std::array<ShapePrior, 3> priors = {
        ShapePrior{.arm = one.bent.arm},
        unknown_arm(base, truth.length()),
        unknown_arm(std::nullopt, std::nullopt),
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
                     found.is_found ? 100 * shape_error(found.shape, truth) : 0.0, found.rms, found.doubted,
                     found.notes.size(),
                     found.notes.empty() ? found.reason.c_str() : found.notes.front().c_str());
    }
  }
  std::printf(
      "| | trusted | marked | median, %% | rms, %% | 99.9 %%, %% | marked: median, %% | over sigma: median | "
      "95 "
      "%% | within 50 %%, %% | within 95 %%, %% |\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Tally& tally : tallies) print(tally, cases);
  return 0;
}

}  // namespace
}  // namespace flexura

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: shape_study CASES SEED\n"), 2;
  return flexura::study(std::stoi(argv[1]), std::stoull(argv[2]));
}

// Prints the tables of docs/studies/clutter.md: clutter_study ARMS SEED.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "flexura/estimate/tube_fit.h"
#include "flexura/vision/arm_finder.h"
#include "flexura/vision/arm_scene.h"
#include "flexura/vision/backbone_image.h"
#include "tests/support/cluttered_arms.h"
#include "tests/support/study_numbers.h"

namespace flexura {
namespace {

constexpr double aimed_median = 0.1;  // px
constexpr double aimed_share = 0.99;
// An answer is wrong if a twentieth of its axis is farther away than this, px, or if it is much shorter than
// the arm's image.
constexpr double wrong_distance = 1.5, least_length = 0.8;

// The answer of one method to one picture.
struct Answer {
  bool is_found = false, is_trusted = false;
  std::vector<double> errors;  // Of points of the axis, px.
  double length = 1;           // Of the axis, as a share of the true one.

  [[nodiscard]] bool is_wrong() const {
    return is_found && (quantile(errors, 0.95) > wrong_distance || length < least_length);
  }
};

struct Tally {
  std::string name;
  std::size_t pictures = 0, found = 0, trusted = 0, wrong = 0, unflagged = 0;
  std::vector<double> medians, errors;  // Of pictures; of all points of answers that are trusted.
  double squares = 0, freedom = 0;      // Of normalised errors of the shape.
  std::vector<double> ratios;

  void add(const Answer& answer) {
    ++pictures;
    if (!answer.is_found) return;
    ++found, trusted += answer.is_trusted ? 1 : 0;
    const bool is_wrong = answer.is_wrong();
    wrong += is_wrong ? 1 : 0, unflagged += is_wrong && answer.is_trusted ? 1 : 0;
    medians.push_back(quantile(answer.errors, 0.5));
    if (answer.is_trusted) errors.insert(errors.end(), answer.errors.begin(), answer.errors.end());
  }
};

double length_of(const std::vector<AxisPoint>& truth) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < truth.size(); ++i)
    if (truth[i].pixel && truth[i + 1].pixel) length += (*truth[i + 1].pixel - *truth[i].pixel).norm();
  return length;
}

Answer by_finder(const ClutteredArm& arm, std::size_t i, const ArmScene& scene) {
  const View& view = arm.shape.views[i];
  ArmFinderConfig config;
  config.base = view.project(arm.shape.bent.arm.X_WB.position);
  if (scene.has_cues() || !scene.region.empty()) config.scene = std::make_shared<const ArmScene>(scene);
  ArmFinder finder(config);
  Photograph photograph;
  photograph.bytes = arm.shape.pictures[i];
  ArmObservation found = finder.find(photograph);
  Answer answer;
  answer.is_found = found.is_found();
  if (!answer.is_found) return answer;
  answer.is_trusted = found.notes.empty() && !found.contradicts && found.is_whole();
  to_backbone_image(view.lens, found.axis);
  double length = 0;
  for (std::size_t k = 0; k < found.axis.size(); ++k) {
    if (k > 0) length += (found.axis[k].pixel - found.axis[k - 1].pixel).norm();
    if (found.axis[k].is_seen)
      answer.errors.push_back(std::abs(distance_to(arm.truth[i], found.axis[k].pixel)));
  }
  answer.length = length / std::max(length_of(arm.truth[i]), 1.0);
  return answer;
}

// Returns a rectangle around the arm's image.
ArmScene region_around(const ClutteredArm& arm, std::size_t i) {
  constexpr double margin = 25;
  Eigen::Vector2d least(1e9, 1e9), most(-1e9, -1e9);
  for (const AxisPoint& point : arm.truth[i])
    if (point.pixel) least = least.cwiseMin(*point.pixel), most = most.cwiseMax(*point.pixel);
  const Eigen::Vector2d a = least.array() - margin, b = most.array() + margin;
  return {.region = {a, {b.x(), a.y()}, b, {a.x(), b.y()}}};
}

constexpr double guess_std = 0.1;  // rad

// Fits the arm near a guess whose bends are wrong by normal deviates of `wrong` rad.
void by_model(const ClutteredArm& arm, std::uint64_t seed, double wrong, bool uses_background, Tally& tally) {
  TestRandom random(seed);
  const ShapePrior prior{.arm = arm.shape.bent.arm};
  std::array<ArmScene, 2> scenes;
  std::vector<TubePicture> pictures;
  for (std::size_t i = 0; i < 2; ++i) {
    scenes[i].background = arm.backgrounds[i];
    pictures.push_back(
        {&arm.shape.pictures[i], arm.shape.views[i], {}, uses_background ? &scenes[i] : nullptr});
  }
  const Shape guess = guessed_shape(random, arm.shape.bent, wrong);
  const TubeFit fit =
      TubeFitter(prior).fit(pictures, rough_prediction(prior, guess, guess_std, std::vector<ViewPrior>(2)));
  bool is_wrong = false;
  for (std::size_t i = 0; i < 2; ++i) {
    Answer answer{fit.estimate.is_found, fit.estimate.is_trusted(), {}, 1};
    answer.errors = image_errors(fit.estimate.shape, arm.shape.views[i], arm.truth[i]);
    is_wrong = is_wrong || answer.is_wrong();
    tally.add(answer);
  }
  if (!fit.estimate.is_trusted() || is_wrong) return;
  const double square = error_square(fit.estimate, arm.shape.bent.state);
  const auto freedom = static_cast<double>(2 * arm.shape.bent.state.bends.size());
  tally.squares += square, tally.freedom += freedom, tally.ratios.push_back(square / freedom);
}

std::string share(std::size_t part, std::size_t all) {
  return fmt::format("{} ({:.1f} %)", part,
                     100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(all, 1)));
}

void print(const Tally& tally, bool has_aim) {
  const double median = quantile(tally.medians, 0.5);
  const double found = static_cast<double>(tally.found) / static_cast<double>(tally.pictures);
  const std::string verdicts =
      !has_aim ? "none"
               : fmt::format("{}, {}, {}", verdict(aimed_share, found), verdict(median, aimed_median),
                             verdict(static_cast<double>(tally.unflagged), 0));
  fmt::print("| {} | {} | {} | {} | {:.3f} | {} | {} | {} | {} | {} |\n", tally.name, tally.pictures,
             share(tally.found, tally.pictures), share(tally.trusted, tally.pictures), median,
             tally.errors.empty() ? "" : fmt::format("{:.3f}", quantile(tally.errors, 0.95)), tally.wrong,
             tally.unflagged,
             tally.freedom > 0
                 ? fmt::format("{:.2f} ({:.2f})", tally.squares / tally.freedom, quantile(tally.ratios, 0.5))
                 : "",
             verdicts);
  std::fflush(stdout);
}

int study(int arms, std::uint64_t seed) {
  if (clutter_files().empty())
    return std::fprintf(stderr, "clutter_study: needs Debian's opencv-doc and visp-images-data\n"), 2;
  std::array<Tally, 9> tallies;
  constexpr std::array names = {"finder alone",
                                "finder, region",
                                "finder, colour",
                                "finder, background picture",
                                "model",
                                "model, background picture",
                                "model, a part hidden, shadow of the arm",
                                "model, wrong guess",
                                "finder, background picture, a part hidden, shadow of the arm"};
  for (std::size_t k = 0; k < tallies.size(); ++k) tallies[k].name = names[k];
  for (int n = 0; n < arms; ++n) {
    const std::uint64_t own = seed + static_cast<std::uint64_t>(n);
    ClutterConfig options;
    TestRandom random(own), same(own);
    options.noise = random.uniform(0.5, 4), options.psf = random.uniform(0.5, 1.2);
    (void)same.uniform(0.5, 4), (void)same.uniform(0.5, 1.2);
    const ClutteredArm arm = cluttered_arm(random, options);
    for (std::size_t i = 0; i < 2; ++i) {
      tallies[0].add(by_finder(arm, i, {}));
      tallies[1].add(by_finder(arm, i, region_around(arm, i)));
      tallies[2].add(by_finder(arm, i, {.color = arm.seen_color[i]}));
      tallies[3].add(by_finder(arm, i, {.background = arm.backgrounds[i]}));
    }
    by_model(arm, own, guess_std, false, tallies[4]);
    by_model(arm, own, guess_std, true, tallies[5]);
    by_model(arm, own, 3 * guess_std, false, tallies[7]);
    options.plate = 0.15, options.cast = 0.35;
    const ClutteredArm hidden = cluttered_arm(same, options);
    by_model(hidden, own, guess_std, false, tallies[6]);
    for (std::size_t i = 0; i < 2; ++i)
      tallies[8].add(by_finder(hidden, i, {.background = hidden.backgrounds[i]}));
  }
  fmt::print(
      "| method | pictures | found | trusted | axis, median of pictures, px | 95 % of trusted, px | wrong | "
      "wrong and not flagged | squared error / expectation, mean (median) | aims: found {:.0f} %, median "
      "{} px, all wrong ones flagged |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
      100 * aimed_share, aimed_median);
  for (std::size_t k = 0; k < tallies.size(); ++k) print(tallies[k], k >= 3 && k <= 6);
  return 0;
}

}  // namespace
}  // namespace flexura

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: clutter_study ARMS SEED\n"), 2;
  return flexura::study(std::atoi(argv[1]), std::strtoull(argv[2], nullptr, 10));
}

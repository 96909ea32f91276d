// Prints the tables of docs/studies/seeing.md: seeing_study CASES SEED.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "flexura/vision/arm_finder.h"
#include "flexura/vision/backbone_image.h"
#include "flexura/vision/linear_light.h"
#include "flexura/vision/markers.h"
#include "flexura/vision/picture_file.h"
#include "tests/support/seen_arms.h"
#include "tests/support/study_numbers.h"

namespace flexura {
namespace {

// Required rms error of the centerline at noise 2 and a PSF of 0.7 px, px.
constexpr double aimed_rms = 0.02;

struct Errors {
  std::vector<double> values;

  void add(double value) { values.push_back(value); }
  [[nodiscard]] double rms() const { return root_mean_square(values); }
  [[nodiscard]] double size(double share) const { return quantile(sizes_of(values), share); }
  [[nodiscard]] double share_beyond(double bound) const {
    return static_cast<double>(std::ranges::count_if(values, [&](double value) { return value > bound; })) /
           static_cast<double>(std::max<std::size_t>(values.size(), 1));
  }
};

struct Tally {
  std::size_t pictures = 0, found = 0, samples = 0, unseen = 0, crossing = 0, crossing_found = 0, markers = 0,
              markers_shown = 0, false_markers = 0, spots = 0;
  Errors plain, middle, whole, by_sigma, picture, tip, marker, marker_by_sigma;
};

double side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

// Returns whether the backbone's image crosses itself, tested on chords of a hundredth of its points.
bool crosses_itself(const std::vector<AxisPoint>& curve) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < curve.size(); i += std::max<std::size_t>(1, curve.size() / 100))
    if (curve[i].pixel) points.push_back(*curve[i].pixel);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    for (std::size_t j = i + 2; j + 1 < points.size(); ++j) {
      const Eigen::Vector2d &a = points[i], &b = points[i + 1], &c = points[j], &d = points[j + 1];
      if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
    }
  }
  return false;
}

void measure(const SeenArm& seen, double undone, ArmFinder& finder, Tally& tally) {
  const bool crosses = crosses_itself(seen.truth);
  ++tally.pictures, tally.crossing += crosses ? 1 : 0;
  Photograph photograph;
  photograph.bytes = gray_picture(seen.picture);
  const ArmObservation& found = finder.find(linear_light(std::move(photograph), undone));
  if (!found.is_found()) return;
  ++tally.found, tally.crossing_found += crosses ? 1 : 0;
  ArmObservation arm = found;
  to_backbone_image(seen.view.lens, arm.axis);
  Errors own;
  for (std::size_t i = 0; i < arm.axis.size(); ++i) {
    const AxisSample& sample = arm.axis[i];
    const double miss = distance_to(seen.truth, sample.pixel);
    tally.whole.add(miss), ++tally.samples;
    if (!sample.is_seen) {
      ++tally.unseen;
      continue;
    }
    own.add(miss), tally.plain.add(miss), tally.by_sigma.add(miss / sample.sigma);
    tally.middle.add(distance_to(seen.truth, found.axis[i].pixel));
  }
  if (own.values.empty()) return;
  tally.picture.add(own.rms());
  for (const AxisEnd& end : arm.ends) {
    if (end.kind != AxisEndKind::free) continue;
    const double to_base = (end.pixel - *seen.truth.front().pixel).norm();
    tally.tip.add(std::min(to_base, (end.pixel - *seen.truth.back().pixel).norm()));
  }
  if (seen.scene.arm.markers.empty()) return;
  const MarkerObservations markers = find_markers(seen.picture, arm);
  Renderer renderer;
  renderer.prepare(seen.scene, seen.view);
  const std::vector<MarkerView> views = marker_views(renderer);
  tally.markers_shown += static_cast<std::size_t>(std::ranges::count_if(
      views, [](const MarkerView& view) { return view.area > 12 && view.center.is_visible; }));
  for (const MarkerObservation& marker : markers.markers) {
    if (!marker.is_band) {
      ++tally.spots;
      continue;
    }
    double nearest = 1e9;
    for (const MarkerView& view : views)
      if (view.center.pixel) nearest = std::min(nearest, (*view.center.pixel - marker.pixel).norm());
    nearest < 6 ? tally.marker.add(nearest) : void(++tally.false_markers);
    tally.marker_by_sigma.add(nearest / marker.sigma), ++tally.markers;
  }
}

void print_row(const std::string& name, const Tally& tally, bool has_aim) {
  std::printf(
      "| %s | %zu of %zu | %zu of %zu | %.4f | %.4f | %.4f | %.4f | %.3f | %.3f | %.1f | %.2f | %.2f | %s "
      "|\n",
      name.c_str(), tally.found, tally.pictures, tally.crossing_found, tally.crossing,
      tally.picture.size(0.5), tally.picture.size(0.9), tally.plain.rms(), tally.plain.size(0.99),
      tally.whole.rms(), tally.middle.rms(),
      100.0 * static_cast<double>(tally.unseen) /
          static_cast<double>(std::max<std::size_t>(tally.samples, 1)),
      tally.tip.size(0.5), tally.by_sigma.size(0.68),
      has_aim ? verdict(tally.plain.rms(), aimed_rms).c_str() : "none");
  std::fflush(stdout);
}

// Computes the row for `cases` random arms. Pictures with a gamma are linearised with the gamma `undone`.
Tally study_row(const std::string& name, const SeenArmConfig& options, double undone, bool has_aim, int cases,
                std::uint64_t seed) {
  ArmFinder finder;
  Tally tally;
  for (int i = 0; i < cases; ++i) {
    TestRandom random(seed + static_cast<std::uint64_t>(i));
    measure(random_seen_arm(random, options), undone, finder, tally);
  }
  print_row(name, tally, has_aim);
  return tally;
}

int study(int cases, std::uint64_t seed) {
  std::printf(
      "| pictures | arms found | crossing arms found | median, px | 90 %%, px | RMS, px | 99 %%, px | RMS "
      "with interpolated samples, px | RMS not corrected, px | interpolated, %% | ends, px | 68 %% / sigma | "
      "aim: RMS at most %.2f px |\n",
      aimed_rms);
  std::printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  Tally banded;
  for (const double noise : {0.0, 1.0, 2.0, 4.0}) {
    for (const double psf : {0.5, 0.7, 1.2}) {
      for (const bool bands : {false, true}) {
        if ((psf != 0.7 || bands) && noise != 2) continue;
        SeenArmConfig options;
        options.noise = noise, options.psf = psf, options.bands = bands, options.color = bands;
        char name[64];
        std::snprintf(name, sizeof name, "noise %.0f, PSF %.1f%s", noise, psf, bands ? ", bands" : "");
        const Tally tally = study_row(name, options, 1, noise == 2 && psf == 0.7, cases, seed);
        if (bands && psf == 0.7) banded = tally;
      }
    }
  }
  const SeenArmConfig gamma{.gamma = 2.2};
  study_row("noise 2, PSF 0.7, gamma 2.2, corrected", gamma, 2.2, false, cases, seed);
  study_row("noise 2, PSF 0.7, gamma 2.2, not corrected", gamma, 1, false, cases, seed);
  std::printf(
      "\nWith noise 2 and PSF 0.7, %zu bands are visible. %zu bands were found, %zu of them false, and also "
      "%zu false spots. The distance of a band from the backbone's image at the band's middle has a median "
      "of %.3f px. Of the distances, 90 %% are within %.2f px, and %.2f %% are beyond 4 sigma.\n",
      banded.markers_shown, banded.markers, banded.false_markers, banded.spots, banded.marker.size(0.5),
      banded.marker.size(0.9), 100 * banded.marker_by_sigma.share_beyond(4));
  return 0;
}

}  // namespace
}  // namespace flexura

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: seeing_study CASES SEED\n"), 2;
  return flexura::study(std::stoi(argv[1]), std::stoull(argv[2]));
}

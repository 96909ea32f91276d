#include "flexura/vision/arm_finder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/base/bytes.h"
#include "flexura/vision/backbone_image.h"
#include "flexura/vision/picture_file.h"
#include "tests/support/plain_arms.h"

namespace flexura {
namespace {

using testing::HasSubstr;

// Every fifth picture is taken through a lens with at least usual distortion.
TEST(ArmFinder, FindsTheBackboneToAFiftiethOfAPixelInNoise) {
  ArmFinder finder;
  std::vector<double> errors;
  double squares = 0, samples = 0;
  int count = 0;
  for_random_cases(24, [&](TestRandom& random) {
    SeenArm seen = random_seen_arm(random, {});
    if (++count % 5 == 0) {
      Intrinsics lens = seen.view.lens.intrinsics();
      lens.distortion = {random.uniform(-0.25, 0.15), random.uniform(-0.05, 0.05),
                         random.uniform(-2e-3, 2e-3), random.uniform(-2e-3, 2e-3), 0};
      seen.view.lens = Lens(lens);
      seen.picture = photograph(seen.scene, seen.view, {}, 7);
      seen.truth = true_axis(seen.scene, seen.view, 601);
    }
    const ArmObservation& found = finder.find(seen.picture);
    ASSERT_TRUE(found.is_found()) << found.reason;
    auto axis = found.axis;
    to_backbone_image(seen.view.lens, axis);
    errors.push_back(rms_error(seen, axis));
    EXPECT_LT(errors.back(), count % 5 == 0 ? 0.04 : 0.1);
    const auto of_one = static_cast<double>(std::ranges::count_if(axis, &AxisSample::is_seen));
    squares += of_one * errors.back() * errors.back(), samples += of_one;
  });
  // Over all samples, including the worst ones.
  EXPECT_LT(std::sqrt(squares / samples), 0.02);
  std::ranges::sort(errors);
  EXPECT_LT(errors[errors.size() / 2], 0.015);
  EXPECT_LT(errors[errors.size() * 4 / 5], 0.025);
}

TEST(ArmFinder, OrdersTheAxisFromTheBaseAndEndsItWhereTheBackboneDoes) {
  const SeenArm seen = plain_arm(0.9);
  ArmFinder finder;
  const ArmObservation& found = finder.find(seen.picture);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_LT((found.axis.front().pixel - *seen.truth.front().pixel).norm(), 0.5);
  EXPECT_LT((found.axis.back().pixel - *seen.truth.back().pixel).norm(), 0.5);
  EXPECT_EQ(found.ends[0].kind, AxisEndKind::free);
  const auto first = found.axis;
  ArmFinder other({.threshold = {}, .base = seen.truth.back().pixel});
  const ArmObservation& reversed = other.find(seen.picture);
  ASSERT_EQ(reversed.axis.size(), first.size());
  EXPECT_EQ(reversed.axis.front().pixel, first.back().pixel);
  EXPECT_EQ(reversed.axis.front().normal, -first.back().normal);
}

TEST(ArmFinder, SeesABrightArmBeforeADarkScreenAsWell) {
  SeenArm seen = plain_arm(0.7);
  for (std::uint8_t& value : seen.picture.values()) value = static_cast<std::uint8_t>(255 - value);
  ArmFinder finder;
  const ArmObservation& found = finder.find(seen.picture);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_EQ(found.threshold.figure, Figure::bright);
  EXPECT_LT(rms_error(seen, found.axis), 0.1);
}

TEST(ArmFinder, SaysThatTheBorderCutsTheArm) {
  const SeenArm seen = plain_arm(0.3);
  // The lowest 100 rows are removed, and the base with them.
  Image<std::uint8_t> cut(seen.picture.width(), seen.picture.height() - 100);
  std::ranges::copy(seen.picture.values().first(cut.values().size()), cut.values().begin());
  ArmFinder finder;
  const ArmObservation& found = finder.find(cut);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_EQ(found.ends[0].kind, AxisEndKind::border);
  EXPECT_EQ(found.ends[1].kind, AxisEndKind::free);
  EXPECT_GT(found.axis.front().pixel.y(), cut.height() - 12);
  EXPECT_LT(rms_error(seen, found.axis), 0.1);
}

TEST(ArmFinder, DoesNotCareWhatItSawBefore) {
  TestRandom random(4);
  const SeenArm first = random_seen_arm(random, {}), second = random_seen_arm(random, {});
  ArmFinder fresh, used;
  (void)used.find(second.picture);
  const ArmObservation &a = fresh.find(first.picture), &b = used.find(first.picture);
  ASSERT_EQ(a.axis.size(), b.axis.size());
  for (std::size_t i = 0; i < a.axis.size(); ++i) EXPECT_EQ(a.axis[i].pixel, b.axis[i].pixel);
  EXPECT_EQ(a.blur, b.blur);
}

TEST(ArmFinder, GivesAReasonWhereThereIsNoArm) {
  ArmFinder finder;
  EXPECT_THAT(finder.find(Image<std::uint8_t>(1, 1, 1, 128)).reason, HasSubstr("blank"));
  EXPECT_THAT(finder.find(Image<std::uint8_t>(64, 48, 1, 200)).reason, HasSubstr("blank"));
  EXPECT_THAT(finder.find(Image<std::uint8_t>(64, 48, 1, 255)).reason, HasSubstr("saturated"));
  EXPECT_THAT(finder.find(Image<std::uint8_t>()).reason, HasSubstr("no pixels"));
  Image<std::uint8_t> disc(200, 200, 1, 220);
  for (int v = 0; v < 200; ++v)
    for (int u = 0; u < 200; ++u)
      if (std::hypot(u - 100, v - 100) < 60) disc.at(u, v) = 20;
  EXPECT_THAT(finder.find(disc).reason, HasSubstr("not a tube"));
  EXPECT_THROW((void)finder.find(Image<std::uint8_t>(4, 4, 3)), std::invalid_argument);
}

TEST(BackboneImage, IsNotTheMiddleOfAThickArmThatIsNear) {
  const SeenArm seen = bent_arm_in_view({{0.5, -0.5}, {-0.5, 0.9}}, 0.03, {0.1, 0.3, 1.0}, {0, 0.3, 0}, 800);
  ArmFinder finder;
  auto axis = finder.find(seen.picture).axis;
  const double middle = rms_error(seen, axis);
  to_backbone_image(seen.view.lens, axis);
  EXPECT_GT(middle, 0.06);
  EXPECT_LT(rms_error(seen, axis), 0.25 * middle);
}

// In file format.
std::string pgm(const Image<std::uint8_t>& picture) {
  std::string file =
      "P5\n" + std::to_string(picture.width()) + " " + std::to_string(picture.height()) + "\n255\n";
  file.append(reinterpret_cast<const char*>(picture.values().data()), picture.values().size());
  return file;
}

TEST(ArmFinder, MeasuresAMaskToAnEighthOfAPixel) {
  for (const double bend : {0.0, 0.3, 1.1}) {
    SCOPED_TRACE(bend);
    SeenArm seen = plain_arm(bend);
    for (std::uint8_t& value : seen.picture.values()) value = value > 120 ? 1 : 0;
    const std::string file = pgm(seen.picture);
    const Photograph mask = decode_picture(bytes_of(file), "mask.pgm");
    EXPECT_TRUE(mask.is_mask);
    ArmFinder finder;
    const ArmObservation& found = finder.find(mask.bytes);
    ASSERT_TRUE(found.is_found()) << found.reason;
    EXPECT_EQ(found.ends[0].kind, AxisEndKind::free);
    EXPECT_EQ(found.ends[1].kind, AxisEndKind::free);
    EXPECT_GT(found.covered, 0.95);
    EXPECT_LT(rms_error(seen, found.axis), 0.125);
  }
}

TEST(ArmFinder, TakesAMaskInColourForOneAndKnowsItNoBetter) {
  SeenArm seen = plain_arm(0.5);
  std::string file = "P6\n640 480\n255\n";
  for (const std::uint8_t value : seen.picture.values()) file.append(3, value > 120 ? '\xFF' : '\0');
  const Photograph mask = decode_picture(bytes_of(file), "mask.ppm");
  EXPECT_TRUE(mask.is_mask);
  EXPECT_EQ(mask.bytes.channels(), 1);
  ArmFinder finder;
  const ArmObservation& found = finder.find(mask);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_LT(rms_error(seen, found.axis), 0.125);
  const auto is_of_mask = [](const AxisSample& sample) { return sample.sigma >= mask_sigma; };
  EXPECT_TRUE(std::ranges::all_of(found.axis, is_of_mask));
  // The next picture need not be a mask.
  EXPECT_FALSE(std::ranges::all_of(finder.find(mask.bytes).axis, is_of_mask));
}

TEST(ArmFinder, KnowsHowWellItKnowsTheAxis) {
  ArmFinder finder;
  std::vector<double> misses;
  for_random_cases(12, [&](TestRandom& random) {
    SeenArmConfig options;
    options.noise = random.uniform(1.5, 5);
    const SeenArm seen = random_seen_arm(random, options);
    auto axis = finder.find(seen.picture).axis;
    to_backbone_image(seen.view.lens, axis);
    for (const AxisSample& sample : axis)
      if (sample.is_seen) misses.push_back(std::abs(distance_to(seen.truth, sample.pixel)) / sample.sigma);
  });
  // Builds with sanitizers draw few of the cases.
  ASSERT_GT(misses.size(), 100U);
  const auto place =
      misses.begin() + static_cast<std::ptrdiff_t>(0.6827 * static_cast<double>(misses.size()));
  std::ranges::nth_element(misses, place);
  EXPECT_GT(*place, misses.size() > 1000 ? 0.75 : 0.5);
  EXPECT_LT(*place, misses.size() > 1000 ? 1.4 : 2);
}

TEST(BackboneImage, DepthsAreThoseOfTheBackbone) {
  ArmFinder finder;
  for_random_cases(8, [&](TestRandom& random) {
    SeenArmConfig options;
    options.noise = 0;
    const SeenArm seen = random_seen_arm(random, options);
    auto axis = finder.find(seen.picture).axis;
    to_backbone_image(seen.view.lens, axis);
    const auto depths = backbone_depths(seen.view.lens, axis, seen.radius);
    std::vector<double> errors;
    for (std::size_t i = 0; i < axis.size(); ++i) {
      if (!axis[i].is_seen) continue;
      const auto nearest = std::ranges::min_element(
          seen.truth, {}, [&](const AxisPoint& point) { return (*point.pixel - axis[i].pixel).norm(); });
      errors.push_back(std::abs(depths[i] / nearest->depth - 1));
    }
    std::ranges::sort(errors);
    EXPECT_LT(errors[errors.size() / 2], 0.01);
  });
}

// A bent tube, 12 px wide, with a lens whose image ends some 90 px from the middle.
TEST(BackboneImage, IsNotToldNextToWhereTheLensHasNoRays) {
  std::vector<AxisSample> axis(80);
  for (std::size_t i = 0; i < axis.size(); ++i) {
    const double phi = 0.025 * static_cast<double>(i) - 1;
    axis[i].pixel = Eigen::Vector2d(160, 270) + 150 * Eigen::Vector2d(std::sin(phi), -std::cos(phi));
    axis[i].normal = {std::sin(phi), -std::cos(phi)};
    axis[i].width = 12, axis[i].sigma = 0.1, axis[i].is_seen = true;
  }
  const auto lens_with = [](double distortion, double cx) {
    return Lens({.fx = 400, .fy = 400, .cx = cx, .cy = 120, .distortion = {distortion, 0, 0, 0, 0}});
  };
  const BackboneAxis whole = backbone_axis(lens_with(0, 160), axis);
  EXPECT_TRUE(whole.is_whole());
  EXPECT_EQ(whole.known().size(), axis.size());
  const Lens lens = lens_with(-3, 160);
  const BackboneAxis some = backbone_axis(lens, axis);
  EXPECT_FALSE(some.is_whole());
  const auto depths = backbone_depths(lens, some.samples, 0.015);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    const double way = (some.samples[i].pixel - axis[i].pixel).norm();
    if (!some.is_backbone[i]) {
      EXPECT_EQ(way, 0) << i;
      continue;
    }
    EXPECT_TRUE(std::isfinite(depths[i])) << i;
    for (const std::size_t near : {i - 1, i, i + 1}) EXPECT_TRUE(has_rays(lens, axis.at(near))) << i;
    if (way > 0.01) ++moved;
  }
  EXPECT_GT(some.known().size(), 20U);
  EXPECT_LT(some.known().size(), 70U);
  EXPECT_GT(moved, some.known().size() / 2);
  const BackboneAxis none = backbone_axis(lens_with(-3, 2000), axis);
  EXPECT_TRUE(none.known().empty());
  EXPECT_EQ(none.samples[40].pixel, axis[40].pixel);
}

// The direction of a sample beside one without a ray is half-way between those of its own borders.
TEST(BackboneImage, ComesUpToWhereTheRaysEnd) {
  const Lens lens({.fx = 400, .fy = 400, .cx = 199.5, .cy = 200, .distortion = {-5, 0, 0, 0, 0}});
  std::vector<AxisSample> axis(100);
  for (std::size_t i = 0; i < axis.size(); ++i) {
    axis[i].pixel = {100.0 + static_cast<double>(i), 208}, axis[i].normal = {0, 1};
    axis[i].width = 10, axis[i].sigma = 0.01, axis[i].is_seen = true;
  }
  std::vector<AxisSample> moved = axis;
  EXPECT_FALSE(to_backbone_image(lens, moved));
  std::size_t first = 0;
  while (!has_rays(lens, axis.at(first))) ++first;
  ASSERT_GT(first, 0U);
  const auto direction = [&](double v) {
    return Eigen::Vector3d(lens.unproject({axis[first].pixel.x(), v})->homogeneous().normalized());
  };
  const Eigen::Vector2d expected = *lens.project(direction(203) + direction(213));
  EXPECT_LT((moved[first].pixel - expected).norm(), 1e-6);
  EXPECT_GT(std::abs(expected.y() - 208), 0.01);
}

}  // namespace
}  // namespace flexura

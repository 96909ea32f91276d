#include "flexura/vision/arm_finder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/vision/backbone_image.h"
#include "flexura/vision/picture_file.h"
#include "tests/support/seen_arms.h"

namespace flexura {
namespace {

using testing::HasSubstr;

/// A planar arm in view, 400 px long: everything of it is seen.
SeenArm plain_arm(double bend, const SeenArmOptions& options = {}) {
  SeenArm seen;
  BentArm bent;
  bent.arm.kind = ArmKind::spatial;
  seen.radius = 0.02;
  for (int i = 0; i < 2; ++i)
    bent.arm.sections.push_back({.length = 0.4, .radius = {seen.radius, seen.radius}});
  bent.state = ArmState::straight(2);
  bent.state.bends = {{0, bend}, {0, -bend}};
  seen.scene.background = Color::Constant(0.85);
  seen.scene.arm.tube = tube_of(bent.arm, bent.backbone());
  seen.view =
      pinhole_view(look_at({0, 0.4, 1.6}, {0, 0.4, 0}), options.width, options.height, 1.25 * options.width);
  seen.picture = photograph(seen.scene, seen.view, options, 1);
  seen.truth = true_axis(seen.scene, seen.view, 2001);
  return seen;
}

double rms_error(const SeenArm& seen, const std::vector<AxisSample>& axis) {
  double squares = 0, count = 0;
  for (const AxisSample& sample : axis) {
    if (!sample.is_seen) continue;
    const double distance = distance_to(seen.truth, sample.pixel);
    squares += distance * distance, ++count;
  }
  return std::sqrt(squares / count);
}

TEST(ArmFinder, FindsTheBackboneToAFiftiethOfAPixelInNoise) {
  ArmFinder finder;
  std::vector<double> errors;
  for_random_cases(24, [&](TestRandom& random) {
    const SeenArm seen = random_seen_arm(random, {});
    const ArmSighting& found = finder.find(seen.picture);
    ASSERT_TRUE(found.is_found()) << found.reason;
    auto axis = found.axis;
    to_backbone_image(seen.view.lens, axis);
    errors.push_back(rms_error(seen, axis));
  });
  std::ranges::sort(errors);
  EXPECT_LT(errors[errors.size() / 2], 0.015);
  EXPECT_LT(errors[errors.size() * 4 / 5], 0.025);
}

TEST(ArmFinder, OrdersTheAxisFromTheBaseAndEndsItWhereTheBackboneDoes) {
  const SeenArm seen = plain_arm(0.9);
  ArmFinder finder;
  const ArmSighting& found = finder.find(seen.picture);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_LT((found.axis.front().pixel - *seen.truth.front().pixel).norm(), 0.5);
  EXPECT_LT((found.axis.back().pixel - *seen.truth.back().pixel).norm(), 0.5);
  EXPECT_EQ(found.ends[0].kind, AxisEndKind::free);
  const auto first = found.axis;
  ArmFinder other({.threshold = {}, .base = seen.truth.back().pixel});
  const ArmSighting& reversed = other.find(seen.picture);
  ASSERT_EQ(reversed.axis.size(), first.size());
  EXPECT_EQ(reversed.axis.front().pixel, first.back().pixel);
  EXPECT_EQ(reversed.axis.front().normal, -first.back().normal);
}

TEST(ArmFinder, SeesABrightArmBeforeADarkScreenAsWell) {
  SeenArm seen = plain_arm(0.7);
  for (std::uint8_t& value : seen.picture.values()) value = static_cast<std::uint8_t>(255 - value);
  ArmFinder finder;
  const ArmSighting& found = finder.find(seen.picture);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_EQ(found.threshold.figure, Figure::bright);
  EXPECT_LT(rms_error(seen, found.axis), 0.1);
}

TEST(ArmFinder, FindsTheSameIn16Bits) {
  const SeenArm seen = plain_arm(0.7);
  ArmFinder finder;
  const auto axis = finder.find(seen.picture).axis;
  Image<std::uint16_t> words(seen.picture.width(), seen.picture.height());
  for (std::size_t i = 0; i < words.values().size(); ++i)
    words.values()[i] = static_cast<std::uint16_t>(seen.picture.values()[i] * 257);
  const ArmSighting& found = finder.find(words);
  ASSERT_EQ(found.axis.size(), axis.size());
  for (std::size_t i = 0; i < axis.size(); ++i) EXPECT_LT((found.axis[i].pixel - axis[i].pixel).norm(), 1e-3);
}

TEST(ArmFinder, SaysThatTheBorderCutsTheArm) {
  const SeenArm seen = plain_arm(0.3);
  // The lowest 100 rows fall away, and the base with them.
  Image<std::uint8_t> cut(seen.picture.width(), seen.picture.height() - 100);
  std::ranges::copy(seen.picture.values().first(cut.values().size()), cut.values().begin());
  ArmFinder finder;
  const ArmSighting& found = finder.find(cut);
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
  const ArmSighting &a = fresh.find(first.picture), &b = used.find(first.picture);
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
  EXPECT_THAT(finder.find(disc).reason, HasSubstr("no tube"));
  EXPECT_THROW((void)finder.find(Image<std::uint8_t>(4, 4, 3)), std::invalid_argument);
}

TEST(ArmFinder, GoesOnUnderAHair) {
  SeenArm seen = plain_arm(0.6);
  for (int u = 100; u < 540; ++u)
    for (int k = 0; k < 2; ++k) seen.picture.at(u, 220 + u / 9 + k) = 30;
  ArmFinder finder;
  const ArmSighting& found = finder.find(seen.picture);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_LT((found.axis.back().pixel - *seen.truth.back().pixel).norm(), 0.5);
  EXPECT_LT((found.axis.front().pixel - *seen.truth.front().pixel).norm(), 0.5);
  EXPECT_LT(rms_error(seen, found.axis), 0.1);
}

// As a file holds it.
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
    const Photograph mask =
        decode_picture({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}, "mask.pgm");
    EXPECT_TRUE(mask.is_mask);
    ArmFinder finder;
    const ArmSighting& found = finder.find(mask.bytes);
    ASSERT_TRUE(found.is_found()) << found.reason;
    EXPECT_EQ(found.ends[0].kind, AxisEndKind::free);
    EXPECT_EQ(found.ends[1].kind, AxisEndKind::free);
    EXPECT_GT(found.covered, 0.95);
    EXPECT_LT(rms_error(seen, found.axis), 0.125);
  }
}

TEST(ArmFinder, CallsNoEndFreeThatIsNone) {
  ArmFinder finder;
  int whole = 0, count = 0;
  for_random_cases(60, [&](TestRandom& random) {
    SeenArmOptions options;
    options.most_bend = 1.6;
    const SeenArm seen = random_seen_arm(random, options);
    const ArmSighting& found = finder.find(seen.picture);
    if (!found.is_found() || found.covered < 0.96) return;
    for (const AxisEnd& end : found.ends) {
      if (end.kind != AxisEndKind::free) continue;
      const double to_base = (end.pixel - *seen.truth.front().pixel).norm(),
                   to_tip = (end.pixel - *seen.truth.back().pixel).norm();
      ++count, whole += std::min(to_base, to_tip) < 1;
    }
  });
  // A tip that hides behind the arm itself is not seen.
  EXPECT_LE(count - whole, 1 + 0.03 * count);
}

TEST(BackboneImage, DepthsAreThoseOfTheBackbone) {
  ArmFinder finder;
  for_random_cases(8, [&](TestRandom& random) {
    SeenArmOptions options;
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

}  // namespace
}  // namespace flexura

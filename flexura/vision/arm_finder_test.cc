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

TEST(ArmFinder, GoesOnUnderAHairFromBorderToBorder) {
  // Its runs are short and many: most of the figure's rows show the hair.
  for (const double end : {100.0, 240.0, 470.0}) {
    SeenArm seen = plain_arm(0.6);
    for (int u = 0; u < 640; ++u) {
      const int v = static_cast<int>(100 + (end - 100) * u / 640);
      for (int k = 0; k < 2; ++k) seen.picture.at(u, v + k) = 30;
    }
    ArmFinder finder;
    const ArmSighting& found = finder.find(seen.picture);
    ASSERT_TRUE(found.is_found()) << end << found.reason;
    EXPECT_LT(rms_error(seen, found.axis), 0.1) << end;
  }
}

TEST(ArmFinder, ByBlockSeesAnArmBeforeAnUnevenScreen) {
  ArmFinderConfig config;
  config.threshold.method = ThresholdMethod::by_block;
  ArmFinder by_block(config);
  const SeenArm plain = plain_arm(0.6);
  const auto at = [&](double u, double v) {
    return Eigen::Vector2d(u / plain.view.width, v / plain.view.height);
  };
  const auto side = [&](double u, double v) { return 0.2 + 0.75 * at(u, v).x(); };
  const auto above = [&](double u, double v) { return 0.95 - 0.7 * at(u, v).y(); };
  const auto corners = [&](double u, double v) {
    return 1 - 1.5 * (at(u, v) - Eigen::Vector2d(0.5, 0.5)).squaredNorm();
  };
  const auto expect_found = [&](const auto& light) {
    SeenArm seen = plain;
    for (int v = 0; v < seen.view.height; ++v)
      for (int u = 0; u < seen.view.width; ++u)
        // What is darkest, 30 of 255, is a third of the screen there.
        seen.picture.at(u, v) =
            static_cast<std::uint8_t>(std::lround((60 + 0.65 * seen.picture.at(u, v)) * light(u, v)));
    const ArmSighting& found = by_block.find(seen.picture);
    ASSERT_TRUE(found.is_found()) << found.reason;
    EXPECT_EQ(found.threshold.figure, Figure::dark);
    EXPECT_LT((found.axis.back().pixel - *seen.truth.back().pixel).norm(), 1.5);
    EXPECT_LT((found.axis.front().pixel - *seen.truth.front().pixel).norm(), 1.5);
    EXPECT_LT(rms_error(seen, found.axis), 0.15);
  };
  expect_found(side);
  expect_found(above);
  expect_found(corners);
  // A shaded screen alone shows nothing.
  Image<std::uint8_t> empty(640, 480);
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) empty.at(u, v) = static_cast<std::uint8_t>(std::lround(200 * side(u, v)));
  EXPECT_NE(by_block.find(empty).reason, "");
}

TEST(ArmFinder, MeasuresTheLargerOfTwoArmsAndSaysSo) {
  const SeenArm one = plain_arm(0.3);
  Image<std::uint8_t> both = one.picture;
  // The arm again, half as long, 150 px beside it.
  for (int v = 0; v < both.height() / 2; ++v)
    for (int u = 0; u + 150 < both.width(); ++u)
      both.at(u + 150, v) = std::min(both.at(u + 150, v), one.picture.at(u, v));
  ArmFinder finder;
  const ArmSighting& found = finder.find(both);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_LT(rms_error(one, found.axis), 0.1);
  EXPECT_THAT(found.notes, testing::Contains(HasSubstr("1 other figure of a like size")));
}

// An arm of three sections of 0.3 m from in front.
SeenArm bent_arm_in_view(const std::vector<Eigen::Vector2d>& bends, double radius,
                         const Eigen::Vector3d& from, const Eigen::Vector3d& to, double focal_length) {
  SeenArm seen;
  BentArm bent;
  bent.arm.kind = ArmKind::spatial;
  bent.arm.sections.resize(bends.size(), {.length = 0.3, .radius = {radius, radius}});
  bent.state = ArmState::straight(bends.size());
  bent.state.bends = bends;
  seen.radius = radius;
  seen.scene.background = Color::Constant(0.85);
  seen.scene.arm.tube = tube_of(bent.arm, bent.backbone());
  seen.view = pinhole_view(look_at(from, to), 640, 480, focal_length);
  seen.picture = photograph(seen.scene, seen.view, {.noise = 1}, 3);
  seen.truth = true_axis(seen.scene, seen.view, 2001);
  return seen;
}

TEST(ArmFinder, FollowsAnArmAcrossItself) {
  // A loop in the plane of the picture, the later part of it before the earlier.
  const SeenArm seen =
      bent_arm_in_view({{0.4, 0}, {4.6, 0.5}, {0.4, 0}}, 0.008, {-0.03, 0.35, 1.6}, {-0.03, 0.35, 0}, 800);
  ArmFinder finder;
  const ArmSighting& found = finder.find(seen.picture);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_LT((found.axis.back().pixel - *seen.truth.back().pixel).norm(), 2);
  EXPECT_LT((found.axis.front().pixel - *seen.truth.front().pixel).norm(), 2);
  EXPECT_LT(rms_error(seen, found.axis), 0.3);
}

TEST(ArmFinder, SaysWhereAnArmPointsAtTheCamera) {
  // The last section turns towards the camera on Z.
  const SeenArm seen = bent_arm_in_view({{0, 0}, {0, 0}, {0, 1.5}}, 0.02, {0, 0.45, 1.8}, {0, 0.45, 0}, 800);
  ArmFinder finder;
  const ArmSighting& found = finder.find(seen.picture);
  if (!found.is_found()) {
    EXPECT_NE(found.reason, "");
    return;
  }
  // What is told of the axis is right.
  EXPECT_LT(rms_error(seen, found.axis), 1);
  EXPECT_LT((found.axis.front().pixel - *seen.truth.front().pixel).norm(), 1);
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

TEST(ArmFinder, TakesAMaskInColourForOneAndKnowsItNoBetter) {
  SeenArm seen = plain_arm(0.5);
  std::string file = "P6\n640 480\n255\n";
  for (const std::uint8_t value : seen.picture.values()) file.append(3, value > 120 ? '\xFF' : '\0');
  const Photograph mask =
      decode_picture({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}, "mask.ppm");
  EXPECT_TRUE(mask.is_mask);
  EXPECT_EQ(mask.bytes.channels(), 1);
  ArmFinder finder({.threshold = {}, .base = {}, .least_sigma = mask_sigma});
  const ArmSighting& found = finder.find(gray_picture(mask.bytes));
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_LT(rms_error(seen, found.axis), 0.125);
  for (const AxisSample& sample : found.axis) EXPECT_GE(sample.sigma, mask_sigma);
}

TEST(ArmFinder, KnowsHowWellItKnowsTheAxis) {
  ArmFinder finder;
  std::vector<double> misses;
  for_random_cases(12, [&](TestRandom& random) {
    SeenArmOptions options;
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

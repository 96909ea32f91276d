#include "flexura/app/measure.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "flexura/app/commands.h"
#include "flexura/base/bytes.h"
#include "flexura/base/source.h"
#include "flexura/picture/image_file.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "flexura/vision/picture_file.h"
#include "tests/support/drawn_arms.h"
#include "tests/support/measured_pictures.h"
#include "tests/support/random_cases.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using testing::HasSubstr, testing::Not;

double number_at(const Node& node, const char* table, const char* key) {
  return *node.find(table)->find(key)->as<double>();
}

TEST(Measure, TellsAxisMarkersAndTheCircleOfAnArm) {
  const Measurement found = measured(png(tube()));
  ASSERT_TRUE(found.is_found) << write_json(found.answer);
  EXPECT_EQ(*found.answer.find("axis_kind")->as<std::string>(), "middle");
  EXPECT_NEAR(number_at(found.answer, "circle", "radius"), 150, 0.1);
  EXPECT_EQ(found.answer.find("markers")->as<Node::Array>()->size(), 3U);
  EXPECT_EQ(found.answer.find("axis")->as<Node::Array>()->size(),
            found.answer.find("width")->as<Node::Array>()->size());
  EXPECT_EQ(found.overlay.width(), 320);
  // Lines are drawn over the picture.
  EXPECT_NE(found.overlay, tube());
}

// Returns the picture with each pixel replaced by the mean of those within `reach` in u and v.
Image<std::uint8_t> box_blurred(const Image<std::uint8_t>& picture, int reach) {
  Image<std::uint8_t> result(picture.width(), picture.height());
  for (int v = 0; v < picture.height(); ++v) {
    for (int u = 0; u < picture.width(); ++u) {
      int sum = 0, count = 0;
      for (int b = std::max(0, v - reach); b <= std::min(picture.height() - 1, v + reach); ++b)
        for (int a = std::max(0, u - reach); a <= std::min(picture.width() - 1, u + reach); ++a)
          sum += picture.at(a, b), ++count;
      result.at(u, v) = static_cast<std::uint8_t>(sum / count);
    }
  }
  return result;
}

TEST(Measure, VerifiesNoCircleForAnAxisThatIsNoArc) {
  TestRandom random(1);
  for (const double amplitude : {3.0, 10.0, 40.0}) {
    SCOPED_TRACE(amplitude);
    const auto wave = [&](double u) { return 120 + amplitude * std::sin(u * 2 * std::numbers::pi / 280); };
    const Measurement found = measured(png(gray_arm(wave, 12, random)));
    ASSERT_TRUE(found.is_found) << write_json(found.answer);
    const Node& circle = *found.answer.find("circle");
    if (circle.find("verified") != nullptr) {
      EXPECT_FALSE(*circle.find("verified")->as<bool>());
    }
    EXPECT_TRUE(found.answer.find("ellipse")->empty());
  }
  const auto arc = [](double u) { return 320 - std::sqrt(200.0 * 200 - (u - 160) * (u - 160)); };
  const Measurement found = measured(png(gray_arm(arc, 12, random)));
  EXPECT_NEAR(number_at(found.answer, "circle", "radius"), 200, 0.5);
  EXPECT_TRUE(*found.answer.find("circle")->find("verified")->as<bool>());
  EXPECT_LT(number_at(found.answer, "ellipse", "rms"), 0.1);
  // A straight arm has no circle.
  const auto line = [](double u) { return 100 + 0.1 * u; };
  EXPECT_TRUE(measured(png(gray_arm(line, 12, random))).answer.find("circle")->empty());
}

TEST(Measure, FindsNoCircleInNoise) {
  for_random_cases(30, [](TestRandom& random) {
    Image<std::uint8_t> picture(60, 60);
    for (int v = 0; v < 60; ++v)
      for (int u = 0; u < 60; ++u) picture.at(u, v) = static_cast<std::uint8_t>(random.integer(0, 255));
    EXPECT_FALSE(measured(png(picture), MeasureTarget::circle).is_found);
  });
}

TEST(Measure, LooksForNoMarkersOnArmsOfFewPixels) {
  TestRandom random(2);
  int found_arms = 0;
  for (const double thickness : {3.0, 3.5}) {
    for (const double slope : {0.05, 0.13, 0.21, 0.32}) {
      const auto line = [&](double u) { return 80 + slope * u; };
      const Measurement found = measured(png(gray_arm(line, thickness, random)));
      if (!found.is_found) continue;  // Too thin to be followed.
      ++found_arms;
      EXPECT_TRUE(found.answer.find("markers")->as<Node::Array>()->empty());
      EXPECT_THAT(write_json(found.answer), HasSubstr("markers are not searched"));
    }
  }
  EXPECT_GE(found_arms, 2);
}

TEST(Measure, TellsTheCircleOfADisc) {
  Image<std::uint8_t> disc(200, 160);
  for (int v = 0; v < 160; ++v)
    for (int u = 0; u < 200; ++u)
      disc.at(u, v) =
          static_cast<std::uint8_t>(std::lround(30 + 180 * share(std::hypot(u - 90.3, v - 80.6) - 50.2)));
  const Measurement found = measured(png(disc), MeasureTarget::circle);
  ASSERT_TRUE(found.is_found) << write_json(found.answer);
  EXPECT_NEAR(number_at(found.answer, "circle", "radius"), 50.2, 0.05);
  EXPECT_LT(number_at(found.answer, "circle", "rms"), 0.1);
  EXPECT_LT(number_at(found.answer, "circle", "detectable_tilt_deg"), 10);
  EXPECT_TRUE(*found.answer.find("circle")->find("verified")->as<bool>());
}

// A polygon's border deviates from the circle through it by as much as noise could, but systematically.
TEST(Measure, VerifiesNoPolygonForACircle) {
  for (const int corners : {12, 16, 20}) {
    SCOPED_TRACE(corners);
    Image<std::uint8_t> polygon(260, 260);
    const double step = 2 * std::numbers::pi / corners;
    for (int v = 0; v < 260; ++v) {
      for (int u = 0; u < 260; ++u) {
        const double x = u - 130.2, y = v - 129.7, aside = std::remainder(std::atan2(y, x), step);
        const double outside = std::hypot(x, y) * std::cos(aside) - 100 * std::cos(0.5 * step);
        polygon.at(u, v) = static_cast<std::uint8_t>(std::lround(30 + 180 * share(outside)));
      }
    }
    const Measurement found = measured(png(polygon), MeasureTarget::circle);
    ASSERT_TRUE(found.is_found) << write_json(found.answer);
    EXPECT_FALSE(*found.answer.find("circle")->find("verified")->as<bool>());
    EXPECT_GT(number_at(found.answer, "circle", "misfit_correlation"), 0.9);
  }
}

// With the camera and the radius, the axis is the image of the backbone, and depths are known.
TEST(Measure, ACameraAndARadiusTellTheBackbonesImage) {
  const TemporaryFolder folder;
  const std::string picture = (folder.path() / "tube.png").string(),
                    camera = (folder.path() / "camera.toml").string();
  write_new_file(picture, png(tube()));
  write_new_file(camera, "[[camera]]\nname = \"front\"\nfx = 400\nfy = 400\ncx = 160\ncy = 120\n");
  MeasureArguments arguments;
  arguments.images = {picture};
  const auto answer = [&] {
    std::ostringstream out;
    EXPECT_EQ(measure_command(arguments, out), exit_done);
    return parse_json(out.str(), "answer");
  };
  const Node middle = answer();
  arguments.camera = camera, arguments.radius = 0.015;
  const Node backbone = answer();
  EXPECT_EQ(*middle.find("axis_kind")->as<std::string>(), "middle");
  EXPECT_EQ(*backbone.find("axis_kind")->as<std::string>(), "backbone");
  // 12 px wide at f = 400 px: 1 m away.
  const auto& depths = *backbone.find("depth")->as<Node::Array>();
  EXPECT_NEAR(*depths[depths.size() / 2].as<double>(), 1, 0.02);
  EXPECT_EQ(depths.size(), backbone.find("axis")->as<Node::Array>()->size());
}

// Where the lens has no rays, the backbone's image is unknown; the rest of the axis is still the backbone's.
TEST(Measure, IsTheTubesMiddleOnlyWhereTheLensHasNoRays) {
  const std::string file = png(tube());
  const auto answer_with = [&](double cx, double distortion) {
    MeasureConfig config;
    config.camera = MeasuredCamera{};
    config.camera->fx = 400, config.camera->cx = cx, config.camera->cy = 120;
    config.camera->distortion[0] = distortion;
    config.radius = 0.015;
    return measure_picture(bytes_of(file), "tube.png", config).answer;
  };
  const auto column = [](const Node& answer, const char* key) {
    return *answer.find(key)->as<Node::Array>();
  };
  const auto is_null = [](const Node& node) { return write_json(node) == "null"; };
  const Node middle = measured(file).answer, plain = answer_with(160, 0), odd = answer_with(160, -3);
  EXPECT_EQ(*odd.find("axis_kind")->as<std::string>(), "backbone");
  EXPECT_THAT(write_json(*odd.find("notes")), HasSubstr("there the axis is its middle"));
  const auto axis = column(odd, "axis"), middles = column(middle, "axis"), depths = column(odd, "depth"),
             sigmas = column(odd, "sigma"), seen = column(odd, "seen");
  std::size_t with = 0, without = 0, moved = 0;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    if (!*seen[i].as<bool>()) continue;
    EXPECT_EQ(is_null(depths[i]), is_null(sigmas[i])) << i;
    const bool is_middle = write_json(axis[i]) == write_json(middles[i]);
    if (is_null(sigmas[i])) {
      EXPECT_TRUE(is_middle) << i;
      ++without;
    } else {
      ++with;
      if (!is_middle) ++moved;
    }
  }
  EXPECT_GT(with, axis.size() / 10);
  EXPECT_GT(without, axis.size() / 10);
  EXPECT_GT(moved, with / 2);
  // The circle is fitted to the backbone's image alone, so it differs from that of the whole tube's middle.
  EXPECT_LT(number_at(odd, "circle", "arc_deg"), 0.9 * number_at(middle, "circle", "arc_deg"));
  EXPECT_THAT(write_json(*plain.find("notes")), Not(HasSubstr("middle")));
  EXPECT_FALSE(std::ranges::any_of(column(plain, "depth"), is_null));
  // Without any rays the result is as without a camera.
  const Node none = answer_with(2000, -3);
  EXPECT_EQ(*none.find("axis_kind")->as<std::string>(), "middle");
  EXPECT_EQ(none.find("depth"), nullptr);
  for (const char* key : {"axis", "sigma", "circle", "ellipse"})
    EXPECT_EQ(write_json(*none.find(key)), write_json(*middle.find(key))) << key;
}

TEST(Measure, RefusesAPictureOfAnotherSizeThanItsCameraIsSaidToBeOf) {
  MeasureConfig config;
  config.camera = MeasuredCamera{};
  const std::string file = png(tube());
  const std::array<std::int64_t, 2> size = {tube().width(), tube().height()};
  config.camera->size = size;
  EXPECT_TRUE(measure_picture(bytes_of(file), "tube.png", config).is_found);
  config.camera->size = {2 * size[0], 2 * size[1]};
  EXPECT_THROW((void)measure_picture(bytes_of(file), "tube.png", config), InputError);
}

// Notes on possible errors matter most if nothing is found.
TEST(Measure, HasNotesWhereNothingIsFound) {
  MeasureConfig config;
  config.camera = MeasuredCamera{};
  config.camera->cx = 2000;
  const Measurement none =
      measure_picture(bytes_of(png(Image<std::uint8_t>(60, 40, 1, 255))), "x.png", config);
  EXPECT_FALSE(none.is_found);
  EXPECT_THAT(write_json(*none.answer.find("notes")), HasSubstr("of another size"));
}

// A 16-bit picture that has two values in 8 bits is not a mask.
TEST(Measure, TakesAFaintPictureOf16BitsForWhatItIs) {
  Image<std::uint16_t> faint(160, 120, 1, 65000);
  for (int v = 40; v < 80; ++v)
    for (int u = 30; u < 130; ++u) faint.at(u, v) = static_cast<std::uint16_t>(64600 + (v - 40));
  EXPECT_FALSE(decode_picture(bytes_of(png(faint)), "faint.png").is_mask);
  for (std::uint16_t& value : faint.values()) value = value == 65000 ? 65000 : 64600;
  EXPECT_TRUE(decode_picture(bytes_of(png(faint)), "mask.png").is_mask);
}

TEST(Measure, SeesAnArmInAFrameAndSaysWhereThePictureIsSaturated) {
  Image<std::uint8_t> picture = tube();
  for (const bool is_dark : {true, false}) {
    Image<std::uint8_t> framed = picture;
    for (int v = 0; v < framed.height(); ++v)
      for (int u = 0; u < framed.width(); ++u)
        if (u == 0 || v == 0 || u == framed.width() - 1 || v == framed.height() - 1)
          for (int c = 0; c < framed.channels(); ++c) framed.at(u, v, c) = is_dark ? 20 : 250;
    const Measurement found = measured(png(framed));
    EXPECT_TRUE(found.is_found) << write_json(found.answer);
    EXPECT_EQ(*found.answer.find("figure")->as<std::string>(), "dark");
  }
  const auto is_reported = [](const Measurement& found) {
    return write_json(*found.answer.find("notes")).find("saturated") != std::string::npos;
  };
  EXPECT_FALSE(is_reported(measured(png(picture))));
  for (int v = 0; v < picture.height() / 3; ++v)
    for (int u = 0; u < picture.width(); ++u)
      for (int c = 0; c < picture.channels(); ++c)
        if (picture.at(u, v, c) > 150) picture.at(u, v, c) = 255;
  EXPECT_TRUE(is_reported(measured(png(picture))));
}

TEST(Measure, TellsSidesAndLinesOfTheEtalon) {
  Image<std::uint8_t> picture(200, 240, 3);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 200; ++u) {
      const double dark = v > 30 && v < 210 ? share(std::abs(u - 100.3) - 40) : 0,
                   red = share(std::abs(u - 110.4) - 2);
      for (int c = 0; c < 3; ++c) {
        const double figure = 30 + (c == 0 ? 150 * red : 0);
        picture.at(u, v, c) = static_cast<std::uint8_t>(std::lround(220 + dark * (figure - 220)));
      }
    }
  }
  const Measurement found = measured(png(picture), MeasureTarget::etalon);
  ASSERT_TRUE(found.is_found) << write_json(found.answer);
  EXPECT_NEAR(number_at(found.answer, "left", "u"), 60.3, 0.1);
  EXPECT_NEAR(number_at(found.answer, "right", "u"), 140.3, 0.1);
  const auto& lines = *found.answer.find("lines")->as<Node::Array>();
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(*lines[0].find("offset")->as<double>(), 10.1, 0.1);
}

TEST(Measure, SaysWhyThereIsNothing) {
  const Measurement found = measured(png(Image<std::uint8_t>(30, 20, 1, 90)));
  EXPECT_FALSE(found.is_found);
  EXPECT_THAT(*found.answer.find("reason")->as<std::string>(), HasSubstr("blank"));
}

// If exposure or focus is why nothing is found, the answer reports it.
TEST(Measure, SaysThatAPictureIsTooDarkOrBlurred) {
  TestRandom random(5);
  const auto wave = [](double u) { return 120 + 20 * std::sin(u * std::numbers::pi / 320); };
  const Image<std::uint8_t> clear = gray_arm(wave, 16, random);
  ASSERT_TRUE(measured(png(clear)).is_found);
  const auto reason_of = [&](const Image<std::uint8_t>& picture) {
    const Measurement found = measured(png(picture));
    EXPECT_FALSE(found.is_found);
    const Node* reason = found.answer.find("reason");
    return reason == nullptr ? std::string() : *reason->as<std::string>();
  };
  Image<std::uint8_t> dark = clear, bright = clear, faint = clear;
  for (std::uint8_t& value : dark.values()) value = static_cast<std::uint8_t>(value / 24);
  for (std::uint8_t& value : bright.values()) value = static_cast<std::uint8_t>(246 + value / 27);
  for (std::uint8_t& value : faint.values()) value = static_cast<std::uint8_t>(100 + value / 27);
  EXPECT_THAT(reason_of(dark), HasSubstr("too dark"));
  EXPECT_THAT(reason_of(bright), HasSubstr("too bright"));
  EXPECT_THAT(reason_of(faint), HasSubstr("too faint"));
  Image<std::uint8_t> empty(320, 240);
  for (std::uint8_t& value : empty.values()) value = static_cast<std::uint8_t>(120 + random.integer(-4, 4));
  EXPECT_THAT(reason_of(empty), HasSubstr("blank"));
  // Means over 15 x 15 px, twice: a standard deviation of 6.1 px.
  Image<std::uint8_t> blurred = clear;
  for (int round = 0; round < 2; ++round) blurred = box_blurred(blurred, 7);
  EXPECT_THAT(reason_of(blurred), HasSubstr("their blur is about"));
  // A sharp figure that is not a tube gets neither reason.
  Image<std::uint8_t> star(320, 240, 1, 220);
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u)
      if (std::hypot(u - 160, v - 120) < 60 + 35 * std::sin(9 * std::atan2(v - 120, u - 160)))
        star.at(u, v) = 30;
  EXPECT_THAT(reason_of(star), testing::Not(testing::AnyOf(HasSubstr("blurred"), HasSubstr("faint"))));
}

// Two parallel sides lie on a long ellipse, which must be rejected.
TEST(Measure, TakesNoStraightSidesForAnEllipse) {
  for_random_cases(15, [](TestRandom& random) {
    const double width = random.uniform(30, 120), height = random.uniform(30, 120);
    // Its corners or its ends may be round; a capsule keeps two straight sides.
    const double corner = (random.integer(0, 2) == 0 ? 0.5 : 0.15) * std::min(width, height);
    const double turn = random.uniform(0, 3);
    const bool is_capsule = corner > 0.4 * std::min(width, height);
    // A short capsule is close to an ellipse.
    if (is_capsule && std::max(width, height) < 2.5 * std::min(width, height)) return;
    Image<std::uint8_t> picture(240, 200, 1, 210);
    for (int v = 0; v < 200; ++v) {
      for (int u = 0; u < 240; ++u) {
        const Eigen::Vector2d at = Eigen::Rotation2Dd(turn) * Eigen::Vector2d(u - 119.5, v - 99.5);
        const Eigen::Vector2d beyond(std::max(0.0, std::abs(at.x()) - width / 2 + corner),
                                     std::max(0.0, std::abs(at.y()) - height / 2 + corner));
        const double inside = std::clamp(corner - beyond.norm() + 0.5, 0.0, 1.0);
        picture.at(u, v) = static_cast<std::uint8_t>(210 - 180 * inside);
      }
    }
    const Measurement circle = measured(png(picture), MeasureTarget::circle);
    EXPECT_FALSE(circle.is_found) << width << " x " << height << ", corner " << corner << ", turn " << turn;
  });
}

TEST(Measure, TakesNoBoxForACircleAndNoBrightFigureForTheEtalon) {
  Image<std::uint8_t> picture(200, 150, 1, 40);
  for (int v = 30; v < 120; ++v)
    for (int u = 20; u < 180; ++u) picture.at(u, v) = 220;
  const Measurement circle = measured(png(picture), MeasureTarget::circle);
  EXPECT_FALSE(circle.is_found);
  const Measurement etalon = measured(png(picture), MeasureTarget::etalon);
  EXPECT_FALSE(etalon.is_found);
  EXPECT_THAT(*etalon.answer.find("reason")->as<std::string>(), HasSubstr("bright"));
}

}  // namespace
}  // namespace flexura

#include "flexura/camera/intrinsics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "flexura/camera/view.h"
#include "flexura/math/derivative_check.h"
#include "flexura/math/so3.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// From no distortion to strong barrel and pincushion, of all lens models. At the corner of a wide lens (a
// radius of 1) the image moves by up to 60 % of the radius.
Intrinsics random_intrinsics(TestRandom& random) {
  Intrinsics intrinsics;
  intrinsics.fx = random.uniform(200, 5000), intrinsics.fy = intrinsics.fx * random.uniform(0.9, 1.1);
  intrinsics.cx = random.uniform(-50, 1000), intrinsics.cy = random.uniform(-50, 1000);
  constexpr std::array<double, 3> scales = {0, 0.1, 1};
  const double scale = scales[static_cast<std::size_t>(random.integer(0, 2))];
  intrinsics.distortion = {scale * random.uniform(-0.4, 0.4), scale * random.uniform(-0.2, 0.2),
                           scale * random.uniform(-0.01, 0.01), scale * random.uniform(-0.01, 0.01),
                           scale * random.uniform(-0.1, 0.1)};
  const auto model = static_cast<LensModel>(random.integer(0, 2));
  if (model == LensModel::brown) return intrinsics;
  Distortion other(model);
  std::copy_n(intrinsics.distortion.begin(), std::min<std::size_t>(5, other.size()), other.begin());
  if (model == LensModel::fisheye)
    for (double& k : other) k *= 0.2;
  for (std::size_t i = 5; i < other.size(); ++i) other[i] = scale * random.uniform(-0.1, 0.2);
  intrinsics.distortion = other;
  return intrinsics;
}

Eigen::Vector3d at(double radius, double angle) {
  return {radius * std::cos(angle), radius * std::sin(angle), 1};
}

TEST(Lens, UnprojectsWhatItProjects) {
  for_random_cases(2000, [](TestRandom& random) {
    const Lens lens(random_intrinsics(random));
    const double rim = std::min(0.9 * lens.largest_radius(), 1.5);
    const Eigen::Vector3d direction = at(random.uniform(0, rim), random.uniform(-3.2, 3.2));
    const auto pixel = lens.project(direction * random.uniform(0.01, 100));
    ASSERT_TRUE(pixel);
    const auto back = lens.unproject(*pixel);
    ASSERT_TRUE(back);
    EXPECT_LE((*back - direction.head<2>()).norm(), 1e-12);
  });
}

TEST(Lens, ProjectsBackToThePixelUpToItsRim) {
  for_random_cases(2000, [](TestRandom& random) {
    Intrinsics intrinsics = random_intrinsics(random);
    intrinsics.distortion = {random.uniform(-0.5, -0.1), 0, 0, 0, 0};  // So that there is a rim.
    if (random.integer(0, 2) == 0) intrinsics.distortion = {random.uniform(-0.5, -0.2), 0, 0, 0};
    if (random.integer(0, 2) == 0) intrinsics.distortion = {-0.3, 0, 0, 0, 0, random.uniform(0, 0.4), 0, 0};
    const Lens lens(intrinsics);
    // Near the rim the radius changes with the square root of the pixel's change.
    const double inward = std::pow(10.0, random.uniform(-14, -1));
    const Eigen::Vector3d direction = at(lens.largest_radius() * (1 - inward), random.uniform(-3.2, 3.2));
    const auto pixel = lens.project(direction);
    ASSERT_TRUE(pixel);
    const auto back = lens.unproject(*pixel);
    ASSERT_TRUE(back);
    EXPECT_LE((*lens.project({back->x(), back->y(), 1}) - *pixel).norm(), 1e-8);
    EXPECT_LE((*back - direction.head<2>()).norm(), 1e-5);
  });
}

TEST(Lens, ShowsNothingBeyondItsRim) {
  Intrinsics intrinsics;
  intrinsics.distortion = {-0.3, 0, 0, 0, 0};
  const Lens lens(intrinsics);
  const double rim = 1 / std::sqrt(0.9);  // 1 + 3 k1 r^2 = 0
  EXPECT_NEAR(lens.largest_radius(), rim, 1e-15);
  EXPECT_TRUE(lens.project(at(0.999 * rim, 1)));
  EXPECT_FALSE(lens.project(at(1.001 * rim, 1)));
  EXPECT_FALSE(lens.project_with_derivatives(at(1.001 * rim, 1)));
  PointProjection alone;
  EXPECT_TRUE(lens.project_by_point(at(0.999 * rim, 1), alone));
  EXPECT_FALSE(lens.project_by_point(at(1.001 * rim, 1), alone));
  const double largest = rim * (1 - 0.3 * rim * rim) * intrinsics.fx;
  EXPECT_TRUE(lens.unproject({intrinsics.cx + 0.999 * largest, intrinsics.cy}));
  EXPECT_FALSE(lens.unproject({intrinsics.cx + 1.001 * largest, intrinsics.cy}));
  EXPECT_FALSE(lens.unproject({intrinsics.cx, intrinsics.cy - 1e9}));
}

// OpenCV's order: k1, k2, p1, p2, k3. The motion of the point (0.5, 0.25) by a tenth of each alone.
TEST(Lens, HasItsCoefficientsInTheirOrder) {
  constexpr std::array<std::array<double, 2>, 5> moved = {{{0.015625, 0.0078125},
                                                           {0.0048828125, 0.00244140625},
                                                           {0.025, 0.04375},
                                                           {0.08125, 0.025},
                                                           {0.00152587890625, 0.000762939453125}}};
  for (std::size_t i = 0; i < moved.size(); ++i) {
    Intrinsics intrinsics{.fx = 1, .fy = 1, .cx = 0, .cy = 0};
    intrinsics.distortion[i] = 0.1;
    const auto pixel = Lens(intrinsics).project({0.5, 0.25, 1});
    ASSERT_TRUE(pixel) << i;
    EXPECT_NEAR(pixel->x() - 0.5, moved[i][0], 1e-15) << i;
    EXPECT_NEAR(pixel->y() - 0.25, moved[i][1], 1e-15) << i;
  }
}

TEST(Lens, TheRimOfTheModelBrownIsWhereTheRadialPartFirstStopsGrowing) {
  for_random_cases(2000, [](TestRandom& random) {
    Intrinsics intrinsics;
    intrinsics.distortion = {random.uniform(-1, 1), random.uniform(-1, 1), 0, 0, random.uniform(-1, 1)};
    if (random.integer(0, 3) == 0) intrinsics.distortion[4] = 0;
    const double rim = Lens(intrinsics).largest_radius();
    const auto slope = [&k = intrinsics.distortion](double r) {
      return 1 + 3 * k[0] * std::pow(r, 2) + 5 * k[1] * std::pow(r, 4) + 7 * k[4] * std::pow(r, 6);
    };
    for (double r = 0; r < std::min(rim, 20.0); r += 0.01) EXPECT_GE(slope(r), 0) << r;
    if (rim == infinity) return;
    EXPECT_NEAR(slope(rim), 0, 1e-9 * (1 + std::pow(rim, 6)));
  });
}

TEST(Lens, ItsRimIsWhereTheImageFirstStopsGrowing) {
  int rims = 0;
  for_random_cases(2000, [&](TestRandom& random) {
    Distortion distortion(random.integer(0, 1) == 0 ? LensModel::rational : LensModel::fisheye);
    for (double& k : distortion) k = random.uniform(-1, 1);
    if (distortion.model() == LensModel::rational) distortion[2] = distortion[3] = 0;
    const Lens lens({.fx = 1, .fy = 1, .cx = 0, .cy = 0, .distortion = distortion});
    const double rim = lens.largest_radius();
    double before = 0;
    for (double r = 0.001; r < std::min(rim, 20.0); r *= 1.01) {
      const auto pixel = lens.project(at(r, 0));
      ASSERT_TRUE(pixel) << r;
      EXPECT_GT(pixel->x(), before) << r;
      before = pixel->x();
    }
    // Just beyond the rim the image of the model shrinks, or has its pole.
    if (rim > 20) return;
    ++rims;
    const double inside = lens.project(at(rim * (1 - 1e-4), 0))->x();
    const auto [k1, k2, k3] = std::array{distortion[0], distortion[1], distortion[4]};
    const double q = std::pow(rim * (1 + 2e-4), 2), angle = std::atan(std::sqrt(q)), t = angle * angle;
    const double radial = distortion.model() == LensModel::fisheye
                              ? angle * (1 + t * (k1 + t * (k2 + t * (distortion[2] + t * distortion[3]))))
                              : std::sqrt(q) * (1 + q * (k1 + q * (k2 + q * k3))) /
                                    (1 + q * (distortion[5] + q * (distortion[6] + q * distortion[7])));
    EXPECT_TRUE(radial < inside || radial > 100 * (1 + rim)) << radial << " " << inside;
  });
  EXPECT_GT(rims, 100);
}

// The image of a lens with a pole reaches infinity at its rim.
TEST(Lens, HasRaysForAllPixelsUpToAPole) {
  for (double k4 = -0.01; k4 > -0.995; k4 -= 0.01) {
    const Lens lens({.fx = 200, .fy = 200, .cx = 0, .cy = 0, .distortion = {0, 0, 0, 0, 0, k4, 0, 0}});
    EXPECT_NEAR(lens.largest_radius(), 1 / std::sqrt(-k4), 1e-9 / -k4);
    for (double u = 5; u < 1e4; u *= 1.3) {
      const auto ray = lens.unproject({u, 0});
      ASSERT_TRUE(ray) << k4 << " " << u;
      EXPECT_NEAR(lens.project(ray->homogeneous())->x(), u, 1e-9 * u);
    }
  }
}

// An equidistant lens shows each angle at f times the angle, up to a right angle.
TEST(Lens, AFisheyeLensShowsAngles) {
  const Lens lens({.fx = 200, .fy = 200, .cx = 300, .cy = 300, .distortion = Distortion(LensModel::fisheye)});
  EXPECT_EQ(lens.largest_radius(), infinity);
  EXPECT_TRUE(lens.intrinsics().is_distorted());
  for (const double angle : {0.0, 1e-9, 1e-4, 0.13, 0.15, 0.5, 1.0, 1.5, 1.57}) {
    const auto pixel = lens.project({0, 2 * std::sin(angle), 2 * std::cos(angle)});
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->y(), 300 + 200 * angle, 1e-12 * 300) << angle;
    const auto back = lens.unproject(*pixel);
    ASSERT_TRUE(back) << angle;
    EXPECT_NEAR(std::atan(back->y()), angle, 1e-13);
  }
  EXPECT_FALSE(lens.unproject({300 + 200 * 1.58, 300}));
  EXPECT_FALSE(lens.project({1, 0, -0.001}));
}

TEST(Lens, ADistortionIsThatOfItsModel) {
  EXPECT_EQ(Distortion().model(), LensModel::brown);
  EXPECT_EQ((Distortion{1, 2, 3, 4}).model(), LensModel::fisheye);
  EXPECT_EQ((Distortion{1, 2, 3, 4, 5, 6, 7, 8}).model(), LensModel::rational);
  EXPECT_THROW((Distortion{1, 2, 3}), std::invalid_argument);
  EXPECT_EQ(distortion_fault(LensModel::fisheye, {1, 0, 0, 0, 0}),
            "5 coefficients for the lens model fisheye: expected 4 (k1, k2, k3, k4)");
  EXPECT_EQ(distortion_of(LensModel::fisheye, {0, 0, 0, 0, 0}), Distortion(LensModel::fisheye));
  EXPECT_THROW((void)distortion_of(LensModel::brown, {0, 1, 0, 0}), std::invalid_argument);
  EXPECT_FALSE(Intrinsics{}.is_distorted());
}

TEST(Lens, ProjectsOnlyWhatIsInFront) {
  const Lens lens{Intrinsics{}};
  EXPECT_EQ(lens.largest_radius(), infinity);
  EXPECT_EQ(*lens.project({0, 0, 2}), Eigen::Vector2d(319.5, 239.5));
  EXPECT_EQ(*lens.project({1, -0.5, 2}), Eigen::Vector2d(719.5, 39.5));
  for (const double z : {0.0, -1.0, -infinity, std::nan("")}) EXPECT_FALSE(lens.project({0.1, 0.1, z}));
  EXPECT_FALSE(lens.project({1, 1, 1e-320}));
  PointProjection alone;
  for (const Eigen::Vector3d& none : {Eigen::Vector3d(0.1, 0.1, 0),
                                      {0.1, 0.1, -1},
                                      {1, 1, 1e-320},
                                      {std::nan(""), 1, 1},
                                      {1, 1, std::nan("")}})
    EXPECT_FALSE(lens.project_by_point(none, alone));
  EXPECT_FALSE(lens.project({std::nan(""), 1, 1}));
  EXPECT_FALSE(lens.unproject({infinity, 0}));
}

TEST(Lens, RefusesNumbersThatDescribeNone) {
  const auto refuses = [](auto&& spoil) {
    Intrinsics intrinsics;
    spoil(intrinsics);
    EXPECT_THROW(Lens{intrinsics}, std::invalid_argument);
  };
  refuses([](Intrinsics& i) { i.fx = 0; });
  refuses([](Intrinsics& i) { i.fy = -800; });
  refuses([](Intrinsics& i) { i.fx = std::nan(""); });
  refuses([](Intrinsics& i) { i.cx = infinity; });
  refuses([](Intrinsics& i) { i.distortion[4] = std::nan(""); });
}

TEST(Lens, ItsDerivativesAreThoseOfItsPixels) {
  for_random_cases(200, [](TestRandom& random) {
    const Intrinsics intrinsics = random_intrinsics(random);
    const double rim = std::min(0.8 * Lens(intrinsics).largest_radius(), 1.0);
    const Eigen::Vector3d p_CP = at(random.uniform(0, rim), random.uniform(-3.2, 3.2)) * random.uniform(1, 4);
    const auto size = static_cast<Eigen::Index>(intrinsics.distortion.size());
    Eigen::VectorXd x(7 + size);
    x << p_CP, intrinsics.fx, intrinsics.fy, intrinsics.cx, intrinsics.cy,
        Eigen::Map<const Eigen::VectorXd>(intrinsics.distortion.data(), size);
    const VectorFunction pixel = [&](const Eigen::VectorXd& y) -> Eigen::VectorXd {
      Intrinsics changed{y[3], y[4], y[5], y[6], intrinsics.distortion};
      std::copy_n(y.data() + 7, size, changed.distortion.begin());
      return *Lens(changed).project(y.head<3>());
    };
    const Projection projection = *Lens(intrinsics).project_with_derivatives(p_CP);
    Eigen::MatrixXd analytic(2, 7 + size);
    analytic << projection.by_point, projection.by_intrinsics.leftCols(4 + size);
    EXPECT_TRUE(projection.by_intrinsics.rightCols(intrinsics_count - 4 - size).isZero(0));
    const NumericalJacobian numeric = numerical_jacobian(pixel, x, 0.01);
    EXPECT_EQ(projection.pixel, pixel(x));
    EXPECT_LE((analytic - numeric.value).cwiseAbs().maxCoeff(), 1e-7 * (1 + intrinsics.fx));
    // With the derivative by the point alone, results agree up to rounding.
    PointProjection alone;
    ASSERT_TRUE(Lens(intrinsics).project_by_point(p_CP, alone));
    EXPECT_LE((alone.pixel - projection.pixel).norm(), 1e-12 * intrinsics.fx);
    EXPECT_LE((alone.by_point - projection.by_point).norm(), 1e-13 * projection.by_point.norm());
  });
}

// A circle of radius R in a plane whose top edge leans towards the camera. The camera is at a distance in
// front of the plane's middle.
constexpr double focal_length = 800, circle_radius = 0.5, distance = 2.5;
constexpr double half_side = circle_radius / std::numbers::sqrt2;  // Of the inscribed square.
constexpr double twenty_degrees = std::numbers::pi / 9;

// In the image's axes from the principal point: the point (x, y) of the plane (right, up), leaning by `tilt`.
// The camera itself looks up by `camera_tilt`.
Eigen::Vector2d pixel(double x, double y, double tilt, double camera_tilt) {
  View view;
  view.lens = Lens({focal_length, focal_length, 0, 0, {}});
  view.X_WC.rotation << 1, 0, 0, 0, -1, 0, 0, 0, -1;  // Looks along -Z, W's Y up.
  view.X_WC.rotation *= so3_exp({camera_tilt, 0, 0});
  view.X_WC.position = {0, 0, distance};
  return *view.project(so3_exp({tilt, 0, 0}) * Eigen::Vector3d(x, y, 0));
}

TEST(TiltedCircle, HasTheFormOfFigures10To13) {
  const auto corner = [](double right, double up) {
    return pixel(right * half_side, up * half_side, twenty_degrees, 0);
  };
  EXPECT_NEAR((corner(1, 1) - corner(-1, 1)).norm(), 237.7751, 5e-5);
  EXPECT_NEAR((corner(1, -1) - corner(-1, -1)).norm(), 215.8345, 5e-5);
  EXPECT_NEAR(corner(1, -1).y() - corner(1, 1).y(), 213.1268, 5e-5);
  EXPECT_NEAR(corner(1, 1).norm(), 163.1414, 5e-5);
  EXPECT_NEAR(-pixel(0, circle_radius, twenty_degrees, 0).y(), 161.3906, 5e-5);
}

TEST(TiltedCircle, LooksOtherwiseWhenTheCameraTiltsInstead) {
  const auto corner = [](double right, double up) {
    return pixel(right * half_side, up * half_side, 0, twenty_degrees);
  };
  EXPECT_NEAR((corner(1, 1) - corner(-1, 1)).norm(), 229.0082, 5e-5);
  EXPECT_NEAR((corner(1, -1) - corner(-1, -1)).norm(), 253.8631, 5e-5);
  EXPECT_NEAR(corner(1, -1).y() - corner(1, 1).y(), 256.9304, 5e-5);
}

}  // namespace
}  // namespace flexura

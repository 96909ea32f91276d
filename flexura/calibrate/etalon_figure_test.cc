#include "flexura/calibrate/etalon_figure.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "flexura/calibrate/rig_calibration.h"
#include "flexura/calibrate/rig_quantities.h"
#include "flexura/math/arrays.h"
#include "flexura/math/derivative_check.h"
#include "tests/support/random_cases.h"
#include "tests/support/rig_figures.h"
#include "tests/support/rig_trials.h"

namespace flexura {
namespace {

// A cylinder between the two cameras of nominal_rig, turned about its axis.
EtalonConfig random_etalon(TestRandom& random) {
  const double half = random.uniform(-0.2, 0.2);
  EtalonConfig etalon;
  etalon.position = {0, 0.3, 0}, etalon.rotation = {std::cos(half), 0, std::sin(half), 0};
  return etalon;
}

View seen_by(const RigModel& model, std::size_t camera, const HeadState& head = {}) {
  return view_of(model, {.camera = camera, .head = head});
}

// A point of the surface, at an angle around the axis.
Eigen::Vector3d surface_point(const EtalonConfig& etalon, double angle, double height) {
  return vector(etalon.position) +
         rotation_of(etalon.rotation) *
             Eigen::Vector3d(etalon.radius * std::sin(angle), height, etalon.radius * std::cos(angle));
}

// Compares with the leftmost, rightmost, highest and lowest of very many points of the surface.
TEST(EtalonFigure, SidesAndRimsAreWhereItsSurfaceEndsAndPixelsShowPointsOfThem) {
  for_random_cases(20, [](TestRandom& random) {
    EtalonConfig etalon = random_etalon(random);
    etalon.position[1] = random.uniform(-0.8, 1.2);  // Also from above and below.
    const EtalonFigure figure(etalon);
    const View view = seen_by(true_rig(nominal_rig(), {.turn = 0.02, .roll = 0}, random), 0);
    const auto expected = figure.expected(view, -1e4);
    ASSERT_TRUE(expected);
    for (const EtalonPoint& point : *expected) {
      const auto place = figure.nearest(point, view);
      ASSERT_TRUE(place);
      EXPECT_LE((*view.project(*place) - point.pixel).norm(), 1e-9);
    }
    const auto& points = *expected;
    ASSERT_EQ(points[0].part, EtalonPart::left_side);
    ASSERT_EQ(points[2].part, EtalonPart::right_side);
    // Column of a side, given by two points, in row v.
    const auto side_at = [&](std::size_t first, double v) {
      const Eigen::Vector2d &a = points[first].pixel, &b = points[first + 1].pixel;
      return a.x() + (b.x() - a.x()) * (v - a.y()) / (b.y() - a.y());
    };
    std::vector<Eigen::Vector2d> rims;
    double least = 1e9, most = -1e9;
    constexpr int around = 2000, up = 40;
    for (int i = 0; i < around; ++i) {
      for (int j = 0; j <= up; ++j) {
        const Eigen::Vector2d pixel =
            *view.project(surface_point(etalon, 2 * std::numbers::pi * i / around, etalon.height * j / up));
        least = std::min(least, pixel.x() - side_at(0, pixel.y()));
        most = std::max(most, pixel.x() - side_at(2, pixel.y()));
        if (j == 0 || j == up) rims.push_back(pixel);
      }
    }
    EXPECT_NEAR(least, 0, 2e-3);
    EXPECT_NEAR(most, 0, 2e-3);
    // As in measured pictures: the end of the silhouette in two columns, a quarter of its width there beside
    // its middle.
    for (const auto& [rim, way] : {std::pair{4, -1.0}, {5, 1.0}}) {
      const double v = points[static_cast<std::size_t>(rim)].pixel.y();
      const double left = side_at(0, v), width = side_at(2, v) - left;
      double middle = 0;
      for (const double share : {0.25, 0.75}) {
        double end = -1e9;
        for (const Eigen::Vector2d& pixel : rims)
          if (std::abs(pixel.x() - left - share * width) < 0.1) end = std::max(end, way * pixel.y());
        middle += 0.5 * way * end;
      }
      EXPECT_NEAR(middle, v, 0.1) << rim;
    }
  });
  EtalonConfig around_camera;
  around_camera.position = {0, 0, 2.5}, around_camera.height = 1;
  EXPECT_FALSE(EtalonFigure(around_camera).nearest({}, seen_by(nominal_rig(), 0)));
}

// Pictures of a cylinder by a rig with errors, from several stances.
RigObservations seen_etalon(const RigModel& truth, const EtalonConfig& etalon, double noise,
                            TestRandom& random) {
  RigObservations seen;
  seen.poses = {ArmState::straight(3)};
  seen.etalon = etalon;
  for (const double aside : {0.0, -0.3, 0.3}) {
    for (const double turn : {0.0, -0.06, 0.06}) {
      for (const std::size_t camera : {std::size_t{0}, std::size_t{1}}) {
        RigStance stance{.camera = camera, .stage = {{aside, 0.3 * aside, turn > 0 ? 0.2 : 0}}};
        // Towards the cylinder, so that all of it is visible; positions can be commanded exactly.
        const View there = view_of(truth, stance);
        const Eigen::Vector3d p_CE = there.X_WC.inverse() * EtalonFigure(etalon).middle();
        stance.head = {std::atan2(-p_CE.x(), p_CE.z()) + turn, std::atan2(-p_CE.y(), p_CE.z()) - turn, 1};
        seen.stances.push_back(stance);
        RigImage& image = seen.images.emplace_back();
        image.stance = seen.stances.size() - 1;
        image.etalon = EtalonFigure(etalon).expected(view_of(truth, stance), 0).value();
        for (EtalonPoint& point : image.etalon) {
          point.sigma = std::max(noise, 1e-3);
          point.pixel += noise * Eigen::Vector2d(normal_number(random), normal_number(random));
        }
      }
    }
  }
  return seen;
}

// Seen from far above or below, the near or far side of a rim lies beyond the ends of the sides.
TEST(EtalonFigure, ItsOutlineBoundsBothRims) {
  for_random_cases(200, [](TestRandom& random) {
    EtalonConfig etalon = random_etalon(random);
    const EtalonFigure figure(etalon);
    const double bearing = random.uniform(-3, 3);
    const Eigen::Vector3d from =
        figure.middle() + random.uniform(1, 2) * Eigen::Vector3d(std::sin(bearing), 0, std::cos(bearing)) +
        Eigen::Vector3d(0, random.uniform(-1, 1), 0);
    MountConfig mount;
    const Eigen::Vector3d at = figure.middle() + random.vector<3>(-0.1, 0.1);
    mount.position = {from.x(), from.y(), from.z()}, mount.look_at = {{at.x(), at.y(), at.z()}};
    mount.roll = random.uniform(-0.8, 0.8);
    const View view{Lens({.fx = 400, .fy = 400, .cx = 319.5, .cy = 239.5, .distortion = {}}), mount.pose(),
                    640, 480};
    const auto outline = figure.outline(view, 0);
    ASSERT_TRUE(outline);
    Eigen::AlignedBox2d reported, drawn;
    for (const Eigen::Vector2d& point : *outline) reported.extend(point);
    for (const double height : {0.0, etalon.height})
      for (int i = 0; i < 1000; ++i)
        drawn.extend(*view.project(surface_point(etalon, 2e-3 * std::numbers::pi * i, height)));
    EXPECT_LT((reported.min() - drawn.min()).norm(), 0.5);
    EXPECT_LT((reported.max() - drawn.max()).norm(), 0.5);
    EXPECT_FALSE(figure.outline(view, reported.min().minCoeff() + 1));
  });
}

// At a rim's height its near and far halves are one line; above and below, both continue smoothly.
TEST(EtalonFigure, HalvesOfARimMeetAtTheCamerasHeight) {
  for_random_cases(50, [](TestRandom& random) {
    EtalonConfig etalon = random_etalon(random);
    etalon.rotation = {1, 0, 0, 0};
    const EtalonFigure figure(etalon);
    const auto is_upper = random.integer(0, 1) == 1;
    const EtalonPart part = is_upper ? EtalonPart::upper_rim : EtalonPart::lower_rim;
    const double bearing = random.uniform(-3, 3), rim = is_upper ? etalon.height : 0;
    const auto from = [&](double above) -> Eigen::Vector3d {
      return vector(etalon.position) +
             Eigen::Vector3d(1.5 * std::sin(bearing), rim + above, 1.5 * std::cos(bearing));
    };
    // Elevation of a half seen from this height above the rim.
    const auto elevation = [&](double above, RimHalf half) {
      const Eigen::Vector3d to = figure.line(part, 0, from(above), half)->point - from(above);
      return std::atan2(to.y(), std::hypot(to.x(), to.z()));
    };
    EXPECT_NEAR(elevation(0, RimHalf::near), elevation(0, RimHalf::far), 1e-12);
    constexpr double little = 1e-3;
    for (const double above : {-little, little}) {
      const RimHalf seen = figure.half_seen(part, from(above));
      EXPECT_EQ(seen, (above < 0) == is_upper ? RimHalf::near : RimHalf::far);
      // The higher half bounds the silhouette at the upper rim, the lower half at the lower rim.
      const RimHalf hidden = seen == RimHalf::near ? RimHalf::far : RimHalf::near;
      EXPECT_EQ(elevation(above, seen) > elevation(above, hidden), is_upper);
      EXPECT_EQ(elevation(above, seen), elevation(above, RimHalf::seen));
    }
  });
}

TEST(EtalonFigure, DerivativesOfItsRowsAreThoseOfDifferences) {
  for_random_cases(4, [](TestRandom& random) {
    const RigModel model = true_rig(nominal_rig(), {}, random);
    RigProblem problem(model, rough_prior(model), seen_etalon(model, random_etalon(random), 0, random));
    const Eigen::VectorXd x = Eigen::VectorXd::Zero(problem.variables().count());
    ASSERT_TRUE(problem.linearise(x));
    const RigRows rows = problem.rows()[3];
    EXPECT_LE(rows.residuals.norm(), 1e-4);
    const NumericalJacobian numerical = row_differences(problem, x, 3, 1e-5);
    // The measured places of a rim hardly move as the camera comes nearer.
    constexpr Eigen::Index first_rim = 4, rims = 2;
    for (Eigen::Index j = 0; j < rows.derivatives.cols(); ++j) {
      Eigen::VectorXd off = numerical.value.col(j) - rows.derivatives.col(j);
      const double size = std::max(1.0, rows.derivatives.col(j).norm());
      const std::string& name = problem.variables().variable(rows.columns[static_cast<std::size_t>(j)]).name;
      EXPECT_LE(off.segment(first_rim, rims).norm(), 1e-3 * size) << name;
      off.segment(first_rim, rims).setZero();
      EXPECT_LE(off.norm(), 1e-5 * size) << name;
    }
  });
}

TEST(EtalonFigure, TellsARigFromRoughGuessesAndHowWell) {
  double squares = 0;
  int count = 0;
  for_random_cases(8, [&](TestRandom& random) {
    RigTrialConfig wrong;
    wrong.turn = 5 * degree, wrong.shift = 0.1, wrong.are_heads_exact = true;
    const RigModel truth = true_rig(nominal_rig(), wrong, random);
    RigPrior prior = rough_prior(nominal_rig());
    for (CameraPrior& camera : prior.cameras) camera.steps = 0;
    RigProblem problem(nominal_rig(), prior, seen_etalon(truth, random_etalon(random), 0.05, random));
    const RigCalibration found = calibrate_rig(problem);
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_LE(found.rms, 1.05);
    const OpticalAxis a = optical_axis(problem.variables(), found.x, {{.camera = 0}, {}}),
                      b = optical_axis(problem.variables(), found.x, {{.camera = 1}, {}});
    const RigQuantity angle = axes_angle(a, b);
    const auto direction = [&](std::size_t i) -> Eigen::Vector3d {
      return view_of(truth, {.camera = i}).X_WC.rotation.col(2);
    };
    const double should = std::atan2(direction(0).cross(direction(1)).norm(), direction(0).dot(direction(1)));
    const double sigma = angle.sigma(found.covariance);
    EXPECT_LE(sigma, 0.3 * degree);
    EXPECT_LE(std::abs(angle.value - should), 4 * sigma);
    squares += std::pow((angle.value - should) / sigma, 2), ++count;
  });
  EXPECT_LT(squares, (1 + 4 * std::sqrt(2.0 / count)) * count);
  // Far too large sigmas would satisfy the tests above easily.
  EXPECT_GT(squares, (one_case_of > 1 ? 0 : 0.2) * count);
}

}  // namespace
}  // namespace flexura

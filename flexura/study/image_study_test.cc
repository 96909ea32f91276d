#include "flexura/study/image_study.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/base/node.h"
#include "flexura/base/table.h"
#include "flexura/camera/camera.h"
#include "flexura/study/study_view.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using std::numbers::pi;

constexpr double focal_length = 800, circle_radius = 0.5, distance = 2.5;
constexpr double half_side = circle_radius / std::numbers::sqrt2;

// Returns the camera in front of the circle of the paper's Figs. 10 to 13.
CameraConfig front_camera() {
  CameraConfig camera = cameras_at({distance, distance}).front();
  camera.lens.fx = focal_length;
  camera.sensor.width = 1280;
  camera.sensor.height = 960;
  return camera;
}

ImageStudy study(VaryConfig::Values VaryConfig::* parameter, double first, double last, std::int64_t points,
                 const CameraConfig& camera = front_camera()) {
  StudyTask task;
  task.vary.*parameter = {{first, last}};
  task.points = points;
  task.target.radius = circle_radius;
  return study_images(task, {camera}, 1);
}

// Returns the features at the last value of a study, by the formulas.
std::array<double, feature_names.size()> last_of(const ImageStudy& study) {
  std::array<double, feature_names.size()> values{};
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = study.columns[0].features.back()[k].value_or(std::nan(""));
  return values;
}

void expect_agreement(const ImageStudy& study) {
  const auto [length, ratio] = study.largest_difference();
  EXPECT_LE(length, 1e-9);
  EXPECT_LE(ratio, 1e-9);
}

TEST(ImageStudy, HasTheKnownFiguresOfAPlaneTiltedBy20Degrees) {
  const ImageStudy orbit = study(&VaryConfig::orbit, 0, 20 * degree, 3);
  const auto [top, bottom, left, right, height, width, corner, circle_top_distance, ratio] = last_of(orbit);
  EXPECT_NEAR(top, 237.7751, 5e-5);
  EXPECT_NEAR(bottom, 215.8345, 5e-5);
  EXPECT_NEAR(height, 213.1268, 5e-5);
  EXPECT_NEAR(corner, 163.1414, 5e-5);
  EXPECT_NEAR(circle_top_distance, 161.3906, 5e-5);
  EXPECT_NEAR(left, right, 1e-9);
  expect_agreement(orbit);
}

TEST(ImageStudy, HasTheKnownFiguresOfACameraTiltedBy20Degrees) {
  const ImageStudy tilt = study(&VaryConfig::tilt, 0, 20 * degree, 3);
  EXPECT_NEAR(last_of(tilt)[0], 229.0082, 5e-5);
  EXPECT_NEAR(last_of(tilt)[1], 253.8631, 5e-5);
  EXPECT_NEAR(last_of(tilt)[4], 256.9304, 5e-5);
  expect_agreement(tilt);
}

TEST(ImageStudy, FollowsThePapersClosedFormsInOrbit) {
  const ImageStudy orbit = study(&VaryConfig::orbit, -80 * degree, 80 * degree, 161);
  const double f = focal_length, a = half_side, R = circle_radius, D = distance;
  for (std::size_t i = 0; i < orbit.values.size(); ++i) {
    const double s = std::sin(orbit.values[i]), c = std::cos(orbit.values[i]);
    const double between = D * D - a * a * s * s;
    const double side = 2 * f * a * std::hypot(a * s, D * c) / between;
    const std::array<double, 9> expected{2 * f * a / (D - a * s),
                                         2 * f * a / (D + a * s),
                                         side,
                                         side,
                                         2 * f * a * D * c / between,
                                         2 * f * a * D / between,
                                         f * a * std::sqrt(1 + c * c) / (D - a * s),
                                         f * R * c / (D - R * s),
                                         c / std::sqrt(1 - R * R / (D * D) * s * s)};
    for (const StudyColumn& column : orbit.columns) {
      for (std::size_t k = 0; k < expected.size(); ++k)
        EXPECT_NEAR(column.features[i][k].value(), expected[k], 1e-9)
            << column.source << " " << feature_names[k] << " at " << orbit.values[i];
    }
  }
}

TEST(ImageStudy, MeasuresInPicturesThroughADistortedLensAndItsNoise) {
  for (const double noise : {0.0, 2.0}) {
    CameraConfig camera = front_camera();
    camera.lens.distortion = {-0.15, 0.02, 0, 0, 0};
    camera.sensor.width = 640, camera.sensor.height = 480;
    camera.sensor.psf = 0.7, camera.sensor.read_noise = noise;
    StudyTask task;
    task.vary.orbit = {{-50 * degree, 50 * degree}};
    task.points = 4, task.measure = true;
    task.target.radius = circle_radius;
    const ImageStudy study = study_images(task, {camera}, 1);
    ASSERT_EQ(study.columns.size(), 3U);
    EXPECT_EQ(study.columns[2].source, "measured");
    const auto [count, rms] = study.measured_difference();
    EXPECT_EQ(count, 4 * length_features);
    EXPECT_LT(rms, 0.1);
    EXPECT_GT(rms, 1e-4);
  }
}

TEST(ImageStudy, MeasuresInTheNoiseOfTheSeedAndTheCamera) {
  CameraConfig front = front_camera(), side = front;
  front.sensor.width = 640, front.sensor.height = 480, front.sensor.read_noise = 2;
  side = front;
  side.name = "side";
  StudyTask task;
  task.vary.orbit = {{-20 * degree, 20 * degree}};
  task.points = 2, task.measure = true;
  task.target.radius = circle_radius;
  const auto measured = [&](const std::vector<CameraConfig>& cameras, const char* name, std::uint64_t seed) {
    task.camera = name;
    const ImageStudy study = study_images(task, cameras, seed);
    EXPECT_LT(study.measured_difference().rms, 0.1);
    EXPECT_EQ(study.measured_difference().count, 2 * length_features);
    return study.columns[2].features;
  };
  const auto first = measured({front, side}, "front", 1);
  EXPECT_EQ(measured({front, side}, "front", 1), first);
  EXPECT_EQ(measured({front}, "front", 1), first);
  EXPECT_NE(measured({front, side}, "front", 2), first) << "another seed";
  EXPECT_NE(measured({front, side}, "side", 1), first) << "another camera in the same place";
  EXPECT_EQ(measured({side, front}, "side", 1), first) << "the cameras' places count, not their names";
}

TEST(ImageStudy, ZoomsLinearly) {
  const ImageStudy zoom = study(&VaryConfig::zoom, 1, 10, 19);
  for (std::size_t i = 0; i < zoom.values.size(); ++i) {
    for (std::size_t k = 0; k < length_features; ++k)
      EXPECT_NEAR(*zoom.columns[1].features[i][k], *zoom.columns[1].features[0][k] * zoom.values[i], 1e-9);
    EXPECT_NEAR(*zoom.columns[1].features[i].back(), 1, 1e-12);
  }
  EXPECT_TRUE(zoom.in_image(0));
  EXPECT_FALSE(zoom.in_image(18));
  EXPECT_TRUE(zoom.is_seen(18)) << "outside the image is not unknown";
}

TEST(ImageStudy, ItsTwoColumnsAgreeForEveryParameterOfACameraInGeneralPosition) {
  CameraConfig camera = front_camera();
  camera.mount.position = {0.4, -0.3, 2.2};
  camera.mount.look_at = {{0.05, 0.1, 0}};
  camera.mount.roll = 0.1;
  camera.head.pupil = {0.01, -0.02, 0.05};
  camera.lens.distortion = {-0.1, 0.02, 1e-3, -1e-3, 0};
  camera.initial.zoom = 1.1;
  for (const FieldInfo& field : fields_of(static_cast<const VaryConfig*>(nullptr)).info().fields) {
    SCOPED_TRACE(field.name);
    double from = 0.3, to = 0.5;
    if (field.name == "distance" || field.name == "mount_z") from = 2, to = 2.4;
    if (field.name == "zoom") from = 1, to = 1.2;
    if (field.name[0] == 'c' || field.name[0] == 'f') from = 400, to = 500;  // In px.
    if (field.name == "k4") {                                                // This and the next ones.
      camera.lens.model = LensModel::rational;
      camera.lens.distortion = {-0.1, 0.02, 1e-3, -1e-3, 0, 0.1, 0.01, 0.001};
    }
    Node written{Node::Table{}, {}};
    ASSERT_EQ(set_at_path(written, fmt::format("vary.{}", field.name),
                          {Node::Array{number_node(from), number_node(to)}, {}}),
              "");
    ASSERT_EQ(set_at_path(written, "points", {std::int64_t{5}, {}}), "");
    const auto task = read_as<StudyTask>(written);
    const ImageStudy found = study_images(task, {camera}, 1);
    EXPECT_EQ(found.variation.name, field.name);
    EXPECT_TRUE(found.is_seen(0));
    EXPECT_GT((*found.images[0].circle[top_right] - *found.images[4].circle[top_right]).norm(), 1e-6);
    expect_agreement(found);
  }
}

TEST(ImageStudy, SeesWithTheHeadAndStageAsTheCameraDoes) {
  CameraConfig config = front_camera();
  config.initial = {.pan = 0.05, .tilt = -0.03, .zoom = 1.5, .stage = {0.1, 0.2, 0.3}};
  config.head.tilt_axis = {0.02, 0.01, -0.03};
  config.head.pupil = {0.01, -0.02, 0.05};
  const Camera camera(config);
  const StudyTarget target({});
  const auto expect_seen = [&](VaryConfig::Values VaryConfig::* parameter, double value,
                               const CameraStance& stance) {
    const auto expected = camera.project(target.point(30), stance);
    EXPECT_LE(
        (*view_with(camera, parameter, value, target).project(target.point(30)) - expected->pixel).norm(),
        1e-9);
  };
  const auto [head, stage] = camera.initial_stance();
  expect_seen(&VaryConfig::pan, 0.2, {{0.2, head.tilt, head.zoom}, stage});
  expect_seen(&VaryConfig::tilt, 0.2, {{head.pan, 0.2, head.zoom}, stage});
  expect_seen(&VaryConfig::zoom, 3, {{head.pan, head.tilt, 3}, stage});
  expect_seen(&VaryConfig::stage_y, 0.5, {head, {{0.1, 0.5, 0.3}}});
  expect_seen(&VaryConfig::focal_length, 1200, {head, stage});
}

TEST(ImageStudy, AnOrbitKeepsTheDistanceAndLooksAtTheCentre) {
  CameraConfig config = front_camera();
  config.mount.look_at = {{0.3, 0.2, 0}};
  config.mount.roll = 0.3;
  StudyTargetConfig place;
  place.center = {0.2, 0.1, -0.1};
  place.normal = {0.3, 0.4, 1};
  const StudyTarget target(place);
  const Camera camera(config);
  const double before = (camera.mount().position - target.center()).norm();
  for (const double angle : {-1.0, 0.0, 0.4, 3.0}) {
    const View view = view_with(camera, &VaryConfig::orbit, angle, target);
    EXPECT_NEAR((view.X_WC.position - target.center()).norm(), before, 1e-12);
    EXPECT_LE((*view.project(target.center()) - Eigen::Vector2d(639.5, 479.5)).norm(), 1e-9);
  }
  EXPECT_GT(view_with(camera, &VaryConfig::orbit, 0.4, target).X_WC.position.y(), camera.mount().position.y())
      << "it rises";
}

TEST(StudyTarget, ItsSquareIsLevelAndUprightAsTheCameraSeesIt) {
  for (const auto& [normal, level] :
       std::vector<std::pair<std::array<double, 3>, Eigen::Vector3d>>{{{0, 0, 2}, {1, 0, 0}},
                                                                      {{-1, 0, 0}, {0, 0, 1}},
                                                                      {{0, 1, 0}, {1, 0, 0}},
                                                                      {{0, -1, 0}, {1, 0, 0}}}) {
    StudyTargetConfig config;
    config.normal = normal;
    const StudyTarget target(config);
    EXPECT_LE((target.level_axis() - level).norm(), 1e-15);
    const Eigen::Vector3d edge = target.point(top_right) - target.point(top_left);
    EXPECT_LE((edge - std::numbers::sqrt2 * 0.5 * level).norm(), 1e-12);
    for (std::size_t i = 0; i < circle_points; ++i)
      EXPECT_NEAR(target.point(i).dot(Eigen::Vector3d(normal.data())), 0, 1e-15);
    EXPECT_GE(target.point(circle_top).y(), 0);
  }
}

TEST(ImageStudy, MeasuresTargetsSmallerThanAPixel) {
  StudyTask task;
  task.vary.orbit = {{-0.5, 0.5}};
  task.points = 3;
  task.target.radius = 1e-4;  // 0.03 px.
  const ImageStudy tiny = study_images(task, {front_camera()}, 1);
  EXPECT_NEAR(*tiny.columns[1].features[1][0], focal_length * std::numbers::sqrt2 * 1e-4 / distance, 1e-9);
  EXPECT_LE(tiny.largest_difference()[0], 1e-9);
}

TEST(ImageStudy, StandsOffFromTheTarget) {
  const ImageStudy away = study(&VaryConfig::distance, 2, 5, 7);
  for (std::size_t i = 0; i < away.values.size(); ++i)
    EXPECT_NEAR(*away.columns[1].features[i][0], focal_length * 2 * half_side / away.values[i], 1e-9);
  const ImageStudy mount = study(&VaryConfig::mount_z, 2, 5, 7);
  EXPECT_EQ(mount.columns[0].features, away.columns[0].features);
}

TEST(ImageStudy, LeavesEmptyWhatTheLensDoesNotShow) {
  CameraConfig camera = front_camera();
  camera.mount.stage.z.limits = {0, 4};
  const ImageStudy ahead = study(&VaryConfig::stage_z, 0, 4, 9, camera);  // Through the plane at 2.5 m.
  for (std::size_t i = 0; i < ahead.values.size(); ++i) {
    EXPECT_EQ(ahead.is_seen(i), ahead.values[i] < distance) << ahead.values[i];
    if (ahead.values[i] < distance) continue;
    EXPECT_EQ(ahead.columns[0].features[i], ImageFeatures{});
  }
  expect_agreement(ahead);
}

TEST(ImageStudy, MeasuresTheSquareWhileThePlaneCutsTheCircle) {
  CameraConfig camera = front_camera();
  camera.mount.position = {0, 0, 0.45};  // Nearer than the radius: in orbit, parts get behind it.
  const ImageStudy orbit = study(&VaryConfig::orbit, 0, 85 * degree, 18, camera);
  EXPECT_TRUE(orbit.is_seen(0));
  EXPECT_FALSE(orbit.is_seen(17));
  EXPECT_TRUE(orbit.columns[0].features.back()[1].has_value()) << "the bottom edge";
  EXPECT_FALSE(orbit.columns[0].features.back()[8].has_value()) << "no ellipse";
  expect_agreement(orbit);
}

TEST(AxesRatio, IsThatOfAnyEllipse) {
  for_random_cases(200, [](TestRandom& random) {
    const double ratio = std::pow(10.0, random.uniform(-6, 0)), turn = random.uniform(-pi, pi);
    const Eigen::Vector2d middle(random.uniform(-500, 500), random.uniform(-500, 500));
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < 12; ++i) {
      const double angle = 2 * pi * (i + random.uniform(-0.4, 0.4)) / 12;
      points.emplace_back(middle + Eigen::Rotation2Dd(turn) *
                                       Eigen::Vector2d(200 * std::cos(angle), 200 * ratio * std::sin(angle)));
    }
    EXPECT_NEAR(axes_ratio(points).value(), ratio, 1e-10);
  });
}

TEST(AxesRatio, IsZeroOnALineAndNoneWhereNothingIsAnEllipse) {
  std::vector<Eigen::Vector2d> points;
  for (const double x : {0.0, 1.0, 2.0, 3.0}) points.emplace_back(x, 2 * x);
  EXPECT_FALSE(axes_ratio(points)) << "four points";
  points.emplace_back(5, 10);
  EXPECT_EQ(axes_ratio(points), 0);
  EXPECT_FALSE(axes_ratio(std::vector<Eigen::Vector2d>(6, {3, 4}))) << "one point";
  points.clear();
  for (const double x : {-2.0, -1.0, 0.0, 1.0, 2.0, 3.0}) points.emplace_back(x, std::sqrt(1 + x * x));
  EXPECT_FALSE(axes_ratio(points)) << "a hyperbola";
}

TEST(ImageStudy, RefusesWhatNoCheckHasPassed) {
  const std::vector<CameraConfig> cameras = {front_camera()};
  StudyTask task;
  EXPECT_THROW((void)study_images(task, cameras, 1), std::invalid_argument) << "nothing to vary";
  task.vary.pan = {{0, 1}};
  EXPECT_THROW((void)study_images(task, {}, 1), std::invalid_argument) << "no camera";
  EXPECT_EQ(study_images(task, cameras, 1).values.size(), 101U);
  task.vary.tilt = {{0, 1}};
  EXPECT_THROW((void)study_images(task, cameras, 1), std::invalid_argument) << "two parameters";
  task.vary.tilt.reset();
  task.points = 1;
  EXPECT_THROW((void)study_images(task, cameras, 1), std::invalid_argument) << "one value";
}

}  // namespace
}  // namespace flexura

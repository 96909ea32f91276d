#include "flexura/rig/filming.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "flexura/base/table.h"
#include "flexura/experiment/schedule.h"
#include "flexura/log/recorder.h"
#include "tests/support/experiment_files.h"
#include "tests/support/runs.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// Small pictures of a small arm that moves for a second.
const std::string small_pictures = R"(
[arm]
kind = "spatial"
[[arm.section]]
length = 0.5
[[arm.section]]
length = 0.5
[[camera]]
name = "front"
mount = { position = [0, 0.5, 2], look_at = [0, 0.5, 0] }
lens = { fx = 80, fy = 80, cx = 31.5, cy = 23.5 }
sensor = { width = 64, height = 48, frame_rate = 10, read_noise = 1, delay_ms = 20 }
[[camera]]
name = "side"
mount = { position = [-2, 0.5, 0], look_at = [0, 0.5, 0] }
lens = { fx = 80, fy = 80, cx = 31.5, cy = 23.5 }
sensor = { width = 64, height = 48, frame_rate = 4, bits = 12 }
[[task]]
kind = "move"
duration = 1
to = { bends = [[0.8, 0.5], [-0.4, 1.2]] }
)";

using Film = std::vector<std::pair<std::string, Frame>>;

Film film_of(const std::string& text, double step = 0.05, std::size_t threads = 2) {
  const Experiment experiment = parse_experiment(text, "x.toml");
  const Schedule schedule(experiment);
  Filming filming(experiment, threads);
  Film film;
  const auto steps = static_cast<int>(std::lround(schedule.duration() / step));
  for (int i = 0; i <= steps; ++i) {
    const double time = i * step;
    filming.play_to(time, schedule.state_at(time), [&](const FilmedFrame& filmed) {
      EXPECT_EQ(filmed.message, logged_image(filmed.camera, filmed.frame));
      film.emplace_back(filmed.camera, filmed.frame);
    });
  }
  return film;
}

TEST(Filming, DeliversEveryFrameOfEveryCameraInTheOrderOfTime) {
  const Film film = film_of(small_pictures);
  std::map<std::string, std::vector<std::int64_t>> numbers;
  double last = 0;
  for (const auto& [camera, frame] : film) {
    EXPECT_GE(frame.received, last);
    last = frame.received;
    numbers[camera].push_back(frame.number);
  }
  // With a delay of 20 ms, the frame of 1 s does not arrive in time.
  EXPECT_EQ(numbers["front"], (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(numbers["side"], (std::vector<std::int64_t>{0, 1, 2, 3, 4}));
  for (const auto& [camera, frame] : film) {
    EXPECT_EQ(std::holds_alternative<Image<std::uint8_t>>(*frame.picture), camera == "front");
    EXPECT_EQ(std::holds_alternative<Image<std::uint16_t>>(*frame.picture), camera == "side");
  }
}

void expect_same_film(const Film& film, const Film& other) {
  ASSERT_EQ(film.size(), other.size());
  for (std::size_t i = 0; i < film.size(); ++i) {
    EXPECT_EQ(film[i].first, other[i].first) << i;
    const Frame &a = film[i].second, &b = other[i].second;
    EXPECT_EQ(a.number, b.number) << i;
    EXPECT_EQ(a.time, b.time) << i;
    EXPECT_EQ(a.received, b.received) << i;
    EXPECT_EQ(*a.picture, *b.picture) << i;
  }
}

TEST(Filming, GivesTheSameFilmForAnyNumberOfThreads) {
  const std::string lossy = replaced(small_pictures, "delay_ms = 20", "delay_ms = 20, drop = 0.3");
  const Film one = film_of(lossy, 0.05, 1);
  EXPECT_LT(one.size(), 14U) << "some frames are lost";
  for (const std::size_t threads : {0U, 3U}) expect_same_film(one, film_of(lossy, 0.05, threads));
}

// The arm in motion is asked by all threads that render.
TEST(Filming, OfAnArmInMotionIsTheSameForAnyNumberOfThreads) {
  std::string moving =
      replaced(small_pictures, "[arm]\n", "[arm]\nmodel = \"dynamic\"\ngravity = [0, -9.81, 0]\n");
  moving = replaced(moving, "[[camera]]\nname = \"front\"", R"([[arm.tendon]]
section = 2
radius_mm = 10
friction = 0.1
[[arm.tendon]]
section = 1
radius_mm = 10
angle_deg = 120
[[camera]]
name = "front")");
  moving =
      replaced(moving, "[[arm.section]]\nlength = 0.5\n[[arm.section]]\n",
               "[[arm.section]]\nlength = 0.5\nradius = 0.02\nmaterial = { youngs_modulus = 5e6, density = "
               "1000, damping_time = 0.02, modes = { bend = 2 } }\n[[arm.section]]\nradius = 0.02\nmaterial "
               "= { youngs_modulus = 5e6, density = 1000, damping_time = 0.02, modes = { bend = 2 } }\n");
  const Film one = film_of(moving, 0.05, 1);
  EXPECT_GT(one.size(), 10U);
  for (const std::size_t threads : {0U, 3U}) expect_same_film(one, film_of(moving, 0.05, threads));
}

TEST(Filming, GivesTheSameFilmForAnyStepOfAnArmThatStands) {
  const std::string still = replaced(small_pictures, "to = { bends = [[0.8, 0.5], [-0.4, 1.2]] }",
                                     "to = { bends = [[0, 0], [0, 0]] }");
  const Film film = film_of(still, 0.05);
  EXPECT_EQ(film.size(), 15U);
  for (const double step : {0.005, 1.0}) expect_same_film(film, film_of(still, step));
}

TEST(Filming, ShowsTheTruthAndNotWhatIsBelieved) {
  const std::string quiet = replaced(small_pictures, "read_noise = 1, ", "");
  const Film nominal = film_of(quiet);
  const Film same = film_of(quiet + "[truth.arm.base]\nposition = [0, 0, 0]\n");
  const Film shifted = film_of(quiet + "[truth.arm.base]\nposition = [0.1, 0, 0]\n");
  const Film light = film_of(quiet + "[truth.arm.look]\ncolor = [0.9, 0.9, 0.9]\n");
  const Film dim = film_of(quiet +
                           "[[truth.stand.screen]]\nbrightness = 0.7\n[[truth.stand.screen]]\n"
                           "brightness = 0.7\n");
  const Film turned = film_of(quiet + "[[truth.camera]]\nname = \"side\"\ninitial = { pan_deg = 2 }\n");
  ASSERT_EQ(nominal.size(), turned.size());
  for (std::size_t i = 0; i < nominal.size(); ++i) {
    EXPECT_EQ(*nominal[i].second.picture, *same[i].second.picture) << i;
    EXPECT_NE(*nominal[i].second.picture, *shifted[i].second.picture) << i;
    EXPECT_NE(*nominal[i].second.picture, *light[i].second.picture) << i;
    EXPECT_NE(*nominal[i].second.picture, *dim[i].second.picture) << i;
    EXPECT_EQ(*nominal[i].second.picture == *turned[i].second.picture, nominal[i].first == "front") << i;
  }
}

const Image<std::uint8_t>& gray(const Frame& frame) { return std::get<Image<std::uint8_t>>(*frame.picture); }

TEST(Filming, SeesNothingBehindACover) {
  const Film film = film_of(small_pictures);
  const Film covered =
      film_of(small_pictures + "[[truth.camera]]\nname = \"front\"\nsensor.covered = [[0.1, 0.3]]\n");
  ASSERT_EQ(film.size(), covered.size());
  int dark = 0;
  for (std::size_t i = 0; i < film.size(); ++i) {
    const auto& [name, frame] = covered[i];
    if (name != "front" || frame.time < 0.1 || frame.time >= 0.3) {
      EXPECT_EQ(*frame.picture, *film[i].second.picture) << i;
      continue;
    }
    const int lightest = *std::ranges::max_element(gray(frame).values());
    EXPECT_LT(lightest, 10);  // Only noise.
    EXPECT_GT(lightest, 0);   // The noise is present.
    ++dark;
  }
  EXPECT_EQ(dark, 2);
}

// Returns a file with one camera of 10 Hz, and the arm's tasks.
std::string one_camera(const std::string& sensor, const std::string& rest) {
  return fmt::format(R"(
[arm]
kind = "spatial"
[[arm.section]]
length = 1
radius = 0.05
[[camera]]
name = "front"
mount = {{ position = [0, 0.5, 2], look_at = [0, 0.5, 0] }}
lens = {{ fx = 80, fy = 80, cx = 31.5, cy = 23.5 }}
sensor = {{ width = 64, height = 48, frame_rate = 10, {} }}
{}
)",
                     sensor, rest);
}
const std::string swing =
    "[[task]]\nkind = \"move\"\nlaw = \"linear\"\nduration = 0.4\nto = { bends = [[1.5, 0]] }\n";

TEST(Filming, ARollingShutterShowsEachRowAtItsOwnTime) {
  const Film rolling = film_of(one_camera("readout = \"rolling\", row_time = 0.002", swing));
  // A camera of 500 Hz has each row's instant in a separate frame.
  const Film fast =
      film_of(replaced(one_camera("read_noise = 0", swing), "frame_rate = 10", "frame_rate = 500"));
  ASSERT_EQ(rolling.size(), 4U);
  ASSERT_EQ(fast.size(), 201U);
  for (const std::size_t frame : {0U, 1U, 3U}) {
    for (int v = 0; v < 48; ++v) {
      const auto& instant = gray(fast[50 * frame + static_cast<std::size_t>(v)].second);
      for (int u = 0; u < 64; ++u)
        ASSERT_NEAR(gray(rolling[frame].second).at(u, v), instant.at(u, v), 1)
            << frame << ": " << u << " " << v;
    }
  }
  const Film global = film_of(one_camera("read_noise = 0", swing));
  EXPECT_NE(*rolling[2].second.picture, *global[2].second.picture);
}

TEST(Filming, ARollingShutterShowsWhatStandsStillAsAnyOther) {
  const std::string hold = "[[task]]\nkind = \"hold\"\nduration = 0.2\n";
  const Film rolling = film_of(one_camera("exposure = 0.02, readout = \"rolling\", row_time = 0.001", hold));
  const Film global = film_of(one_camera("exposure = 0.02", hold));
  ASSERT_EQ(rolling.size(), 2U);
  EXPECT_EQ(*rolling[1].second.picture, *global[1].second.picture);
}

// Returns the number of values between the arm's and the screen's.
int blurred_values(const Film& film, std::size_t frame) {
  return static_cast<int>(std::ranges::count_if(
      gray(film[frame].second).values(), [](std::uint8_t value) { return value > 80 && value < 190; }));
}

TEST(Filming, BlursAMotionThereAndBackAsWellAsOneThatGoesOn) {
  // One swing in an exposure of 0.1 s, and half of one.
  const auto sine = [](double period) {
    return fmt::format(
        "[[task]]\nkind = \"sine\"\nduration = 0.21\namplitude = {{ bends = [[1, 0]] }}\nperiod = {}\n",
        period);
  };
  const std::string exposed = "exposure = 0.1";
  const Film sharp = film_of(one_camera("exposure = 0", sine(0.1)), 0.005);
  const Film whole = film_of(one_camera(exposed, sine(0.1)), 0.005);
  const Film half = film_of(one_camera(exposed, sine(0.2)), 0.005);
  EXPECT_GT(blurred_values(whole, 1), 3 * blurred_values(sharp, 1));
  EXPECT_NEAR(blurred_values(whole, 1), blurred_values(half, 1), 0.5 * blurred_values(half, 1));
}

TEST(TrueRig, IsLaidUponTheDefaultStandToo) {
  const std::string text = R"(
[arm]
[[arm.section]]
length = 2
[[truth.camera]]
name = "side"
lens.fx = 808
[[truth.stand.screen]]
center_mm = [0, 0, -3000]
[[truth.stand.screen]]
)";
  const Experiment experiment = parse_experiment(text, "x.toml");
  EXPECT_TRUE(experiment.camera.empty());
  const RigConfig model = experiment.model_rig(), truth = experiment.true_rig();
  ASSERT_EQ(truth.cameras.size(), 2U);
  EXPECT_EQ(truth.cameras[1].lens.fx, 808);
  EXPECT_EQ(truth.cameras[0].lens.fx, model.cameras[0].lens.fx);
  EXPECT_EQ(truth.cameras[1].mount.position, model.cameras[1].mount.position);
  const auto screens = default_screens(2, {0, 0, 0});
  const StandConfig stand = experiment.true_stand();
  EXPECT_EQ(stand.screen->at(0).center, (std::array<double, 3>{0, 0, -3}));
  EXPECT_EQ(stand.screen->at(0).width, screens[0].width);
  EXPECT_EQ(stand.screen->at(1).center, screens[1].center);
  const std::string written = experiment_toml(experiment);
  EXPECT_EQ(experiment_toml(parse_experiment(written, "again.toml")), written);
}

TEST(DefaultStand, HasItsCamerasAtTheDistancesOfTheFile) {
  const std::string arm = "[arm]\nbase.position = [0.1, 0.2, 0.3]\n[[arm.section]]\nlength = 2\n";
  const std::string text = arm + "[stand]\ncamera_distances_mm = [2500, 4000]\n";
  const auto cameras = parse_experiment(text, "x.toml").cameras();
  EXPECT_EQ(cameras[0].mount.position, (std::array<double, 3>{0.1, 0.2, 0.3 + 2.5}));
  EXPECT_EQ(cameras[1].mount.position, (std::array<double, 3>{0.1 - 4, 0.2, 0.3}));
  EXPECT_THAT(error_of_file(
                  text + "[[camera]]\nname = \"a\"\nmount = { position = [0, 0, 1], look_at = [0, 0, 0] }\n"),
              HasSubstr("x.toml:6:1: stand.camera_distances: applies only to the default cameras"));
  EXPECT_THAT(error_of_file(text + "[truth.stand]\ncamera_distances = [2, 2]\n"),
              HasSubstr("truth.stand.camera_distances: moves no camera"));
  EXPECT_THAT(error_of_file(arm + "[stand]\ncamera_distances = [2, 0]\n"),
              HasSubstr("stand.camera_distances[1] = 0: expected a number above 0"));
}

TEST(TrueRig, MovesNoScreensWithTheArm) {
  const Experiment experiment =
      parse_experiment(small_pictures + "[truth.arm.base]\nposition = [0.1, 0, 0]\n", "x.toml");
  EXPECT_EQ(experiment.true_stand().screen->at(0).center, default_screens(1, {0, 0, 0})[0].center);
}

TEST(Filming, IsKeptInTheLogAndNothingElseOfTheLogChanges) {
  Runs runs;
  const auto log_of = [&](const std::string& text) {
    const RunResult result = runs.run(text);
    std::map<std::string, std::vector<std::string>> messages;
    const McapReader log(result.folder / log_file_name);
    for (const McapMessage& message : log.messages())
      messages[message.channel->topic].emplace_back(message.text());
    return messages;
  };
  auto filmed = log_of(small_pictures + "[record]\ncameras = true\nreport = false\n");
  const auto plain = log_of(small_pictures + "[record]\nreport = false\n");
  ASSERT_EQ(filmed["/camera/front"].size(), 10U);
  ASSERT_EQ(filmed["/camera/side"].size(), 5U);
  for (const std::string& text : filmed["/camera/front"]) {
    const auto message = read_as<ImageMessage>(parse_json(text, "log"));
    EXPECT_EQ(message.format, "png");
    EXPECT_EQ(message.frame_id, "camera/front");
    EXPECT_THAT(message.data.data, ::testing::StartsWith("\x89PNG"));
  }
  for (const char* topic : {"/camera/front", "/camera/side", "/arm/truth", "/arm/reading", "/head/front",
                            "/head/side", "/stage/front", "/stage/side"}) {
    EXPECT_FALSE(filmed[topic].empty()) << topic;
    filmed.erase(topic);
  }
  EXPECT_EQ(filmed, plain);
}

TEST(Filming, LogsWhatTheRigsDevicesSayOfThemselves) {
  Runs runs;
  const RunResult result =
      runs.run(small_pictures +
               "[record]\ncameras = true\nreport = false\n[[truth.arm.section]]\nmax_bend_rate = 0.3\n"
               "[[truth.arm.section]]\n[[truth.camera]]\nname = \"side\"\ninitial.pan_deg = 2\n");
  const auto readings = logged<ArmReadingMessage>(result, arm_reading_topic);
  EXPECT_EQ(readings.size(), logged<ArmStateMessage>(result, arm_state_topic).size());
  const ArmReadingMessage& arm = readings.back();
  EXPECT_EQ(arm.time, 1);
  EXPECT_TRUE(arm.moving) << "slower than believed";
  EXPECT_LE(std::hypot(arm.bends[0][0], arm.bends[0][1]), 0.3 + 1e-9);
  EXPECT_EQ(logged<HeadReadingMessage>(result, head_topic("side")).back().pan, 0)
      << "the head counts from where it is believed to stand";
}

TEST(Filming, TellsWhatIsWrongWithCamerasAndTheTruth) {
  const BadFile bad[] = {
      {"two of a name", replaced(small_pictures, "\"side\"", "\"front\""), "front"},
      {"no such camera", small_pictures + "[[truth.camera]]\nname = \"top\"\n", "has the name \"top\""},
      {"another arm", small_pictures + "[[truth.arm.section]]\nlength = 1\n", "the true arm has 1 sections"},
      {"unknown key", small_pictures + "[truth]\nweather = 1\n", "truth.weather: unknown key"},
      {"a name that leads elsewhere", replaced(small_pictures, "\"side\"", "\"../side\""),
       "x.toml:14:1: camera[1].name: \"../side\" cannot be a file name"},
      {"two true ones of a name",
       small_pictures + "[[truth.camera]]\nname = \"side\"\n[[truth.camera]]\nname = \"side\"\n",
       "truth.camera[1].name: \"side\" is the name of another entry"},
      {"too many frames",
       replaced(small_pictures, "frame_rate = 10", "frame_rate = 1e6") + "[record]\ncameras = true\n",
       "x.toml:23:11: record.cameras: makes 1e+06 images in 1 s at the cameras' frame rates: expected at "
       "most"},
      {"a zoom that falls",
       replaced(small_pictures, "lens = { fx = 80,",
                "lens = { zoom = [{ ratio = 1 },\n{ ratio = 3 },\n{ ratio = 2 }], fx = 80,"),
       "x.toml:13:3: camera[0].lens.zoom[2].ratio: expected a ratio that increases from row to row"},
      {"no focal length", replaced(small_pictures, "fx = 80", "fx = 0"), "fx = 0"},
      {"a negative length", small_pictures + "[truth.arm.base]\nposition = [0, 0]\n",
       "truth.arm.base.position"},
  };
  for (const BadFile& file : bad) EXPECT_THAT(error_of_file(file.text), HasSubstr(file.error)) << file.what;
}

}  // namespace
}  // namespace flexura

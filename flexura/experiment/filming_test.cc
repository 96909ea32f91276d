#include "flexura/experiment/filming.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/experiment/messages.h"
#include "flexura/experiment/results.h"
#include "flexura/experiment/run.h"
#include "flexura/experiment/schedule.h"
#include "flexura/store/json.h"
#include "flexura/store/mcap_reader.h"
#include "flexura/store/text_file.h"
#include "tests/support/experiment_files.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// Small pictures of a small arm that moves for a second.
const std::string two_cameras = R"(
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

class Quiet : public Progress {
 public:
  void update(double, std::string_view) override {}
};

using Film = std::vector<std::pair<std::string, Frame>>;

Film film_of(const std::string& text, double step = 0.05) {
  const Experiment experiment = parse_experiment(text, "x.toml");
  const Schedule schedule(experiment);
  Filming filming(experiment);
  Film film;
  const auto steps = static_cast<int>(std::lround(schedule.duration() / step));
  for (int i = 0; i <= steps; ++i) {
    const double time = i * step;
    filming.play_to(time, schedule.state_at(time),
                    [&](const std::string& camera, const Frame& frame) { film.emplace_back(camera, frame); });
  }
  return film;
}

TEST(Filming, DeliversEveryFrameOfEveryCameraInTheOrderOfTime) {
  const Film film = film_of(two_cameras);
  std::map<std::string, std::vector<std::int64_t>> numbers;
  double last = 0;
  for (const auto& [camera, frame] : film) {
    EXPECT_GE(frame.received, last);
    last = frame.received;
    numbers[camera].push_back(frame.number);
  }
  // 20 ms late, the frame of 1 s does not come any more.
  EXPECT_EQ(numbers["front"], (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(numbers["side"], (std::vector<std::int64_t>{0, 1, 2, 3, 4}));
  for (const auto& [camera, frame] : film) {
    EXPECT_EQ(std::holds_alternative<Image<std::uint8_t>>(*frame.picture), camera == "front");
    EXPECT_EQ(std::holds_alternative<Image<std::uint16_t>>(*frame.picture), camera == "side");
  }
}

TEST(Filming, GivesTheSamePicturesTwice) {
  const Film first = film_of(two_cameras), second = film_of(two_cameras);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i)
    EXPECT_EQ(*first[i].second.picture, *second[i].second.picture) << i;
}

TEST(Filming, ShowsTheArmMoving) {
  const Film film = film_of(two_cameras);
  EXPECT_NE(*film.front().second.picture, *film[film.size() - 2].second.picture);
}

TEST(Filming, ShowsTheTruthAndNotWhatIsBelieved) {
  const std::string quiet = replaced(two_cameras, "read_noise = 1, ", "");
  const Film believed = film_of(quiet);
  const Film same = film_of(quiet + "[truth.arm.base]\nposition = [0, 0, 0]\n");
  const Film shifted = film_of(quiet + "[truth.arm.base]\nposition = [0.1, 0, 0]\n");
  const Film turned = film_of(quiet + "[[truth.camera]]\nname = \"side\"\ninitial = { pan_deg = 2 }\n");
  ASSERT_EQ(believed.size(), turned.size());
  for (std::size_t i = 0; i < believed.size(); ++i) {
    EXPECT_EQ(*believed[i].second.picture, *same[i].second.picture) << i;
    EXPECT_NE(*believed[i].second.picture, *shifted[i].second.picture) << i;
    EXPECT_EQ(*believed[i].second.picture == *turned[i].second.picture, believed[i].first == "front") << i;
  }
}

TEST(Filming, IsKeptInTheLogAndNothingElseOfTheLogChanges) {
  const TemporaryFolder folder;
  const auto log_of = [&](const std::string& text, const char* name) {
    Quiet progress;
    const Experiment experiment = parse_experiment(text, "x.toml");
    const RunResult result = run_experiment(experiment, make_new_folder(folder.path() / name), progress);
    std::map<std::string, std::vector<std::string>> messages;
    const McapReader log(result.folder / log_file_name);
    for (const McapMessage& message : log.messages())
      messages[message.channel->topic].emplace_back(message.text());
    return messages;
  };
  auto filmed = log_of(two_cameras + "[record]\ncameras = true\nreport = false\n", "filmed");
  const auto plain = log_of(two_cameras + "[record]\nreport = false\n", "plain");
  ASSERT_EQ(filmed["/camera/front"].size(), 10U);
  ASSERT_EQ(filmed["/camera/side"].size(), 5U);
  for (const std::string& text : filmed["/camera/front"]) {
    const auto message = read_as<ImageMessage>(parse_json(text, "log"));
    EXPECT_EQ(message.format, "png");
    EXPECT_EQ(message.frame_id, "camera/front");
    EXPECT_THAT(message.data.data, ::testing::StartsWith("\x89PNG"));
  }
  filmed.erase("/camera/front");
  filmed.erase("/camera/side");
  EXPECT_EQ(filmed, plain);
}

TEST(Filming, TellsWhatIsWrongWithCamerasAndTheTruth) {
  const BadFile bad[] = {
      {"two of a name", replaced(two_cameras, "\"side\"", "\"front\""), "front"},
      {"no such camera", two_cameras + "[[truth.camera]]\nname = \"top\"\n", "nothing is named \"top\""},
      {"another arm", two_cameras + "[[truth.arm.section]]\nlength = 1\n", "the true arm has 1 sections"},
      {"unknown key", two_cameras + "[truth]\nweather = 1\n", "truth.weather: unknown key"},
      {"no focal length", replaced(two_cameras, "fx = 80", "fx = 0"), "fx = 0"},
      {"a negative length", two_cameras + "[truth.arm.base]\nposition = [0, 0]\n", "truth.arm.base.position"},
  };
  for (const BadFile& file : bad) EXPECT_THAT(error_of_file(file.text), HasSubstr(file.error)) << file.what;
}

}  // namespace
}  // namespace flexura

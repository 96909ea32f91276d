#include "flexura/camera/sensor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "flexura/base/table.h"

namespace flexura {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> problems_of(Node::Table members) {
  try {
    (void)read_as<SensorConfig>(Node{std::move(members), {}});
  } catch (const InputError& error) {
    std::vector<std::string> texts;
    for (const Problem& problem : error.problems()) texts.push_back(problem.text());
    return texts;
  }
  return {};
}

Node::Member member(std::string key, Node::Value value) {
  return {std::move(key), {}, {std::move(value), {}}};
}

std::vector<std::string> written(const SensorConfig& sensor) {
  const Node node = Codec<SensorConfig>::write(sensor);
  std::vector<std::string> lines;
  for (const Node::Member& one : *node.as<Node::Table>())
    lines.push_back(one.key + " = " + one.node.literal());
  return lines;
}

TEST(Sensor, AnEmptyTableIsACameraWithoutFaults) {
  const auto sensor = read_as<SensorConfig>(Node{Node::Table{}, {}});
  EXPECT_EQ(sensor.width, 640);
  EXPECT_EQ(sensor.channels(), 1);
  EXPECT_EQ(sensor.readout, Readout::global);
  for (const double fault : {sensor.exposure, sensor.delay, sensor.drop, sensor.full_well, sensor.read_noise,
                             sensor.psf, sensor.vignetting, sensor.row_time})
    EXPECT_EQ(fault, 0);
  EXPECT_EQ(sensor.gain, 1);
  EXPECT_EQ(sensor.gamma, 1);
}

TEST(Sensor, ReadsWhatItWrites) {
  SensorConfig sensor{
      .width = 1920, .height = 1080, .pixels = PixelKind::color, .bits = 12, .frame_rate = 25};
  sensor.exposure = 0.01, sensor.delay = 0.02, sensor.drop = 0.125, sensor.gain = 2, sensor.full_well = 1e4;
  sensor.read_noise = 1.5, sensor.psf = 0.75, sensor.vignetting = 0.25, sensor.gamma = 2.2;
  sensor.readout = Readout::rolling, sensor.row_time = 2e-5;
  sensor.covered = {{1, 2}, {4, 4.5}};
  const auto read = read_as<SensorConfig>(Codec<SensorConfig>::write(sensor));
  EXPECT_EQ(written(read), written(sensor));
  EXPECT_THAT(written(read), Contains("gamma = 2.2"));
  EXPECT_EQ(read.channels(), 3);
  EXPECT_EQ(read.row_time, 2e-5);
  EXPECT_EQ(read.covered, sensor.covered);
  EXPECT_TRUE(read.silent.empty());
}

TEST(Sensor, TakesTimesInMilliseconds) {
  EXPECT_DOUBLE_EQ(
      read_as<SensorConfig>(Node{Node::Table{member("exposure_ms", std::int64_t{20})}, {}}).exposure, 0.02);
}

TEST(Sensor, ExposesWithinAFrame) {
  EXPECT_THAT(problems_of({member("frame_rate", 50.0), member("exposure", 0.02)}), IsEmpty());
  EXPECT_THAT(
      problems_of({member("frame_rate", 50.0), member("exposure", 0.0201)}),
      ElementsAre(HasSubstr("exposure: is longer than a frame: expected at most 0.02 s at 50 frames/s")));
}

TEST(Sensor, ReadsTheRowsOfARollingShutterWithinAFrame) {
  const auto rolling = [](double row_time) {
    return problems_of({member("readout", "rolling"), member("height", std::int64_t{500}),
                        member("frame_rate", 20.0), member("row_time", row_time)});
  };
  EXPECT_THAT(rolling(1e-4), IsEmpty());
  EXPECT_THAT(rolling(1.01e-4), ElementsAre(HasSubstr("row_time: 500 rows take longer than a frame: expected "
                                                      "at most 0.0001 s at 20 frames/s")));
  EXPECT_THAT(rolling(0.0), ElementsAre(HasSubstr("row_time: is missing")));
}

TEST(Sensor, HasSpansThatEndAfterTheirBeginning) {
  const auto problems = [](const std::string& key, std::vector<std::array<double, 2>> spans) {
    SensorConfig sensor;
    (key == "covered" ? sensor.covered : sensor.silent) = std::move(spans);
    return problems_of(*Codec<SensorConfig>::write(sensor).as<Node::Table>());
  };
  for (const std::string key : {"covered", "silent"}) {
    EXPECT_THAT(problems(key, {{0, 1}, {0.5, 2}}), IsEmpty());
    EXPECT_THAT(problems(key, {{0, 1}, {2, 2}}),
                ElementsAre(HasSubstr(key + "[1]: ends at 2 s, which is not after its start")));
    EXPECT_THAT(problems(key, {{-1, 1}}), ElementsAre(HasSubstr(key)));
  }
  const std::vector<std::array<double, 2>> spans = {{1, 2}, {4, 5}};
  for (const double inside : {1.0, 1.999, 4.0}) EXPECT_TRUE(is_within(inside, spans)) << inside;
  for (const double outside : {0.999, 2.0, 5.0, 9.0}) EXPECT_FALSE(is_within(outside, spans)) << outside;
}

TEST(Sensor, HasRowTimesForARollingShutterAlone) {
  EXPECT_THAT(problems_of({member("row_time", 1e-5)}),
              ElementsAre(HasSubstr("row_time: is only for readout = \"rolling\"")));
  EXPECT_THAT(problems_of({member("row_time", 1e-5), member("readout", "interlaced")}),
              ElementsAre(HasSubstr("row_time: is only for readout")));
}

TEST(Sensor, KeepsEveryFieldWithinItsRange) {
  for (const std::string key : {"width", "height", "bits"})
    EXPECT_THAT(problems_of({member(key, std::int64_t{0})}), ElementsAre(HasSubstr(key + " = 0"))) << key;
  EXPECT_THAT(problems_of({member("bits", std::int64_t{17})}), ElementsAre(HasSubstr("from 1 to 16")));
  for (const std::string key : {"frame_rate", "gain", "gamma"})
    EXPECT_THAT(problems_of({member(key, 0.0)}), ElementsAre(HasSubstr(key + " = 0"))) << key;
  for (const std::string key :
       {"exposure", "delay", "drop", "full_well", "read_noise", "psf", "vignetting", "row_time"})
    EXPECT_THAT(problems_of({member(key, -1e-9)}), ElementsAre(HasSubstr(key + " = -1e-09"))) << key;
  for (const std::string key : {"drop", "vignetting"})
    EXPECT_THAT(problems_of({member(key, 1.01)}), ElementsAre(HasSubstr("from 0 to 1"))) << key;
}

TEST(Sensor, IsNotLargerThanTheMemory) {
  EXPECT_THAT(problems_of({member("width", std::int64_t{16384}), member("height", std::int64_t{4096})}),
              IsEmpty());
  EXPECT_THAT(problems_of({member("width", std::int64_t{16384}), member("height", std::int64_t{4097})}),
              ElementsAre(HasSubstr("height: 16384 x 4097 pixels: expected at most 67108864")));
}

}  // namespace
}  // namespace flexura

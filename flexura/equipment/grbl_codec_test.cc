#include "flexura/equipment/grbl_codec.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <variant>

namespace flexura {
namespace {

using testing::ElementsAre;

// Messages as in gnea/grbl, doc/markdown/interface.md: "Real-time Status Reports", "Start Up Message",
// "Grbl $ Settings Message", "Feedback Messages", "Alarm Message".
TEST(GrblCodec, ReadsTheManualsExamples) {
  const auto idle = std::get<GrblStatus>(parse_grbl("<Idle|MPos:0.000,-10.000,5.000|FS:0.0,0>"));
  EXPECT_EQ(idle.state, GrblState::idle);
  EXPECT_THAT(idle.positions, ElementsAre(0, -10, 5));
  EXPECT_FALSE(idle.is_work);
  const auto hold =
      std::get<GrblStatus>(parse_grbl("<Hold:1|WPos:-2.500,0.000,11.000|Bf:15,128|Ln:99999|FS:500,8000|WCO:0."
                                      "000,1.551,5.664|Pn:XYZPDHRS|Ov:100,100,"
                                      "100|A:SFM>"));
  EXPECT_EQ(hold.state, GrblState::hold);
  EXPECT_EQ(hold.part, 1);
  EXPECT_TRUE(hold.is_work);
  EXPECT_THAT(hold.offset, ElementsAre(0, 1.551, 5.664));
  EXPECT_EQ(hold.free_blocks, 15);
  EXPECT_EQ(hold.free_bytes, 128);
  EXPECT_EQ(hold.feed, 500);
  EXPECT_EQ(hold.pins, "XYZPDHRS");
  EXPECT_EQ(std::get<GrblBanner>(parse_grbl("Grbl 1.1h ['$' for help]")).name, "Grbl 1.1h");
  EXPECT_EQ(std::get<GrblBanner>(parse_grbl("GrblHAL 1.1f ['$' or '$HELP' for help]")).name, "GrblHAL 1.1f");
  EXPECT_EQ(std::get<GrblSetting>(parse_grbl("$100=250.000")).number, 100);
  EXPECT_EQ(std::get<GrblSetting>(parse_grbl("$100=250.000")).value, "250.000");
  EXPECT_EQ(std::get<GrblFeedback>(parse_grbl("[VER:1.1d.20161014:Some string]")).text,
            "1.1d.20161014:Some string");
  EXPECT_EQ(std::get<GrblFeedback>(parse_grbl("[MSG:'$H'|'$X' to unlock]")).type, "MSG");
  EXPECT_EQ(std::get<GrblAlarm>(parse_grbl("ALARM:1")).code, 1);
  EXPECT_EQ(std::get<GrblError>(parse_grbl("error:20")).code, 20);
  EXPECT_TRUE(std::holds_alternative<GrblOk>(parse_grbl("ok")));
  // The ok of a startup line answers no line of ours.
  EXPECT_TRUE(std::holds_alternative<GrblUnknown>(parse_grbl(">G54G20:ok")));
}

TEST(GrblCodec, TakesNoPartOfAReport) {
  const std::string whole = "<Jog|MPos:1.250,2.500,-3.750|Bf:14,127|FS:100,0|WCO:0.000,0.000,0.000>";
  ASSERT_TRUE(std::holds_alternative<GrblStatus>(parse_grbl(whole)));
  for (std::size_t i = 0; i < whole.size(); ++i)
    EXPECT_TRUE(std::holds_alternative<GrblUnknown>(parse_grbl(whole.substr(0, i)))) << i;
  for (const char* const bad :
       {"<Idle>", "<Idle|>", "<Idle|MPos:>", "<Idle|MPos:1,>", "<Idle|MPos:1,,2>", "<Idle|MPos:inf>",
        "<Idle|MPos:1e3>", "<Idle|MPos:0x1>", "<Idle|MPos:1|MPos:2>", "<Idle|MPos:1,2|WCO:1>",
        "<Lost|MPos:1>", "<Idle:x|MPos:1>", "<Idle|MPos:1,2,3,4,5,6,7,8,9>", "<Idle|MPos:1-2>",
        "error:", "error:x", "ALARM:", "$=1"})
    EXPECT_TRUE(std::holds_alternative<GrblUnknown>(parse_grbl(bad))) << bad;
}

TEST(GrblCodec, PrintsWhatItReads) {
  const GrblStatus status{.state = GrblState::jog,
                          .positions = {1.25, -2},
                          .offset = {0, 1},
                          .free_blocks = 3,
                          .free_bytes = 99,
                          .feed = 60,
                          .pins = "X"};
  const auto again = std::get<GrblStatus>(parse_grbl(text(status)));
  EXPECT_EQ(again.state, status.state);
  EXPECT_EQ(again.positions, status.positions);
  EXPECT_EQ(again.offset, status.offset);
  EXPECT_EQ(again.free_bytes, status.free_bytes);
  EXPECT_EQ(again.pins, status.pins);
}

TEST(GrblCodec, ExplainsNumbers) {
  EXPECT_EQ(grbl_error_meaning(15), "the target is outside the travel (settings $130 and following)");
  EXPECT_EQ(grbl_alarm_meaning(1), "a limit switch was hit in motion, the position is lost");
  EXPECT_EQ(grbl_alarm_meaning(99), "no meaning is documented for this number");
}

TEST(GrblCodec, CutsLinesAndLeavesOutEndlessOnes) {
  GrblLines lines;
  EXPECT_THAT(lines.add("o"), ElementsAre());
  EXPECT_THAT(lines.add("k\r\n\r\nerror:1\r\nGr"), ElementsAre("ok", "error:1"));
  EXPECT_THAT(lines.add(std::string(10000, 'x')), ElementsAre());
  EXPECT_THAT(lines.add("\nok\n"), ElementsAre("ok"));
}

TEST(GrblCodec, WritesJogsThatFitIntoALine) {
  EXPECT_EQ(grbl_jog("XZ", std::vector<double>{1.5, -0.000001}, 90), "$J=G90G21G53X1.5Z0F90.000\n");
  const std::vector<double> longest(3, -12345.12345);
  EXPECT_LE(grbl_jog("XYZ", longest, 123456.789).size(), grbl::longest_line);
}

// Grbl reads and prints numbers in 32-bit floating point: at most 8 digits of a word (gnea/grbl, nuts_bolts.c
// read_float), and 3 decimals (print.c printFloat).
float read_as_grbl(const std::string& word) {
  float value = 0;
  int digits = 0, decimals = 0;
  bool is_negative = false, is_decimal = false;
  std::uint32_t whole = 0;
  for (const char c : word) {
    if (c == '-') is_negative = true;
    if (c == '.') is_decimal = true;
    if (c < '0' || c > '9') continue;
    if (++digits > 8) {
      if (!is_decimal) ++decimals;
      continue;
    }
    whole = 10 * whole + static_cast<std::uint32_t>(c - '0');
    if (is_decimal) --decimals;
  }
  value = static_cast<float>(whole);
  for (; decimals <= -2; decimals += 2) value *= 0.01F;
  if (decimals < 0) value *= 0.1F;
  return is_negative ? -value : value;
}

TEST(GrblCodec, WholeStepsSurviveTheWayThroughTheController) {
  std::mt19937_64 random(3);
  for (const double per_mm : {1.0, 26.67, 80.0, 100.0, 160.0, 250.0, 320.0, 400.0, 500.0}) {
    std::uniform_int_distribution<std::int64_t> any(-2097152, 2097152);
    for (int i = 0; i < 2000; ++i) {
      const std::int64_t steps = i < 100 ? i - 50 : any(random);
      const std::string line = grbl_jog("X", std::vector<double>{static_cast<double>(steps) / per_mm}, 1);
      const std::string word = line.substr(13, line.find('F') - 13);
      const float target = read_as_grbl(word);
      EXPECT_EQ(std::lround(target * static_cast<float>(per_mm)), steps) << line;
      const float there = static_cast<float>(steps) / static_cast<float>(per_mm);
      const double printed = std::round(static_cast<double>(there) * 1000) / 1000;
      EXPECT_EQ(std::llround(printed * per_mm), steps) << line;
    }
  }
}

}  // namespace
}  // namespace flexura

#include "flexura/report/charts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/report/report.h"

namespace flexura {
namespace {

using testing::ElementsAre;

const LineChart& chart_of(const std::vector<ReportFigure>& charts, const std::string& name) {
  for (const ReportFigure& chart : charts)
    if (chart.name == name) return std::get<LineChart>(chart.content);
  throw std::invalid_argument("no chart " + name);
}

ReportData run_of(ArmKind kind, const std::vector<Eigen::Vector2d>& bends) {
  ReportData data;
  data.arm.kind = kind;
  data.arm.sections.resize(bends.size(), {.length = 2});
  const ArmState straight = ArmState::straight(bends.size());
  data.times = {0, 1}, data.states = {straight, straight};
  data.states[1].bends = bends;
  return data;
}

TEST(Charts, OfAPlanarArmAreInDegreesAndMetres) {
  // Archings of 10 and -30 degrees of an upright arm.
  const auto charts = charts_of(motion_of(run_of(ArmKind::planar, {{-20 * degree, 0}, {60 * degree, 0}})));
  const std::vector<std::vector<double>> bends = {{0, -20}, {0, 60}}, archings = {{0, 10}, {0, -30}},
                                         cords = {{90, 100}, {90, 80}};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(chart_of(charts, "bends").series.at(i).values.at(k), bends[i][k], 1e-12);
      EXPECT_NEAR(chart_of(charts, "archings").series.at(i).values.at(k), archings[i][k], 1e-12);
      EXPECT_NEAR(chart_of(charts, "cord-angles").series.at(i).values.at(k), cords[i][k], 1e-12);
    }
  }
  EXPECT_NEAR(chart_of(charts, "tip").series.at(1).values.at(0), 4, 1e-12);
}

TEST(Charts, OfASpatialArmHaveBothBends) {
  ReportData data = run_of(ArmKind::spatial, {{20 * degree, -45 * degree}});
  data.states[1].stretches[0] = 1.25;
  const auto charts = charts_of(motion_of(data));
  EXPECT_NEAR(chart_of(charts, "bends-x").series.at(0).values.at(1), 20, 1e-12);
  EXPECT_NEAR(chart_of(charts, "bends-y").series.at(0).values.at(1), -45, 1e-12);
  EXPECT_THAT(chart_of(charts, "stretches").series.at(0).values, ElementsAre(1, 1.25));
  EXPECT_EQ(chart_of(charts, "tip").series.size(), 3U);
}

}  // namespace
}  // namespace flexura

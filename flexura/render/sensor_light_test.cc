#include "flexura/render/sensor_light.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace flexura {
namespace {

// Light equal to the time everywhere; counts the calls and the rows drawn.
struct Clock {
  int goes = 0, rows_drawn = 0;

  DrawLight draw() {
    return [this](double time, const Rows& rows, Image<float>& light) {
      ++goes;
      for (int v = rows.first; v < rows.last; v += rows.step) {
        ++rows_drawn;
        for (float& value : light.row(v)) value = static_cast<float>(time);
      }
    };
  }
};

Image<float> light_of(const SensorConfig& sensor, double start, int instants, Clock& clock) {
  Image<float> light, scratch;
  gather_light(sensor, start, instants, clock.draw(), light, scratch);
  return light;
}

TEST(SensorLight, AGlobalShutterDrawsOneInstant) {
  Clock clock;
  const SensorConfig sensor{.width = 5, .height = 7, .pixels = PixelKind::color};
  EXPECT_EQ(light_of(sensor, 2.5, 8, clock), (Image<float>(5, 7, 3, 2.5f)));
  EXPECT_EQ(clock.goes, 1);
}

TEST(SensorLight, AnExposureIsTheMeanOfItsInstants) {
  const SensorConfig sensor{.width = 3, .height = 2, .exposure = 0.5};
  for (const int instants : {1, 2, 5}) {
    Clock clock;
    const Image<float> light = light_of(sensor, 1, instants, clock);
    for (const float value : light.values()) EXPECT_NEAR(value, 1.25, 1e-6);
    EXPECT_EQ(clock.goes, instants);
  }
}

TEST(SensorLight, ARollingShutterExposesEachRowLater) {
  const SensorConfig sensor{
      .width = 2, .height = 9, .exposure = 0.125, .readout = Readout::rolling, .row_time = 0.0625};
  Clock clock;
  const Image<float> light = light_of(sensor, 4, 4, clock);
  for (int v = 0; v < 9; ++v) EXPECT_NEAR(light.at(1, v), 4 + 0.0625 * v + 0.0625, 1e-6);
  EXPECT_EQ(clock.rows_drawn, 9 * 4);
}

TEST(SensorLight, InterlacedFieldsAreHalfAFrameApart) {
  for (const int height : {1, 2, 7}) {
    const SensorConfig sensor{.width = 2, .height = height, .frame_rate = 25, .readout = Readout::interlaced};
    Clock clock;
    const Image<float> light = light_of(sensor, 1, 1, clock);
    for (int v = 0; v < height; ++v) EXPECT_FLOAT_EQ(light.at(0, v), v % 2 == 0 ? 1.0f : 1.02f);
    EXPECT_EQ(clock.rows_drawn, height);
  }
}

TEST(SensorLight, RefusesAFrameWithoutInstants) {
  Image<float> light, scratch;
  Clock clock;
  EXPECT_THROW(gather_light({}, 0, 0, clock.draw(), light, scratch), std::invalid_argument);
}

}  // namespace
}  // namespace flexura

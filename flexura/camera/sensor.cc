#include "flexura/camera/sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "flexura/base/table.h"

namespace flexura {
namespace {

// Limits above those of any camera, which prevent a faulty file from exhausting memory.
constexpr double max_side = 16384;
constexpr double max_pixels = 1 << 26;

void check_sensor(const SensorConfig& sensor, Reader& reader) {
  const auto width = static_cast<double>(sensor.width), height = static_cast<double>(sensor.height);
  if (width * height > max_pixels) {
    reader.problem_at("height", fmt::format("{} x {} pixels: expected at most {}", sensor.width,
                                            sensor.height, max_pixels));
  }
  for (const auto& [key, spans] : {std::pair{"covered", &sensor.covered}, {"silent", &sensor.silent}})
    for (std::size_t i = 0; i < spans->size(); ++i)
      if (!((*spans)[i][0] < (*spans)[i][1]))
        reader.problem_at(fmt::format("{}[{}]", key, i),
                          fmt::format("ends at {:.6g} s, which is not after its start: expected [from, to]",
                                      (*spans)[i][1]));
  const double frame = 1 / sensor.frame_rate;
  if (sensor.exposure > frame) {
    reader.problem_at(
        "exposure", fmt::format("is longer than a frame: expected at most {:.6g} s at {:.6g} frames/s", frame,
                                sensor.frame_rate));
  }
  const bool is_rolling = sensor.readout == Readout::rolling;
  if (is_rolling && sensor.row_time == 0) {
    reader.problem_at("row_time", "is missing: a rolling shutter needs the time between two rows");
  }
  if (!is_rolling && sensor.row_time > 0) {
    reader.problem_at("row_time", "is only for readout = \"rolling\"");
  }
  if (is_rolling && sensor.row_time * height > frame) {
    reader.problem_at(
        "row_time",
        fmt::format("{} rows take longer than a frame: expected at most {:.6g} s at {:.6g} frames/s",
                    sensor.height, frame / height, sensor.frame_rate));
  }
}

// Adds the fields for format and timing of frames.
void add_frames(Table<SensorConfig>& table) {
  table.field("width", &SensorConfig::width, {.meaning = "Image width, px.", .range = between(1, max_side)})
      .field("height", &SensorConfig::height, {.meaning = "Image height, px.", .range = between(1, max_side)})
      .field("pixels", &SensorConfig::pixels,
             {.meaning = "Channels of a pixel: one gray value or three colour values."})
      .field("bits", &SensorConfig::bits,
             {.meaning = "Bits per value. Values of more than 8 bits are stored in 16.",
              .range = between(1, 16)})
      .field("frame_rate", &SensorConfig::frame_rate,
             {.meaning = "Frame rate, Hz.", .range = above_up_to(0, 1e6)})
      .field("exposure", &SensorConfig::exposure,
             {.meaning = "Exposure time of a frame, with motion blur; 0: instantaneous.",
              .unit = Unit::second,
              .range = between(0, 1e3)})
      .field("delay", &SensorConfig::delay,
             {.meaning = "Delay from the end of the exposure to the arrival of the frame.",
              .unit = Unit::second,
              .range = between(0, 1e3)})
      .field("drop", &SensorConfig::drop,
             {.meaning = "Fraction of the frames that are lost.", .range = between(0, 1)})
      .field("covered", &SensorConfig::covered,
             {.meaning = "Intervals [from, to], s from the experiment's start, in which the lens is covered "
                         "and pictures are dark.",
              .unit = Unit::second,
              .range = between(0, 1e6)})
      .field("silent", &SensorConfig::silent,
             {.meaning =
                  "Intervals [from, to], s from the experiment's start, in which the camera does not answer.",
              .unit = Unit::second,
              .range = between(0, 1e6)})
      .field(
          "readout", &SensorConfig::readout,
          {.meaning =
               "Readout: all rows at once, row by row, or even rows first and odd rows half a frame later."})
      .field("row_time", &SensorConfig::row_time,
             {.meaning = "Time between two rows of a rolling shutter.",
              .unit = Unit::second,
              .range = between(0, 1)});
}

// Adds the fields for effects on the light, in physical order.
void add_effects(Table<SensorConfig>& table) {
  table
      .field("vignetting", &SensorConfig::vignetting,
             {.meaning = "Fraction of the light lost in the image's corners. The loss increases with the "
                         "square of the distance from the middle.",
              .range = between(0, 1)})
      .field("psf", &SensorConfig::psf,
             {.meaning = "Standard deviation of the Gaussian blur of lens and pixel, px.",
              .range = between(0, 20)})
      .field("full_well", &SensorConfig::full_well,
             {.meaning = "Electrons at full scale and gain 1. Shot noise is the square root of the electron "
                         "count; 0: no shot noise.",
              .range = between(0, 1e9)})
      .field("gain", &SensorConfig::gain,
             {.meaning = "Factor on the light and its shot noise.", .range = above_up_to(0, 1e3)})
      .field("read_noise", &SensorConfig::read_noise,
             {.meaning = "Standard deviation of the read noise, in values of an 8-bit image.",
              .range = between(0, 255)})
      .field("gamma", &SensorConfig::gamma,
             {.meaning = "Gamma: pixel value is light to the power 1/gamma.", .range = between(0.1, 10)});
}

}  // namespace

double row_delay(const SensorConfig& sensor, int v) {
  if (sensor.readout == Readout::rolling) return v * sensor.row_time;
  return sensor.readout == Readout::interlaced && v % 2 == 1 ? 0.5 / sensor.frame_rate : 0;
}

double last_row_delay(const SensorConfig& sensor) {
  const auto last = static_cast<int>(sensor.height) - 1;
  return std::max(row_delay(sensor, last), row_delay(sensor, std::max(last - 1, 0)));
}

FrameTimes times_of_frame_at(const SensorConfig& sensor, double start) {
  const double last_row = last_row_delay(sensor);  // Delay of the last row after the first row.
  FrameTimes times;
  times.start = start;
  times.middle = start + 0.5 * (last_row + sensor.exposure);
  times.end = start + last_row + sensor.exposure;
  times.received = times.end + sensor.delay;
  return times;
}

FrameTimes frame_times(const SensorConfig& sensor, std::int64_t frame) {
  return times_of_frame_at(sensor, static_cast<double>(frame) / sensor.frame_rate);
}

bool is_within(double time, const std::vector<std::array<double, 2>>& spans) {
  return std::ranges::any_of(spans, [&](const auto& span) { return time >= span[0] && time < span[1]; });
}

const std::vector<std::string>& names_of(const PixelKind*) {
  static const std::vector<std::string> names{"gray", "color"};
  return names;
}

const std::vector<std::string>& names_of(const Readout*) {
  static const std::vector<std::string> names{"global", "rolling", "interlaced"};
  return names;
}

const Table<SensorConfig>& fields_of(const SensorConfig*) {
  static const auto table = [] {
    Table<SensorConfig> result("sensor", "Image sensor: resolution, timing and noise.");
    add_frames(result);
    add_effects(result);
    result.check(check_sensor);
    return result;
  }();
  return table;
}

}  // namespace flexura

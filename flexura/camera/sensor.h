#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/base/fields.h"

namespace flexura {

/// What a pixel holds: one value, or red, green and blue.
enum class PixelKind { gray, color };

/// How rows become an image: all at once, one after another, or the even rows of one instant and the odd ones
/// of half a frame later.
enum class Readout { global, rolling, interlaced };

/// What turns the light on a camera's image plane into numbers. Everything that makes an image worse is off
/// by default. render/sensor_image.h does it.
///
/// Light is measured in units of the sensor's full scale: 1 is where the quantizer ends at gain 1.
struct SensorConfig {
  std::int64_t width = 640, height = 480;  ///< px
  PixelKind pixels = PixelKind::gray;
  std::int64_t bits = 8;   ///< Of each value; 1 to 16.
  double frame_rate = 30;  ///< Hz
  double exposure = 0;     ///< s during which a frame gathers light; motion blurs over it. 0: an instant.
  double delay = 0;        ///< s from the end of the exposure until the frame can be had.
  double drop = 0;         ///< The share of frames that are lost.
  /// From one time to another, s: something covers the lens, the camera does not answer.
  std::vector<std::array<double, 2>> covered = {}, silent = {};
  double gain = 1;        ///< Factor on the light before it is read out; it amplifies shot noise too.
  double full_well = 0;   ///< Electrons at full scale and gain 1; sets the shot noise. 0: no shot noise.
  double read_noise = 0;  ///< Standard deviation in values of an 8-bit image.
  double psf = 0;         ///< Standard deviation of the Gaussian blur of lens and pixel, px.
  double vignetting = 0;  ///< Share of light lost in the image's corners; grows with the radius squared.
  double gamma = 1;       ///< Values are light to the power 1/gamma.
  Readout readout = Readout::global;
  double row_time = 0;  ///< s between two rows of a rolling shutter; with Readout::rolling alone.

  /// Values a pixel: 1 or 3.
  [[nodiscard]] int channels() const { return pixels == PixelKind::color ? 3 : 1; }
  /// The largest value of a pixel: 2^bits - 1.
  [[nodiscard]] constexpr int white() const { return (1 << bits) - 1; }
};

/// How long after the frame's own beginning row v begins to gather light, s: v row times with a rolling
/// shutter, half a frame for the odd rows of an interlaced image, else 0.
[[nodiscard]] double row_delay(const SensorConfig& sensor, int v);
/// The same of the row that begins last.
[[nodiscard]] double last_row_delay(const SensorConfig& sensor);

/// When a frame of a sensor is exposed and can be had.
struct FrameTimes {
  double start = 0;     ///< Of the first row's exposure, s.
  double middle = 0;    ///< Of the exposure of the middle of the image, s.
  double end = 0;       ///< Of the last row's exposure, s.
  double received = 0;  ///< end + delay, s.
};
/// Of a frame that starts at `start`, s.
[[nodiscard]] FrameTimes times_of_frame_at(const SensorConfig& sensor, double start);
/// Of frame number `frame`, which starts at frame / frame_rate.
[[nodiscard]] FrameTimes frame_times(const SensorConfig& sensor, std::int64_t frame);

/// Whether a time, s, is in one of the spans [from, to).
[[nodiscard]] bool is_within(double time, const std::vector<std::array<double, 2>>& spans);

const std::vector<std::string>& names_of(const PixelKind*);
const std::vector<std::string>& names_of(const Readout*);
const Table<SensorConfig>& fields_of(const SensorConfig*);

}  // namespace flexura

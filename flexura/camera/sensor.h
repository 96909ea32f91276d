#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/base/fields.h"

namespace flexura {

/// Channels of a pixel: one gray value, or red, green and blue.
enum class PixelKind { gray, color };

/// Readout of an image's rows. `global`: all rows at once. `rolling`: one row after another. `interlaced`:
/// even rows first, odd rows half a frame later.
enum class Readout { global, rolling, interlaced };

/// Sensor of a camera, which converts light on the image plane to pixel values. All degrading effects are off
/// by default. render/sensor_image.h implements the conversion.
///
/// Light is in units of the sensor's full scale: at gain 1, light 1 gives the largest pixel value.
struct SensorConfig {
  std::int64_t width = 640, height = 480;  ///< Size, px.
  PixelKind pixels = PixelKind::gray;
  std::int64_t bits = 8;   ///< Bits per pixel value, 1 to 16.
  double frame_rate = 30;  ///< Frame rate, Hz.
  double exposure = 0;     ///< Exposure time of a frame, with motion blur, s; 0: instantaneous.
  double delay = 0;        ///< Delay from the end of the exposure to the arrival of the frame, s.
  double drop = 0;         ///< Fraction of the frames that are lost.
  /// Intervals [from, to), s, in which the lens is covered (`covered`) or the camera does not answer
  /// (`silent`).
  std::vector<std::array<double, 2>> covered = {}, silent = {};
  double gain = 1;  ///< Factor on the light before readout. It also amplifies shot noise.
  /// Number of electrons at full scale and gain 1. It determines the shot noise; 0: no shot noise.
  double full_well = 0;
  double read_noise = 0;  ///< Standard deviation of the read noise, in values of an 8-bit image.
  double psf = 0;         ///< Standard deviation of the Gaussian blur of lens and pixels, px.
  double vignetting = 0;  ///< Fraction of the light lost in the image's corners. The loss increases with the
                          ///< square of the distance from the middle.
  double gamma = 1;       ///< Gamma: pixel values are light to the power 1/gamma.
  Readout readout = Readout::global;
  double row_time = 0;  ///< Time between two rows of a rolling shutter, s; only with Readout::rolling.

  /// Returns the number of values per pixel: 1 or 3.
  [[nodiscard]] int channels() const { return pixels == PixelKind::color ? 3 : 1; }
  /// Returns the largest value of a pixel: 2^bits - 1.
  [[nodiscard]] constexpr int white() const { return (1 << bits) - 1; }
};

/// Returns the delay from the start of the frame to the start of row v's exposure, s. With a rolling shutter,
/// the delay is v * row_time. For odd rows of an interlaced image, it is half a frame. Otherwise it is 0.
[[nodiscard]] double row_delay(const SensorConfig& sensor, int v);
/// Returns the largest row delay of a frame, s.
[[nodiscard]] double last_row_delay(const SensorConfig& sensor);

/// Times of a frame since the start of the run.
struct FrameTimes {
  double start = 0;     ///< Start of the first row's exposure, s.
  double middle = 0;    ///< Mean of `start` and `end`, s.
  double end = 0;       ///< End of the last row's exposure, s.
  double received = 0;  ///< Arrival of the frame: end + delay, s.
};
/// Returns the times of a frame that starts at time `start`, s.
[[nodiscard]] FrameTimes times_of_frame_at(const SensorConfig& sensor, double start);
/// Returns the times of frame number `frame`, counted from 0. The frame starts at frame / frame_rate.
[[nodiscard]] FrameTimes frame_times(const SensorConfig& sensor, std::int64_t frame);

/// Returns whether a time, s, is in one of the intervals [from, to), s.
[[nodiscard]] bool is_within(double time, const std::vector<std::array<double, 2>>& spans);

const std::vector<std::string>& names_of(const PixelKind*);
const std::vector<std::string>& names_of(const Readout*);
const Table<SensorConfig>& fields_of(const SensorConfig*);

}  // namespace flexura

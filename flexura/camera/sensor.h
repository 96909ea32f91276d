#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/base/fields.h"

namespace flexura {

/// Content of a pixel: one value, or red, green and blue.
enum class PixelKind { gray, color };

/// Readout of an image's rows: all at once, one after another, or the even rows at one instant and the odd
/// ones half a frame later.
enum class Readout { global, rolling, interlaced };

/// Conversion of light on a camera's image plane to values. All degrading effects are off by default.
/// render/sensor_image.h implements it.
///
/// Light is in units of the sensor's full scale: 1 is the end of the quantizer's range at gain 1.
struct SensorConfig {
  std::int64_t width = 640, height = 480;  ///< Size, px.
  PixelKind pixels = PixelKind::gray;
  std::int64_t bits = 8;   ///< Bits of each value, 1 to 16.
  double frame_rate = 30;  ///< Frame rate, Hz.
  double exposure = 0;     ///< Duration for which a frame gathers light, s, with motion blur. 0: an instant.
  double delay = 0;        ///< Delay from the end of the exposure until the frame is available, s.
  double drop = 0;         ///< Share of lost frames.
  /// Intervals, s, in which something covers the lens, or the camera does not answer.
  std::vector<std::array<double, 2>> covered = {}, silent = {};
  double gain = 1;       ///< Factor on the light before readout; it amplifies shot noise, too.
  double full_well = 0;  ///< Electrons at full scale and gain 1; determines the shot noise. 0: no shot noise.
  double read_noise = 0;  ///< Standard deviation of the read noise, in values of an 8-bit image.
  double psf = 0;         ///< Standard deviation of the Gaussian blur of lens and pixel, px.
  double vignetting = 0;  ///< Share of light lost in the image's corners; grows with the radius squared.
  double gamma = 1;       ///< Gamma: values are light to the power 1/gamma.
  Readout readout = Readout::global;
  double row_time = 0;  ///< Time between two rows of a rolling shutter, s; only with Readout::rolling.

  /// Returns the number of values per pixel: 1 or 3.
  [[nodiscard]] int channels() const { return pixels == PixelKind::color ? 3 : 1; }
  /// Returns the largest value of a pixel: 2^bits - 1.
  [[nodiscard]] constexpr int white() const { return (1 << bits) - 1; }
};

/// Returns the delay from the frame's beginning until row v begins to gather light, s. It is v row times with
/// a rolling shutter, half a frame for the odd rows of an interlaced image, otherwise 0.
[[nodiscard]] double row_delay(const SensorConfig& sensor, int v);
/// Returns the delay of the row that begins last.
[[nodiscard]] double last_row_delay(const SensorConfig& sensor);

/// Times of a frame.
struct FrameTimes {
  double start = 0;     ///< Start of the first row's exposure, s.
  double middle = 0;    ///< Middle of the exposure in the middle of the image, s.
  double end = 0;       ///< End of the last row's exposure, s.
  double received = 0;  ///< end + delay, s.
};
/// Returns the times of a frame that starts at `start`, s.
[[nodiscard]] FrameTimes times_of_frame_at(const SensorConfig& sensor, double start);
/// Returns the times of frame number `frame`, which starts at frame / frame_rate.
[[nodiscard]] FrameTimes frame_times(const SensorConfig& sensor, std::int64_t frame);

/// Returns whether a time, s, is in one of the spans [from, to).
[[nodiscard]] bool is_within(double time, const std::vector<std::array<double, 2>>& spans);

const std::vector<std::string>& names_of(const PixelKind*);
const std::vector<std::string>& names_of(const Readout*);
const Table<SensorConfig>& fields_of(const SensorConfig*);

}  // namespace flexura

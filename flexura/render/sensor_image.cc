#include "flexura/render/sensor_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "flexura/math/hash.h"
#include "flexura/render/psf.h"

namespace flexura {
namespace {

const SensorKernels& kernels_of(SimdPath path) {
  require_simd_path(path);
  if (path == SimdPath::avx512) return *avx512_sensor_kernels();
  return path == SimdPath::avx2 ? *avx2_sensor_kernels() : *baseline_sensor_kernels();
}

const SensorConfig& checked(const SensorConfig& config) {
  const auto require = [](bool holds, const char* message) {
    if (!holds) throw std::invalid_argument(message);
  };
  require(config.width >= 1 && config.height >= 1 && config.width <= 1 << 20 && config.height <= 1 << 20,
          "a sensor needs from 1 to 2^20 pixels a side");
  require(config.bits >= 1 && config.bits <= 16, "a sensor has from 1 to 16 bits");
  for (const double strength : {config.full_well, config.read_noise, config.psf, config.vignetting})
    require(std::isfinite(strength) && strength >= 0, "a sensor's effect must be finite and not negative");
  for (const double factor : {config.gain, config.gamma})
    require(std::isfinite(factor) && factor > 0, "a sensor's gain and gamma must be positive");
  require(config.psf <= 100, "a sensor's PSF must be at most 100 px");
  return config;
}

int top_of(const SensorConfig& config) { return (1 << config.bits) - 1; }

// In levels, rounding included; before a gamma table in units of full scale.
SensorLevels levels_for(const SensorConfig& config) {
  const bool is_linear = config.gamma == 1;
  const double unit = is_linear ? top_of(config) : 1, gain = config.gain * unit;
  const double shot = config.full_well > 0 ? gain * gain / config.full_well : 0;
  const double read = config.read_noise / 255 * unit;
  return {static_cast<float>(gain),
          is_linear ? 0.5f : 0.0f,
          static_cast<float>(shot),
          static_cast<float>(read * read),
          static_cast<float>(is_linear ? unit + 0.5 : 1),
          shot > 0 || read > 0};
}

NoiseRow noise_of(const NoiseStream& stream, int v) {
  const std::uint64_t key = hash(stream.seed, stream.camera, stream.frame, static_cast<std::uint64_t>(v));
  return {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)};
}

// (x - middle)^2 of n pixels.
double square_from_middle(int x, int n) {
  const double distance = x - 0.5 * (n - 1);
  return distance * distance;
}

}  // namespace

Sensor::Sensor(const SensorConfig& config, SimdPath path)
    : config_(checked(config)),
      kernels_(&kernels_of(path)),
      width_(static_cast<int>(config.width)),
      height_(static_cast<int>(config.height)),
      channels_(static_cast<std::size_t>(config.channels())),
      weights_(flexura::psf_weights(config.psf)),
      levels_(levels_for(config)) {
  radius_ = static_cast<int>(weights_.size()) - 1;
  count_ = static_cast<std::size_t>(width_) * channels_;
  const std::size_t block = sensor_block * channels_;
  padded_ = (count_ + block - 1) / block * block;
  if (config.gamma != 1) gamma_ = GammaTable(config.gamma, top_of(config));
  if (config.vignetting == 0) return;
  const double corner = square_from_middle(0, width_) + square_from_middle(0, height_);
  for (int u = 0; u < width_; ++u) {
    const double lost = corner > 0 ? config.vignetting * square_from_middle(u, width_) / corner : 0;
    lost_across_.insert(lost_across_.end(), channels_, static_cast<float>(lost));
  }
}

void Sensor::reserve(SensorRows& rows) const {
  const auto radius = static_cast<std::size_t>(radius_);
  // The comparison for flat blocks reads a little further than the taps.
  rows.conditioned.resize(padded_ + 2 * radius * channels_ + 16);
  rows.blurred.resize((2 * radius + 1) * padded_);
  rows.light.resize(padded_), rows.levels.resize(padded_);
  rows.window.resize(2 * radius + 1);
  rows.changed.resize(padded_ / (sensor_block * channels_));
  rows.flags.resize(rows.changed.size());
}

// Row v of the light, within its edges' continuation.
void Sensor::condition(const Image<float>& light, int v, SensorRows& rows) const {
  const std::size_t reach = static_cast<std::size_t>(radius_) * channels_;
  float* const row = rows.conditioned.data() + reach;
  float down = 0;
  if (!lost_across_.empty() && height_ > 1) {
    const double corner = square_from_middle(0, width_) + square_from_middle(0, height_);
    down = static_cast<float>(config_.vignetting * square_from_middle(v, height_) / corner);
  }
  kernels_->condition(light.row(v).data(), lost_across_.empty() ? nullptr : lost_across_.data(), down, row,
                      count_);
  for (std::size_t i = 0; i < reach; ++i)
    row[-1 - static_cast<std::ptrdiff_t>(i)] = row[channels_ - 1 - i % channels_];
  for (float* to = row + count_; to < rows.conditioned.data() + rows.conditioned.size(); ++to)
    *to = *(to - channels_);
}

// Takes row v of the light, blurred along the row.
void Sensor::push(const Image<float>& light, int v, bool is_first, SensorRows& rows) const {
  condition(light, v, rows);
  const auto radius = static_cast<std::size_t>(radius_);
  const auto slot = [&](int row) {
    return rows.blurred.data() + static_cast<std::size_t>(row % (2 * radius_ + 1)) * padded_;
  };
  kernels_->blur_across(rows.conditioned.data() + radius * channels_, slot(v), padded_, channels_,
                        weights_.data() + 1, radius);
  if (is_first) {
    std::ranges::fill(rows.changed, v);
    return;
  }
  kernels_->compare(slot(v), slot(v - 1), padded_, channels_, rows.flags.data());
  for (std::size_t i = 0; i < rows.flags.size(); ++i)
    if (rows.flags[i] == 0) rows.changed[i] = v;
}

// Row v blurred both ways, once all rows within the radius were pushed.
const float* Sensor::blurred(int v, SensorRows& rows) const {
  for (int i = -radius_; i <= radius_; ++i) {
    const int row = std::clamp(v + i, 0, height_ - 1);
    rows.window[static_cast<std::size_t>(i + radius_)] =
        rows.blurred.data() + static_cast<std::size_t>(row % (2 * radius_ + 1)) * padded_;
  }
  const int first = std::max(v - radius_, 0);
  for (std::size_t i = 0; i < rows.flags.size(); ++i) rows.flags[i] = rows.changed[i] <= first ? 1 : 0;
  kernels_->blur_down(rows.window.data(), rows.light.data(), padded_, channels_, weights_.data() + 1,
                      static_cast<std::size_t>(radius_), rows.flags.data());
  return rows.light.data();
}

template <typename Value>
void Sensor::read_band(const Image<float>& light, const NoiseStream& stream, int first, int last,
                       SensorRows& rows, Image<Value>& image) const {
  require_fit(light, image);
  if (first < 0 || first > last || last > height_) throw std::invalid_argument("no such rows in the image");
  reserve(rows);
  const int begin = std::max(first - radius_, 0);
  int pushed = begin;
  for (int v = first; v < last; ++v) {
    const float* row = rows.conditioned.data();
    if (radius_ == 0) {
      condition(light, v, rows);
    } else {
      for (; pushed <= std::min(v + radius_, height_ - 1); ++pushed)
        push(light, pushed, pushed == begin, rows);
      row = blurred(v, rows);
    }
    kernels_->levels(row, rows.levels.data(), padded_, channels_, levels_, noise_of(stream, v));
    Value* const to = image.row(v).data();
    if (!gamma_.empty()) {
      for (std::size_t i = 0; i < count_; ++i) to[i] = static_cast<Value>(gamma_.level(rows.levels[i]));
    } else if constexpr (std::is_same_v<Value, std::uint8_t>) {
      kernels_->to_bytes(rows.levels.data(), to, count_);
    } else {
      kernels_->to_words(rows.levels.data(), to, count_);
    }
  }
}

template <typename Value>
void Sensor::require_fit(const Image<float>& light, const Image<Value>& image) const {
  const int channels = config_.channels();
  const auto fits = [&](const auto& one) {
    return one.width() == width_ && one.height() == height_ && one.channels() == channels;
  };
  if (!fits(light) || !fits(image)) {
    throw std::invalid_argument(fmt::format("the light and the image must have {} x {} pixels of {} values",
                                            width_, height_, channels));
  }
  if ((config_.bits <= 8) != std::is_same_v<Value, std::uint8_t>)
    throw std::invalid_argument(fmt::format("a sensor of {} bits delivers {}", config_.bits,
                                            config_.bits <= 8 ? "bytes" : "16-bit words"));
}

template <typename Value>
void Sensor::read_all(const Image<float>& light, const NoiseStream& stream, SensorRows& rows,
                      Image<Value>& image) const {
  const int channels = config_.channels();
  if (image.width() != width_ || image.height() != height_ || image.channels() != channels)
    image = Image<Value>(width_, height_, channels);
  read_band(light, stream, 0, height_, rows, image);
}

void Sensor::read(const Image<float>& light, const NoiseStream& stream, SensorRows& rows,
                  Image<std::uint8_t>& image) const {
  read_all(light, stream, rows, image);
}
void Sensor::read(const Image<float>& light, const NoiseStream& stream, SensorRows& rows,
                  Image<std::uint16_t>& image) const {
  read_all(light, stream, rows, image);
}
void Sensor::read_rows(const Image<float>& light, const NoiseStream& stream, int first, int last,
                       SensorRows& rows, Image<std::uint8_t>& image) const {
  read_band(light, stream, first, last, rows, image);
}
void Sensor::read_rows(const Image<float>& light, const NoiseStream& stream, int first, int last,
                       SensorRows& rows, Image<std::uint16_t>& image) const {
  read_band(light, stream, first, last, rows, image);
}

}  // namespace flexura

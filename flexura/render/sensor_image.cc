#include "flexura/render/sensor_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "flexura/math/hash.h"
#include "flexura/render/kernels.h"
#include "flexura/render/psf.h"

namespace flexura {
namespace {

SensorConfig checked(SensorConfig config) {
  const auto require = [](bool holds, const char* message) {
    if (!holds) throw std::invalid_argument(message);
  };
  require(config.width >= 1 && config.height >= 1 && config.width <= 1 << 20 && config.height <= 1 << 20,
          "a sensor needs from 1 to 2^20 pixels per side");
  require(config.bits >= 1 && config.bits <= 16, "a sensor has from 1 to 16 bits");
  for (const double strength : {config.full_well, config.read_noise, config.psf, config.vignetting})
    require(std::isfinite(strength) && strength >= 0, "a sensor's effect must be finite and not negative");
  for (const double factor : {config.gain, config.gamma})
    require(std::isfinite(factor) && factor > 0, "a sensor's gain and gamma must be positive");
  require(config.psf <= 30, "a sensor's PSF must be at most 30 px");
  return config;
}

// Conversion to levels, including the offset for rounding; with a gamma table, in units of full scale.
SensorLevels levels_for(const SensorConfig& config) {
  const bool is_linear = config.gamma == 1;
  const double unit = is_linear ? config.white() : 1, gain = config.gain * unit;
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

// Fills `to` with one pixel repeatedly.
void repeat(const float* pixel, std::size_t channels, std::vector<float>& to) {
  if (channels == 1) {
    std::ranges::fill(to, *pixel);
    return;
  }
  for (std::size_t i = 0; i < to.size(); i += channels) std::copy_n(pixel, channels, to.data() + i);
}

// Square of the distance from the middle of n pixels.
double square_from_middle(int x, int n) {
  const double distance = x - 0.5 * (n - 1);
  return distance * distance;
}

}  // namespace

Sensor::Sensor(const SensorConfig& config, SimdPath path)
    : config_(checked(config)),
      kernels_(&kernels_of(path).sensor),
      width_(static_cast<int>(config.width)),
      height_(static_cast<int>(config.height)),
      weights_(psf_weights(config.psf)),
      channels_(static_cast<std::size_t>(config.channels())),
      levels_(levels_for(config)) {
  radius_ = static_cast<int>(weights_.size()) - 1;
  count_ = static_cast<std::size_t>(width_) * channels_;
  values_ = sensor_block * channels_;
  margin_ = (weights_.size() - 1 + sensor_block - 1) / sensor_block;
  blocks_ = (count_ + values_ - 1) / values_ + 2 * margin_;
  if (config.gamma != 1) gamma_ = GammaTable(config.gamma, config.white());
  if (config.vignetting == 0) return;
  for (std::size_t i = 0; i < blocks_ * sensor_block; ++i) {
    const auto u = static_cast<int>(i) - static_cast<int>(margin_ * sensor_block);
    lost_across_.insert(lost_across_.end(), channels_, lost(std::clamp(u, 0, width_ - 1), width_));
  }
}

// Returns the contribution of a column, or of a row, to vignetting.
float Sensor::lost(int x, int n) const {
  if (config_.vignetting == 0) return 0;
  const double corner = square_from_middle(0, width_) + square_from_middle(0, height_);
  if (corner == 0) return 0;
  return static_cast<float>(config_.vignetting * square_from_middle(x, n) / corner);
}

void Sensor::reserve(SensorRows& rows) const {
  const std::size_t slots = 2 * weights_.size(), padded = blocks_ * values_;
  rows.left.resize(margin_ * values_);
  rows.right.resize((margin_ + 1) * values_);
  rows.conditioned.resize(slots * padded);
  rows.same.resize(slots * blocks_);
  rows.work.resize(blocks_);
  for (auto* flags : {&rows.age, &rows.is_plain, &rows.is_even, &rows.is_known, &rows.is_needed})
    flags->assign(blocks_, 0);
  rows.window.resize(2 * weights_.size() - 1);
  rows.light.resize(padded), rows.levels.resize(padded), rows.bytes.resize(padded);
}

// Storage slot of row v.
std::size_t Sensor::slot(int v) const { return static_cast<std::size_t>(v) % (2 * weights_.size()); }

// Conditions row v of the light, continued at its ends, and finds where it equals the previous row.
void Sensor::take(const Image<float>& light, int v, bool is_first, SensorRows& rows) const {
  const float* const from = light.row(v).data();
  const std::size_t whole = count_ / values_, rest = count_ % values_, padded = blocks_ * values_;
  repeat(from, channels_, rows.left);
  repeat(from + count_ - channels_, channels_, rows.right);
  std::copy_n(from + whole * values_, rest, rows.right.begin());
  float* const to = rows.conditioned.data() + slot(v) * padded;
  const float* const above = rows.conditioned.data() + slot(v + 2 * radius_ + 1) * padded;
  std::uint8_t* const same = rows.same.data() + slot(v) * blocks_;
  std::size_t begin = 0;
  const auto condition = [&](const float* part, std::size_t blocks) {
    const std::size_t at = begin * values_;
    kernels_->condition({blocks, nullptr, 0, channels_}, part,
                        lost_across_.empty() ? nullptr : lost_across_.data() + at, lost(v, height_),
                        above + at, begin > 0, to + at, same + begin);
    begin += blocks;
  };
  condition(rows.left.data(), margin_);
  condition(from, whole);
  condition(rows.right.data(), blocks_ - margin_ - whole);
  std::uint8_t* const age = rows.age.data();
  for (std::size_t i = 0, end = blocks_; i < end; ++i) {
    const int older = std::min(age[i] + 1, 255), is_older = same[i] / same_as_above;
    age[i] = static_cast<std::uint8_t>(older * is_older);
  }
  if (is_first) std::ranges::fill(rows.age, std::uint8_t{0});
}

// Plans the work for row v. A block is plain if all rows that are blurred into the block are equal. It is
// even if the block and its left neighbour are plain and equal. It is known if all blocks that are blurred
// into it along the row are even.
void Sensor::plan(int v, SensorRows& rows) const {
  const std::uint8_t *const same = rows.same.data() + slot(v) * blocks_, *const age = rows.age.data();
  std::uint8_t *const is_plain = rows.is_plain.data(), *const is_even = rows.is_even.data();
  std::uint8_t *const is_known = rows.is_known.data() + margin_, *const is_needed = rows.is_needed.data();
  const auto before =
      static_cast<std::uint8_t>(std::min(v + radius_, height_ - 1) - std::max(v - radius_, 0));
  const std::size_t blocks = blocks_, count = blocks_ - 2 * margin_;
  for (std::size_t i = 0; i < blocks; ++i) is_plain[i] = age[i] >= before ? 1 : 0;
  for (std::size_t i = 1; i < blocks; ++i)
    is_even[i] = static_cast<std::uint8_t>(is_plain[i] & is_plain[i - 1] & same[i] & same_as_left);
  std::fill_n(is_known, count, std::uint8_t{1});
  std::fill_n(is_needed, blocks, std::uint8_t{0});
  for (std::size_t shift = 0; shift <= 2 * margin_; ++shift)
    for (std::size_t i = 0; i < count; ++i) is_known[i] &= is_even[i + shift];
  for (std::size_t shift = 0; shift <= 2 * margin_; ++shift)
    for (std::size_t i = 0; i < count; ++i) is_needed[i + shift] |= is_known[i] ^ 1;
  BlockWork* const work = rows.work.data();
  for (std::size_t i = 0; i < blocks; ++i) {
    const BlockWork needed = is_plain[i] != 0 ? BlockWork::copy : BlockWork::blur;
    work[i] = is_needed[i] != 0 ? needed : BlockWork::none;
  }
}

// Blurs row v down the columns, where needed.
const float* Sensor::blur_down(int v, SensorRows& rows) const {
  const std::size_t padded = blocks_ * values_;
  if (radius_ == 0) {
    const std::uint8_t* const same = rows.same.data() + slot(v) * blocks_;
    std::ranges::transform(same, same + blocks_, rows.is_known.begin(),
                           [](std::uint8_t one) { return static_cast<std::uint8_t>(one & same_as_left); });
    return rows.conditioned.data() + slot(v) * padded;
  }
  const int count = 2 * radius_ + 1;
  for (int place = 0; place < count; ++place) {
    const std::size_t at = slot(std::clamp(v + place - radius_, 0, height_ - 1));
    rows.window[static_cast<std::size_t>(place)] = rows.conditioned.data() + at * padded;
  }
  plan(v, rows);
  kernels_->blur_down(row(blocks_), rows.window.data(), rows.work.data(), rows.light.data());
  return rows.light.data();
}

// Delivers whole blocks; the image takes those within its width.
template <typename Value>
void Sensor::deliver(int v, const NoiseStream& stream, SensorRows& rows, Value* to) const {
  const float* const light = blur_down(v, rows) + margin_ * values_;
  const std::uint8_t* const is_known = rows.is_known.data() + margin_;
  const SensorRow image_row = row(blocks_ - 2 * margin_);
  const NoiseRow noise = noise_of(stream, v);
  if constexpr (std::is_same_v<Value, std::uint8_t>) {
    if (gamma_.empty()) {
      kernels_->to_bytes(image_row, light, is_known, levels_, noise, rows.bytes.data());
      std::copy_n(rows.bytes.data(), count_, to);
      return;
    }
  }
  kernels_->to_levels(image_row, light, is_known, levels_, noise, rows.levels.data());
  for (std::size_t i = 0; i < count_; ++i) {
    const float level = rows.levels[i];
    to[i] = static_cast<Value>(gamma_.empty() ? static_cast<int>(level) : gamma_.level(level));
  }
}

// Row description for the kernels.
SensorRow Sensor::row(std::size_t blocks) const {
  return {blocks, weights_.data() + 1, static_cast<std::size_t>(radius_), channels_};
}

template <typename Value>
void Sensor::read_rows(const Image<float>& light, const NoiseStream& stream, int first, int last,
                       SensorRows& rows, Image<Value>& image) const {
  require_fit(light, image);
  if (first < 0 || first > last || last > height_) throw std::invalid_argument("no such rows in the image");
  reserve(rows);
  const int begin = std::max(first - radius_, 0);
  int taken = begin;
  for (int v = first; v < last; ++v) {
    for (; taken <= std::min(v + radius_, height_ - 1); ++taken) take(light, taken, taken == begin, rows);
    deliver(v, stream, rows, image.row(v).data());
  }
}

template <typename Value>
void Sensor::require_fit(const Image<float>& light, const Image<Value>& image) const {
  const int channels = config_.channels();
  const auto fits = [&](const auto& one) {
    return one.width() == width_ && one.height() == height_ && one.channels() == channels;
  };
  if (!fits(light) || !fits(image)) {
    throw std::invalid_argument(fmt::format(
        "the light and the image must have {} x {} pixels with {} values each", width_, height_, channels));
  }
  if ((config_.bits <= 8) != std::is_same_v<Value, std::uint8_t>)
    throw std::invalid_argument(fmt::format("a sensor of {} bits delivers {}", config_.bits,
                                            config_.bits <= 8 ? "bytes" : "16-bit words"));
}

template <typename Value>
void Sensor::read(const Image<float>& light, const NoiseStream& stream, SensorRows& rows,
                  Image<Value>& image) const {
  const int channels = config_.channels();
  if (image.width() != width_ || image.height() != height_ || image.channels() != channels)
    image = Image<Value>(width_, height_, channels);
  read_rows(light, stream, 0, height_, rows, image);
}

template void Sensor::read(const Image<float>&, const NoiseStream&, SensorRows&, Image<std::uint8_t>&) const;
template void Sensor::read(const Image<float>&, const NoiseStream&, SensorRows&, Image<std::uint16_t>&) const;
template void Sensor::read_rows(const Image<float>&, const NoiseStream&, int, int, SensorRows&,
                                Image<std::uint8_t>&) const;
template void Sensor::read_rows(const Image<float>&, const NoiseStream&, int, int, SensorRows&,
                                Image<std::uint16_t>&) const;

}  // namespace flexura

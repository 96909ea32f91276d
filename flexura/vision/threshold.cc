#include "flexura/vision/threshold.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

namespace flexura {
namespace {

// Smallest contrast of two classes. A smaller contrast is due to noise or an unevenly lit screen.
constexpr double least_contrast = 10;

// Margin for messages about exposure: a picture darker than this everywhere, or nearer than this to white.
constexpr double dimmest = 32;

// Number of adjacent pixels counted together. Longer runs cost less but are more likely to miss thin arms.
constexpr std::size_t run_length = 16;

// Sums over a histogram up to and including each brightness.
struct Moments {
  double count = 0, sum = 0, squares = 0;

  void add(double brightness, double times) {
    count += times;
    sum += times * brightness;
    squares += times * brightness * brightness;
  }
  [[nodiscard]] double mean() const { return count > 0 ? sum / count : 0; }
  [[nodiscard]] double deviations() const { return count > 0 ? squares - sum * sum / count : 0; }
};

Moments moments(const Histogram& histogram, std::size_t first, std::size_t last) {
  Moments result;
  for (std::size_t i = first; i < last; ++i) result.add(static_cast<double>(i), histogram[i]);
  return result;
}

// Returns the last brightness of the dark class. Among several equally good ones the middle: a threshold
// between two distant modes is then half-way.
double otsu_split(const Histogram& histogram) {
  const Moments all = moments(histogram, 0, 256);
  Moments dark;
  double best = -1, first = 0, last = 0;
  for (std::size_t i = 0; i < 255; ++i) {
    dark.add(static_cast<double>(i), histogram[i]);
    if (dark.count == 0 || dark.count == all.count) continue;
    const double between = dark.sum / dark.count - (all.sum - dark.sum) / (all.count - dark.count);
    const double variance = dark.count * (all.count - dark.count) * between * between;
    if (variance > best) best = variance, first = static_cast<double>(i);
    if (variance >= best) last = static_cast<double>(i);
  }
  return best < 0 ? 127 : std::floor(0.5 * (first + last));
}

// Smooths until two peaks are left (J. M. S. Prewitt, M. L. Mendelsohn, 1966) and returns the lowest place
// between them.
double valley_split(const Histogram& histogram) {
  std::array<double, 256> smooth{}, next{};
  std::ranges::copy(histogram, smooth.begin());
  for (int round = 0; round < 2000; ++round) {
    std::vector<std::size_t> peaks;
    for (std::size_t i = 0; i < 256; ++i) {
      const double before = i > 0 ? smooth[i - 1] : -1, after = i < 255 ? smooth[i + 1] : -1;
      if (smooth[i] > before && smooth[i] >= after && smooth[i] > 0) peaks.push_back(i);
    }
    if (peaks.size() < 2) break;
    if (peaks.size() == 2) {
      const auto valley = std::min_element(smooth.begin() + static_cast<std::ptrdiff_t>(peaks[0]),
                                           smooth.begin() + static_cast<std::ptrdiff_t>(peaks[1]));
      return static_cast<double>(valley - smooth.begin());
    }
    for (std::size_t i = 0; i < 256; ++i)
      next[i] = (smooth[i > 0 ? i - 1 : 0] + smooth[i] + smooth[i < 255 ? i + 1 : 255]) / 3;
    smooth = next;
  }
  return otsu_split(histogram);
}

std::string reason_against(const Histogram& histogram, const Threshold& found, double count) {
  if (count == 0) return "the picture has no pixels";
  for (const std::size_t end : {std::size_t{0}, std::size_t{255}}) {
    // A thin arm has few pixels, too: only dust and hot pixels are fewer.
    constexpr double dust = 24, share = 0.995;
    if (histogram[end] < share * count || count - histogram[end] >= dust) continue;
    return fmt::format("the picture is {}: {:.4g} % of it is {}", end == 0 ? "black" : "saturated",
                       100.0 * histogram[end] / count, end == 0 ? 0 : 255);
  }
  const double contrast = found.bright - found.dark;
  if (contrast >= std::max(least_contrast, 3 * found.spread)) return "";
  const std::string means =
      fmt::format("(means {:.1f} and {:.1f}, spread {:.1f})", found.dark, found.bright, found.spread);
  // Noise alone is split into halves 2.7 of their spreads apart, a shaded screen 3.5.
  constexpr double spreads = 5;
  const char* exposure = contrast > spreads * found.spread ? "too faint" : "blank";
  if (found.dark > 255 - dimmest) exposure = "too bright";
  if (found.bright < dimmest) exposure = "too dark";
  if (contrast > spreads * found.spread)
    return fmt::format("the picture is {}: the two classes differ by less than {} in brightness {}", exposure,
                       least_contrast, means);
  return fmt::format("the picture is {}: two classes of brightness cannot be distinguished {}", exposure,
                     means);
}

// Returns the reason why a fixed level separates nothing although another would.
std::string reason_against_level(double level, const Threshold& otsu) {
  const char* where = "separates the picture at the wrong brightness";
  if (level < otsu.dark) where = "is darker than nearly all of the picture";
  if (level > otsu.bright) where = "is brighter than nearly all of the picture";
  return fmt::format(
      "the fixed level {:g} {}: the two classes have the mean brightnesses {:.0f} and {:.0f}, which the "
      "level {:g} separates",
      level, where, otsu.dark, otsu.bright, otsu.level);
}

// Returns the share of bright pixels in the ring `ring` px inside the picture's border. `level`: at (u, v).
template <typename Level>
double bright_share(const Image<std::uint8_t>& gray, int ring, const Level& level) {
  const int right = gray.width() - 1 - ring, bottom = gray.height() - 1 - ring;
  if (right < ring || bottom < ring) return 0.5;
  std::size_t bright = 0, count = 0;
  const auto look = [&](int u, int v) { ++count, bright += gray.at(u, v) >= level(u, v) ? 1 : 0; };
  for (const int v : {ring, bottom})
    for (int u = ring; u <= right; ++u) look(u, v);
  for (int v = ring; v <= bottom; ++v) look(ring, v), look(right, v);
  return static_cast<double>(bright) / static_cast<double>(count);
}

// The class that is more frequent at the picture's border is the background. Three rings are used, because
// the outermost pixels may be a frame.
template <typename Level>
Figure figure_of(const Image<std::uint8_t>& gray, const Level& level) {
  const double share =
      (bright_share(gray, 0, level) + bright_share(gray, 2, level) + bright_share(gray, 4, level)) / 3;
  return share >= 0.5 ? Figure::dark : Figure::bright;
}

// Returns whether two classes of a block are far apart, by a share of the brightness. They must be much
// farther apart than the halves of a shaded screen (3.5 times its own spread).
bool stand_apart(const Threshold& found) {
  constexpr double spreads = 5, share = 0.2;
  const double contrast = found.bright - found.dark;
  return found.reason.empty() && contrast > std::max(spreads * found.spread, share * found.bright);
}

}  // namespace

const std::vector<std::string>& names_of(const ThresholdMethod*) {
  static const std::vector<std::string> names = {"otsu", "two_mode", "fixed", "by_block"};
  return names;
}

const std::vector<std::string>& names_of(const Figure*) {
  static const std::vector<std::string> names = {"dark", "bright"};
  return names;
}

Histogram histogram_of(const Image<std::uint8_t>& gray, std::size_t samples) {
  // Uses four counters per brightness, because neighbouring pixels are often equal and repeated increments of
  // one counter are slow.
  std::array<Histogram, 4> counts{};
  const auto values = gray.values();
  const std::size_t step =
      run_length * std::max<std::size_t>(1, values.size() / std::max<std::size_t>(samples, 1));
  // The step between samples avoids a fixed relation to the row length.
  const std::size_t odd_step = step == run_length ? run_length : step + (step / run_length % 2 == 0 ? 3 : 5);
  // Each run lies in another cache line: the next ones are prefetched.
  const std::size_t ahead = 16 * odd_step;
  for (std::size_t from = 0; from < values.size(); from += odd_step) {
    if (from + ahead < values.size()) __builtin_prefetch(&values[from + ahead]);
    const std::size_t to = std::min(from + run_length, values.size());
    for (std::size_t i = from; i < to; ++i) ++counts[i % 4][values[i]];
  }
  Histogram sum{};
  for (std::size_t i = 0; i < 256; ++i) sum[i] = counts[0][i] + counts[1][i] + counts[2][i] + counts[3][i];
  return sum;
}

Threshold threshold_of(const Histogram& histogram, const ThresholdConfig& config) {
  Threshold found;
  found.method = config.method;
  found.level = config.level;
  switch (config.method) {
    case ThresholdMethod::fixed:
      if (!std::isfinite(config.level)) throw std::invalid_argument("the threshold must be a finite number");
      break;
    case ThresholdMethod::two_mode:
      found.level = valley_split(histogram) + 0.5;
      break;
    case ThresholdMethod::otsu:
    case ThresholdMethod::by_block:
      found.level = otsu_split(histogram) + 0.5;
      break;
  }
  const auto split = static_cast<std::size_t>(std::clamp(std::floor(found.level) + 1, 0.0, 256.0));
  const Moments dark = moments(histogram, 0, split), bright = moments(histogram, split, 256);
  found.dark = dark.mean(), found.bright = bright.mean();
  if (dark.count == 0) found.dark = found.bright;
  if (bright.count == 0) found.bright = found.dark;
  const double count = dark.count + bright.count;
  found.mean = count > 0 ? (dark.sum + bright.sum) / count : 0;
  found.spread = count > 0 ? std::sqrt(std::max(0.0, dark.deviations() + bright.deviations()) / count) : 0;
  found.reason = reason_against(histogram, found, count);
  if (config.method != ThresholdMethod::fixed || found.reason.empty()) return found;
  const Threshold otsu = threshold_of(histogram);
  if (otsu.reason.empty()) found.reason = reason_against_level(config.level, otsu);
  return found;
}

Threshold threshold_of(const Image<std::uint8_t>& gray, const ThresholdConfig& config, std::size_t samples) {
  Threshold found = threshold_of(histogram_of(gray, samples), config);
  if (found.reason.empty())
    found.figure = config.figure.value_or(figure_of(gray, [&](int, int) { return found.level; }));
  return found;
}

Threshold BlockThresholds::around(const Image<std::uint8_t>& gray, int column, int row, int margin) const {
  Histogram histogram{};
  const int v0 = std::max(0, row * block_ - margin), u0 = std::max(0, column * block_ - margin);
  const int v1 = std::min(gray.height(), (row + 1) * block_ + margin);
  const int u1 = std::min(gray.width(), (column + 1) * block_ + margin);
  for (int v = v0; v < v1; ++v)
    for (int u = u0; u < u1; ++u) ++histogram[gray.at(u, v)];
  return threshold_of(histogram);
}

bool BlockThresholds::make(const Image<std::uint8_t>& gray, const ThresholdConfig& config) {
  block_ = std::max(8, config.block);
  columns_ = (gray.width() + block_ - 1) / block_, rows_ = (gray.height() + block_ - 1) / block_;
  blocks_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), {});
  figure_ = config.figure;
  mean_ = {};
  mean_.method = ThresholdMethod::by_block;
  double count = 0;
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      Block& block = blocks_[place(i, j)];
      // The threshold method always splits a block into two classes.
      const Threshold own = around(gray, i, j, 0);
      block.mean = own.mean;
      // A block inside the figure sees background only in a larger neighbourhood.
      for (const int margin : {block_ / 2, 3 * block_ / 2, 7 * block_ / 2}) {
        const Threshold here = around(gray, i, j, margin);
        if (!stand_apart(here)) continue;
        block.level = here.level, block.dark = here.dark, block.bright = here.bright;
        mean_.level += here.level, mean_.dark += here.dark, mean_.bright += here.bright;
        mean_.spread += here.spread, count += 1;
        break;
      }
    }
  }
  if (count == 0) return false;
  for (double* sum : {&mean_.level, &mean_.dark, &mean_.bright, &mean_.spread}) *sum /= count;
  fill();
  return true;
}

void BlockThresholds::fill() {
  // Blocks without a level take the mean of their neighbours', repeated until all have one. It is scaled by
  // the block's brightness relative to the nearer of the neighbours' classes.
  for (bool is_open = true; is_open;) {
    is_open = false;
    const std::vector<Block> before = blocks_;
    for (int j = 0; j < rows_; ++j) {
      for (int i = 0; i < columns_; ++i) {
        if (before[place(i, j)].has_level()) continue;
        Block sum{.level = 0, .dark = 0, .bright = 0};
        double count = 0;
        for (int b = std::max(0, j - 1); b <= std::min(rows_ - 1, j + 1); ++b) {
          for (int a = std::max(0, i - 1); a <= std::min(columns_ - 1, i + 1); ++a) {
            const Block& near = before[place(a, b)];
            if (!near.has_level()) continue;
            sum.level += near.level, sum.dark += near.dark, sum.bright += near.bright, ++count;
          }
        }
        is_open = is_open || count == 0;
        if (count == 0) continue;
        Block& block = blocks_[place(i, j)];
        const double dark = std::max(sum.dark / count, 1.0), bright = std::max(sum.bright / count, 1.0);
        const double own = std::max(block.mean, 1.0);
        const double share = own * own > dark * bright ? own / bright : own / dark;
        block.level = share * sum.level / count, block.dark = share * dark, block.bright = share * bright;
      }
    }
  }
}

Threshold BlockThresholds::mean(const Image<std::uint8_t>& gray) const {
  Threshold result = mean_;
  std::vector<std::uint8_t> levels(static_cast<std::size_t>(gray.width()));
  int made = -1;
  const auto level = [&](int u, int v) {
    if (v != made) row(v, levels), made = v;
    return levels[static_cast<std::size_t>(u)];
  };
  result.figure = figure_ ? *figure_ : figure_of(gray, level);
  return result;
}

void BlockThresholds::row(int v, std::vector<std::uint8_t>& levels) const {
  const auto between = [&](int pixel, int count, int& low, double& share) {
    const double x = std::clamp((pixel + 0.5) / block_ - 0.5, 0.0, static_cast<double>(count - 1));
    low = std::min(static_cast<int>(x), std::max(0, count - 2));
    share = count > 1 ? x - low : 0;
  };
  int j = 0;
  double down = 0;
  between(v, rows_, j, down);
  const auto at = [&](int a, int b) {
    return blocks_[place(std::min(a, columns_ - 1), std::min(b, rows_ - 1))].level;
  };
  for (std::size_t u = 0; u < levels.size(); ++u) {
    int i = 0;
    double right = 0;
    between(static_cast<int>(u), columns_, i, right);
    const double top = at(i, j) + right * (at(i + 1, j) - at(i, j));
    const double bottom = at(i, j + 1) + right * (at(i + 1, j + 1) - at(i, j + 1));
    levels[u] = static_cast<std::uint8_t>(std::clamp(std::ceil(top + down * (bottom - top)), 1.0, 255.0));
  }
}

}  // namespace flexura

#include "flexura/vision/runs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace flexura {
namespace {

constexpr int word_pixels = 64;

// Returns a word whose bit i tells whether pixel i is at or above the level. `levels` has one level for all
// pixels, or one per pixel.
struct BrightBits {
  std::uint8_t level = 0;
  const std::uint8_t* levels = nullptr;

  [[nodiscard]] std::uint64_t of(const std::uint8_t* pixels, int first, int count) const {
    std::uint64_t bits = 0;
    int i = 0;
#if defined(__SSE2__)
    for (; i + 16 <= count; i += 16) {
      const auto* from = reinterpret_cast<const __m128i*>(pixels + first + i);
      const __m128i value = _mm_loadu_si128(from);
      const __m128i least = levels == nullptr
                                ? _mm_set1_epi8(static_cast<char>(level))
                                : _mm_loadu_si128(reinterpret_cast<const __m128i*>(levels + first + i));
      const int mask = _mm_movemask_epi8(_mm_cmpeq_epi8(_mm_max_epu8(value, least), value));
      bits |= static_cast<std::uint64_t>(static_cast<unsigned>(mask)) << i;
    }
#endif
    for (; i < count; ++i) {
      const std::uint8_t least = levels == nullptr ? level : levels[first + i];
      bits |= static_cast<std::uint64_t>(pixels[first + i] >= least ? 1 : 0) << i;
    }
    return bits;
  }
};

// Adds the runs of a row, from its bits.
void add_runs(const std::uint8_t* pixels, int width, int v, const BrightBits& bright, bool is_dark_desired,
              std::vector<Run>& runs) {
  bool is_inside = false;
  for (int first = 0; first < width; first += word_pixels) {
    const int count = std::min(word_pixels, width - first);
    const std::uint64_t all = count == word_pixels ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
    std::uint64_t bits = bright.of(pixels, first, count);
    if (is_dark_desired) bits = ~bits & all;
    // Where a bit differs from the one before it.
    std::uint64_t changes = (bits ^ (bits << 1 | (is_inside ? 1U : 0U))) & all;
    for (; changes != 0; changes &= changes - 1) {
      const int u = first + std::countr_zero(changes);
      if (is_inside) {
        runs.back().last = u;
      } else {
        runs.push_back({v, u, width, 0});
      }
      is_inside = !is_inside;
    }
  }
}

}  // namespace

void Components::find(const Image<std::uint8_t>& gray, const Threshold& threshold,
                      const BlockThresholds* blocks, const Image<std::uint8_t>* inside) {
  runs.clear();
  row_start_.clear();
  const double least = std::clamp(std::ceil(threshold.level), 0.0, 256.0);
  // At level 256 no pixel is bright. A byte cannot represent this level, so that another level is used that
  // affects no run.
  const bool nothing_bright = least > 255;
  BrightBits bright{static_cast<std::uint8_t>(std::min(least, 255.0)), nullptr};
  for (int v = 0; v < gray.height(); ++v) {
    row_start_.push_back(static_cast<std::uint32_t>(runs.size()));
    if (nothing_bright) {
      if (threshold.figure == Figure::dark) runs.push_back({v, 0, gray.width(), 0});
      continue;
    }
    if (blocks != nullptr) {
      levels_.resize(static_cast<std::size_t>(gray.width()));
      blocks->row(v, levels_);
      bright.levels = levels_.data();
    }
    add_runs(gray.row(v).data(), gray.width(), v, bright, threshold.figure == Figure::dark, runs);
  }
  row_start_.push_back(static_cast<std::uint32_t>(runs.size()));
  if (inside != nullptr) keep_inside(*inside);
  join(gray.height());
  for (Run& run : runs) {
    Component& component = list[run.component];
    if (run.first == 0) ++component.on_border;
    if (run.last == gray.width()) ++component.on_border;
    if (run.v == 0 || run.v == gray.height() - 1) component.on_border += run.last - run.first;
  }
}

void Components::keep_inside(const Image<std::uint8_t>& inside) {
  std::vector<Run> all;
  std::swap(all, runs);
  row_start_.clear();
  for (const Run& run : all) {
    while (row_start_.size() <= static_cast<std::size_t>(run.v))
      row_start_.push_back(static_cast<std::uint32_t>(runs.size()));
    for (int u = run.first; u < run.last; ++u) {
      if (inside.at(u, run.v) == 0) continue;
      if (u == run.first || inside.at(u - 1, run.v) == 0) runs.push_back({run.v, u, u, 0});
      runs.back().last = u + 1;
    }
  }
  while (row_start_.size() <= static_cast<std::size_t>(inside.height()))
    row_start_.push_back(static_cast<std::uint32_t>(runs.size()));
}

std::uint32_t Components::root(std::uint32_t label) {
  while (parent_[label] != label) label = parent_[label] = parent_[parent_[label]];
  return label;
}

void Components::join(int height) {
  parent_.resize(runs.size());
  for (std::uint32_t i = 0; i < parent_.size(); ++i) parent_[i] = i;
  for (int v = 1; v < height; ++v) {
    std::uint32_t above = row_start_[static_cast<std::size_t>(v) - 1];
    const std::uint32_t above_end = row_start_[static_cast<std::size_t>(v)];
    for (std::uint32_t i = above_end; i < row_start_[static_cast<std::size_t>(v) + 1]; ++i) {
      while (above < above_end && runs[above].last < runs[i].first) ++above;
      for (std::uint32_t j = above; j < above_end && runs[j].first <= runs[i].last; ++j) {
        const std::uint32_t a = root(j), b = root(i);
        parent_[std::max(a, b)] = std::min(a, b);
      }
    }
  }
  // Roots precede their members, so components are numbered by their first run.
  list.clear();
  for (std::uint32_t i = 0; i < runs.size(); ++i) {
    Run& run = runs[i];
    const std::uint32_t top = root(i);
    if (top == i) {
      run.component = static_cast<std::uint32_t>(list.size());
      list.push_back({0, run.first, run.v, run.last - 1, run.v, 0, i, 0});
    }
    run.component = runs[top].component;
    Component& component = list[run.component];
    component.area += run.last - run.first;
    component.left = std::min(component.left, run.first);
    component.right = std::max(component.right, run.last - 1);
    component.bottom = run.v;
    ++component.run_count;
  }
}

const Run* Components::run_at(int u, int v) const {
  if (v < 0 || static_cast<std::size_t>(v) + 1 >= row_start_.size()) return nullptr;
  const auto from = runs.begin() + row_start_[static_cast<std::size_t>(v)];
  const auto to = runs.begin() + row_start_[static_cast<std::size_t>(v) + 1];
  const auto after =
      std::upper_bound(from, to, u, [](int column, const Run& run) { return column < run.first; });
  if (after == from || (after - 1)->last <= u) return nullptr;
  return &*(after - 1);
}

void strew(const Components& components, std::uint32_t component, int spacing,
           std::vector<Eigen::Vector2d>& places) {
  places.clear();
  for (const Run& run : components.runs) {
    if (run.component != component || run.v % spacing != 0) continue;
    places.emplace_back(run.first, run.v);
    if (run.last - run.first < 2) continue;
    for (int u = run.first + spacing - run.first % spacing; u < run.last - 1; u += spacing)
      places.emplace_back(u, run.v);
    places.emplace_back(run.last - 1, run.v);
  }
}

Threshold segment(const Image<std::uint8_t>& gray, const ThresholdConfig& config, Components& components,
                  BlockThresholds& blocks, std::size_t samples, const Image<std::uint8_t>* inside) {
  components.runs.clear(), components.list.clear();
  Threshold threshold = threshold_of(gray, config, samples);
  // A subset of pixels may miss a thin arm.
  if (!threshold.reason.empty() && samples < gray.values().size()) threshold = threshold_of(gray, config);
  // In front of an uneven screen, the two classes may separate in blocks but not in the whole picture.
  const bool by_block = config.method == ThresholdMethod::by_block && blocks.make(gray, config);
  if (by_block) threshold = blocks.mean(gray);
  if (threshold.reason.empty()) components.find(gray, threshold, by_block ? &blocks : nullptr, inside);
  return threshold;
}

}  // namespace flexura

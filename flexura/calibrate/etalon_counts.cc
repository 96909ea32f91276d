#include "flexura/calibrate/etalon_counts.h"

#include <algorithm>
#include <cstddef>
#include <ranges>

#include "flexura/vision/picture_file.h"
#include "flexura/vision/threshold.h"

namespace flexura {
namespace {

// Columns in which a third of the black lines are red.
std::vector<double> red_axes(const Image<std::uint8_t>& picture, const std::vector<int>& black_by_row) {
  constexpr double reddest = 25;  // Of 255, above the other colours' mean.
  std::vector<int> red(static_cast<std::size_t>(picture.width()), 0);
  int lines = 0;
  for (int v = 0; v < picture.height(); ++v) {
    if (black_by_row[static_cast<std::size_t>(v)] == 0) continue;
    ++lines;
    for (int u = 0; u < picture.width(); ++u)
      if (picture.at(u, v, 0) - 0.5 * (picture.at(u, v, 1) + picture.at(u, v, 2)) > reddest)
        ++red[static_cast<std::size_t>(u)];
  }
  std::vector<double> axes;
  for (std::size_t u = 0; u < red.size(); ++u) {
    if (3 * red[u] < lines) continue;
    std::size_t end = u;
    while (end < red.size() && 3 * red[end] >= lines) ++end;
    axes.push_back(0.5 * static_cast<double>(u + end - 1));
    u = end;
  }
  return axes;
}

}  // namespace

EtalonCounts count_etalon(const Image<std::uint8_t>& picture) {
  EtalonCounts counts;
  const Image<std::uint8_t> gray = picture.channels() == 1 ? picture : gray_picture(picture);
  const Threshold threshold = threshold_of(gray, {});
  counts.reason = threshold.reason;
  if (!counts.reason.empty()) return counts;
  const int width = gray.width(), height = gray.height();
  std::vector<int> by_row(static_cast<std::size_t>(height), 0), by_column(static_cast<std::size_t>(width), 0);
  const auto is_black = [&](int u, int v) { return gray.at(u, v) <= threshold.level; };
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      if (is_black(u, v)) ++by_row[static_cast<std::size_t>(v)], ++by_column[static_cast<std::size_t>(u)];
  const auto row = static_cast<int>(std::ranges::max_element(by_row) - by_row.begin());
  const auto column = static_cast<int>(std::ranges::max_element(by_column) - by_column.begin());
  while (counts.left < width && !is_black(counts.left, row)) ++counts.left;
  while (counts.right < width && !is_black(width - 1 - counts.right, row)) ++counts.right;
  while (counts.above < height && !is_black(column, counts.above)) ++counts.above;
  while (counts.below < height && !is_black(column, height - 1 - counts.below)) ++counts.below;
  const auto has_black = [](int n) { return n > 0; };
  counts.first = *std::ranges::find_if(by_row, has_black);
  counts.last = *std::ranges::find_if(by_row | std::views::reverse, has_black);
  for (const int n : by_row) counts.white += width - n;
  counts.middle = 0.5 * (width - 1 + counts.left - counts.right);
  if (picture.channels() == 3) counts.axes = red_axes(picture, by_row);
  return counts;
}

}  // namespace flexura

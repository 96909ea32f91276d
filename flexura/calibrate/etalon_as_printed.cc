#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ranges>
#include <string>
#include <vector>

#include "flexura/calibrate/etalon_loop.h"
#include "flexura/vision/eight_bits.h"
#include "flexura/vision/picture_file.h"
#include "flexura/vision/threshold.h"

namespace flexura {
namespace {

// What the paper counts in a picture of the calibration cylinder (section 3.4): whole pixels on either side
// of a threshold.
struct EtalonCounts {
  std::string reason;        // Why there is nothing to count; "" if there is something.
  int left = 0, right = 0;   // White pixels left and right of the line with the most black ones: p_st, p_dr.
  int above = 0, below = 0;  // White pixels of the column with the most black ones: p_sus, p_jos.
  int first = 0, last = 0;   // Black pixels of the first and the last line that have any: p_sup, p_inf.
  std::int64_t white = 0;    // Total number of white pixels: p_zoom.
  std::vector<double> axes;  // Columns of the red axes, left to right.
  double middle = 0;         // Column half-way between the whites to the left and right.
};

// Returns the columns in which a third of the black lines are red.
std::vector<double> red_axes(const Image<std::uint8_t>& picture, const std::vector<int>& black_by_row) {
  constexpr double reddest = 25;  // Excess of red over the mean of the other colours, of 255.
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

void report_counts(const EtalonCounts& counts, const LookLoop& loop, CameraObservation& observed) {
  observed.seen.reason = counts.reason;
  if (!counts.reason.empty()) return;
  // Same layout as drawn_etalon: the counts bound the silhouette, and an axis is a column.
  constexpr double whole_pixel = 0.29;  // Standard deviation of a position rounded to whole pixels, px.
  const SensorConfig& sensor = loop.nominal().cameras[observed.stance.camera].sensor;
  const double left = counts.left, right = static_cast<double>(sensor.width - 1 - counts.right),
               top = counts.above, bottom = static_cast<double>(sensor.height - 1 - counts.below);
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(left, top), {left, bottom}, {right, bottom}, {right, top}})
    observed.seen.points.push_back({corner, whole_pixel});
  for (const double axis : counts.axes)
    for (const double share : {0.75, 0.25})
      observed.seen.markers.push_back(
          {{axis, bottom + share * (top - bottom)}, share * loop.config().etalon.height, whole_pixel});
  observed.values = {{"white left, px", left},
                     {"white right, px", static_cast<double>(counts.right)},
                     {"white above, px", top},
                     {"white below, px", static_cast<double>(counts.below)},
                     {"black in the first line, px", static_cast<double>(counts.first)},
                     {"black in the last line, px", static_cast<double>(counts.last)},
                     {"white, px", static_cast<double>(counts.white)},
                     {"red axes", static_cast<double>(counts.axes.size())}};
}

class EtalonAsPrinted : public EtalonLoop {
 public:
  explicit EtalonAsPrinted(LookLoop& loop) : EtalonLoop(loop, true) {}

 private:
  Error look(std::size_t i) override {
    auto error = loop_.look(i, [this, i](CameraObservation& observed) {
      counts_[i] = count_etalon(eight_bits(*observed.frame.picture, loop_.model(i).sensor.white()));
      report_counts(counts_[i], loop_, observed);
    });
    if (error) return error;
    if (counts_[i].reason.empty()) return std::nullopt;
    return fmt::format("camera {} does not see the cylinder: {}", loop_.name(i), counts_[i].reason);
  }

  std::array<Offset, 4> offsets(std::size_t i) const override {
    const EtalonCounts& seen = counts_[i];
    const LoopConfig& config = loop_.config();
    const auto offset = [&](const char* step, int difference, const Eigen::Vector4d& by) {
      const double px = difference;
      return Offset{step, px, px, config.accepted, 0, "", by};
    };
    return {offset("horizontal orientation", seen.left - seen.right, {-config.turn, 0, 0, 0}),
            offset("horizontal positioning", seen.left - seen.right, {0, 0, config.slide, 0}),
            offset("vertical orientation", seen.above - seen.below, {0, -config.turn, 0, 0}),
            offset("vertical positioning", seen.first - seen.last, {0, 0, 0, config.slide})};
  }

  // If horizontal positioning sees two axes, turns the outer one out of the picture.
  Error prepare(std::size_t i, std::size_t offset, bool& is_turned) override {
    if (offset != 1) return std::nullopt;
    const std::vector<double>& axes = counts_[i].axes;
    if (axes.empty()) return fmt::format("camera {} sees no red axis", loop_.name(i));
    if (axes.size() == 1) return std::nullopt;
    is_turned = true;
    constexpr int most = 3;
    if (++turned_away_[i] > most)
      return fmt::format(
          "horizontal positioning of camera {} cannot stop. The head turned the outer of two red axes out of "
          "the picture, but both axes were visible again with the cylinder in the middle",
          loop_.name(i));
    const auto off = [&](double u) { return std::abs(u - counts_[i].middle); };
    const double outer = off(axes.front()) > off(axes.back()) ? axes.front() : axes.back();
    const Intrinsics lens = loop_.lens(i);
    const auto width = static_cast<double>(loop_.model(i).sensor.width);
    constexpr double margin = 8;  // px, more than half of a line's width.
    const double beyond = outer < counts_[i].middle ? -margin : width - 1 + margin;
    const double turn = std::atan((beyond - lens.cx) / lens.fx) - std::atan((outer - lens.cx) / lens.fx);
    RigStance next = loop_.stance(i);
    next.head.pan += turn;
    next = loop_.commandable_stance(i, next);
    loop_.decide(
        i, "horizontal positioning", off(outer), 0, "px",
        fmt::format("two red axes are visible: pan by {:.4f} rad to turn the outer axis out of the picture",
                    turn));
    return loop_.go(i, next);
  }

  Error align(std::size_t i) override {
    for (std::size_t first = 0; first < 4; first += 2) {
      for (bool holds = false; !holds;) {
        for (const std::size_t offset : {first, first + 1})
          if (auto error = null(i, {offset})) return error;
        if (auto error = look(i)) return error;
        // As printed, the vertical test checks the offset of positioning, which was just accepted: it always
        // stops.
        const Offset tested = offsets(i)[first + 1];
        holds = first == 2 || std::abs(tested.px) <= tested.accepted;
        loop_.decide(i, first == 0 ? "full horizontal calibration" : "full vertical calibration", tested.px,
                     tested.accepted, "px", holds ? "stops" : "returns to step 1");
      }
    }
    if (counts_[i].above != 0 || counts_[i].below != 0) return std::nullopt;
    return fmt::format(
        "vertical calibration of camera {} stops, but the cylinder touches the upper and the lower border of "
        "the picture. The distances from both borders are then zero and do not depend on the position",
        loop_.name(i));
  }

  double ratio() const override {
    return static_cast<double>(counts_[1].white) / static_cast<double>(counts_[0].white);
  }

  Error finish() override {
    // The printed method never checks whether the counts cover the whole cylinder.
    for (std::size_t i = 0; i < 2; ++i) {
      const EtalonCounts& last = counts_[i];
      if (std::min({last.left, last.right, last.above, last.below}) == 0)
        return fmt::format(
            "all procedures stop, but the cylinder touches the border of camera {}'s picture: only the "
            "pixels of a part of the cylinder were counted",
            loop_.name(i));
    }
    loop_.result().zoom_ratio.reset();  // White pixels do not measure magnification.
    loop_.result().notes.emplace_back(
        "the paper's method does not measure the positions of the cameras around the cylinder: the number of "
        "white pixels beside the red axis does not depend on the axis's position");
    return std::nullopt;
  }

  std::array<EtalonCounts, 2> counts_;
  std::array<int, 2> turned_away_ = {0, 0};
};

}  // namespace

std::unique_ptr<EtalonLoop> etalon_as_printed(LookLoop& loop) {
  return std::make_unique<EtalonAsPrinted>(loop);
}

}  // namespace flexura

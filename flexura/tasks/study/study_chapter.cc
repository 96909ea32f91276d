#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "flexura/report/image_picture.h"
#include "flexura/tasks/study/study_results.h"

namespace flexura {
namespace {

// Returns the displayed unit of a parameter.
UnitSpelling shown_unit(const Variation& variation) {
  const auto ways = spellings(variation.unit);
  return variation.unit == Unit::radian ? ways[1] : ways[0];
}

std::string value_text(const Variation& variation, double value) {
  const UnitSpelling unit = shown_unit(variation);
  return fmt::format("{:.4g}{}{}", value / unit.factor, unit.symbol.empty() ? "" : " ", unit.symbol);
}

std::string plain_name(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '_', ' ');
  return text;
}

double number(const std::optional<double>& value) {
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

// Returns a chart of some features: lines for the first source, some dots for the second, rings for the
// third, if any.
ReportFigure chart_of(const ImageStudy& study, const char* chart_name, LineChart chart,
                      std::span<const std::size_t> features) {
  constexpr std::size_t most_dots = 24;
  const UnitSpelling unit = shown_unit(study.variation);
  const std::string name = plain_name(study.variation.name);
  chart.x_label = unit.symbol.empty() ? name : fmt::format("{} ({})", name, unit.symbol);
  const std::size_t count = study.values.size();
  const std::size_t pitch = (count + most_dots - 1) / most_dots;
  for (const double value : study.values) chart.x.push_back(value / unit.factor);
  for (const std::size_t feature : features) {
    ChartSeries& series = chart.series.emplace_back(ChartSeries{plain_name(feature_names[feature]), {}});
    for (std::size_t i = 0; i < count; ++i) {
      const auto some_of = [&](std::size_t column, std::size_t shift) {
        return i % pitch == shift ? number(study.columns[column].features[i][feature])
                                  : std::numeric_limits<double>::quiet_NaN();
      };
      series.values.push_back(number(study.columns[0].features[i][feature]));
      series.dots.push_back(some_of(1, 0));
      // Between the dots.
      if (study.columns.size() > 2) series.rings.push_back(some_of(2, pitch / 2));
    }
  }
  if (chart.x.front() > chart.x.back()) {
    std::ranges::reverse(chart.x);
    for (ChartSeries& series : chart.series) {
      std::ranges::reverse(series.values);
      std::ranges::reverse(series.dots);
      std::ranges::reverse(series.rings);
    }
  }
  return {fmt::format("{}-{}", study.name, chart_name), std::move(chart)};
}

// The square, and the visible parts of the circle.
std::vector<ImageOutline::Line> lines_of(const TargetImage& image) {
  std::vector<ImageOutline::Line> lines;
  const auto& at = image.circle;
  if (at[bottom_right] && at[top_right] && at[top_left] && at[bottom_left])
    lines.push_back(
        {{*at[bottom_right], *at[top_right], *at[top_left], *at[bottom_left], *at[bottom_right]}, ""});
  lines.push_back({{}, "dash2"});
  for (std::size_t i = 0; i <= circle_points; ++i) {
    const auto& point = at[i % circle_points];
    if (point) {
      lines.back().points.push_back(*point);
    } else if (!lines.back().points.empty()) {
      lines.push_back({{}, "dash2"});
    }
  }
  return lines;
}

ReportFigure target_picture(const ImageStudy& study) {
  constexpr std::size_t shown = 5;
  ImagePlot plot{.heading = "the target in the image",
                 .legend = plain_name(study.variation.name),
                 .width = study.width,
                 .height = study.height,
                 .outlines = {}};
  std::set<std::size_t> places;
  for (std::size_t k = 0; k < shown; ++k) places.insert(k * (study.values.size() - 1) / (shown - 1));
  for (const std::size_t i : places) {
    plot.outlines.push_back({value_text(study.variation, study.values[i]),
                             fmt::format("s{}", plot.outlines.size()), lines_of(study.images[i])});
  }
  return {study.name + "-image", image_picture(plot)};
}

std::string text_of(const ImageStudy& study) {
  const auto [length, ratio] = study.largest_difference();
  const auto [measured, rms] = study.measured_difference();
  const std::string pictures = measured == 0 ? ""
                                             : fmt::format(
                                                   " The rings show {} lengths measured in pictures of the "
                                                   "square, with an error of {:.3f} px rms.",
                                                   measured, rms);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < study.values.size(); ++i) seen += study.is_seen(i) ? 1 : 0;
  return fmt::format(
      "Camera {}, {} from {} to {}; the target could be measured at {} of {} values. Lines: projection "
      "formulas; dots: exact values of the renderer. They differ by at most {:.1e} px, and the ratios of "
      "axes by {:.1e}.{}",
      study.camera, plain_name(study.variation.name), value_text(study.variation, study.variation.values[0]),
      value_text(study.variation, study.variation.values[1]), seen, study.values.size(), length, ratio,
      pictures);
}

}  // namespace

Chapter study_chapter(const ImageStudy& study) {
  Chapter chapter{"Study: " + study.name, text_of(study), {target_picture(study)}};
  constexpr std::array<std::size_t, 4> edges{0, 1, 2, 3};
  constexpr std::array<std::size_t, 2> sizes{4, 5}, distances{6, 7};
  constexpr std::array<std::size_t, 1> ratio{8};
  const auto add = [&](const char* name, const char* heading, const char* label, double least,
                       std::span<const std::size_t> features) {
    chapter.figures.push_back(chart_of(
        study, name, {.heading = heading, .x_label = {}, .value_label = label, .least = least}, features));
  };
  add("edges", "edges of the square", "length (px)", 1, edges);
  add("sizes", "height and width of the square", "distance (px)", 1, sizes);
  add("distances", "distance of two points to the centre", "distance (px)", 1, distances);
  add("axes", "axes of the circle's image", "smaller over larger", 0.01, ratio);
  return chapter;
}

}  // namespace flexura

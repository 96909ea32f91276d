#include "flexura/report/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "flexura/report/page.h"
#include "flexura/report/svg.h"

namespace flexura {
namespace {

constexpr std::size_t most_times = 2000;

// Returns the value at `time`; not a number outside the course.
double value_at(const TimedValues& course, double time) {
  const auto after = std::ranges::lower_bound(course.times, time);
  if (after == course.times.end()) return std::numeric_limits<double>::quiet_NaN();
  const auto i = static_cast<std::size_t>(after - course.times.begin());
  if (*after == time) return course.values[i];
  if (i == 0) return std::numeric_limits<double>::quiet_NaN();
  const double share = (time - course.times[i - 1]) / (course.times[i] - course.times[i - 1]);
  return course.values[i - 1] + share * (course.values[i] - course.values[i - 1]);
}

std::string run_html(const char* letter, const std::string& name, const std::string& headline) {
  return fmt::format("<div><dt>{}: {}</dt><dd>{}</dd></div>\n", letter, xml_escape(name),
                     xml_escape(headline));
}

}  // namespace

LineChart overlaid_chart(std::string heading, std::string label, double least, const TimedValues& a,
                         const TimedValues& b) {
  std::vector<double> times;
  std::ranges::set_union(a.times, b.times, std::back_inserter(times));
  if (times.empty()) throw std::invalid_argument("neither run has values");
  if (times.size() > most_times) {
    const double first = times.front(), last = times.back();
    times.resize(most_times);
    for (std::size_t i = 0; i < most_times; ++i)
      times[i] = first + (last - first) * static_cast<double>(i) / static_cast<double>(most_times - 1);
  }
  LineChart chart{.heading = std::move(heading),
                  .x_label = "t (s)",
                  .value_label = std::move(label),
                  .least = least,
                  .x = std::move(times),
                  .series = {{.name = "A", .values = {}}, {.name = "B", .values = {}}}};
  for (const double time : chart.x) {
    chart.series[0].values.push_back(value_at(a, time));
    chart.series[1].values.push_back(value_at(b, time));
  }
  return chart;
}

std::string comparison_html(const ComparisonData& data) {
  std::string figures, notes;
  for (const ReportFigure& figure : data.figures) figures += picture_html(figure);
  for (const std::string& note : data.notes)
    notes += fmt::format("<p class=\"note\">{}</p>\n", xml_escape(note));
  return plain_page(
      data.a + " and " + data.b, data.version,
      fmt::format(
          "<dl class=\"summary\">\n{}</dl>\n{}"
          "<section aria-labelledby=\"values-title\">\n<h2 id=\"values-title\">Values that differ</h2>\n{}"
          "</section>\n<section aria-labelledby=\"charts-title\">\n<h2 id=\"charts-title\">Over time</h2>\n"
          "<div class=\"charts\">\n{}</div>\n</section>\n",
          run_html("A", data.a, data.headline_a) + run_html("B", data.b, data.headline_b), notes,
          data.table.rows.empty() ? "<p>None.</p>\n" : table_html(data.table), figures));
}

}  // namespace flexura

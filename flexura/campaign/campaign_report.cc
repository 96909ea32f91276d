#include "flexura/campaign/campaign_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "flexura/campaign/campaign_groups.h"
#include "flexura/campaign/campaign_summary.h"
#include "flexura/report/axes.h"
#include "flexura/report/chart.h"
#include "flexura/report/page.h"
#include "flexura/report/report.h"
#include "flexura/report/svg.h"

namespace flexura {
namespace {

constexpr std::size_t most_dots = 1500;

std::vector<double> sorted_numbers(const CampaignColumn& column) {
  std::vector<double> values;
  for (const double value : column.values)
    if (!std::isnan(value)) values.push_back(value);
  std::ranges::sort(values);
  return values;
}

std::string number_text(double value) { return fmt::format("{:.5g}", value); }

std::string rate_text(std::int64_t successes, std::int64_t count) {
  if (count == 0) return "";
  const ConfidenceInterval interval = wilson_interval(successes, count);
  return fmt::format("{:.1f} % ({:.1f} to {:.1f} %)",
                     100 * static_cast<double>(successes) / static_cast<double>(count), 100 * interval.low,
                     100 * interval.high);
}

// Returns a histogram of sorted numbers as bars.
Drawing histogram(const std::string& name, const std::vector<double>& values) {
  constexpr double width = 520, height = 216, right_space = 18;
  const Interval range = padded({values.front(), values.back()}, 0, 0);
  const double most = std::ceil(std::sqrt(static_cast<double>(values.size())));
  const auto bins = static_cast<std::size_t>(std::clamp(most, 5.0, 40.0));
  std::vector<double> counts(bins);
  for (const double value : values) {
    const double place = (value - range.low) / range.extent() * static_cast<double>(bins);
    counts[std::min(bins - 1, static_cast<std::size_t>(std::max(place, 0.0)))] += 1;
  }
  const Interval up = {0, 1.05 * *std::ranges::max_element(counts)};
  const double left = left_of_axes(up, height);
  const PlotFrame frame = {range, up, {left, heading_space}, {width - left - right_space, height}};
  XmlWriter svg;
  svg.label({left, 22}, "heading", name);
  draw_axes(svg, frame, name, "runs");
  for (std::size_t i = 0; i < bins; ++i) {
    const double from = range.low + range.extent() * static_cast<double>(i) / static_cast<double>(bins);
    const Eigen::Vector2d corner = frame.page({from, counts[i]});
    svg.rect(corner, {frame.size.x() / static_cast<double>(bins) - 1, frame.bottom() - corner.y()}, "dot s0");
  }
  return {width, frame.bottom() + space_below_axes, "Histogram of " + name, svg.text()};
}

// Returns the values of a measure over a parameter as dots.
LineChart scatter(const CampaignColumn& measure, const CampaignColumn& parameter) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < measure.values.size(); ++i)
    if (!std::isnan(measure.values[i]) && !std::isnan(parameter.values[i])) order.push_back(i);
  // The first runs are spread over all values; one run of every few might not be.
  order.resize(std::min(order.size(), most_dots));
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return parameter.values[i]; });
  LineChart chart{.heading = measure.name + " over " + parameter.name,
                  .x_label = parameter.name,
                  .value_label = measure.name,
                  .least = 1e-12,
                  .series = {{.name = measure.name, .values = {}, .css_class = "s0"}}};
  for (const std::size_t i : order) {
    chart.x.push_back(parameter.values[i]);
    chart.series[0].dots.push_back(measure.values[i]);
  }
  chart.series[0].values.assign(chart.x.size(), std::nan(""));
  return chart;
}

std::string section(const std::string& heading, const std::string& html) {
  return html.empty() ? "" : fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", heading, html);
}

std::string fact(const std::string& name, const std::string& value) {
  return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", xml_escape(name), xml_escape(value));
}

std::string facts(const CampaignSummary& summary, const CampaignResults& results) {
  const auto runs = static_cast<std::int64_t>(summary.ids.size());
  std::string html = fact("Runs", fmt::format("{} of {}", runs, results.campaign().design().runs()));
  for (const auto& [status, count] : summary.statuses)
    html += fact(fmt::format("Runs with status \"{}\"", status),
                 fmt::format("{}: {}", count, rate_text(count, runs)));
  html += fact("Seed", fmt::format("{}", results.campaign().config().seed));
  html += fact("Time of all runs", fmt::format("{:.3g} s", summary.seconds));
  return "<dl class=\"summary\">\n" + html + "</dl>\n";
}

std::string measures_html(const CampaignSummary& summary) {
  ChapterTable table{{"measure", "runs", "mean", "95 % interval of the mean", "standard deviation",
                      "smallest", "median", "largest", "success rate (95 % interval)"},
                     {}};
  for (const CampaignColumn& column : summary.measures) {
    const std::vector<double> values = sorted_numbers(column);
    std::vector<std::string> row{column.name, fmt::format("{}", values.size())};
    if (column.categories.empty() && !values.empty()) {
      RunningMean mean;
      for (const double value : column.values)
        if (!std::isnan(value)) mean.add(value);
      row.insert(row.end(), {number_text(mean.mean()),
                             fmt::format("{} to {}", number_text(mean.mean() - mean.half_width()),
                                         number_text(mean.mean() + mean.half_width())),
                             number_text(mean.deviation()), number_text(values.front()),
                             number_text(values[values.size() / 2]), number_text(values.back())});
    }
    row.resize(table.columns.size() - 1);
    row.push_back(rate_text(std::ranges::count(column.successes, true),
                            static_cast<std::int64_t>(column.successes.size())));
    table.rows.push_back(std::move(row));
  }
  return table.rows.empty() ? "" : table_html(table);
}

std::string groups_html(const CampaignSummary& summary, const CampaignConfig& config) {
  const CampaignGroups groups = groups_of(summary, config);
  const ChapterTable reasons = reason_table(groups, summary);
  std::string html;
  if (groups.groups.size() > 1)
    html +=
        "<p>Runs with equal values of grids, lists and choices. The numbers include only runs that are "
        "done.</p>\n" +
        table_html(group_table(groups, summary, config));
  return reasons.rows.empty() ? html : html + table_html(reasons);
}

std::string distributions_html(const CampaignSummary& summary) {
  std::string html;
  std::size_t number = 0;
  for (const auto* columns : {&summary.measures, &summary.parameters}) {
    for (const CampaignColumn& column : *columns) {
      const std::vector<double> values = sorted_numbers(column);
      if (!column.categories.empty() || values.empty() || values.front() == values.back()) continue;
      html += picture_html({fmt::format("histogram-{}", ++number), histogram(column.name, values)});
    }
  }
  return html.empty() ? "" : "<div class=\"charts\">\n" + html + "</div>\n";
}

std::string sensitivity_html(const CampaignSummary& summary) {
  ChapterTable table{{"parameter"}, {}};
  for (const CampaignColumn& measure : summary.measures)
    if (measure.categories.empty()) table.columns.push_back(measure.name);
  for (const CampaignColumn& parameter : summary.parameters) {
    std::vector<std::string> row{parameter.name};
    for (const CampaignColumn& measure : summary.measures) {
      if (!measure.categories.empty()) continue;
      const auto found = sensitivity_of(measure, parameter);
      std::string cell;
      if (found) cell = fmt::format("{:.0f} %", 100 * found->share);
      if (found && parameter.categories.empty()) cell += fmt::format(", {:+.2f}", found->rank_correlation);
      row.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  std::string charts;
  std::size_t number = 0;
  for (const CampaignColumn& measure : summary.measures) {
    const CampaignColumn* most = nullptr;
    double share = 0.01;  // Less is not worth a chart.
    for (const CampaignColumn& parameter : summary.parameters) {
      const auto found = sensitivity_of(measure, parameter);
      if (!found || !parameter.categories.empty() || found->share <= share) continue;
      most = &parameter, share = found->share;
    }
    if (most != nullptr && measure.categories.empty())
      charts += picture_html({fmt::format("scatter-{}", ++number), scatter(measure, *most)});
  }
  if (table.columns.size() < 2 || table.rows.empty()) return "";
  return "<p>Share of the measure's variance that the parameter alone explains (computed from groups "
         "of runs with similar values), and rank correlation.</p>\n" +
         table_html(table) + (charts.empty() ? "" : "<div class=\"charts\">\n" + charts + "</div>\n");
}

std::string worst_html(const CampaignSummary& summary, const CampaignConfig& config,
                       const std::string& file) {
  constexpr std::size_t most = 5;
  const auto command = [&](std::int64_t id) {
    return fmt::format("flexura run --from {} --row {}", file, id);
  };
  ChapterTable table{{"run", "why", "replay"}, {}};
  for (const CampaignSummary::Fault& fault : summary.faults)
    table.rows.push_back(
        {fmt::format("{}", fault.id), fmt::format("{}: {}", fault.status, fault.error), command(fault.id)});
  for (std::size_t k = 0; k < summary.measures.size(); ++k) {
    const CampaignColumn& column = summary.measures[k];
    if (!column.categories.empty()) continue;
    for (const std::size_t i : worst_runs(column, config.measure[k], most)) {
      const std::string value = std::isnan(column.values[i]) ? "no value" : number_text(column.values[i]);
      table.rows.push_back({fmt::format("{}", summary.ids[i]), fmt::format("{}: {}", column.name, value),
                            command(summary.ids[i])});
    }
  }
  return table.rows.empty() ? "" : table_html(table);
}

}  // namespace

std::string campaign_html(CampaignResults& results, const std::string& file) {
  const CampaignSummary summary = summary_of(results);
  const CampaignConfig& config = results.campaign().config();
  std::string html = fmt::format("<p class=\"outcome\">{}</p>\n",
                                 xml_escape(results.reason().empty() ? "The campaign is not complete."
                                                                     : "Complete: " + results.reason()));
  if (!config.description.empty())
    html += fmt::format("<p style=\"white-space: pre-line\">{}</p>\n", xml_escape(config.description));
  html += facts(summary, results);
  html += section("Measures", measures_html(summary));
  html += section("Groups", groups_html(summary, config));
  html += section("Distributions", distributions_html(summary));
  html += section("Sensitivity", sensitivity_html(summary));
  html += section("Worst runs", worst_html(summary, config, file));
  return plain_page(config.title, results.version(), html);
}

}  // namespace flexura

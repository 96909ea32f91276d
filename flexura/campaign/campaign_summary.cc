#include "flexura/campaign/campaign_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "flexura/store/csv.h"
#include "flexura/store/mcap_file.h"

namespace flexura {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t least_runs = 20;
constexpr std::size_t most_groups = 10;

void add(const Node& value, CampaignColumn& column) {
  const auto* text = value.as<std::string>();
  if (text == nullptr) {
    column.values.push_back(measured_number(value).value_or(missing));
    return;
  }
  const auto found = std::ranges::find(column.categories, *text);
  column.values.push_back(static_cast<double>(found - column.categories.begin()));
  if (found == column.categories.end()) column.categories.push_back(*text);
}

// Replaces the numbers of a text by "...", so that equal reasons can be counted.
std::string without_numbers(const std::string& text) {
  std::string kind;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    const auto is_digit = [&](std::size_t at) {
      return at < text.size() && text[at] >= '0' && text[at] <= '9';
    };
    if (i == 0 || (std::isalnum(static_cast<unsigned char>(text[i - 1])) == 0 && text[i - 1] != '_')) {
      if (text[end] == '-') ++end;
      if (is_digit(end))
        while (is_digit(end) || (end < text.size() && text[end] == '.' && is_digit(end + 1))) ++end;
      else
        end = i;
    }
    kind += end > i ? "..." : std::string(1, text[i]);
    i = std::max(end, i + 1);
  }
  return kind;
}

// Beyond this number, reasons are counted together.
constexpr std::size_t most_kinds = 10000;

std::size_t reason_index(const std::string& error, std::map<std::string, std::size_t>& kinds,
                         std::vector<std::string>& names) {
  // A run may have many reasons, of which the first counts.
  std::string kind = without_numbers(error.substr(0, error.find("; ")));
  if (kinds.size() >= most_kinds && !kinds.contains(kind)) kind = "other reasons";
  const auto [place, is_new] = kinds.try_emplace(kind, names.size());
  if (is_new) names.push_back(kind);
  return place->second;
}

// Returns the ranks of numbers, from 0; equal numbers have their mean rank.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    const double mean = static_cast<double>(first + end - 1) / 2;
    for (std::size_t i = first; i < end; ++i) ranks[order[i]] = mean;
    first = end;
  }
  return ranks;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<double>(a.size());
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / n;
  const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / n;
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    aa += (a[i] - mean_a) * (a[i] - mean_a), bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return ab / std::sqrt(aa * bb);
}

// Returns the group of each value: its category, or one of at most ten groups of equal size.
std::vector<std::size_t> groups_of(const std::vector<double>& values, bool is_category) {
  std::vector<double> distinct = values;
  std::ranges::sort(distinct);
  distinct.erase(std::ranges::unique(distinct).begin(), distinct.end());
  const std::vector<double> ranks = ranks_of(values);
  std::vector<std::size_t> groups(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    groups[i] =
        is_category || distinct.size() <= most_groups
            ? static_cast<std::size_t>(std::ranges::lower_bound(distinct, values[i]) - distinct.begin())
            : static_cast<std::size_t>(ranks[i] * most_groups / static_cast<double>(values.size()));
  }
  return groups;
}

double explained_share(const std::vector<double>& values, const std::vector<std::size_t>& groups) {
  std::vector<RunningMean> means(*std::ranges::max_element(groups) + 1);
  RunningMean all;
  for (std::size_t i = 0; i < values.size(); ++i) means[groups[i]].add(values[i]), all.add(values[i]);
  double inside = 0;
  std::size_t used = 0;
  for (const RunningMean& mean : means) {
    inside += mean.deviation() * mean.deviation() *
              static_cast<double>(std::max<std::int64_t>(mean.count(), 1) - 1);
    if (mean.count() > 0) ++used;
  }
  if (values.size() <= used) return 0;
  const double whole = all.deviation() * all.deviation();
  return std::clamp(1 - inside / static_cast<double>(values.size() - used) / whole, 0.0, 1.0);
}

bool varies(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax_element(values);
  return *low < *high;
}

}  // namespace

CampaignSummary summary_of(CampaignResults& results) {
  const CampaignConfig& config = results.campaign().config();
  CampaignSummary summary;
  for (const ParameterConfig& one : config.parameter)
    summary.parameters.push_back({place_of(one).label(), {}, {}, {}});
  for (const CampaignMeasureConfig& one : config.measure)
    summary.measures.push_back({one.label(), {}, {}, {}});
  std::map<std::string, std::size_t> kinds{{"", 0}};
  summary.reason_kinds = {""};
  // Whether a measure has had a value that is no truth value. Truth values are stored as whole numbers.
  std::vector<bool> is_number(config.measure.size());
  results.for_each([&](const CampaignRow& row) {
    summary.ids.push_back(row.id);
    summary.seconds += row.seconds;
    summary.is_done.push_back(row.status == "done");
    summary.reasons.push_back(reason_index(row.error, kinds, summary.reason_kinds));
    if (++summary.statuses[row.status] <= most_faults && row.status != "done")
      summary.faults.push_back({row.id, row.status, row.error});
    for (std::size_t i = 0; i < row.parameters.size(); ++i) add(row.parameters[i], summary.parameters[i]);
    for (std::size_t i = 0; i < row.measures.size(); ++i) {
      add(row.measures[i], summary.measures[i]);
      const auto* whole = row.measures[i].as<std::int64_t>();
      if (row.measures[i].as<double>() != nullptr || (whole != nullptr && *whole != 0 && *whole != 1))
        is_number[i] = true;
      summary.measures[i].successes.push_back(row.status == "done" &&
                                              is_success(config.measure[i], row.measures[i]));
    }
  });
  for (std::size_t i = 0; i < summary.measures.size(); ++i) {
    CampaignColumn& column = summary.measures[i];
    const bool has_bounds = config.measure[i].min || config.measure[i].max;
    const bool has_values =
        !std::ranges::all_of(column.values, [](double value) { return std::isnan(value); });
    if (!has_bounds && (!has_values || !column.categories.empty() || is_number[i])) column.successes.clear();
  }
  return summary;
}

std::optional<Sensitivity> sensitivity_of(const CampaignColumn& measure, const CampaignColumn& parameter) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < measure.values.size(); ++i) {
    if (std::isnan(measure.values[i]) || std::isnan(parameter.values[i])) continue;
    x.push_back(parameter.values[i]), y.push_back(measure.values[i]);
  }
  if (x.size() < least_runs || !varies(x) || !varies(y)) return std::nullopt;
  const bool is_category = !parameter.categories.empty();
  return Sensitivity{is_category ? 0 : correlation(ranks_of(x), ranks_of(y)),
                     explained_share(y, groups_of(x, is_category))};
}

std::vector<std::size_t> worst_runs(const CampaignColumn& column, const CampaignMeasureConfig& measure,
                                    std::size_t most) {
  const auto badness = [&](std::size_t i) {
    const double value = column.values[i];
    if (std::isnan(value)) return std::numeric_limits<double>::infinity();
    if (column.successes.empty()) return value;
    if (!measure.min && !measure.max) return -value;
    return std::max(measure.min ? *measure.min - value : -std::numeric_limits<double>::infinity(),
                    measure.max ? value - *measure.max : -std::numeric_limits<double>::infinity());
  };
  std::vector<std::size_t> runs;
  for (std::size_t i = 0; i < column.values.size(); ++i)
    if (column.successes.empty() ? !std::isnan(column.values[i]) : !column.successes[i]) runs.push_back(i);
  const std::size_t count = std::min(most, runs.size());
  const auto is_worse = [&](std::size_t a, std::size_t b) {
    return badness(a) != badness(b) ? badness(a) > badness(b) : a < b;
  };
  std::partial_sort(runs.begin(), runs.begin() + static_cast<std::ptrdiff_t>(count), runs.end(), is_worse);
  runs.resize(count);
  return runs;
}

void export_campaign_csv(CampaignResults& results, const std::filesystem::path& out) {
  constexpr std::size_t piece = std::size_t{256} << 10;
  AppendFile file(out);
  CsvText text;
  for (const char* name : {"id", "seed", "status", "error", "seconds"}) text.cell(name);
  for (const ParameterConfig& one : results.campaign().config().parameter) text.cell(place_of(one).label());
  for (const CampaignMeasureConfig& one : results.campaign().config().measure) text.cell(one.label());
  text.end_row();
  const auto add_value = [&](const Node& value) {
    if (const auto* words = value.as<std::string>())
      text.cell(*words);
    else if (const auto* whole = value.as<std::int64_t>())
      text.cell(fmt::format("{}", *whole));
    else if (const auto* real = value.as<double>())
      text.cell(*real);
    else
      text.cell("");
  };
  const auto write = [&] { file.append(std::as_bytes(std::span(text.text()))), text = {}; };
  results.for_each([&](const CampaignRow& row) {
    text.cell(fmt::format("{}", row.id));
    text.cell(fmt::format("{}", row.seed));
    text.cell(row.status);
    text.cell(row.error);
    text.cell(row.seconds);
    for (const Node& value : row.parameters) add_value(value);
    for (const Node& value : row.measures) add_value(value);
    text.end_row();
    if (text.text().size() >= piece) write();
  });
  write();
  file.close();
}

}  // namespace flexura

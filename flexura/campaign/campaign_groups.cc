#include "flexura/campaign/campaign_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace flexura {
namespace {

constexpr std::size_t most_reasons = 30;

std::string value_text(const CampaignColumn& column, std::size_t run) {
  const double value = column.values[run];
  if (std::isnan(value)) return "";
  if (!column.categories.empty()) return column.categories[static_cast<std::size_t>(value)];
  return fmt::format("{:.6g}", value);
}

std::string name_of(const CampaignGroup& group) {
  std::string name;
  for (const std::string& value : group.values) name += (name.empty() ? "" : ", ") + value;
  return name;
}

// Returns the numbers of the runs of a group that are done, sorted.
std::vector<double> done_numbers(const CampaignColumn& column, const CampaignSummary& summary,
                                 const CampaignGroup& group) {
  std::vector<double> numbers;
  for (const std::size_t run : group.runs)
    if (summary.is_done[run] && !std::isnan(column.values[run])) numbers.push_back(column.values[run]);
  std::ranges::sort(numbers);
  return numbers;
}

std::string spread_text(const std::vector<double>& sorted) {
  if (sorted.empty()) return "-";
  const auto at = [&](double share) {
    const double place = std::ceil(share * static_cast<double>(sorted.size()));
    return sorted[static_cast<std::size_t>(std::max(place, 1.0)) - 1];
  };
  constexpr double nearly_all = 0.95;
  return fmt::format("{:.3g} / {:.3g} / {:.3g}", at(0.5), at(nearly_all), sorted.back());
}

// Returns what the rows of a table have from one measure, by columns.
struct MeasureColumns {
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> cells;  // Of each group.
};

MeasureColumns columns_of(const CampaignColumn& column, const CampaignMeasureConfig& measure,
                          const CampaignSummary& summary, const CampaignGroups& groups) {
  MeasureColumns found;
  found.cells.resize(groups.groups.size());
  const bool has_bounds = measure.min || measure.max, is_truth = !column.successes.empty() && !has_bounds;
  if (!is_truth) {
    found.headings.push_back(column.name + ": median / 95 % / largest");
    for (std::size_t i = 0; i < groups.groups.size(); ++i)
      found.cells[i].push_back(spread_text(done_numbers(column, summary, groups.groups[i])));
  }
  if (is_truth || has_bounds) {
    found.headings.push_back(is_truth ? column.name : column.name + ": within the bounds");
    for (std::size_t i = 0; i < groups.groups.size(); ++i) {
      const CampaignGroup& group = groups.groups[i];
      const auto count = std::ranges::count_if(group.runs, [&](std::size_t run) {
        return is_truth ? column.values[run] == 1 : static_cast<bool>(column.successes[run]);
      });
      found.cells[i].push_back(fmt::format("{} of {}", count, group.runs.size()));
    }
  }
  return found;
}

std::string markdown_cell(const std::string& text) {
  std::string cell;
  for (const char c : text) cell += c == '|' ? "\\|" : std::string(1, c);
  return cell;
}

// Columns of texts are aligned to the left, those of numbers to the right.
std::string markdown_table(const ChapterTable& table, std::size_t texts) {
  std::string text = "|", line = "|";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    text += " " + markdown_cell(table.columns[i]) + " |";
    line += i < texts ? " --- |" : " ---: |";
  }
  text += "\n" + line + "\n";
  for (const std::vector<std::string>& row : table.rows) {
    text += "|";
    for (const std::string& cell : row) text += " " + markdown_cell(cell) + " |";
    text += "\n";
  }
  return text;
}

}  // namespace

CampaignGroups groups_of(const CampaignSummary& summary, const CampaignConfig& config) {
  CampaignGroups result;
  std::vector<std::size_t> used;
  std::size_t count = 1;
  for (std::size_t i = 0; i < config.parameter.size(); ++i) {
    const std::size_t size = grid_size(config.parameter[i]);
    if (size < 2 || count * size > most_campaign_groups) continue;
    count *= size;
    used.push_back(i), result.parameters.push_back(summary.parameters[i].name);
  }
  std::map<std::vector<double>, std::size_t> index;
  for (std::size_t run = 0; run < summary.ids.size(); ++run) {
    std::vector<double> key;
    key.reserve(used.size());
    for (const std::size_t i : used) key.push_back(summary.parameters[i].values[run]);
    const auto [place, is_new] = index.try_emplace(std::move(key), result.groups.size());
    if (is_new) {
      CampaignGroup& group = result.groups.emplace_back();
      for (const std::size_t i : used) group.values.push_back(value_text(summary.parameters[i], run));
    }
    result.groups[place->second].runs.push_back(run);
  }
  return result;
}

ChapterTable group_table(const CampaignGroups& groups, const CampaignSummary& summary,
                         const CampaignConfig& config) {
  ChapterTable table{groups.parameters, {}};
  table.columns.insert(table.columns.end(), {"runs", "done"});
  for (const CampaignGroup& group : groups.groups) {
    const auto done =
        std::ranges::count_if(group.runs, [&](std::size_t run) { return summary.is_done[run]; });
    std::vector<std::string>& row = table.rows.emplace_back(group.values);
    row.insert(row.end(), {fmt::format("{}", group.runs.size()), fmt::format("{}", done)});
  }
  for (std::size_t i = 0; i < summary.measures.size(); ++i) {
    if (!summary.measures[i].categories.empty()) continue;
    const MeasureColumns columns = columns_of(summary.measures[i], config.measure[i], summary, groups);
    table.columns.insert(table.columns.end(), columns.headings.begin(), columns.headings.end());
    for (std::size_t k = 0; k < table.rows.size(); ++k)
      table.rows[k].insert(table.rows[k].end(), columns.cells[k].begin(), columns.cells[k].end());
  }
  return table;
}

ChapterTable reason_table(const CampaignGroups& groups, const CampaignSummary& summary) {
  std::map<std::size_t, std::map<std::size_t, std::size_t>> counts;  // Of each reason, by groups.
  for (std::size_t i = 0; i < groups.groups.size(); ++i)
    for (const std::size_t run : groups.groups[i].runs)
      if (!summary.is_done[run]) ++counts[summary.reasons[run]][i];
  std::vector<std::pair<std::size_t, std::size_t>> order;  // Number of runs, and reason.
  for (const auto& [reason, by_group] : counts) {
    std::size_t runs = 0;
    for (const auto& [group, count] : by_group) runs += count;
    order.emplace_back(runs, reason);
  }
  std::ranges::stable_sort(order, std::ranges::greater{}, [](const auto& one) { return one.first; });
  order.resize(std::min(order.size(), most_reasons));
  ChapterTable table{{"reason of a run that is not done", "runs"}, {}};
  for (const auto& [runs, reason] : order) {
    std::string cell;
    for (const auto& [group, count] : counts[reason]) {
      const std::string name = name_of(groups.groups[group]);
      cell += (cell.empty() ? "" : "; ") + (name.empty() ? "" : name + ": ") + fmt::format("{}", count);
    }
    table.rows.push_back({summary.reason_kinds[reason], std::move(cell)});
  }
  return table;
}

std::string campaign_markdown(CampaignResults& results) {
  const CampaignSummary summary = summary_of(results);
  const CampaignConfig& config = results.campaign().config();
  const CampaignGroups groups = groups_of(summary, config);
  std::string text = fmt::format("# {}\n\n", config.title);
  std::string description = config.description;
  while (description.ends_with('\n')) description.pop_back();
  if (!description.empty()) text += description + "\n\n";
  if (results.reason().empty())
    text += fmt::format("The campaign is not complete: {} of {} runs.\n\n", summary.ids.size(),
                        results.campaign().design().runs());
  text += markdown_table(group_table(groups, summary, config), groups.parameters.size());
  const ChapterTable reasons = reason_table(groups, summary);
  if (!reasons.rows.empty()) text += "\n" + markdown_table(reasons, 2);
  return text;
}

}  // namespace flexura

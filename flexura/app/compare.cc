#include "flexura/app/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <ostream>
#include <system_error>
#include <utility>

#include "flexura/app/commands.h"
#include "flexura/app/compare_page.h"
#include "flexura/app/terminal_progress.h"
#include "flexura/app/words.h"
#include "flexura/base/source.h"
#include "flexura/base/version.h"
#include "flexura/log/results.h"
#include "flexura/log/results_log.h"
#include "flexura/report/comparison.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"

namespace flexura {
namespace {

using Values = std::vector<std::pair<std::string, Node>>;

std::optional<double> number_of(const Node& node) {
  if (const auto* real = node.as<double>()) return *real;
  if (const auto* whole = node.as<std::int64_t>()) return static_cast<double>(*whole);
  return std::nullopt;
}

// Returns the name by which the entry of a list is compared; "" without one.
std::string name_of_entry(const Node& entry) {
  for (const char* key : {"name", "task"})
    if (const Node* name = entry.find(key))
      if (const auto* text = name->as<std::string>()) return *text;
  return "";
}

void add_values(const std::string& place, const Node& node, Values& values);

void add_entries(const std::string& place, const Node::Array& entries, Values& values) {
  std::map<std::string, int> times;  // Two servos may have one name.
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const bool is_table = entries[i].as<Node::Table>() != nullptr;
    const std::string name = is_table ? name_of_entry(entries[i]) : fmt::format("{}", i);
    if (is_table && name.empty()) continue;
    const int count = ++times[name];
    add_values(count == 1 ? fmt::format("{}.{}", place, name) : fmt::format("{}.{} {}", place, name, count),
               entries[i], values);
  }
}

// Adds the leaves below a node.
void add_values(const std::string& place, const Node& node, Values& values) {
  if (const auto* table = node.as<Node::Table>()) {
    for (const Node::Member& member : *table)
      add_values(place.empty() ? member.key : place + "." + member.key, member.node, values);
  } else if (const auto* entries = node.as<Node::Array>()) {
    add_entries(place, *entries, values);
  } else {
    values.emplace_back(place, node);
  }
}

Values values_of(const Node& summary) {
  Values values;
  add_values("", summary, values);
  // In words; their numbers are compared where they are.
  std::erase_if(values, [](const auto& value) {
    return value.first == "flexura" || value.first == "headline" || value.first.starts_with("notes.") ||
           (value.first.starts_with("outcomes.") && !value.first.ends_with(".reached"));
  });
  return values;
}

ComparedValue compared(const std::string& measure, std::optional<Node> a, std::optional<Node> b) {
  ComparedValue value{measure, std::move(a), std::move(b), {}, {}};
  if (!value.a || !value.b) return value;
  const auto first = number_of(*value.a), second = number_of(*value.b);
  if (!first || !second) return value;
  value.difference = *second - *first;
  if (*first != 0) value.relative = *value.difference / std::abs(*first);
  return value;
}

// Returns a value for people.
std::string text_of(const std::optional<Node>& node) {
  if (!node) return "-";
  if (const auto number = number_of(*node)) return fmt::format("{:.6g}", *number);
  if (const auto* text = node->as<std::string>()) return one_line(*text);
  return node->brief();
}

std::vector<std::string> row_of(const ComparedValue& value) {
  return {value.measure, text_of(value.a), text_of(value.b),
          value.difference ? fmt::format("{:+.3g}", *value.difference) : "",
          value.relative ? fmt::format("{:+.2f} %", 100 * *value.relative) : ""};
}

ChapterTable table_of(const std::vector<ComparedValue>& values) {
  ChapterTable table{{"measure", "A", "B", "difference", "relative"}, {}};
  for (const ComparedValue& value : values) table.rows.push_back(row_of(value));
  return table;
}

void print_table(const ChapterTable& table, std::ostream& out) {
  constexpr std::size_t widest = 48;  // Longer texts move the rest of their line.
  std::vector<std::size_t> widths(table.columns.size(), 0);
  const auto widen = [&](const std::vector<std::string>& row) {
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], std::min(row[i].size(), widest));
  };
  widen(table.columns);
  for (const auto& row : table.rows) widen(row);
  const auto print = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) line += fmt::format("{:<{}}  ", row[i], widths[i]);
    out << line.substr(0, line.find_last_not_of(' ') + 1) << '\n';
  };
  print(table.columns);
  for (const auto& row : table.rows) print(row);
}

Node json_of(const CompareArguments& arguments, const std::vector<ComparedValue>& values, std::size_t equal) {
  Node::Array list;
  for (const ComparedValue& value : values) {
    const auto number = [](const std::optional<double>& one) { return one ? number_node(*one) : Node{}; };
    list.push_back({Node::Table{{"measure", {}, {value.measure, {}}},
                                {"a", {}, value.a.value_or(Node{})},
                                {"b", {}, value.b.value_or(Node{})},
                                {"difference", {}, number(value.difference)},
                                {"relative", {}, number(value.relative)}},
                    {}});
  }
  return {Node::Table{{"a", {}, {arguments.a, {}}},
                      {"b", {}, {arguments.b, {}}},
                      {"equal", {}, {static_cast<std::int64_t>(equal), {}}},
                      {"values", {}, {std::move(list), {}}}},
          {}};
}

Node summary_in(const std::string& folder) {
  std::error_code error;
  if (!std::filesystem::exists(folder, error)) throw input_error(folder, "no such folder");
  if (!std::filesystem::is_directory(folder, error))
    throw input_error(folder, "expected a folder made by flexura run");
  const std::filesystem::path file = file_of_results(folder, summary_file_name);
  constexpr std::size_t most_bytes = std::size_t{1} << 28;
  Node summary = parse_json(read_text_file(file, most_bytes), file.string());
  if (summary.find("outcome") == nullptr)
    throw input_error(file.string(), "the summary has no outcome: expected the summary of a run");
  return summary;
}

std::string headline_in(const Node& summary) {
  for (const char* key : {"headline", "outcome"})
    if (const Node* text = summary.find(key))
      if (const auto* value = text->as<std::string>()) return *value;
  return "";
}

void write_page(const CompareArguments& arguments, const Node& a, const Node& b, ChapterTable table,
                std::size_t equal, std::ostream& err) {
  TerminalProgress progress(err);
  ComparisonData data{.a = arguments.a,
                      .b = arguments.b,
                      .headline_a = headline_in(a),
                      .headline_b = headline_in(b),
                      .version = std::string(version()),
                      .notes = {fmt::format("{} values are equal.", equal)},
                      .table = std::move(table),
                      .figures = comparison_figures(arguments.a, arguments.b, progress)};
  if (data.figures.empty()) data.notes.emplace_back("Neither log contains states.");
  progress.clear();
  write_new_file(arguments.out, comparison_html(data));
}

}  // namespace

bool ComparedValue::is_equal() const {
  return a && b && a->brief() == b->brief() && difference.value_or(0) == 0;
}

std::vector<ComparedValue> compared_values(const Node& a, const Node& b) {
  const Values first = values_of(a), second = values_of(b);
  const auto find = [](const Values& values, const std::string& measure) {
    const auto found = std::ranges::find(values, measure, &Values::value_type::first);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  };
  std::vector<ComparedValue> values;
  for (const auto& [measure, value] : first)
    values.push_back(compared(measure, value, find(second, measure)));
  for (const auto& [measure, value] : second)
    if (!find(first, measure)) values.push_back(compared(measure, std::nullopt, value));
  return values;
}

int compare_command(const CompareArguments& arguments, std::ostream& out, std::ostream& err) {
  const Node a = summary_in(arguments.a), b = summary_in(arguments.b);
  std::vector<ComparedValue> values = compared_values(a, b);
  const auto equal = static_cast<std::size_t>(std::ranges::count_if(values, &ComparedValue::is_equal));
  if (!arguments.all) std::erase_if(values, [](const ComparedValue& value) { return value.is_equal(); });
  if (!arguments.out.empty()) write_page(arguments, a, b, table_of(values), equal, err);
  if (arguments.json) {
    out << write_json(json_of(arguments, values, equal), 2) << '\n';
  } else {
    print_line(out, "A", arguments.a + ": " + headline_in(a));
    print_line(out, "B", arguments.b + ": " + headline_in(b));
    if (!values.empty()) print_table(table_of(values), out);
    out << fmt::format("{} values are equal\n", equal);
  }
  if (!arguments.out.empty()) print_line(arguments.json ? err : out, "page", arguments.out);
  return exit_done;
}

}  // namespace flexura

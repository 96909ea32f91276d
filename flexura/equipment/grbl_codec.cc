#include "flexura/equipment/grbl_codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace flexura {
namespace {

constexpr std::array<std::pair<GrblState, std::string_view>, 10> states{{{GrblState::idle, "Idle"},
                                                                         {GrblState::run, "Run"},
                                                                         {GrblState::hold, "Hold"},
                                                                         {GrblState::jog, "Jog"},
                                                                         {GrblState::alarm, "Alarm"},
                                                                         {GrblState::door, "Door"},
                                                                         {GrblState::check, "Check"},
                                                                         {GrblState::home, "Home"},
                                                                         {GrblState::sleep, "Sleep"},
                                                                         {GrblState::tool, "Tool"}}};

// Returns the whole text as a number, or std::nullopt.
template <class Number>
std::optional<Number> grbl_number(std::string_view text) {
  Number number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// Returns a decimal number as Grbl prints one. from_chars() would also take "inf" and "1e9".
std::optional<double> grbl_decimal(std::string_view text) {
  const auto is_part = [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-'; };
  if (!std::ranges::all_of(text, is_part)) return std::nullopt;
  return grbl_number<double>(text);
}

// Returns the part before the separator, and removes it and the separator from `text`.
std::string_view cut(std::string_view& text, char separator) {
  const std::size_t at = std::min(text.find(separator), text.size());
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(std::min(at + 1, text.size()));
  return part;
}

// Returns numbers between commas: at least one, at most one per axis; or std::nullopt.
std::optional<std::vector<double>> grbl_numbers(std::string_view text) {
  std::vector<double> numbers;
  if (text.ends_with(',')) return std::nullopt;
  do {
    const std::optional<double> one = grbl_decimal(cut(text, ','));
    if (!one || numbers.size() == grbl::most_axes) return std::nullopt;
    numbers.push_back(*one);
  } while (!text.empty());
  return numbers;
}

bool read_state(std::string_view text, GrblStatus& status) {
  const std::string_view name = cut(text, ':');
  const auto* const found = std::ranges::find(states, name, &std::pair<GrblState, std::string_view>::second);
  if (found == states.end()) return false;
  status.state = found->first;
  if (text.empty()) return true;
  const std::optional<int> part = grbl_number<int>(text);
  if (part) status.part = *part;
  return part.has_value();
}

bool read_field(std::string_view field, GrblStatus& status) {
  const std::string_view type = cut(field, ':');
  if (type == "MPos" || type == "WPos") {
    const auto positions = grbl_numbers(field);
    if (!positions || !status.positions.empty()) return false;
    status.positions = *positions, status.is_work = type == "WPos";
    return true;
  }
  if (type == "WCO") {
    const auto offset = grbl_numbers(field);
    if (offset) status.offset = *offset;
    return offset.has_value();
  }
  if (type == "Bf") {
    status.free_blocks = grbl_number<std::int64_t>(cut(field, ','));
    status.free_bytes = grbl_number<std::int64_t>(field);
    return status.free_blocks && status.free_bytes;
  }
  if (type == "FS" || type == "F") {
    status.feed = grbl_decimal(cut(field, ','));
    return status.feed.has_value();
  }
  if (type == "Pn") status.pins = field;
  return true;  // Ov, Ln, A and what later versions add.
}

GrblMessage parse_status(std::string_view line) {
  GrblStatus status;
  std::string_view rest = line.substr(1, line.size() - 2);
  bool is_good = read_state(cut(rest, '|'), status);
  while (is_good && !rest.empty()) is_good = read_field(cut(rest, '|'), status);
  if (!is_good || status.positions.empty()) return GrblUnknown{std::string(line)};
  if (!status.offset.empty() && status.offset.size() != status.positions.size())
    return GrblUnknown{std::string(line)};
  return status;
}

std::string listed(const std::vector<double>& numbers) {
  std::string list;
  for (const double number : numbers) list += fmt::format("{}{:.3f}", list.empty() ? "" : ",", number);
  return list;
}

}  // namespace

std::string_view text(GrblState state) {
  return std::ranges::find(states, state, &std::pair<GrblState, std::string_view>::first)->second;
}

GrblMessage parse_grbl(std::string_view line) {
  const auto number_after = [&](std::string_view prefix) {
    return grbl_number<int>(line.substr(prefix.size()));
  };
  if (line == "ok") return GrblOk{};
  if (line.size() > 2 && line.front() == '<' && line.back() == '>') return parse_status(line);
  if (line.starts_with("error:")) {
    if (const auto code = number_after("error:")) return GrblError{*code};
  } else if (line.starts_with("ALARM:")) {
    if (const auto code = number_after("ALARM:")) return GrblAlarm{*code};
  } else if (line.starts_with("Grbl") && line.find(" ['$'") != std::string_view::npos) {
    return GrblBanner{std::string(line.substr(0, line.find(" ['$'")))};
  } else if (line.size() > 2 && line.front() == '[' && line.back() == ']') {
    std::string_view rest = line.substr(1, line.size() - 2);
    std::string type(cut(rest, ':'));
    return GrblFeedback{std::move(type), std::string(rest)};
  } else if (line.starts_with('$') && line.find('=') != std::string_view::npos) {
    std::string_view rest = line.substr(1);
    if (const auto number = grbl_number<int>(cut(rest, '='))) return GrblSetting{*number, std::string(rest)};
  }
  return GrblUnknown{std::string(line)};
}

std::string text(const GrblStatus& status) {
  std::string line = fmt::format("<{}", text(status.state));
  if (status.part >= 0) line += fmt::format(":{}", status.part);
  line += fmt::format("|{}:{}", status.is_work ? "WPos" : "MPos", listed(status.positions));
  if (status.free_blocks && status.free_bytes)
    line += fmt::format("|Bf:{},{}", *status.free_blocks, *status.free_bytes);
  if (status.feed) line += fmt::format("|FS:{:.0f},0", *status.feed);
  if (!status.pins.empty()) line += "|Pn:" + status.pins;
  if (!status.offset.empty()) line += "|WCO:" + listed(status.offset);
  return line + ">";
}

std::string grbl_jog(std::string_view letters, std::span<const double> positions, double feed) {
  // Two words of one line must not be "-0".
  const auto decimal = [](double value) {
    std::string digits = fmt::format("{:.5f}", value);
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.ends_with('.')) digits.pop_back();
    return digits == "-0" ? std::string("0") : digits;
  };
  std::string line = "$J=G90G21G53";
  for (std::size_t i = 0; i < positions.size() && i < letters.size(); ++i)
    line += letters[i] + decimal(positions[i]);
  return line + fmt::format("F{:.3f}\n", feed);
}

std::vector<std::string> GrblLines::add(std::string_view bytes) {
  std::vector<std::string> lines;
  for (const char byte : bytes) {
    if (byte == '\n' || byte == '\r') {
      if (!begun_.empty() && !is_too_long_) lines.push_back(begun_);
      clear();
    } else if (begun_.size() == longest) {
      is_too_long_ = true;
    } else {
      begun_ += byte;
    }
  }
  return lines;
}

}  // namespace flexura

#include "flexura/view/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "flexura/serve/request_target.h"

namespace flexura {
namespace {

std::vector<std::string_view> split(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(at), text.size());
    parts.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

// Returns the query of the address: each key once, and only keys in `known`.
std::map<std::string, std::string> query_of(const RequestTarget& target,
                                            const std::vector<std::string>& known) {
  std::map<std::string, std::string> query;
  for (const auto& [key, value] : target.query) {
    if (std::ranges::count(known, key) == 0 || !query.emplace(key, value).second)
      throw ViewRefusal(fmt::format("the address has the unknown parameter \"{}\"", key));
  }
  return query;
}

template <class T>
T number_of(const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(static_cast<double>(value)))
    throw ViewRefusal(fmt::format("\"{}\" is not a number", text));
  return value;
}

ImageAsk image_ask(std::string_view name, const RequestTarget& target) {
  constexpr std::string_view ending = ".png";
  if (!name.ends_with(ending)) throw ViewRefusal("expected /image/CAMERA.png");
  ImageAsk ask{std::string(name.substr(0, name.size() - ending.size())), {}};
  const auto values = query_of(target, {"time"});
  if (const auto time = values.find("time"); time != values.end()) ask.time = number_of<double>(time->second);
  return ask;
}

SeriesAsk series_ask(const RequestTarget& target) {
  constexpr std::size_t most_names = 64;
  constexpr std::int64_t most_points = 100'000;
  auto values = query_of(target, {"names", "points"});
  SeriesAsk ask;
  for (const std::string_view name : split(values["names"], ',')) ask.names.emplace_back(name);
  std::vector<std::string> sorted = ask.names;
  std::ranges::sort(sorted);
  if (ask.names.empty() || ask.names.size() > most_names ||
      std::ranges::adjacent_find(sorted) != sorted.end())
    throw ViewRefusal(fmt::format("names: expected 1 to {} different names", most_names));
  ask.points = values.contains("points") ? number_of<std::int64_t>(values["points"]) : 1000;
  if (ask.points < 2 || ask.points > most_points)
    throw ViewRefusal(fmt::format("points: expected 2 to {}", most_points));
  return ask;
}

}  // namespace

Document read_document(std::string_view text) {
  const auto target = parse_request_target(text);
  if (!target) throw ViewRefusal("the address is not valid");
  const std::string_view path = target->path;
  constexpr std::string_view image = "/image/";
  if (path.starts_with(image)) return image_ask(path.substr(image.size()), *target);
  if (path == "/series") return series_ask(*target);
  if (path == "/report" && target->query.empty()) return ReportAsk{};
  throw ViewRefusal("nothing exists at this address");
}

}  // namespace flexura

#include "flexura/tasks/task_outcome.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace flexura {
namespace {

std::string plural_of(const std::string& noun) {
  return noun.ends_with('y') ? noun.substr(0, noun.size() - 1) + "ies" : noun + "s";
}

// Returns the total of outcomes with one noun; at least one. `is_alone`: there are no others.
std::string total_of_noun(const std::vector<const TaskOutcome*>& some, bool is_alone) {
  if (some.size() == 1) {
    const TaskOutcome& one = *some.front();
    return is_alone || one.brief.empty() ? one.line() : fmt::format("{}: {}", one.task, one.brief);
  }
  const auto reached = std::ranges::count_if(some, &TaskOutcome::is_reached);
  std::string text = fmt::format("{} of {} {} {}", reached, some.size(), plural_of(some.front()->noun),
                                 some.front()->success);
  const auto worst =
      std::ranges::max_element(some, {}, [](const TaskOutcome* one) { return one->size.value_or(-1); });
  if ((*worst)->size) text += ", worst " + (*worst)->size_text;
  return text;
}

}  // namespace

std::string TaskOutcome::line() const { return fmt::format("{}: {}", task, text); }

TaskOutcome not_begun(std::string task, std::string kind, std::string noun, std::string success) {
  return {.task = std::move(task),
          .kind = std::move(kind),
          .noun = std::move(noun),
          .success = std::move(success),
          .is_reached = false,
          .text = "not begun",
          .size = {}};
}

std::string total_of(const std::vector<TaskOutcome>& outcomes) {
  std::vector<std::vector<const TaskOutcome*>> nouns;
  for (const TaskOutcome& outcome : outcomes) {
    auto found =
        std::ranges::find_if(nouns, [&](const auto& some) { return some.front()->noun == outcome.noun; });
    if (found == nouns.end()) found = nouns.emplace(nouns.end());
    found->push_back(&outcome);
  }
  std::vector<std::string> texts;
  texts.reserve(nouns.size());
  for (const auto& some : nouns) texts.push_back(total_of_noun(some, nouns.size() == 1));
  return fmt::format("{}", fmt::join(texts, "; "));
}

Node outcomes_node(const std::vector<TaskOutcome>& outcomes) {
  Node::Array list;
  for (const TaskOutcome& outcome : outcomes)
    list.push_back({Node::Table{{"task", {}, {outcome.task, {}}},
                                {"kind", {}, {outcome.kind, {}}},
                                {"reached", {}, {outcome.is_reached, {}}},
                                {"text", {}, {outcome.text, {}}}},
                    {}});
  return {std::move(list), {}};
}

std::string length_text(double metres) {
  constexpr double least = 1e-6, one_metre = 1;
  if (metres < least) return "less than 0.001 mm";
  if (metres >= one_metre) return fmt::format("{:.3g} m", metres);
  const double millimetres = 1e3 * metres;
  return millimetres < 10 ? fmt::format("{:.2g} mm", millimetres) : fmt::format("{:.0f} mm", millimetres);
}

}  // namespace flexura

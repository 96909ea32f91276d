#include "flexura/base/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "flexura/base/one_line.h"
#include "flexura/base/problems.h"

namespace flexura {
namespace {

std::string listing(const std::vector<Problem>& problems) {
  std::string text;
  for (std::size_t i = 0; i < std::min(problems.size(), max_listed_problems); ++i) {
    text += (i == 0 ? "" : "\n") + problems[i].text();
  }
  if (problems.size() > max_listed_problems) {
    text += fmt::format("\n... and {} more", problems.size() - max_listed_problems);
  }
  return text;
}

// Returns the Levenshtein distance, where a transposition of neighbours counts as one edit (optimal string
// alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
    std::swap(before_last, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::string SourcePosition::text() const {
  if (!source) return "";
  return line == 0 ? *source : fmt::format("{}:{}:{}", *source, line, column);
}

std::string Problem::text() const {
  const std::string place = where.text();
  return one_line(place.empty() ? what : place + ": " + what);
}

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(listing(problems)), problems_(std::move(problems)) {}

InputError input_error(const std::string& source, std::string what, int line, int column) {
  return InputError({{{std::make_shared<const std::string>(source), line, column}, std::move(what)}});
}

std::string_view nearest_name(std::string_view word, const std::vector<std::string>& names) {
  // A much longer key is not a misspelling. The bound also limits the time for huge keys.
  constexpr std::size_t longest_word = 64;
  if (word.empty() || word.size() > longest_word) return {};
  std::string_view best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(word, name);
    if (distance < best_distance) {
      best_distance = distance;
      best = name;
    }
  }
  return best;
}

}  // namespace flexura

#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// A place in something a user wrote. Line and column count from 1; a line of 0 means the source as a whole.
struct SourcePosition {
  std::shared_ptr<const std::string>
      source;  ///< What to call it: a file's path, "--set", "stdin"; may be null.
  int line = 0;
  int column = 0;
  /// Where the characters of a text begin, when they stand on one line as they are: after its quotes. 0 for
  /// other values, and where escapes have changed the text.
  int text_column = 0;

  /// "file:line:column", "file" without a line, "" without a source.
  [[nodiscard]] std::string text() const;
};

/// One thing that is wrong with the input, in one line.
struct Problem {
  SourcePosition where;
  /// Begins with the path of what is wrong, where that has one: "arm.kind = 3: expected ...".
  std::string what;

  /// "file:line:column: what".
  [[nodiscard]] std::string text() const;
};

/// Input that cannot be used: every problem found, in the order of their discovery (the program's exit status
/// 2).
class InputError : public std::runtime_error {
 public:
  /// what() has a line each for the first 20, and how many more there are.
  explicit InputError(std::vector<Problem> problems);
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// The InputError of a source that fails as a whole, or at one place.
[[nodiscard]] InputError input_error(const std::string& source, std::string what, int line = 0,
                                     int column = 0);

/// `name` out of `names` that the misspelt `word` most likely means; empty when none is near.
[[nodiscard]] std::string_view nearest_name(std::string_view word, const std::vector<std::string>& names);

}  // namespace flexura

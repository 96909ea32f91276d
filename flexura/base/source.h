#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// A position in the user's input. Line and column count from 1; line 0 means the source as a whole.
struct SourcePosition {
  /// Name of the source: a file's path, "--set", "stdin"; may be null.
  std::shared_ptr<const std::string> source;
  int line = 0;
  int column = 0;
  /// Column of the first character of a text, after its quotes, if it is on one line without escapes. 0 for
  /// other values and texts.
  int text_column = 0;

  /// Returns "file:line:column", "file" without a line, "" without a source.
  [[nodiscard]] std::string text() const;
};

/// One error in the input, in one line.
struct Problem {
  SourcePosition where;
  /// Begins with the path of the error, if it has one: "arm.kind = 3: expected ...".
  std::string what;

  /// Returns "file:line:column: what".
  [[nodiscard]] std::string text() const;
};

/// Unusable input: all problems found, in order of discovery (the program's exit status 2).
class InputError : public std::runtime_error {
 public:
  /// what() has one line for each of the first 20, and the number of further ones.
  explicit InputError(std::vector<Problem> problems);
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// Returns the InputError of a source that fails as a whole, or at one position.
[[nodiscard]] InputError input_error(const std::string& source, std::string what, int line = 0,
                                     int column = 0);

/// Returns the name in `names` that the misspelt `word` most likely means; empty if no name is near.
[[nodiscard]] std::string_view nearest_name(std::string_view word, const std::vector<std::string>& names);

}  // namespace flexura

#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// A position in the user's input. Lines and columns are counted from 1; line 0 means the source as a whole.
struct SourcePosition {
  /// Name of the source: a file's path, "--set", "stdin"; may be null.
  std::shared_ptr<const std::string> source;
  int line = 0;
  int column = 0;
  /// Column of the first character inside the quotes of a text, if the text is on one line and has no
  /// escapes. Otherwise 0.
  int text_column = 0;

  /// Returns "file:line:column"; "file" if the line is 0; "" if the source is null.
  [[nodiscard]] std::string text() const;
};

/// One error in the input.
struct Problem {
  SourcePosition where;
  /// Message of one line. Begins with the path of the faulty value, if there is one: "arm.kind = 3: expected
  /// ...".
  std::string what;

  /// Returns "file:line:column: what".
  [[nodiscard]] std::string text() const;
};

/// Exception for unusable input, with all problems in the order found. The program then exits with status 2.
class InputError : public std::runtime_error {
 public:
  /// what() has one line for each of the first 20 problems, and states the number of further problems.
  explicit InputError(std::vector<Problem> problems);
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// Returns an InputError with one problem, at a position in the source or, with line 0, for the source as a
/// whole.
[[nodiscard]] InputError input_error(const std::string& source, std::string what, int line = 0,
                                     int column = 0);

/// Returns the name in `names` that is most similar to the misspelt `word`; empty if no name is similar.
[[nodiscard]] std::string_view nearest_name(std::string_view word, const std::vector<std::string>& names);

}  // namespace flexura

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// A running program that reads its standard input from this process. The program writes to the standard
/// error of this process. The standard output of the program is discarded.
class ChildProcess {
 public:
  /// Starts `arguments[0]` from the PATH. Throws std::runtime_error if the program does not exist.
  explicit ChildProcess(const std::vector<std::string>& arguments);
  /// Closes the program's input and waits for the program to end.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Writes to the program's input. Returns false if the program no longer reads.
  [[nodiscard]] bool write(std::string_view bytes);
  /// Closes the program's input, waits for its end, and returns its exit status. If a signal killed the
  /// program, the status is 128 plus the signal's number.
  int finish();

 private:
  std::string name_;
  int input_ = -1;
  int process_ = -1;
};

/// Returns true if a program with this name is on the PATH.
[[nodiscard]] bool has_program(const std::string& name);

}  // namespace flexura

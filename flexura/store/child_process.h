#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// A running program that reads its standard input from this process. It shares this process's standard
/// error; its standard output is discarded.
class ChildProcess {
 public:
  /// Starts `arguments[0]` from the PATH. Throws std::runtime_error if there is no such program.
  explicit ChildProcess(const std::vector<std::string>& arguments);
  /// Closes its input and waits for it.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Returns false if it no longer reads.
  [[nodiscard]] bool write(std::string_view bytes);
  /// Closes its input, waits for it, and returns its exit status; 128 plus the signal's number if a signal
  /// killed it.
  int finish();

 private:
  std::string name_;
  int input_ = -1;
  int process_ = -1;
};

/// Returns true if this program is on the PATH.
[[nodiscard]] bool has_program(const std::string& name);

}  // namespace flexura

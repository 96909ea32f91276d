#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace flexura {

/// A program at work that reads what it is given on its standard input. It gets this process's standard
/// error, and its standard output is thrown away.
class ChildProcess {
 public:
  /// Starts `arguments[0]`, looked for on the PATH. std::runtime_error when there is no such program.
  explicit ChildProcess(const std::vector<std::string>& arguments);
  /// Ends its input and waits for it.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// False when it no longer reads.
  [[nodiscard]] bool write(std::string_view bytes);
  /// Ends its input, waits for it, and returns its exit status; 128 and the signal's number when one killed
  /// it.
  int finish();

 private:
  std::string name_;
  int input_ = -1;
  int process_ = -1;
};

/// Whether the PATH has this program.
[[nodiscard]] bool has_program(const std::string& name);

}  // namespace flexura

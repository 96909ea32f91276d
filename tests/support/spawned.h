#pragma once

#include <string>
#include <vector>

namespace flexura {

/// Another program that runs during a test. It is killed in the end.
class Spawned {
 public:
  /// Starts a program with these arguments; the first is its name or path. Throws std::runtime_error if it
  /// cannot be started. Its standard output can be read by line(); its standard input stays open until its
  /// end.
  explicit Spawned(const std::vector<std::string>& arguments);
  ~Spawned();
  Spawned(const Spawned&) = delete;
  Spawned& operator=(const Spawned&) = delete;

  /// Returns the next line of its output; "" after its end.
  [[nodiscard]] std::string line();
  /// Kills it by SIGKILL and waits for its end.
  void kill();
  /// Starts it again, after kill().
  void restart();

 private:
  void start();

  std::vector<std::string> arguments_;
  int process_ = -1, input_ = -1, output_ = -1;
};

}  // namespace flexura

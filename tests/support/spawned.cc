#include "tests/support/spawned.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

extern char** environ;  // NOLINT(readability-identifier-naming): the system's name.

namespace flexura {

Spawned::Spawned(const std::vector<std::string>& arguments) : arguments_(arguments) { start(); }

void Spawned::restart() {
  ::close(input_), ::close(output_);
  start();
}

void Spawned::start() {
  int to_it[2] = {-1, -1}, from_it[2] = {-1, -1};
  if (::pipe2(to_it, O_CLOEXEC) != 0 || ::pipe2(from_it, O_CLOEXEC) != 0)
    throw std::runtime_error("no pipe for a program");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, to_it[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, from_it[1], STDOUT_FILENO);
  std::vector<char*> words;
  for (const std::string& argument : arguments_) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  const int problem = ::posix_spawnp(&process_, words[0], &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(to_it[0]), ::close(from_it[1]);
  input_ = to_it[1], output_ = from_it[0];
  if (problem != 0) throw std::runtime_error("cannot start " + arguments_.front());
}

Spawned::~Spawned() {
  kill();
  ::close(input_), ::close(output_);
}

std::string Spawned::line() {
  std::string text;
  char c = 0;
  while (::read(output_, &c, 1) == 1 && c != '\n') text += c;
  return text;
}

void Spawned::kill() {
  if (process_ <= 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
  process_ = -1;
}

}  // namespace flexura

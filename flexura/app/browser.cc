#include "flexura/app/browser.h"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>
#include <system_error>

#include "flexura/store/child_process.h"

namespace flexura {
namespace {

constexpr const char* opener = "xdg-open";

bool is_set(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0';
}

bool has_screen() { return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY"); }

// Writes the redirecting page to a new file that only this user can read. Returns an empty path on failure.
std::filesystem::path write_page(const std::string& url) {
  std::error_code error;
  const auto folder = std::filesystem::temp_directory_path(error);
  if (error) return {};
  std::string name = (folder / "flexura-XXXXXX.html").string();
  const int file = ::mkstemps(name.data(), 5);
  if (file < 0) return {};
  const std::string text =
      "<!DOCTYPE html><meta charset=\"utf-8\"><title>Flexura</title><script>location.replace(\"" + url +
      "\")</script>\n";
  const bool is_written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  ::close(file);
  return is_written ? std::filesystem::path(name) : std::filesystem::path();
}

// Starts the opener as a detached process, in its own session so that signals to this program's group do not
// end it.
void start(const std::string& argument) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_RDWR, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK);
  std::string program = opener, page = argument;
  char* const arguments[] = {program.data(), page.data(), nullptr};
  pid_t process = -1;
  // A failed start is ignored: the address has been printed anyway.
  (void)::posix_spawnp(&process, opener, &actions, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
}

}  // namespace

BrowserPage::BrowserPage(const std::string& url) {
  if (!has_screen() || !has_program(opener)) return;
  file_ = write_page(url);
  if (!file_.empty()) start(file_.string());
}

BrowserPage::~BrowserPage() {
  std::error_code ignored;
  if (!file_.empty()) std::filesystem::remove(file_, ignored);
}

}  // namespace flexura

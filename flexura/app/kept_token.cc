#include "flexura/app/kept_token.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "flexura/serve/token.h"

namespace flexura {
namespace {

constexpr std::size_t token_size = 32;
constexpr std::time_t longest_kept = 86400;  // s
// A file's time and the program's come of different clocks, one of which may tick first.
constexpr std::time_t most_ahead = 2;  // s

// A file descriptor that is closed with this object.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] bool is_open() const { return number_ >= 0; }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

// What is open there, if it is of this kind and nobody but this user can look into it.
std::optional<struct stat> own(const Descriptor& file, mode_t kind) {
  struct stat status{};
  if (!file.is_open() || ::fstat(file.number(), &status) != 0) return std::nullopt;
  const bool is_private = status.st_uid == ::geteuid() && (status.st_mode & 077U) == 0;
  if (!is_private || (status.st_mode & S_IFMT) != kind) return std::nullopt;
  return status;
}

bool is_token(std::string_view text) {
  return text.size() == token_size && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

std::optional<std::string> read_token(const Descriptor& folder, const std::string& name) {
  const Descriptor file(
      ::openat(folder.number(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  const auto status = own(file, S_IFREG);
  if (!status) return std::nullopt;
  const std::time_t age = std::time(nullptr) - status->st_mtime;
  if (age < -most_ahead || age > longest_kept) return std::nullopt;
  std::array<char, token_size + 1> bytes{};
  const ssize_t count = ::read(file.number(), bytes.data(), bytes.size());
  const std::string text(bytes.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  return is_token(text) ? std::optional(text) : std::nullopt;
}

// Another's file of that name is taken away and not written into. Where it cannot be kept, it holds for this
// start all the same.
void write_token(const Descriptor& folder, const std::string& name, const std::string& token) {
  (void)::unlinkat(folder.number(), name.c_str(), 0);
  const Descriptor file(
      ::openat(folder.number(), name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!file.is_open()) return;
  if (::write(file.number(), token.data(), token.size()) != static_cast<ssize_t>(token.size()))
    (void)::unlinkat(folder.number(), name.c_str(), 0);
}

std::filesystem::path folder_in(const char* variable) {
  const char* value = std::getenv(variable);
  std::filesystem::path path = value == nullptr ? "" : value;
  return path.is_absolute() ? path : std::filesystem::path();
}

}  // namespace

std::filesystem::path private_folder() {
  if (const auto runtime = folder_in("XDG_RUNTIME_DIR"); !runtime.empty()) return runtime / "flexura";
  if (const auto cache = folder_in("XDG_CACHE_HOME"); !cache.empty()) return cache / "flexura" / "viewer";
  if (const auto home = folder_in("HOME"); !home.empty()) return home / ".cache" / "flexura" / "viewer";
  return {};
}

std::string kept_token(const std::filesystem::path& folder, std::uint16_t port) {
  if (folder.empty()) return new_token();
  std::error_code error;
  std::filesystem::create_directories(folder.parent_path(), error);
  (void)::mkdir(folder.c_str(), 0700);
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  if (!own(opened, S_IFDIR)) return new_token();
  const std::string name = "token-" + std::to_string(port);
  if (auto token = read_token(opened, name)) return *std::move(token);
  std::string token = new_token();
  write_token(opened, name, token);
  return token;
}

}  // namespace flexura

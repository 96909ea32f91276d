#include "flexura/store/text_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "flexura/base/descriptor.h"
#include "flexura/base/source.h"

namespace flexura {

bool is_missing(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::status(path, error).type() == std::filesystem::file_type::not_found;
}

namespace {

// Returns true for devices without an end, such as /dev/zero. Input from a terminal ends.
bool is_endless(const std::filesystem::path& file, const std::filesystem::file_status& status) {
  if (!std::filesystem::is_character_file(status) && !std::filesystem::is_block_file(status)) return false;
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  const bool is_terminal = descriptor >= 0 && ::isatty(descriptor) == 1;
  if (descriptor >= 0) ::close(descriptor);
  return !is_terminal;
}

// Returns true for a pipe with a place in the file system. The standard input and pipes of a shell,
// /dev/fd/63, have none.
bool is_named_pipe(const std::filesystem::path& file, const std::filesystem::file_status& status) {
  std::error_code error;
  const auto place = std::filesystem::weakly_canonical(file, error);
  return std::filesystem::is_fifo(status) && !error && !place.string().starts_with("/proc/");
}

// Appends to `text` what comes through a named pipe until its writers have closed it, or until `text` has
// more than `max_bytes`. A pipe that is opened in the usual way waits for a writer for ever.
void read_named_pipe(const std::filesystem::path& file, std::size_t max_bytes, double longest_silence,
                     std::string& text) {
  const Descriptor pipe(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!pipe) throw input_error(file.string(), fmt::format("cannot be read: {}", std::strerror(errno)));
  std::string piece(std::size_t{64} << 10, '\0');
  while (text.size() <= max_bytes) {
    pollfd event{pipe.get(), POLLIN, 0};
    const int ready = ::poll(&event, 1, static_cast<int>(1000 * longest_silence));
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0)
      throw input_error(file.string(), fmt::format("is a pipe into which nothing was written for {:g} s: "
                                                   "expected a file",
                                                   longest_silence));
    const ssize_t got = ::read(pipe.get(), piece.data(), piece.size());
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (got < 0) throw input_error(file.string(), "cannot be read to its end");
    if (got == 0) return;
    text.append(piece, 0, static_cast<std::size_t>(got));
  }
}

}  // namespace

std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes, double longest_silence) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found)
    throw input_error(file.string(), "no such file");
  if (std::filesystem::is_directory(status)) throw input_error(file.string(), "is a folder: expected a file");
  if (is_endless(file, status)) throw input_error(file.string(), "is a device: expected a file");
  const auto too_large = [&] {
    return input_error(file.string(),
                       fmt::format("is larger than {} MiB: expected a smaller file", max_bytes >> 20));
  };
  std::string text;
  if (is_named_pipe(file, status)) {
    read_named_pipe(file, max_bytes, longest_silence, text);
    if (text.size() > max_bytes) throw too_large();
    return text;
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw input_error(file.string(), fmt::format("cannot be read: {}", std::strerror(errno)));
  if (std::filesystem::is_regular_file(status)) {
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (!error && size > max_bytes) throw too_large();
    if (!error) text.reserve(size);
  }
  // Reads in pieces up to the limit, because a pipe has no known size.
  std::string piece(std::size_t{64} << 10, '\0');
  while (stream && text.size() <= max_bytes) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    text.append(piece, 0, static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) throw input_error(file.string(), "cannot be read to its end");
  if (text.size() > max_bytes) throw too_large();
  return text;
}

std::filesystem::path file_inside(const std::filesystem::path& folder, const std::string& name) {
  const auto fail = [](const std::string& what) {
    std::vector<Problem> problems(1);
    problems.front().what = what;
    throw InputError(std::move(problems));
  };
  if (name.empty() || name.find('\0') != std::string::npos) fail("expected a file name");
  std::error_code error;
  const auto root = std::filesystem::weakly_canonical(folder.empty() ? "." : folder, error);
  if (error) fail(fmt::format("cannot read its folder: {}", error.message()));
  const auto target = std::filesystem::weakly_canonical(root / name, error);
  if (error) fail(fmt::format("cannot read \"{}\": {}", name, error.message()));
  const auto from_root = target.lexically_relative(root);
  if (from_root.empty() || *from_root.begin() == "..") {
    fail(fmt::format("\"{}\" is outside the experiment's folder: expected a file in that folder or below",
                     name));
  }
  // Checks the path as written: a path through a missing folder and back is invalid, even if its target
  // exists.
  if (!std::filesystem::exists(root / name, error)) fail(fmt::format("no file \"{}\"", name));
  if (!std::filesystem::is_regular_file(target, error))
    fail(fmt::format("\"{}\" is not a regular file", name));
  return folder / name;
}

namespace {

// Writes a file at `place`; `name` is its name in messages.
void write_fresh_file(const std::filesystem::path& place, std::string_view text,
                      const std::filesystem::path& name) {
  const auto fail = [&](bool is_begun) {
    const int reason = errno;
    if (is_begun) ::unlink(place.c_str());  // Removes an incomplete file.
    throw std::runtime_error(fmt::format("cannot write {}: {}", name.string(), std::strerror(reason)));
  };
  const int descriptor = ::open(place.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (descriptor < 0) fail(false);
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      ::close(descriptor);
      fail(true);
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::close(descriptor) != 0) fail(true);
}

// Returns an unused name in that folder. It is short, because the file's own name may have the maximal
// length.
std::filesystem::path unused_name(const std::filesystem::path& folder) {
  std::error_code error;
  for (int number = 0;; ++number) {
    std::filesystem::path name = folder / fmt::format(".flexura-{}-{}", ::getpid(), number);
    if (!std::filesystem::exists(std::filesystem::symlink_status(name, error))) return name;
  }
}

}  // namespace

void write_new_file(const std::filesystem::path& file, std::string_view text) {
  write_fresh_file(file, text, file);
}

void replace_file(const std::filesystem::path& file, std::string_view text) {
  const std::filesystem::path beside = unused_name(file.parent_path());
  write_fresh_file(beside, text, file);
  std::error_code error;
  std::filesystem::rename(beside, file, error);
  if (!error) return;
  std::error_code ignored;
  std::filesystem::remove(beside, ignored);
  throw std::runtime_error(fmt::format("cannot write {}: {}", file.string(), error.message()));
}

}  // namespace flexura

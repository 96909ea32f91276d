#include "flexura/store/mcap_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace flexura {
namespace {

[[noreturn]] void fail(int error, const std::string& what, const std::filesystem::path& path) {
  throw std::system_error(error, std::generic_category(), what + " " + path.string());
}

}  // namespace

AppendFile::AppendFile(std::filesystem::path path) : path_(std::move(path)) {
  constexpr mode_t everyone_but_the_umask = 0666;
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, everyone_but_the_umask);
  if (descriptor_ < 0) fail(errno, "cannot create", path_);
}

AppendFile::~AppendFile() {
  if (is_open()) ::close(descriptor_);
}

void AppendFile::append(std::span<const std::byte> bytes) {
  if (!is_open()) fail(EBADF, "cannot write to", path_);
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t count = ::write(descriptor_, bytes.data() + written, bytes.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      const int error = count < 0 ? errno : ENOSPC;
      // A reader could handle the incomplete end (as after a killed writer), but without it the file is
      // cleaner.
      [[maybe_unused]] const int tried = ::ftruncate(descriptor_, static_cast<off_t>(size_));
      ::close(std::exchange(descriptor_, -1));
      fail(error, "cannot write to", path_);
    }
    written += static_cast<std::size_t>(count);
  }
  size_ += bytes.size();
}

void AppendFile::close() {
  if (is_open() && ::close(std::exchange(descriptor_, -1)) != 0) fail(errno, "cannot close", path_);
}

// Opening a pipe without a writer would block forever.
MappedFile::MappedFile(const std::filesystem::path& path)
    : name_(path.string()), file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (!file_) fail(errno, "cannot read", path);
  struct stat status{};
  if (::fstat(file_.get(), &status) != 0) fail(errno, "cannot read", path);
  if (S_ISDIR(status.st_mode)) fail(EISDIR, "cannot read", path);
  if (!S_ISREG(status.st_mode)) fail(EINVAL, "not a regular file:", path);
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return;  // mmap refuses a length of zero.
  void* const start = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file_.get(), 0);
  if (start == MAP_FAILED) fail(errno, "cannot read", path);
  bytes_ = {static_cast<const std::byte*>(start), size};
}

void MappedFile::require_whole() const {
  struct stat status{};
  if (::fstat(file_.get(), &status) != 0 || static_cast<std::size_t>(status.st_size) < bytes_.size())
    throw std::runtime_error(name_ + " has become shorter since it was opened");
}

void MappedFile::has_read(std::size_t bytes) const {
  if (read_.fetch_add(bytes) + bytes < window || bytes_.empty()) return;
  read_ = 0;
  // A failure leaves the pages in memory.
  (void)::madvise(const_cast<std::byte*>(bytes_.data()), bytes_.size(), MADV_DONTNEED);
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

}  // namespace flexura

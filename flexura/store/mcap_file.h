#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "flexura/base/descriptor.h"

namespace flexura {

/// A new file to which bytes are appended. A new file never replaces an existing file.
class AppendFile {
 public:
  /// Creates the file. Throws std::system_error with the path if the file already exists, its folder does not
  /// exist, or access is denied.
  explicit AppendFile(std::filesystem::path path);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Returns the number of bytes appended so far, which is the position of the next byte.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Returns false after close() or a failure.
  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }

  /// Passes the bytes to the operating system before it returns, so that they are not lost if the process
  /// ends. If not all bytes can be written, removes those already written, closes the file and throws
  /// std::system_error with the path.
  void append(std::span<const std::byte> bytes);
  /// Closes the file. Throws std::system_error with the path if the system reports a late failure. May be
  /// called twice.
  void close();

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// Content of a file, mapped into memory: only the accessed pages are read. Pages that are no longer needed
/// can be released, so that a large file that is read once occupies little memory.
class MappedFile {
 public:
  /// Throws std::system_error with the path if the file cannot be read or is not a regular file.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// Returns the bytes that the file had when it was opened. The bytes are valid as long as this object
  /// exists.
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

  /// Bytes after which the pages are released.
  static constexpr std::size_t window = std::size_t{8} << 20;
  /// Throws std::runtime_error if the file has become shorter, so that its last bytes cannot be read. A file
  /// that is shortened just after this check ends the program (SIGBUS).
  void require_whole() const;
  /// Reports that so many bytes were read. After each `window` bytes, releases all pages from memory; they
  /// are read again when they are accessed. Several threads may call this function while others read.
  void has_read(std::size_t bytes) const;

 private:
  std::string name_;
  Descriptor file_;
  std::span<const std::byte> bytes_;
  mutable std::atomic<std::size_t> read_ = 0;
};

}  // namespace flexura

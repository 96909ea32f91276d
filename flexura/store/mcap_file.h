#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace flexura {

/// A new file that only grows, and never replaces another.
class AppendFile {
 public:
  /// Creates the file. Throws std::system_error with the path: it exists already, its folder does not, no
  /// right to write there.
  explicit AppendFile(std::filesystem::path path);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Bytes appended so far: where the next ones will lie.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// False from close() or a failure on.
  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }

  /// Hands the bytes to the operating system before it returns: they outlive the process. When they do not
  /// all fit, takes back what was written of them, closes the file and throws std::system_error with the
  /// path.
  void append(std::span<const std::byte> bytes);
  /// Throws std::system_error with the path when the system reports a late failure. Twice is harmless.
  void close();

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// A file's content, mapped into memory: only the pages that are looked at are read.
class MappedFile {
 public:
  /// Throws std::system_error with the path when it cannot be read or is not a regular file.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// As long as the file was when it was opened; lives as long as this object.
  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace flexura

#pragma once

#include <cstddef>
#include <memory>
#include <string>

namespace flexura {

/// The system calls on a video device. Tests replace these calls by V4l2Fake. Each function returns the
/// result of the system call, but a negative error number in place of -1.
class V4l2Calls {
 public:
  virtual ~V4l2Calls() = default;
  V4l2Calls() = default;
  V4l2Calls(const V4l2Calls&) = delete;
  V4l2Calls& operator=(const V4l2Calls&) = delete;

  /// Opens a device for reading and writing, without blocking.
  virtual int open(const std::string& path) = 0;
  virtual void close(int device) = 0;
  virtual int ioctl(int device, unsigned long request, void* argument) = 0;
  /// Maps a buffer of the device; null if that fails.
  virtual void* map(int device, std::size_t length, std::size_t offset) = 0;
  virtual void unmap(void* memory, std::size_t length) = 0;
  /// Waits for at most `timeout`, s. Returns 1 if a frame or an error is available, otherwise 0.
  virtual int wait(int device, double timeout) = 0;
};

/// Returns the real system calls.
[[nodiscard]] std::shared_ptr<V4l2Calls> v4l2_system_calls();

/// Owner of an open video device, which the destructor closes.
class V4l2Device {
 public:
  V4l2Device(V4l2Calls& calls, const std::string& path) : calls_(calls), device_(calls.open(path)) {}
  ~V4l2Device() {
    if (device_ >= 0) calls_.close(device_);
  }
  V4l2Device(const V4l2Device&) = delete;
  V4l2Device& operator=(const V4l2Device&) = delete;

  /// Returns 0, or the negative error number of the failed open().
  [[nodiscard]] int problem() const { return device_ < 0 ? device_ : 0; }
  int ioctl(unsigned long request, void* argument) { return calls_.ioctl(device_, request, argument); }
  void* map(std::size_t length, std::size_t offset) { return calls_.map(device_, length, offset); }
  int wait(double timeout) { return calls_.wait(device_, timeout); }
  [[nodiscard]] V4l2Calls& calls() { return calls_; }

 private:
  V4l2Calls& calls_;
  int device_;
};

/// Returns the system's message for a negative error number.
[[nodiscard]] std::string v4l2_error(int negative);

}  // namespace flexura

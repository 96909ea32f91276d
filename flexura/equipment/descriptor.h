#pragma once

#include <unistd.h>

#include <utility>

namespace flexura {

/// An open file descriptor, closed in the end.
class Descriptor {
 public:
  Descriptor() = default;
  /// Takes over an open descriptor, or -1 for none.
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  /// Returns the descriptor, or -1.
  [[nodiscard]] int get() const { return descriptor_; }
  /// Returns true if there is a descriptor.
  explicit operator bool() const { return descriptor_ >= 0; }

 private:
  int descriptor_ = -1;
};

}  // namespace flexura

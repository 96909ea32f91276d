#pragma once

#include <unistd.h>

#include <utility>

namespace flexura {

/// Owner of an open file descriptor, which the destructor closes.
class Descriptor {
 public:
  Descriptor() = default;
  /// Becomes the owner of an open descriptor; -1: none.
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

#pragma once

#include <cstdint>

#include "flexura/base/image.h"

namespace flexura {

/// A frame as it is compared.
struct PeerPicture {
  Image<std::uint8_t> pixels;  ///< Gray or red, green, blue; 255 is light 1, without gamma.
  Image<float> depth;          ///< Along the optical axis, m.
};

/// A renderer under measurement.
class Peer {
 public:
  Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  virtual ~Peer() = default;

  /// Draws a frame and brings its numbers into main memory: what is measured.
  virtual void draw() = 0;
  /// A frame, with its depth even where draw() leaves it behind.
  virtual PeerPicture picture() = 0;
};

}  // namespace flexura

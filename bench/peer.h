#pragma once

#include <cstdint>

#include "flexura/base/image.h"

namespace flexura {

/// A frame to compare.
struct PeerPicture {
  Image<std::uint8_t> pixels;  ///< Gray or red, green, blue; 255 is light 1, without gamma.
  Image<float> depth;          ///< Along the optical axis, m.
};

/// A renderer to benchmark.
class Peer {
 public:
  Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  virtual ~Peer() = default;

  /// Draws a frame and copies its pixels into main memory. This is the measured operation.
  virtual void draw() = 0;
  /// Returns a frame with its depth, even if draw() does not read the depth back.
  virtual PeerPicture picture() = 0;
};

}  // namespace flexura

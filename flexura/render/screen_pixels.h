#pragma once

#include <cstddef>
#include <vector>

#include "flexura/camera/sensor.h"
#include "flexura/camera/view.h"
#include "flexura/render/scene.h"

namespace flexura {

/// Stores pixels of the reference path that show only screens. Stored pixels can be reused in later pictures
/// as long as camera and screens do not change. This object stores the pixels of the last few cameras.
class ScreenPixels {
 public:
  /// A pixel: column, row, depth, m, and light of each channel.
  struct Pixel {
    int u = 0, v = 0;
    float depth = 0, light[3] = {};
  };

  /// Starts a picture. Afterwards, find() must be called in the order of rows, and within a row in the order
  /// of columns.
  void begin(const Scene& scene, const View& view, PixelKind pixels);
  /// Returns the pixel if it is stored; null otherwise. The pointer is valid until the next call.
  [[nodiscard]] const Pixel* find(int u, int v);
  /// Stores the pixel that the last find() did not find.
  void add(const Pixel& pixel) { merged_.push_back(pixel); }
  /// Ends the picture.
  void end();

 private:
  struct Known {
    View view;
    std::vector<Screen> screens;
    Color background;
    PixelKind pixels;
    std::vector<Pixel> list;  // In the order of rows.
  };
  std::vector<Known> known_;
  std::size_t now_ = 0, next_ = 0;  // Used for this picture; replaced next.
  std::size_t at_ = 0;              // Entries before it are in merged_.
  std::vector<Pixel> merged_;
};

}  // namespace flexura

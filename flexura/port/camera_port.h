#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "flexura/base/image.h"
#include "flexura/port/outcome.h"

namespace flexura {

/// One image of a camera. Cheap to copy, because copies share the picture.
struct Frame {
  std::int64_t number = 0;  ///< Number of the exposure, from 0; lost frames are counted.
  /// Middle of the exposure, s; with a rolling shutter, middle of the exposure of the middle row.
  double time = 0;
  double exposure = 0;                     ///< Exposure time, s.
  double received = 0;                     ///< Time at which the frame became available, s.
  std::shared_ptr<const Picture> picture;  ///< The image; never null.
};

/// A camera that records frames continuously.
class CameraPort {
 public:
  virtual ~CameraPort() = default;
  CameraPort() = default;
  CameraPort(const CameraPort&) = delete;
  CameraPort& operator=(const CameraPort&) = delete;

  /// Returns the newest frame that is available now; std::nullopt if this frame was returned before. Skips
  /// older frames.
  [[nodiscard]] virtual Outcome<std::optional<Frame>> newest() = 0;
  /// Waits for the next frame. Returns std::nullopt if no frame arrives within `timeout`, s. Refuses a
  /// timeout that is not finite.
  [[nodiscard]] virtual Outcome<std::optional<Frame>> wait(double timeout) = 0;
};

}  // namespace flexura

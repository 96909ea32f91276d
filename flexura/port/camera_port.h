#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "flexura/base/image.h"
#include "flexura/port/outcome.h"

namespace flexura {

/// One image of a camera. Cheap to copy.
struct Frame {
  std::int64_t number = 0;  ///< Number of the exposure, from 0. Lost frames count.
  double time = 0;          ///< Middle of the exposure (of the middle row with a rolling shutter), s.
  double exposure = 0;      ///< Exposure time, s.
  double received = 0;      ///< Time from which it was available, s.
  std::shared_ptr<const Picture> picture;  ///< Never null.
};

/// A camera that records frames by itself.
class CameraPort {
 public:
  virtual ~CameraPort() = default;
  CameraPort() = default;
  CameraPort(const CameraPort&) = delete;
  CameraPort& operator=(const CameraPort&) = delete;

  /// Returns the newest frame available now, or std::nullopt if it was given before. Skips older frames.
  [[nodiscard]] virtual Outcome<std::optional<Frame>> newest() = 0;
  /// Waits up to `timeout` s for the next frame. Returns std::nullopt after that. Refuses a timeout that is
  /// not finite.
  [[nodiscard]] virtual Outcome<std::optional<Frame>> wait(double timeout) = 0;
};

}  // namespace flexura

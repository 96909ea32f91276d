#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "flexura/base/image.h"
#include "flexura/port/outcome.h"

namespace flexura {

/// One image of a camera. Cheap to copy.
struct Frame {
  std::int64_t number = 0;  ///< Counts the camera's exposures from 0, those that are lost too.
  double time = 0;          ///< Middle of the exposure (of the middle row, where rows follow each other), s.
  double exposure = 0;      ///< s
  double received = 0;      ///< When it could be had, s.
  std::shared_ptr<const Picture> picture;  ///< Never null.
};

/// A camera that gives frames on its own.
class CameraPort {
 public:
  virtual ~CameraPort() = default;
  CameraPort() = default;
  CameraPort(const CameraPort&) = delete;
  CameraPort& operator=(const CameraPort&) = delete;

  /// The newest frame that can be had now, unless it was given before. Older ones are passed over.
  [[nodiscard]] virtual Outcome<std::optional<Frame>> newest() = 0;
  /// The next one: waits for it until `timeout` s have passed; then none. Refused: a timeout that is not
  /// finite.
  [[nodiscard]] virtual Outcome<std::optional<Frame>> wait(double timeout) = 0;
};

}  // namespace flexura

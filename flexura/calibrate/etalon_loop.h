#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <memory>

#include "flexura/calibrate/look_loop.h"
#include "flexura/calibrate/offset_steps.h"

namespace flexura {

/// Base class of calibrations with the cylinder (section 3.4 of the paper). Each camera is oriented and
/// positioned horizontally, then vertically. Each of these motions nulls an offset in the picture. Then the
/// zooms are equalised. Derived classes measure, choose the steps, and decide when an offset is small enough.
class EtalonLoop {
 public:
  /// `is_printed`: steps have equal size, offsets are nulled one after the other, and zooms change as printed
  /// in the paper.
  EtalonLoop(LookLoop& loop, bool is_printed) : loop_(loop), is_printed_(is_printed) {}
  virtual ~EtalonLoop() = default;
  EtalonLoop(const EtalonLoop&) = delete;
  EtalonLoop& operator=(const EtalonLoop&) = delete;
  [[nodiscard]] LookLoop::Error run();

 protected:
  using Error = LookLoop::Error;
  /// An offset to be nulled, and the motion that would null it according to the model.
  struct Offset {
    const char* step;
    double px;  ///< Measured offset.
    /// Required motion, rad or m. If steps have equal size (is_printed), the measured offset, px.
    double want;
    /// Tolerance and largest step, in the unit of `want`. `most` is 0 for steps of equal size.
    double accepted, most;
    const char* how;  ///< Description of the motion for the log.
    /// Motion of pan, tilt, stage x and stage y per unit of `want`, or per step if steps have equal size.
    Eigen::Vector4d by;
  };

  /// Takes a picture and measures it.
  [[nodiscard]] virtual Error look(std::size_t i) = 0;
  /// Returns an error if the last picture could not be measured.
  [[nodiscard]] virtual Error unmeasured(std::size_t /*i*/) const { return std::nullopt; }
  /// Returns the offsets of the last picture: horizontal orientation and positioning, then vertical.
  [[nodiscard]] virtual std::array<Offset, 4> offsets(std::size_t i) const = 0;
  /// If the offset cannot be nulled in the present picture, turns the camera and sets `is_turned`.
  [[nodiscard]] virtual Error prepare(std::size_t i, std::size_t offset, bool& is_turned) = 0;
  /// Nulls all offsets of a camera.
  [[nodiscard]] virtual Error align(std::size_t i) = 0;
  /// Returns the size of the cylinder's image in the first camera relative to the second camera.
  [[nodiscard]] virtual double ratio() const = 0;
  /// Runs the steps after the zooms are equal. Returns an error if the result is not acceptable.
  [[nodiscard]] virtual Error finish() = 0;

  /// Takes pictures and moves the camera until these offsets are within their tolerances in one picture, or
  /// at the resolution of the commands.
  [[nodiscard]] Error null(std::size_t i, std::initializer_list<std::size_t> which);

  LookLoop& loop_;

 private:
  [[nodiscard]] Error step(std::size_t i, const Offset& offset, OffsetSteps& steps, bool& is_moved);
  [[nodiscard]] Error zoom();

  bool is_printed_;
};

/// Returns the method exactly as printed in the paper, including its errors (docs/calibration-paper.md). The
/// method counts pixels, and positioning uses a quantity that does not depend on the position. The test of
/// the vertical calibration checks the quantity that was just nulled, and the zoom changes in the wrong
/// direction. The method reports loops that never end, and loops that diverge.
[[nodiscard]] std::unique_ptr<EtalonLoop> etalon_as_printed(LookLoop& loop);
/// Returns the corrected method. The method measures borders with subpixel accuracy. The steps shrink until
/// all four offsets are within tolerance in one picture. Then the method repeats the steps with the measured
/// principal point, the fixed point of pictures with different focal lengths. Finally the heads move to those
/// neighbouring positions for which the optical axes are most nearly orthogonal.
[[nodiscard]] std::unique_ptr<EtalonLoop> etalon_corrected(LookLoop& loop);

}  // namespace flexura

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <memory>

#include "flexura/calibrate/look_loop.h"
#include "flexura/calibrate/offset_steps.h"

namespace flexura {

/// Base class of calibrations with the cylinder (section 3.4). Each camera is oriented and positioned
/// horizontally, then vertically: a motion nulls an offset in the picture. Then the zooms are equalized.
/// Derived classes measure, choose the steps and decide when an offset is small enough.
class EtalonLoop {
 public:
  /// `is_printed`: steps have equal size, offsets are nulled one after the other, and zooms change as the
  /// paper prints.
  EtalonLoop(LookLoop& loop, bool is_printed) : loop_(loop), is_printed_(is_printed) {}
  virtual ~EtalonLoop() = default;
  EtalonLoop(const EtalonLoop&) = delete;
  EtalonLoop& operator=(const EtalonLoop&) = delete;
  [[nodiscard]] LookLoop::Error run();

 protected:
  using Error = LookLoop::Error;
  /// An offset to be nulled, and the motion that nulls it according to the model.
  struct Offset {
    const char* step;
    double px;    ///< Measured offset.
    double want;  ///< Required motion, rad or m; with is_printed, the measured offset.
    /// Tolerance and largest step, in the unit of `want`; `most` is 0 for steps of equal size.
    double accepted, most;
    const char* how;     ///< Description for the log.
    Eigen::Vector4d by;  ///< Motion of pan, tilt, stage x and y per unit of `want`, or per step.
  };

  /// Takes a picture and measures it.
  [[nodiscard]] virtual Error look(std::size_t i) = 0;
  /// Returns why the last picture could not be measured, if so.
  [[nodiscard]] virtual Error unmeasured(std::size_t /*i*/) const { return std::nullopt; }
  /// Returns the offsets of the last picture: horizontal orientation and positioning, then vertical.
  [[nodiscard]] virtual std::array<Offset, 4> offsets(std::size_t i) const = 0;
  /// Turns the camera first if the picture requires it; sets `is_turned` if the camera was turned.
  [[nodiscard]] virtual Error prepare(std::size_t i, std::size_t offset, bool& is_turned) = 0;
  /// Nulls all offsets of a camera.
  [[nodiscard]] virtual Error align(std::size_t i) = 0;
  /// Returns the size of the cylinder in the first camera relative to the second.
  [[nodiscard]] virtual double ratio() const = 0;
  /// Runs the steps after the zooms. Returns why the result is not acceptable, if so.
  [[nodiscard]] virtual Error finish() = 0;

  /// Takes pictures and moves until these offsets are within their tolerances in one picture, or nothing
  /// finer can be commanded.
  [[nodiscard]] Error null(std::size_t i, std::initializer_list<std::size_t> which);

  LookLoop& loop_;

 private:
  [[nodiscard]] Error step(std::size_t i, const Offset& offset, OffsetSteps& steps, bool& is_moved);
  [[nodiscard]] Error zoom();

  bool is_printed_;
};

/// The method as the paper prints it, including its errors (docs/calibration-paper.md). It counts pixels, and
/// positioning uses a quantity that does not depend on the position. The test of the vertical calibration
/// checks the quantity that was just nulled, and the zoom changes in the wrong direction. The method reports
/// loops that never end or diverge.
[[nodiscard]] std::unique_ptr<EtalonLoop> etalon_as_printed(LookLoop& loop);
/// Corrected method: subpixel borders, and steps that shrink until all four offsets hold in one picture. This
/// is repeated with the measured principal point: the fixed point of pictures with a longer focal length.
/// Finally the heads move to the neighbouring positions whose optical axes are the most nearly orthogonal.
[[nodiscard]] std::unique_ptr<EtalonLoop> etalon_corrected(LookLoop& loop);

}  // namespace flexura

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <memory>

#include "flexura/calibrate/look_loop.h"
#include "flexura/calibrate/offset_steps.h"

namespace flexura {

/// Calibrates with the calibration cylinder (section 3.4): of both cameras horizontal orientation and
/// positioning, then vertical ones, each an offset in the picture that a motion nulls; then the zooms. What
/// derives from it measures, and says which steps are taken and when that is enough.
class EtalonLoop {
 public:
  /// `is_printed`: steps are all alike, one offset after the other is nulled, and zooms go the printed way.
  EtalonLoop(LookLoop& loop, bool is_printed) : loop_(loop), is_printed_(is_printed) {}
  virtual ~EtalonLoop() = default;
  EtalonLoop(const EtalonLoop&) = delete;
  EtalonLoop& operator=(const EtalonLoop&) = delete;
  [[nodiscard]] LookLoop::Trouble run();

 protected:
  using Trouble = LookLoop::Trouble;
  /// Something to be nulled, and the motion that does it by the behaviour of the image that is believed.
  struct Offset {
    const char* step;
    double px;              ///< As measured.
    double want;            ///< As a motion: rad, or m. As printed: as measured.
    double accepted, most;  ///< Likewise; most: of one step, 0 where steps are all alike.
    const char* how;        ///< In words.
    Eigen::Vector4d by;     ///< Of pan, tilt, stage x and y, for each unit of `want`, or a step.
  };

  /// Takes a picture and measures it.
  [[nodiscard]] virtual Trouble look(std::size_t i) = 0;
  /// Why there was nothing to be measured in the last one.
  [[nodiscard]] virtual Trouble unmeasured(std::size_t /*i*/) const { return std::nullopt; }
  /// Of the last picture: horizontal orientation and positioning, then vertical.
  [[nodiscard]] virtual std::array<Offset, 4> offsets(std::size_t i) const = 0;
  /// Whether the camera had to turn first, for what the picture shows.
  [[nodiscard]] virtual Trouble prepare(std::size_t i, std::size_t offset, bool& is_turned) = 0;
  /// Nulls all offsets of a camera.
  [[nodiscard]] virtual Trouble align(std::size_t i) = 0;
  /// How much larger the first camera shows the cylinder.
  [[nodiscard]] virtual double ratio() const = 0;
  /// What follows the zooms, and why that is no good end.
  [[nodiscard]] virtual Trouble finish() = 0;

  /// Looks and moves until these offsets hold in one picture, or nothing finer can be commanded.
  [[nodiscard]] Trouble null(std::size_t i, std::initializer_list<std::size_t> which);

  LookLoop& loop_;

 private:
  [[nodiscard]] Trouble step(std::size_t i, const Offset& offset, OffsetSteps& steps, bool& is_moved);
  [[nodiscard]] Trouble zoom();

  bool is_printed_;
};

/// As printed, slips included: pixels are counted, positioning looks at what does not depend on it, the test
/// of the vertical calibration asks what was just made so, and the zoom goes the wrong way
/// (docs/calibration-paper.md). Where a loop goes on for ever, or runs away, it says so.
[[nodiscard]] std::unique_ptr<EtalonLoop> etalon_as_printed(LookLoop& loop);
/// Corrected: borders to a part of a pixel, steps that shrink until all four hold in one picture, and again
/// with the principal point that a longer focal length shows: where things stay; in the end, of the heads'
/// positions around, those whose axes are the most nearly orthogonal.
[[nodiscard]] std::unique_ptr<EtalonLoop> etalon_corrected(LookLoop& loop);

}  // namespace flexura

#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "flexura/port/drive_port.h"

namespace flexura {

/// Several drives, the parts, that together form one drive. The axes of the first part come first, then the
/// axes of the second part, and so on.
class JoinedDrive : public DrivePort {
 public:
  /// Order in which the functions of the parts are called.
  enum class Calls {
    one_by_one,  ///< The parts are called one after the other, in the thread of the caller.
    /// The parts are called at the same time, each in a separate thread, so that delays of slow links do not
    /// add up.
    at_once
  };

  /// The parts must outlive this object. Throws std::invalid_argument if there are none or their quantities
  /// differ.
  explicit JoinedDrive(std::vector<DrivePort*> parts, Calls calls = Calls::at_once);

  [[nodiscard]] DriveQuantity quantity() const override { return parts_.front()->quantity(); }
  [[nodiscard]] std::size_t axes() const override { return axes_; }
  /// Commands each part to its own targets, with the same duration. If a part fails, halts all parts and
  /// returns the first fault.
  CommandOutcome command(std::span<const double> targets, double duration) override;
  /// Halts every part, even if a part fails. Returns the first fault.
  CommandOutcome halt() override;
  /// Returns the readings of all parts. The time is the middle between the earliest and the latest reading.
  /// The reading has positions behind the backlash only if every part reports them.
  Outcome<DriveReading> read() override;

 private:
  void for_each(const std::function<void(std::size_t)>& call) const;

  std::vector<DrivePort*> parts_;
  Calls calls_;
  std::size_t axes_ = 0;
};

}  // namespace flexura

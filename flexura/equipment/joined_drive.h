#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "flexura/port/drive_port.h"

namespace flexura {

/// Several motion controllers that together form one drive. Its axes are those of the first, then those of
/// the second, and so on.
class JoinedDrive : public DrivePort {
 public:
  /// How the parts are called.
  enum class Calls {
    one_by_one,  ///< In order, from the thread of the caller.
    at_once      ///< Each from a thread of its own, so that slow links do not add up.
  };

  /// The parts must outlive this object. Throws std::invalid_argument if there are none or their quantities
  /// differ.
  explicit JoinedDrive(std::vector<DrivePort*> parts, Calls calls = Calls::at_once);

  [[nodiscard]] DriveQuantity quantity() const override { return parts_.front()->quantity(); }
  [[nodiscard]] std::size_t axes() const override { return axes_; }
  /// Commands every part with its share of the targets and the same duration. If one fails, halts all and
  /// returns the first fault.
  CommandOutcome command(std::span<const double> targets, double duration) override;
  /// Halts every part, even if one fails. Returns the first fault.
  CommandOutcome halt() override;
  /// Returns the readings of all parts. The time is the middle between the earliest and the latest. Positions
  /// behind the backlash are there if every part has them.
  Outcome<DriveReading> read() override;

 private:
  void for_each(const std::function<void(std::size_t)>& call) const;

  std::vector<DrivePort*> parts_;
  Calls calls_;
  std::size_t axes_ = 0;
};

}  // namespace flexura

#include "flexura/base/time_left.h"

namespace flexura {

std::optional<double> TimeLeft::at(double fraction, double elapsed) {
  if (fraction < last_fraction_) {
    begin_elapsed_ = elapsed;
    begin_fraction_ = fraction;
  }
  last_fraction_ = fraction;
  const double done = fraction - begin_fraction_;
  const double took = elapsed - begin_elapsed_;
  // Too early, the estimate would jump.
  if (done < 0.02 || took < 1) return std::nullopt;
  return took * (1 - fraction) / done;
}

}  // namespace flexura

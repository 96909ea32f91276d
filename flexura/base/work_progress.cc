#include "flexura/base/work_progress.h"

#include <algorithm>

namespace flexura {

WorkProgress::WorkProgress(Progress& whole, const std::vector<double>& weights) : whole_(whole) {
  double sum = 0;
  for (const double weight : weights) sum += std::max(weight, 0.0);
  for (const double weight : weights) pieces_.emplace_back(*this, sum > 0 ? std::max(weight, 0.0) / sum : 0);
}

void WorkProgress::Piece::update(double fraction, std::string_view what) {
  const double now = std::clamp(fraction, done_, 1.0);
  job_->done_ = std::min(1.0, job_->done_ + (now - done_) * share_);
  done_ = now;
  job_->whole_.update(job_->done_, what);
}

}  // namespace flexura

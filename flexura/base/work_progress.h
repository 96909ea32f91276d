#pragma once

#include <cstddef>
#include <deque>
#include <string_view>
#include <vector>

#include "flexura/base/progress.h"

namespace flexura {

/// Progress of a job that consists of several pieces of work. The job's fraction is the completed share of
/// all work. The fraction does not depend on the order of the pieces, and never decreases.
class WorkProgress {
 public:
  /// `weights` is the amount of work of each piece, in any common unit; only the ratios matter. Negative
  /// weights count as 0.
  WorkProgress(Progress& whole, const std::vector<double>& weights);
  WorkProgress(const WorkProgress&) = delete;
  WorkProgress& operator=(const WorkProgress&) = delete;

  /// Returns the progress of one piece, valid as long as this object. Throws std::out_of_range for an index
  /// without a piece.
  [[nodiscard]] Progress& piece(std::size_t index) { return pieces_.at(index); }
  /// Reports that the piece `index` is completed.
  void finish(std::size_t index, std::string_view what) { piece(index).update(1, what); }

 private:
  class Piece : public Progress {
   public:
    Piece(WorkProgress& job, double share) : job_(&job), share_(share) {}
    void update(double fraction, std::string_view what) override;
    [[nodiscard]] bool is_cancelled() const override { return job_->whole_.is_cancelled(); }

   private:
    WorkProgress* job_;
    double share_;  // Of the job's work.
    double done_ = 0;
  };

  Progress& whole_;
  double done_ = 0;           // Share of the job's work.
  std::deque<Piece> pieces_;  // Does not move them.
};

}  // namespace flexura

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "flexura/campaign/engine.h"
#include "flexura/campaign/rank_dealer.h"

namespace flexura {

/// Returns whether mpirun or srun started this program as one of several ranks.
[[nodiscard]] bool is_started_by_mpi();

/// The connection between the ranks of a program, from the start to the end of MPI. Rank 0 sends the command
/// to the other ranks. The destructor of rank 0 makes the other ranks end.
class MpiSession {
 public:
  /// Starts MPI. Throws InputError if the program was built without MPI.
  MpiSession();
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int ranks() const { return ranks_; }

  /// Rank 0 passes a text to all other ranks. Called at most once.
  void tell(const std::string& text);
  /// The other ranks wait for this text and return it; "": there is nothing to do.
  [[nodiscard]] static std::string hear();
  /// Makes the destructor print a reason and end all ranks at once, because one of them no longer answers.
  void give_up(std::string reason) { given_up_ = std::move(reason); }

 private:
  int rank_ = 0, ranks_ = 1;
  [[maybe_unused]] bool has_told_ = false;
  std::string given_up_;  // Why; "": not given up.
};

/// Executes runs in rank 0 and assigns runs dynamically to the other ranks, which must be in serve_runs().
/// Only rank 0 uses it.
class MpiEngine : public CampaignEngine {
 public:
  /// `threads`: runs at the same time in each rank.
  MpiEngine(MpiSession& session, RunFunction run, std::size_t threads);
  [[nodiscard]] std::size_t workers() const override;
  /// Throws std::runtime_error if a rank has failed, or does not answer at the end.
  void execute(const EngineJob& job) override;

 private:
  void deal(const EngineJob& job, RankDealer& dealer);
  // Throws std::runtime_error if a rank does not answer.
  void dismiss(RankDealer& dealer);

  MpiSession& session_;
  RunFunction run_;
  std::size_t threads_;
};

/// Executes the runs that rank 0 deals, `threads` at the same time, until rank 0 ends the campaign.
void serve_runs(const RunFunction& run, std::size_t threads);

}  // namespace flexura

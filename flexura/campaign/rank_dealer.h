#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "flexura/campaign/engine.h"

namespace flexura {

/// A message of a rank to rank 0.
struct RankMessage {
  enum class Kind : std::uint8_t { row, failure, bye };
  Kind kind = Kind::row;
  std::size_t from = 1;  ///< Number of the rank, from 1.
  std::string text;      ///< A row (row_text.h), or the reason of a failure.
};

/// The messages between rank 0 and the other ranks.
class RankLink {
 public:
  RankLink() = default;
  virtual ~RankLink() = default;
  RankLink(const RankLink&) = delete;
  RankLink& operator=(const RankLink&) = delete;

  /// Makes a rank execute a run.
  virtual void deal(std::size_t rank, std::int64_t id) = 0;
  /// Makes a rank end. It answers with a bye.
  virtual void end(std::size_t rank) = 0;
  /// Returns the next message that has arrived; std::nullopt: none at present.
  [[nodiscard]] virtual std::optional<RankMessage> arrived() = 0;
};

/// Assigns the runs of a campaign to other ranks: each rank has at most `runs_ahead` runs per thread, and
/// gets the next one as soon as a row arrives.
class RankDealer {
 public:
  /// `ranks`: number of other ranks. `threads`: runs at the same time in each rank.
  RankDealer(RankLink& link, std::size_t ranks, std::size_t threads);

  /// Receives all rows that have arrived, then deals runs to ranks that have room for them. Throws
  /// std::runtime_error with the reason if a rank has failed.
  [[nodiscard]] std::vector<CampaignRow> turn(const EngineJob& job);
  /// Returns the number of runs that were dealt and have no row yet.
  [[nodiscard]] std::size_t pending() const { return all_pending_; }

  /// Ends all ranks, and receives messages until all have said bye. `wait` is called when no message has
  /// arrived; it returns whether to go on waiting. Returns the ranks that did not say bye.
  [[nodiscard]] std::vector<std::size_t> dismiss(const std::function<bool()>& wait);

 private:
  RankLink& link_;
  std::size_t most_;                  // Runs that a rank has at most.
  std::vector<std::size_t> pending_;  // Runs that rank 1, rank 2, ... has.
  std::size_t all_pending_ = 0;
};

}  // namespace flexura

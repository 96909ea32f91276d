#include "flexura/campaign/rank_dealer.h"

#include <fmt/format.h>

#include <stdexcept>

#include "flexura/campaign/row_text.h"

namespace flexura {

RankDealer::RankDealer(RankLink& link, std::size_t ranks, std::size_t threads)
    : link_(link), most_(runs_ahead * threads), pending_(ranks, 0) {}

std::vector<CampaignRow> RankDealer::turn(const EngineJob& job) {
  std::vector<CampaignRow> rows;
  while (const std::optional<RankMessage> message = link_.arrived()) {
    if (message->kind == RankMessage::Kind::failure)
      throw std::runtime_error(fmt::format("rank {}: {}", message->from, message->text));
    rows.push_back(row_of(message->text));
    --pending_.at(message->from - 1), --all_pending_;
  }
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    while (pending_[i] < most_) {
      const std::optional<std::int64_t> id = job.next();
      if (!id) return rows;
      link_.deal(i + 1, *id);
      ++pending_[i], ++all_pending_;
    }
  }
  return rows;
}

std::vector<std::size_t> RankDealer::dismiss(const std::function<bool()>& wait) {
  for (std::size_t i = 0; i < pending_.size(); ++i) link_.end(i + 1);
  std::vector<bool> has_gone(pending_.size(), false);
  // A rank may still wait until its row is received.
  for (std::size_t waiting = pending_.size(); waiting > 0;) {
    const std::optional<RankMessage> message = link_.arrived();
    if (message && message->kind == RankMessage::Kind::bye) has_gone.at(message->from - 1) = true, --waiting;
    if (!message && !wait()) break;
  }
  std::vector<std::size_t> lost;
  for (std::size_t i = 0; i < has_gone.size(); ++i)
    if (!has_gone[i]) lost.push_back(i + 1);
  return lost;
}

}  // namespace flexura

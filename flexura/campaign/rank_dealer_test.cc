#include "flexura/campaign/rank_dealer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <vector>

#include "flexura/campaign/row_text.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// Ranks that finish their runs in a random order, some of them never.
class RandomRanks : public RankLink {
 public:
  RandomRanks(std::size_t ranks, TestRandom& random) : dealt(ranks), random_(random) {}
  void deal(std::size_t rank, std::int64_t id) override { dealt.at(rank - 1).push_back(id); }
  void end(std::size_t rank) override { ended.push_back(rank); }
  std::optional<RankMessage> arrived() override {
    if (!failure.empty()) return RankMessage{RankMessage::Kind::failure, 2, failure};
    if (random_.integer(0, 2) == 0) return std::nullopt;
    const auto rank = static_cast<std::size_t>(random_.integer(0, static_cast<int>(dealt.size()) - 1));
    if (!dealt[rank].empty()) {
      CampaignRow row;
      row.id = dealt[rank].front(), row.status = "done";
      dealt[rank].erase(dealt[rank].begin());
      return RankMessage{RankMessage::Kind::row, rank + 1, row_text(row)};
    }
    const auto place = std::ranges::find(ended, rank + 1);
    if (place == ended.end() || rank + 1 == dead) return std::nullopt;
    ended.erase(place);
    return RankMessage{RankMessage::Kind::bye, rank + 1, ""};
  }

  std::vector<std::vector<std::int64_t>> dealt;
  std::vector<std::size_t> ended;
  std::string failure;
  std::size_t dead = 0;

 private:
  TestRandom& random_;
};

TEST(RankDealer, DealsEachRunOnceAndFewAtATime) {
  for (int i = 0; i < 50; ++i) {
    TestRandom random(case_seed(i));
    const auto ranks = static_cast<std::size_t>(random.integer(1, 7)),
               threads = static_cast<std::size_t>(random.integer(1, 3));
    const int runs = random.integer(0, 200);
    RandomRanks link(ranks, random);
    RankDealer dealer(link, ranks, threads);
    std::int64_t next = 0;
    EngineJob job;
    job.next = [&]() -> std::optional<std::int64_t> {
      return next < runs ? std::optional(next++) : std::nullopt;
    };
    std::set<std::int64_t> done;
    do {
      for (const CampaignRow& row : dealer.turn(job)) EXPECT_TRUE(done.insert(row.id).second) << row.id;
      std::size_t pending = 0;
      for (const auto& of_rank : link.dealt) {
        EXPECT_LE(of_rank.size(), runs_ahead * threads);
        if (next < runs) {
          EXPECT_EQ(of_rank.size(), runs_ahead * threads) << "a rank waits";
        }
        pending += of_rank.size();
      }
      EXPECT_EQ(dealer.pending(), pending);
    } while (dealer.pending() > 0);
    EXPECT_EQ(done.size(), static_cast<std::size_t>(runs)) << "seed " << case_seed(i);
    EXPECT_TRUE(dealer.dismiss([] { return true; }).empty());
  }
}

TEST(RankDealer, NamesRanksThatDoNotAnswer) {
  TestRandom random(case_seed(0));
  RandomRanks link(3, random);
  link.dead = 2;
  RankDealer dealer(link, 3, 1);
  int patience = 1000;
  EXPECT_THAT(dealer.dismiss([&] { return --patience > 0; }), testing::ElementsAre(2));
  link.failure = "no memory";
  EXPECT_THROW((void)dealer.turn({}), std::runtime_error);
}

}  // namespace
}  // namespace flexura

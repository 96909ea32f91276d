#include <gtest/gtest.h>

#include "tests/support/campaign_program.h"

namespace flexura {
namespace {

TEST_F(CampaignProgram, LosesNoRunIn200Kills) { check_kills(200); }

TEST_F(CampaignProgram, LosesNoRunIn40KillsOfRanks) {
  if (!has_mpi()) GTEST_SKIP() << "skipped: needs MPI";
  check_kills_of_ranks(40);
}

}  // namespace
}  // namespace flexura

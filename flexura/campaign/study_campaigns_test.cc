// The campaigns of the studies in examples/.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "flexura/base/progress.h"
#include "flexura/campaign/campaign.h"
#include "tests/support/campaign_files.h"
#include "tests/support/checkout.h"

namespace flexura {
namespace {

TEST(StudyCampaigns, CanBeRead) {
  int read = 0;
  for (const char* folder : {"19_campaign", "20_servo_study", "21_calibration_study", "22_ik_study"}) {
    for (const auto& file :
         std::filesystem::directory_iterator(checkout_file("examples/" + std::string(folder)))) {
      const std::string name = file.path().filename().string();
      if (file.path().extension() != ".toml" || name.ends_with("experiment.toml")) continue;
      EXPECT_NO_THROW(Campaign(file.path())) << name;
      ++read;
    }
  }
  EXPECT_GE(read, 15);
}

TEST(StudyCampaigns, SolveInverseKinematics) {
  const Campaign campaign(checkout_file("examples/22_ik_study/reachable.toml"), {"samples=20"});
  ASSERT_EQ(campaign.design().runs(), 60);
  for (std::int64_t id = 0; id < campaign.design().runs(); ++id) {
    NoProgress progress;
    const auto row = execute_run(campaign, id, progress);
    EXPECT_EQ(row->status, "done") << row->error;
    EXPECT_TRUE(*row->measures[0].as<bool>()) << id;
    EXPECT_LE(*row->measures[1].as<double>(), 2.4e-9) << id;
    EXPECT_LE(*row->measures[2].as<double>(), 2e-9) << id;
  }
}

TEST(StudyCampaigns, ProveThatTargetsAreOutOfReach) {
  const Campaign campaign(checkout_file("examples/22_ik_study/unreachable.toml"), {"samples=5"});
  for (std::int64_t id = 0; id < campaign.design().runs(); ++id) {
    NoProgress progress;
    const auto row = execute_run(campaign, id, progress);
    EXPECT_EQ(row->status, "unsafe");
    EXPECT_TRUE(*row->measures[0].as<bool>()) << id;
  }
}

std::string fault_of_move(const std::string& to) {
  const CampaignFolder folder("experiment = \"bow.toml\"\nset = [\"task=[{kind='move', to=" + to + "}]\"]\n");
  try {
    (void)folder.campaign();
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(MoveToATip, HasOneTarget) {
  using testing::HasSubstr;
  const std::string shape = "{bends=[[0.5, 0], [0, 0]]}";
  EXPECT_EQ(fault_of_move("{tip_of=" + shape + "}"), "none");
  EXPECT_EQ(fault_of_move("{position=[0, 0.5, 0.1], direction=[0, 1, 0]}"), "none");
  EXPECT_THAT(fault_of_move("{tip_of=" + shape + ", position=[0, 0.5, 0]}"),
              HasSubstr("task[0].to.tip_of: is given together with another target"));
  EXPECT_THAT(fault_of_move("{direction=[0, 1, 0], bends=[[0, 0], [0, 0]]}"),
              HasSubstr("task[0].to.direction: is given without position"));
  EXPECT_THAT(fault_of_move("{position=[0, 0.5, 0], direction=[0, 1, 0], rotation=[1, 0, 0, 0]}"),
              HasSubstr("is given together with rotation"));
  EXPECT_THAT(fault_of_move("{position=[0, 0.5, 0], direction=[0, 0, 0]}"),
              HasSubstr("is 0: expected a direction"));
  EXPECT_THAT(fault_of_move("{position=[0, 0.5, 0], rotation=[1, 1, 0, 0]}"), HasSubstr("rotation"));
  EXPECT_THAT(fault_of_move("{tip_of={bends=[[0.5, 0]]}}"), HasSubstr("tip_of"));
}

}  // namespace
}  // namespace flexura

// Runs of the campaigns in examples/ that make the tables of the studies.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/campaign/campaign.h"
#include "tests/support/checkout.h"

namespace flexura {
namespace {

std::vector<std::filesystem::path> campaigns_in(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& file : std::filesystem::directory_iterator(checkout_file("examples/" + folder)))
    if (file.path().extension() == ".toml" && !file.path().stem().string().ends_with("experiment"))
      files.push_back(file.path());
  std::ranges::sort(files);
  return files;
}

// Executes the first and the last combination of each campaign in a folder. A run may fail, but it must have
// the measure that every calibration or servo has.
void check_runs(const std::string& folder) {
  for (const std::filesystem::path& file : campaigns_in(folder)) {
    SCOPED_TRACE(file.string());
    const Campaign campaign(file, {"samples=1"});
    const std::int64_t runs = campaign.design().runs();
    for (std::int64_t id = 0; id < runs; id += std::max<std::int64_t>(runs - 1, 1)) {
      NoProgress progress;
      const auto row = execute_run(campaign, id, progress);
      ASSERT_TRUE(row);
      EXPECT_NE(row->status, "error") << row->error;
      EXPECT_FALSE(row->measures.at(0).empty()) << row->error;
      if (row->status != "done") continue;
      for (std::size_t i = 0; i < row->measures.size(); ++i)
        EXPECT_FALSE(row->measures[i].empty()) << campaign.config().measure[i].key;
    }
  }
}

TEST(StudyCampaigns, OfServosHaveTheirMeasures) { check_runs("20_servo_study"); }
TEST(StudyCampaigns, OfCalibrationsHaveTheirMeasures) { check_runs("21_calibration_study"); }

}  // namespace
}  // namespace flexura

// Whether the rows of a campaign wait for the disk.
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <string>
#include <vector>

#include "tests/support/campaign_files.h"

namespace {

std::atomic<int> waits_for_disk = 0;

}  // namespace

// SQLite calls these functions instead of those of the C library.
extern "C" __attribute__((visibility("default"))) int fdatasync(int file) {
  ++waits_for_disk;
  return static_cast<int>(::syscall(SYS_fdatasync, file));
}
extern "C" __attribute__((visibility("default"))) int fsync(int file) {
  ++waits_for_disk;
  return static_cast<int>(::syscall(SYS_fsync, file));
}

namespace flexura {
namespace {

// Returns how often SQLite waits for the disk while `groups` groups of rows are added.
int waits_of(Durability durability, int groups) {
  const CampaignFolder folder;
  const Campaign campaign = folder.campaign();
  CampaignFile file(folder.path("a.db"), campaign, durability);
  const int before = waits_for_disk;
  for (int i = 0; i < groups; ++i) {
    const auto id = static_cast<std::int64_t>(i);
    const std::vector<CampaignRow> rows{{.id = id,
                                         .seed = campaign.design().seed(id),
                                         .parameters = campaign.design().values(id),
                                         .status = "done",
                                         .error = {},
                                         .measures = {{0.5, {}}, text_node("done"), {id, {}}},
                                         .seconds = 0.1}};
    file.add(rows);
  }
  return waits_for_disk - before;
}

TEST(CampaignDurability, WaitsForTheDiskAfterEachGroupOfRowsIfPowerMayBeLost) {
  EXPECT_GE(waits_of(Durability::power, 20), 20);
  EXPECT_LT(waits_of(Durability::process, 20), 5);
}

}  // namespace
}  // namespace flexura

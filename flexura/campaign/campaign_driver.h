#pragma once

#include <cstdint>
#include <string>

#include "flexura/base/progress.h"
#include "flexura/campaign/campaign.h"
#include "flexura/campaign/campaign_file.h"
#include "flexura/campaign/engine.h"

namespace flexura {

/// How a call of run_campaign() ended.
struct CampaignEnd {
  std::int64_t before = 0;  ///< Runs that the file already had.
  std::int64_t runs = 0;    ///< Runs that the file has now.
  bool is_complete = false;
  bool is_cancelled = false;
  std::string reason;  ///< Why it ended, in words.
};

/// Executes the missing runs of a campaign and writes their rows into `file`. The rows of a complete campaign
/// depend neither on the engine nor on interruptions. Throws std::runtime_error if a row cannot be written; a
/// later call continues the campaign.
[[nodiscard]] CampaignEnd run_campaign(const Campaign& campaign, CampaignFile& file, CampaignEngine& engine,
                                       Progress& progress);

}  // namespace flexura

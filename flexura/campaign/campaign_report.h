#pragma once

#include <string>

#include "flexura/campaign/campaign_file.h"

namespace flexura {

/// Returns a self-contained HTML page about the results of a campaign: distributions, success rates,
/// sensitivities, and the worst runs with the commands that replay them. `file`: name of the results in these
/// commands.
[[nodiscard]] std::string campaign_html(CampaignResults& results, const std::string& file);

}  // namespace flexura

#pragma once

#include <string>
#include <string_view>

#include "flexura/campaign/campaign.h"

namespace flexura {

/// Returns a row as text (JSON), which keeps all its values exactly.
[[nodiscard]] std::string row_text(const CampaignRow& row);
/// Returns the row of a text from row_text().
[[nodiscard]] CampaignRow row_of(std::string_view text);

}  // namespace flexura

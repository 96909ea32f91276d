// Fuzzes campaign files with any bytes. A file gives a campaign or an InputError; the runs of a campaign have
// parameters within their bounds, and its record gives the same campaign.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "flexura/base/table.h"
#include "flexura/campaign/braces.h"
#include "flexura/campaign/campaign.h"
#include "flexura/campaign/row_text.h"
#include "flexura/campaign/statistics.h"
#include "flexura/store/json.h"
#include "flexura/store/toml.h"

namespace {

using flexura::CampaignConfig;
using flexura::Node;

void check_value(const flexura::ParameterConfig& parameter, const Node& value) {
  if (value.empty()) std::abort();
  if (const auto* uniform = std::get_if<flexura::UniformParameter>(&parameter))
    if (const double x = *value.as<double>(); !(x >= uniform->low && x <= uniform->high)) std::abort();
  if (const auto* logarithm = std::get_if<flexura::LogUniformParameter>(&parameter))
    if (const double x = *value.as<double>(); !(x >= logarithm->low && x <= logarithm->high)) std::abort();
  if (const auto* integer = std::get_if<flexura::IntegerParameter>(&parameter))
    if (const auto x = *value.as<std::int64_t>(); x < integer->low || x > integer->high) std::abort();
}

void check_campaign(const CampaignConfig& config) {
  const flexura::CampaignDesign design(config),
      again(flexura::read_as<CampaignConfig>(
          flexura::parse_json(flexura::write_json(flexura::Codec<CampaignConfig>::write(config)), "record")));
  if (design.runs() < 1 || again.runs() != design.runs()) std::abort();
  for (const std::int64_t id : {std::int64_t{0}, design.runs() / 2, design.runs() - 1}) {
    const auto values = design.values(id), others = again.values(id);
    if (design.seed(id) != again.seed(id)) std::abort();
    flexura::CampaignRow row{.id = id,
                             .seed = design.seed(id),
                             .parameters = values,
                             .status = "done",
                             .error = {},
                             .measures = std::vector<Node>(config.measure.size()),
                             .seconds = 0};
    const std::string text = flexura::row_text(row);
    if (flexura::row_text(flexura::row_of(text)) != text) std::abort();
    for (std::size_t i = 0; i < values.size(); ++i) {
      check_value(config.parameter[i], values[i]);
      if (flexura::write_json(values[i]) != flexura::write_json(others[i])) std::abort();
    }
    flexura::StopTracker tracker(config);
    tracker.add(row);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    check_campaign(flexura::read_as<CampaignConfig>(
        flexura::with_expanded_parameters(flexura::parse_toml(text, "campaign.toml"))));
  } catch (const flexura::InputError&) {
  }
  try {
    const Node document = flexura::parse_json(R"({"a":[{"b":1},2],"c":{"d":true}})", "summary");
    (void)flexura::find_path(document, text.substr(0, 100));
  } catch (const flexura::InputError&) {
  }
  return 0;
}

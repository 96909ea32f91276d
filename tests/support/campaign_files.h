#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "flexura/campaign/campaign.h"
#include "flexura/campaign/campaign_driver.h"
#include "flexura/campaign/campaign_file.h"
#include "flexura/store/json.h"
#include "tests/support/temporary_folder.h"

namespace flexura {

/// An experiment that takes a fraction of a millisecond. Some bends are beyond the limit.
inline constexpr const char* bow_text = R"([arm]
kind = "spatial"
[[arm.section]]
length = 0.3
max_bend_deg = 120
[[arm.section]]
length = 0.25
max_bend_deg = 120
[[task]]
kind = "move"
duration = 1
to.bends_deg = [[60, 0], [0, 90]]
)";

/// A campaign of 60 runs of the experiment in bow.toml, of which some are unsafe and some cannot be read.
inline constexpr const char* bow_campaign_text = R"(experiment = "bow.toml"
seed = 7
sampling = "latin_hypercube"
samples = 15
repeats = 2
[[parameter]]
kind = "uniform"
path = "arm.section.0.length_mm"
low = -20
high = 400
[[parameter]]
kind = "list"
path = "task.0.to.bends_deg.1.1"
values = [90, 130]
[[measure]]
key = "tip.position[1]"
name = "height"
min = 0.2
[[measure]]
key = "outcome"
[[measure]]
key = "seed"
name = "of_summary"
)";

/// A folder with bow.toml and a campaign of it.
class CampaignFolder {
 public:
  explicit CampaignFolder(const std::string& campaign = bow_campaign_text) {
    write("bow.toml", bow_text);
    write("campaign.toml", campaign);
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  [[nodiscard]] Campaign campaign(const std::vector<std::string>& sets = {}) const {
    return Campaign(path("campaign.toml"), sets);
  }

 private:
  TemporaryFolder folder_;
};

/// Returns all rows of results as text, bit for bit, except their times.
inline std::string rows_text(const std::filesystem::path& file) {
  std::string text;
  CampaignResults(file).for_each([&](const CampaignRow& row) {
    Node::Array values{{row.id, {}}, {row.seed, {}}, text_node(row.status), text_node(row.error)};
    values.insert(values.end(), row.parameters.begin(), row.parameters.end());
    values.insert(values.end(), row.measures.begin(), row.measures.end());
    text += write_json({std::move(values), {}}) + "\n";
  });
  return text;
}

/// Executes a campaign with `threads` threads, and returns the rows as text.
inline std::string rows_of(const Campaign& campaign, const std::string& file, std::size_t threads) {
  CampaignFile results(file, campaign);
  ThreadEngine engine([&](std::int64_t id, Progress& run) { return execute_run(campaign, id, run); },
                      threads);
  NoProgress progress;
  EXPECT_TRUE(run_campaign(campaign, results, engine, progress).is_complete);
  return rows_text(file);
}

}  // namespace flexura

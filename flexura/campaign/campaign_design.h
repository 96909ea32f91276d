#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/campaign/campaign_config.h"

namespace flexura {

/// The parameters and the seed of each run of a campaign, as a function of the run's number alone.
///
/// Repeats change fastest, then the combinations of grids, lists and choices (the last parameter changes
/// fastest), then the samples. So the first runs already cover all combinations.
class CampaignDesign {
 public:
  explicit CampaignDesign(const CampaignConfig& config);

  /// Returns the number of runs.
  [[nodiscard]] std::int64_t runs() const { return runs_; }
  /// Returns the values of the parameters in run `id`, counted from 0, in their order in the file.
  [[nodiscard]] std::vector<Node> values(std::int64_t id) const;
  /// Returns the seed of run `id`, from 0 to 1e15 - 1.
  [[nodiscard]] std::int64_t seed(std::int64_t id) const;

 private:
  std::vector<ParameterConfig> parameters_;
  Sampler sampler_;
  std::int64_t repeats_ = 1, combinations_ = 1, runs_ = 1;
};

}  // namespace flexura

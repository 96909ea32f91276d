#include "flexura/campaign/campaign_design.h"

#include <algorithm>

#include "flexura/math/hash.h"

namespace flexura {

CampaignDesign::CampaignDesign(const CampaignConfig& config)
    : parameters_(config.parameter),
      sampler_{config.sampling, static_cast<std::uint64_t>(config.seed),
               static_cast<std::uint64_t>(config.samples)},
      repeats_(config.repeats) {
  for (const ParameterConfig& parameter : parameters_)
    combinations_ *= static_cast<std::int64_t>(std::max<std::size_t>(grid_size(parameter), 1));
  runs_ = std::min(config.samples * combinations_ * repeats_, config.stop.runs.value_or(INT64_MAX));
}

std::vector<Node> CampaignDesign::values(std::int64_t id) const {
  const std::int64_t point = id / repeats_;
  const auto sample = static_cast<std::uint64_t>(point / combinations_);
  auto combination = static_cast<std::size_t>(point % combinations_);
  std::vector<Node> values(parameters_.size());
  std::size_t dimension = 0;
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    if (grid_size(parameters_[i]) == 0)
      values[i] = quantile(parameters_[i], sampler_.at(dimension++, sample));
  for (std::size_t i = parameters_.size(); i-- > 0;) {
    const std::size_t size = grid_size(parameters_[i]);
    if (size == 0) continue;
    values[i] = grid_value(parameters_[i], combination % size);
    combination /= size;
  }
  return values;
}

std::int64_t CampaignDesign::seed(std::int64_t id) const {
  constexpr std::uint64_t of_runs = 4, seeds = 1'000'000'000'000'000;
  return static_cast<std::int64_t>(hash(sampler_.seed, of_runs, static_cast<std::uint64_t>(id)) % seeds);
}

}  // namespace flexura

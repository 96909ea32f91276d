#include "flexura/campaign/campaign_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>

#include "flexura/base/table.h"
#include "flexura/campaign/sobol.h"

namespace flexura {
namespace {

constexpr std::size_t most_columns = 500;
constexpr double most_runs = 1e9;
// Columns that every table of results has.
constexpr std::array<std::string_view, 6> taken = {"id", "seed", "status", "error", "seconds", "rowid"};

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

// SQLite does not distinguish columns by the case of ASCII letters.
void check_names(const CampaignConfig& campaign, Reader& reader) {
  std::set<std::string> names(taken.begin(), taken.end());
  const auto add = [&](const std::string& label, const std::string& path) {
    if (!names.insert(lower_case(label)).second)
      reader.problem_at(path, fmt::format("the name \"{}\" is already used: expected another `name`", label));
  };
  for (std::size_t i = 0; i < campaign.parameter.size(); ++i)
    if (place_of(campaign.parameter[i]).path != "seed")  // Reported by check_parameters().
      add(place_of(campaign.parameter[i]).label(), fmt::format("parameter[{}]", i));
  for (std::size_t i = 0; i < campaign.measure.size(); ++i)
    add(campaign.measure[i].label(), fmt::format("measure[{}]", i));
}

// Checks a path that a parameter changes. `used`: the paths of other parameters.
void check_path(const std::string& path, const std::string& at, std::set<std::string>& used, Reader& reader) {
  if (path == "seed")
    reader.problem_at(at, "each run has a seed of its own: expected `repeats` and `seed` of the campaign");
  if (path.substr(0, path.find('.')) == "include")
    reader.problem_at(at, "files are included first: expected a value of the experiment");
  if (!used.insert(path).second) reader.problem_at(at, fmt::format("\"{}\" is already a parameter", path));
}

void check_parameters(const CampaignConfig& campaign, Reader& reader) {
  std::set<std::string> used;
  std::size_t distributions = 0;
  for (std::size_t i = 0; i < campaign.parameter.size(); ++i) {
    const ParameterPlace& place = place_of(campaign.parameter[i]);
    if (grid_size(campaign.parameter[i]) == 0) ++distributions;
    check_path(place.path, fmt::format("parameter[{}].path", i), used, reader);
    for (std::size_t k = 0; k < place.also.size(); ++k)
      check_path(place.also[k], fmt::format("parameter[{}].also[{}]", i, k), used, reader);
  }
  if (campaign.sampling == Sampling::sobol && distributions > most_sobol_dimensions)
    reader.problem_at("sampling", fmt::format("\"sobol\" has {} dimensions, but {} parameters have "
                                              "distributions: expected \"latin_hypercube\"",
                                              most_sobol_dimensions, distributions));
  if (distributions == 0 && campaign.samples > 1)
    reader.problem_at(
        "samples", fmt::format("{}: no parameter has a distribution: expected `repeats`", campaign.samples));
}

void check_rules(const CampaignConfig& campaign, Reader& reader) {
  std::vector<std::string> names;
  names.reserve(campaign.measure.size());
  for (const CampaignMeasureConfig& measure : campaign.measure) names.push_back(measure.label());
  for (std::size_t i = 0; i < campaign.stop.precision.size(); ++i) {
    const std::string& name = campaign.stop.precision[i].measure;
    if (std::ranges::count(names, name) > 0) continue;
    const std::string_view near = nearest_name(name, names);
    reader.problem_at(fmt::format("stop.precision[{}].measure", i),
                      fmt::format("no measure has the name \"{}\"{}", name,
                                  near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
  }
}

void check_campaign(const CampaignConfig& campaign, Reader& reader) {
  check_names(campaign, reader);
  check_parameters(campaign, reader);
  check_rules(campaign, reader);
  double runs = static_cast<double>(campaign.samples) * static_cast<double>(campaign.repeats);
  for (const ParameterConfig& parameter : campaign.parameter)
    runs *= static_cast<double>(std::max<std::size_t>(grid_size(parameter), 1));
  if (runs > most_runs) reader.problem(fmt::format("{:.3g} runs: expected at most {:.0e}", runs, most_runs));
}

}  // namespace

const std::vector<std::string>& names_of(const Precise*) {
  static const std::vector<std::string> names{"mean", "rate"};
  return names;
}

const Table<CampaignMeasureConfig>& fields_of(const CampaignMeasureConfig*) {
  using M = CampaignMeasureConfig;
  static const auto table =
      Table<M>("measure", "A value of the summary of each run.")
          .field(
              "key", &M::key,
              {.meaning = "Path in `summary.json`: `servos.0.rms`. Indices count from 0.", .required = true})
          .field("name", &M::name,
                 {.meaning = "Name of the measure's column in the results.", .default_text = "the key"})
          .field("min", &M::min,
                 {.meaning = "Smallest value at which a run counts as a success. A measure that is true or "
                             "false needs no bounds.",
                  .default_text = "none"})
          .field("max", &M::max,
                 {.meaning = "Largest value at which a run counts as a success.", .default_text = "none"})
          .field("scale", &M::scale,
                 {.meaning = "Factor on a number: 100 for percent, 1000 for mm. `min` and `max` apply to the "
                             "product."})
          .field("absolute", &M::absolute,
                 {.meaning = "Whether the measure is the absolute value of the number."})
          .check([](const M& measure, Reader& reader) {
            if (measure.min && measure.max && *measure.min > *measure.max)
              reader.problem_at(
                  "max", fmt::format("{:.6g}: expected at least `min`, {:.6g}", *measure.max, *measure.min));
          });
  return table;
}

const Table<PrecisionConfig>& fields_of(const PrecisionConfig*) {
  using P = PrecisionConfig;
  static const auto table =
      Table<P>("precision",
               "A rule that is fulfilled when a mean or a success rate has the required precision.")
          .field("measure", &P::measure, {.meaning = "Name of the measure.", .required = true})
          .field("of", &P::of,
                 {.meaning = "`mean`: the mean of the values. `rate`: the share of successes (Wilson's "
                             "interval)."})
          .field("half_width", &P::half_width,
                 {.meaning = "Largest half width of the 95 % confidence interval.",
                  .range = above(0),
                  .required = true})
          .field("least_runs", &P::least_runs,
                 {.meaning = "The rule decides only after this number of runs.", .range = between(2, 1e9)});
  return table;
}

const Table<StopConfig>& fields_of(const StopConfig*) {
  using S = StopConfig;
  static const auto table =
      Table<S>("stop", "When the campaign ends before all its runs are done.")
          .field(
              "runs", &S::runs,
              {.meaning = "Largest number of runs.", .range = between(1, most_runs), .default_text = "all"})
          .field("time", &S::time,
                 {.meaning = "Time after which the program starts no further runs. The same command "
                             "continues the campaign.",
                  .unit = Unit::second,
                  .range = above(0),
                  .default_text = "unlimited"})
          .field(
              "precision", &S::precision,
              {.meaning = "The campaign ends when all these rules are fulfilled. They read the runs in the "
                          "order of their numbers.",
               .count = {0, 100},
               .default_text = "none"});
  return table;
}

const Table<CampaignConfig>& fields_of(const CampaignConfig*) {
  using C = CampaignConfig;
  static const auto table =
      Table<C>("Flexura campaign file", "An experiment that runs many times with varied values.")
          .field("title", &C::title, {.meaning = "Title of the report.", .default_text = "name of the file"})
          .field(
              "description", &C::description,
              {.meaning = "Text in the report, with Markdown in the exported one.", .default_text = "none"})
          .field("experiment", &C::experiment,
                 {.meaning = "The experiment file, relative to the campaign file.", .required = true})
          .field("set", &C::set,
                 {.meaning = "Changes to the experiment that apply to all runs, each in the form of `--set`: "
                             "`\"task.0.duration=1\"`.",
                  .count = {0, most_columns},
                  .default_text = "none"})
          .field("seed", &C::seed,
                 {.meaning = "Seed of the samples and of the runs' seeds.", .range = between(0, 1e15)})
          .field("sampling", &C::sampling,
                 {.meaning = "How the samples are spread: `random`, `latin_hypercube` (one sample in each "
                             "of `samples` intervals of each distribution) or `sobol` (a Sobol sequence)."})
          .field("samples", &C::samples,
                 {.meaning = "Number of samples of the distributions, for each combination of grids, lists "
                             "and choices. All combinations use the same samples.",
                  .range = between(1, most_runs)})
          .field("repeats", &C::repeats,
                 {.meaning = "Number of runs with equal parameters and different seeds.",
                  .range = between(1, most_runs)})
          .field("parameter", &C::parameter,
                 {.meaning = "Values of the experiment that vary.",
                  .count = {0, most_columns},
                  .default_text = "none"})
          .field("measure", &C::measure,
                 {.meaning = "Results of each run.", .count = {0, most_columns}, .default_text = "none"})
          .field("stop", &C::stop, {.meaning = "When the campaign ends early.", .partial = true})
          .check(check_campaign);
  return table;
}

}  // namespace flexura

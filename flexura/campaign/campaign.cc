#include "flexura/campaign/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <new>
#include <system_error>
#include <utility>

#include "flexura/base/one_line.h"
#include "flexura/base/table.h"
#include "flexura/campaign/braces.h"
#include "flexura/campaign/statistics.h"
#include "flexura/experiment/run.h"
#include "flexura/rig/rig.h"
#include "flexura/store/json.h"
#include "flexura/store/toml.h"

namespace flexura {
namespace {

// Runs whose experiments are read before the first run starts.
constexpr std::int64_t checked_runs = 16;

CampaignConfig read_config(const Node& document) { return read_as<CampaignConfig>(document); }

Node campaign_document(const std::filesystem::path& file, const std::vector<std::string>& sets) {
  return with_expanded_parameters(with_overrides(read_toml_file(file), {sets, {}}));
}

// Returns the experiment of a campaign in `folder`. An experiment that is missing is reported at its name.
ExperimentDocument experiment_of_campaign(const CampaignConfig& config, const Node& document,
                                          const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / config.experiment;
  if (!std::filesystem::is_regular_file(file))
    throw InputError(std::vector<Problem>{
        {document.find("experiment")->where,
         fmt::format("experiment = \"{}\": expected an experiment file, relative to the campaign file",
                     config.experiment)}});
  return ExperimentDocument(file, {config.set, {}});
}

Node document_of(const CampaignConfig& config) { return Codec<CampaignConfig>::write(config); }

std::string joined_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "; ") + line;
  return one_line(text);
}

Node files_node(const std::vector<NamedFile>& files) {
  Node::Table table;
  for (const NamedFile& file : files) table.push_back({file.name, {}, text_node(file.digest)});
  return {std::move(table), {}};
}

// Returns a value of a summary as a measure. Whole numbers and truth values stay such if possible.
Node measured(const Node& value, const CampaignMeasureConfig& measure) {
  const bool is_truth = value.as<bool>() != nullptr, is_as_it_is = measure.scale == 1 && !measure.absolute;
  const std::optional<double> number = is_truth || is_as_it_is ? std::nullopt : measured_number(value);
  if (!number) return value;
  const double scaled = measure.scale * *number;
  return {measure.absolute ? std::abs(scaled) : scaled, {}};
}

// Returns the number at a path of an experiment plus an offset.
Node sum_at(const Node& document, const std::string& path, const Node& offset) {
  const Node* found = find_path(document, path);
  const auto* whole = found == nullptr ? nullptr : found->as<std::int64_t>();
  const auto* real = found == nullptr ? nullptr : found->as<double>();
  const std::optional<double> added = measured_number(offset);
  if ((whole == nullptr && real == nullptr) || !added)
    throw InputError(std::vector<Problem>{
        {offset.where,
         fmt::format("{}: expected a number in the experiment file, to which the offset is added", path)}});
  return {(whole != nullptr ? static_cast<double>(*whole) : *real) + *added, offset.where};
}

// The positions of errors name the campaign file, which the user of a row does not need.
std::string reason_of(const InputError& error) {
  std::string text;
  for (const Problem& problem : error.problems()) text += (text.empty() ? "" : "; ") + problem.what;
  return one_line(text);
}

}  // namespace

Campaign::Campaign(CampaignConfig config, ExperimentDocument experiment, std::vector<NamedFile> files)
    : config_(std::move(config)),
      design_(config_),
      experiment_(std::move(experiment)),
      files_(std::move(files)) {}

Campaign::Campaign(const std::filesystem::path& file, const std::vector<std::string>& sets)
    : Campaign([&] {
        const Node document = campaign_document(file, sets);
        CampaignConfig config = read_config(document);
        if (config.title.empty()) config.title = file.stem().string();
        ExperimentDocument experiment = experiment_of_campaign(config, document, file.parent_path());
        auto files = named_files(experiment.document(), config, experiment.folder());
        Campaign campaign(std::move(config), std::move(experiment), std::move(files));
        if (const Node* parameters = document.find("parameter"))
          for (const Node& parameter : *parameters->as<Node::Array>())
            campaign.places_.push_back(parameter.find("path")->where);
        campaign.check_first_runs();
        return campaign;
      }()) {}

Campaign Campaign::from_record(std::string_view record, const std::string& source) {
  const Node node = parse_json(record, source);
  const auto member = [&](std::string_view key) -> const Node& {
    const Node* found = node.find(key);
    if (found == nullptr) throw input_error(source, fmt::format("the record has no \"{}\"", key));
    return *found;
  };
  const auto text = [&](std::string_view key) {
    const auto* found = member(key).as<std::string>();
    return found == nullptr ? std::string() : *found;
  };
  CampaignConfig config = read_config(member("campaign"));
  ExperimentDocument experiment(member("experiment"), text("folder"), text("title"));
  std::vector<NamedFile> files;
  const Node* given = node.find("files");
  if (given == nullptr) {
    // A campaign that a program has made just now.
    files = named_files(experiment.document(), config, experiment.folder());
  } else if (const auto* table = given->as<Node::Table>()) {
    for (const Node::Member& file : *table)
      if (const auto* digest = file.node.as<std::string>()) files.push_back({file.key, *digest});
  }
  return {std::move(config), std::move(experiment), std::move(files)};
}

void Campaign::check_named_files(const std::string& source) const {
  for (const NamedFile& file : files_)
    if (const std::string change = change_of(file, experiment_.folder()); !change.empty())
      throw input_error(source, fmt::format("the experiment names {}, which {}: expected the file of the "
                                            "campaign",
                                            (experiment_.folder() / file.name).string(), change));
}

// Paths that do not exist and files without tasks fail in all runs; a value out of its range may not.
void Campaign::check_first_runs() const {
  std::optional<InputError> first;
  for (std::int64_t id = 0; id < std::min(design_.runs(), checked_runs); ++id) {
    try {
      const Experiment read = experiment(id);
      if (read.task.empty())
        throw input_error(config_.experiment, "nothing to do: expected at least one [[task]]", 1, 1);
      if (read.equipment)
        throw input_error(config_.experiment, "rig: a campaign is simulated: expected no table [rig]");
      return;
    } catch (const InputError& error) {
      if (!first) first = error;
    }
  }
  if (first) throw InputError(*first);
}

std::vector<Setting> Campaign::settings(std::int64_t id) const {
  std::vector<Setting> settings;
  std::vector<Node> values = design_.values(id);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i < places_.size()) values[i].where = places_[i];
    const ParameterPlace& place = place_of(config_.parameter[i]);
    const auto add = [&](const std::string& path) {
      settings.push_back({path, place.offset ? sum_at(experiment_.document(), path, values[i]) : values[i]});
    };
    add(place.path);
    for (const std::string& other : place.also) add(other);
  }
  settings.push_back({"seed", {design_.seed(id), {}}});
  return settings;
}

Experiment Campaign::experiment(std::int64_t id, const std::vector<std::string>& sets) const {
  if (sets.empty()) return experiment_.experiment(settings(id));
  const ExperimentDocument changed(with_overrides(experiment_.document(), {sets, {}}), experiment_.folder(),
                                   experiment_.title());
  return changed.experiment(settings(id));
}

std::string Campaign::identity() const {
  CampaignConfig config = config_;
  config.stop.time.reset();  // Decides only when the program pauses.
  config.title.clear(), config.description.clear();
  return write_json({Node::Table{{"campaign", {}, document_of(config)},
                                 {"experiment", {}, experiment_.document()},
                                 {"title", {}, text_node(experiment_.title())},
                                 {"files", {}, files_node(files_)}},
                     {}});
}

std::string Campaign::record() const {
  // An empty path cannot be made absolute.
  const std::filesystem::path folder =
      std::filesystem::absolute(experiment_.folder() / ".").lexically_normal();
  return write_json({Node::Table{{"campaign", {}, document_of(config_)},
                                 {"experiment", {}, experiment_.document()},
                                 {"folder", {}, text_node(folder.string())},
                                 {"title", {}, text_node(experiment_.title())},
                                 {"files", {}, files_node(files_)}},
                     {}});
}

std::optional<CampaignRow> execute_run(const Campaign& campaign, std::int64_t id, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  CampaignRow row{.id = id,
                  .seed = campaign.design().seed(id),
                  .parameters = campaign.design().values(id),
                  .status = "error",
                  .error = {},
                  .measures = std::vector<Node>(campaign.config().measure.size()),
                  .seconds = 0};
  try {
    const RunResult result = run_experiment(campaign.experiment(id), {}, progress, nullptr, simulated_rig);
    if (result.outcome == RunOutcome::cancelled) return std::nullopt;
    row.status = name_of(result.outcome);
    row.error = joined_lines(result.reasons);
    for (std::size_t i = 0; i < row.measures.size(); ++i)
      if (const Node* found = find_path(result.summary, campaign.config().measure[i].key))
        row.measures[i] = measured(*found, campaign.config().measure[i]);
  } catch (const InputError& error) {
    row.error = reason_of(error);
  } catch (const std::system_error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    row.error = one_line(error.what());
  }
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return row;
}

const Node* find_path(const Node& root, std::string_view path) {
  std::string dotted;
  for (const char c : path) {
    if (c == '[') dotted += '.';
    if (c != '[' && c != ']') dotted += c;
  }
  const Node* node = &root;
  for (std::string_view rest = dotted; node != nullptr;) {
    const std::size_t dot = rest.find('.');
    const std::string_view part = rest.substr(0, dot);
    if (const auto* list = node->as<Node::Array>()) {
      std::size_t index = list->size();
      const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
      const bool is_index = error == std::errc() && end == part.data() + part.size() && index < list->size();
      node = is_index ? &(*list)[index] : nullptr;
    } else {
      node = node->find(part);
    }
    if (dot == std::string_view::npos) break;
    rest.remove_prefix(dot + 1);
  }
  return node;
}

}  // namespace flexura

#include "flexura/campaign/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <thread>

#include "flexura/base/version.h"
#include "flexura/campaign/campaign_driver.h"
#include "flexura/campaign/campaign_file.h"
#include "flexura/campaign/campaign_report.h"
#include "flexura/campaign/campaign_summary.h"
#include "flexura/campaign/engine.h"
#include "flexura/log/results.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "python/bindings/callbacks.h"
#include "python/bindings/module.h"
#include "python/bindings/paths.h"
#include "python/bindings/toml_text.h"

namespace flexura::python {
namespace {

using Owner = std::shared_ptr<Campaign>;

Owner load(const py::object& file, const py::dict& sets) {
  const std::filesystem::path path = path_of(file);
  const std::vector<std::string> texts = set_texts(sets);
  const py::gil_scoped_release released;
  return std::make_shared<Campaign>(path, texts);
}

ExperimentDocument document_of(const py::object& experiment, const std::vector<std::string>& sets) {
  if (!py::isinstance<Experiment>(experiment)) return ExperimentDocument(path_of(experiment), {sets, {}});
  const auto& given = py::cast<const Experiment&>(experiment);
  return {with_overrides(Codec<Experiment>::write(given), {sets, {}}), ".", given.title};
}

// Makes a campaign of an experiment, or the path of its file, from the keys of a campaign file.
Owner made(const py::object& experiment, const py::kwargs& keys) {
  const Node table = node_of(keys);
  // The campaign's own text names the experiment, although it is not read again.
  Node::Table members = *table.as<Node::Table>();
  members.push_back({"experiment", {}, text_node("experiment.toml")});
  const Node campaign{std::move(members), {}};
  const auto config = read_as<CampaignConfig>(campaign);
  const ExperimentDocument document = document_of(experiment, config.set);
  const std::string record = write_json({Node::Table{{"campaign", {}, campaign},
                                                     {"experiment", {}, document.document()},
                                                     {"folder", {}, text_node(document.folder().string())},
                                                     {"title", {}, text_node(document.title())}},
                                         {}});
  const py::gil_scoped_release released;
  auto made = std::make_shared<Campaign>(Campaign::from_record(record, "<campaign>"));
  made->check_first_runs();
  return made;
}

std::int64_t own_run(const Campaign& campaign, std::int64_t id) {
  const std::int64_t runs = campaign.design().runs();
  if (id < 0 || id >= runs)
    throw py::index_error(
        fmt::format("run {}: the campaign has {} runs: expected 0 to {}", id, runs, runs - 1));
  return id;
}

Experiment experiment_of(const Campaign& campaign, std::int64_t id, const py::dict& sets) {
  const std::vector<std::string> texts = set_texts(sets);
  own_run(campaign, id);
  const py::gil_scoped_release released;
  return campaign.experiment(id, texts);
}

py::dict values_of(const Campaign& campaign, std::int64_t id) {
  const std::vector<Node> values = campaign.design().values(own_run(campaign, id));
  py::dict dict;
  for (std::size_t i = 0; i < values.size(); ++i)
    dict[py::str(place_of(campaign.config().parameter[i]).label())] = python_value(values[i]);
  return dict;
}

// How a call of Campaign.run ended, and where the rows are.
struct CampaignRun {
  CampaignEnd end;
  std::filesystem::path file;
};

CampaignRun run(const Campaign& campaign, const py::object& out, std::optional<std::size_t> workers,
                const py::object& on_progress, bool is_safe_from_power_loss) {
  if (workers && (*workers == 0 || *workers > 4096))
    throw py::value_error(fmt::format("workers: {}: expected 1 to 4096", *workers));
  const std::filesystem::path path = path_of(out);
  const std::size_t threads = workers.value_or(std::max<std::size_t>(std::thread::hardware_concurrency(), 1));
  return {with_progress(
              on_progress,
              [&](Progress& progress) {
                if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
                CampaignFile file(path, campaign,
                                  is_safe_from_power_loss ? Durability::power : Durability::process);
                ThreadEngine engine(
                    [&](std::int64_t id, Progress& of) { return execute_run(campaign, id, of); }, threads);
                return run_campaign(campaign, file, engine, progress);
              }),
          path};
}

// The results of a campaign, which one thread at a time reads.
class Results {
 public:
  explicit Results(std::filesystem::path path) : path_(std::move(path)), results_(path_) {}

  // Calls work(results) without the GIL.
  template <class Work>
  auto with(const Work& work) {
    const py::gil_scoped_release released;
    const std::lock_guard lock(mutex_);
    return work(results_);
  }
  // The campaign and its labels do not change.
  [[nodiscard]] const CampaignResults& fixed() const { return results_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  CampaignResults results_;
  std::mutex mutex_;
};

// Returns a column as an array: int64 for whole numbers, float64 with NaN for missing numbers, otherwise
// objects: str, or None for a missing text.
py::object column_array(const std::vector<Node>& values) {
  const auto count = static_cast<py::ssize_t>(values.size());
  const auto all = [&](const auto& is) { return std::ranges::all_of(values, is); };
  const auto is_whole = [](const Node& value) { return value.as<std::int64_t>() != nullptr; };
  if (!values.empty() && all(is_whole)) {
    py::array_t<std::int64_t> array(count);
    std::ranges::transform(values, array.mutable_data(),
                           [](const Node& value) { return *value.as<std::int64_t>(); });
    return array;
  }
  if (all([&](const Node& value) {
        return value.empty() || is_whole(value) || value.as<double>() != nullptr;
      })) {
    py::array_t<double> array(count);
    std::ranges::transform(values, array.mutable_data(), [&](const Node& value) {
      if (value.empty()) return std::nan("");
      return is_whole(value) ? static_cast<double>(*value.as<std::int64_t>()) : *value.as<double>();
    });
    return array;
  }
  py::list list;
  for (const Node& value : values) list.append(python_value(value));
  return py::module_::import("numpy").attr("array")(list, py::arg("dtype") = py::str("object"));
}

// Returns all rows as a dict of columns.
py::dict table(Results& results) {
  const CampaignConfig& config = results.fixed().campaign().config();
  std::vector<std::string> names = {"id", "seed", "status", "error", "seconds"};
  for (const ParameterConfig& one : config.parameter) names.push_back(place_of(one).label());
  for (const CampaignMeasureConfig& one : config.measure) names.push_back(one.label());
  std::vector<std::vector<Node>> columns(names.size());
  results.with([&](CampaignResults& read) {
    read.for_each([&](const CampaignRow& row) {
      auto column = columns.begin();
      const auto add = [&](Node value) { (column++)->push_back(std::move(value)); };
      add({row.id, {}});
      add({row.seed, {}});
      add(text_node(row.status));
      add(text_node(row.error));
      add({row.seconds, {}});
      for (const Node& value : row.parameters) add(value);
      for (const Node& value : row.measures) add(value);
    });
  });
  py::dict dict;
  for (std::size_t i = 0; i < names.size(); ++i) dict[py::str(names[i])] = column_array(columns[i]);
  return dict;
}

py::object sensitivity(Results& results, const std::string& measure, const std::string& parameter) {
  const CampaignSummary summary = results.with([](CampaignResults& read) { return summary_of(read); });
  const auto named = [](const std::vector<CampaignColumn>& columns, const std::string& name) {
    const auto found = std::ranges::find(columns, name, &CampaignColumn::name);
    if (found == columns.end()) throw py::key_error(fmt::format("the campaign has no column \"{}\"", name));
    return *found;
  };
  const auto found = sensitivity_of(named(summary.measures, measure), named(summary.parameters, parameter));
  if (!found) return py::none();
  py::dict dict;
  dict["rank_correlation"] = found->rank_correlation;
  dict["share"] = found->share;
  return dict;
}

py::object report(Results& results, const py::object& out) {
  std::filesystem::path page = results.path();
  page.replace_extension(".html");
  if (!out.is_none()) page = path_of(out);
  results.with([&](CampaignResults& read) {
    replace_file(page, campaign_html(read, results.path().string()));
    return 0;
  });
  return python_path(page);
}

py::object to_csv(Results& results, const py::object& out) {
  std::filesystem::path file = results.path();
  file.replace_extension(".csv");
  if (!out.is_none()) file = path_of(out);
  if (!is_missing(file)) throw input_error(file.string(), "exists already: expected another file");
  results.with([&](CampaignResults& read) {
    export_campaign_csv(read, file);
    return 0;
  });
  return python_path(file);
}

template <class Labels>
std::vector<std::string> labels(const Labels& of) {
  std::vector<std::string> names;
  for (const auto& one : of) {
    if constexpr (requires { one.label(); })
      names.push_back(one.label());
    else
      names.push_back(place_of(one).label());
  }
  return names;
}

void bind_results(py::module_& module) {
  using py::arg;
  py::class_<Results, std::shared_ptr<Results>>(
      module, "CampaignResults", "The table of a campaign, one row per run; also while the campaign runs.")
      .def(py::init([](const py::object& file) { return std::make_shared<Results>(path_of(file)); }),
           arg("file"),
           "Opens a file of Campaign.run or `flexura campaign`. Raises InputError for other files.")
      .def("table", &table,
           "Returns all rows, in the order of their numbers, as a dict of arrays (runs,): id, seed, status, "
           "error,\n"
           "seconds, then parameters and measures by their names. Missing numbers are NaN, missing texts "
           "None.")
      .def_property_readonly(
          "reason", [](const Results& of) { return of.fixed().reason(); },
          "Why the campaign is complete; \"\" if runs are missing.")
      .def_property_readonly(
          "parameters", [](const Results& of) { return labels(of.fixed().campaign().config().parameter); },
          "Names of the parameters, a list of str.")
      .def_property_readonly(
          "measures", [](const Results& of) { return labels(of.fixed().campaign().config().measure); },
          "Names of the measures, a list of str.")
      .def(
          "experiment",
          [](const Results& of, std::int64_t run, const py::dict& sets) {
            return experiment_of(of.fixed().campaign(), run, sets);
          },
          arg("run"), arg("sets") = py::dict(),
          "Returns the Experiment of a run, to replay it: results.experiment(3).run(\"replay\"). sets: "
          "further\n"
          "changes.")
      .def("sensitivity", &sensitivity, arg("measure"), arg("parameter"),
           "Returns how a measure depends on a parameter: a dict with Spearman's rank_correlation, and the "
           "share of\n"
           "the measure's variance that the parameter alone explains. None for fewer than 20 runs with both, "
           "or if\n"
           "one does not vary.")
      .def("report", &report, arg("out") = py::none(),
           "Writes a page about the results, which replaces an existing one (default: NAME.html). Returns "
           "its path.")
      .def("to_csv", &to_csv, arg("out") = py::none(),
           "Writes all rows as CSV into a new file (default: NAME.csv). Returns its path.")
      .def("__repr__", [](const Results& of) {
        return fmt::format("<flexura.CampaignResults: {}>", of.path().string());
      });
}

void bind_campaign_run(py::module_& module) {
  py::class_<CampaignRun>(module, "CampaignRun", "How a call of Campaign.run ended.")
      .def_property_readonly(
          "complete", [](const CampaignRun& of) { return of.end.is_complete; },
          "Whether all runs are done, or the required precision is reached.")
      .def_property_readonly(
          "cancelled", [](const CampaignRun& of) { return of.end.is_cancelled; },
          "Whether on_progress ended the campaign early.")
      .def_property_readonly(
          "reason", [](const CampaignRun& of) { return of.end.reason; }, "Why it ended, in words.")
      .def_property_readonly(
          "runs", [](const CampaignRun& of) { return of.end.runs; }, "Number of rows in the file.")
      .def_property_readonly(
          "runs_before", [](const CampaignRun& of) { return of.end.before; },
          "Number of rows that were there before the call.")
      .def_property_readonly(
          "file", [](const CampaignRun& of) { return python_path(of.file); }, "The file, a pathlib.Path.")
      .def_property_readonly(
          "results", [](const CampaignRun& of) { return std::make_shared<Results>(of.file); },
          "The rows, a CampaignResults.")
      .def("__repr__",
           [](const CampaignRun& of) { return fmt::format("<flexura.CampaignRun: {}>", of.end.reason); });
}

}  // namespace

void bind_campaign(py::module_& module) {
  using py::arg;
  bind_results(module);
  bind_campaign_run(module);
  py::class_<Campaign, Owner>(module, "Campaign",
                              "A campaign: one experiment, run many times with varied values.")
      .def(py::init(&made), arg("experiment"),
           "Makes a campaign from an Experiment, or the path of its file, and the keys of a campaign file:\n"
           "Campaign(experiment, samples=100, parameter=[{\"kind\": \"uniform\", \"path\": ...}], "
           "measure=[{...}]). The "
           "keys of\nan Experiment are those of Experiment.table, in base units. Raises InputError for wrong "
           "keys.")
      .def_static(
          "load", &load, arg("file"), arg("sets") = py::dict(),
          "Reads a campaign file. sets: changes of it, as {\"samples\": 20}. Raises InputError with all "
          "problems.")
      .def_property_readonly(
          "runs", [](const Campaign& of) { return of.design().runs(); }, "Number of runs.")
      .def_property_readonly(
          "parameters", [](const Campaign& of) { return labels(of.config().parameter); },
          "Names of the parameters, a list of str.")
      .def_property_readonly(
          "measures", [](const Campaign& of) { return labels(of.config().measure); },
          "Names of the measures, a list of str.")
      .def("values", &values_of, arg("run"), "Returns the parameters of a run, a dict.")
      .def(
          "seed", [](const Campaign& of, std::int64_t run) { return of.design().seed(own_run(of, run)); },
          arg("run"), "Returns the seed of a run.")
      .def("experiment", &experiment_of, arg("run"), arg("sets") = py::dict(),
           "Returns the Experiment of a run, with further changes. Raises InputError if its values are "
           "invalid.")
      .def("run", &run, arg("out"), py::kw_only(), arg("workers") = py::none(),
           arg("on_progress") = py::none(), arg("safe_from_power_loss") = false,
           "Executes the missing runs on `workers` threads (default: one per processor) and writes one row "
           "per run\n"
           "into the SQLite file `out`, as `flexura campaign` does. An interrupted campaign goes on. "
           "on_progress(\n"
           "fraction, what) may return False to end the call; its exceptions end the call, too. Returns a "
           "CampaignRun.")
      .def("__repr__",
           [](const Campaign& of) { return fmt::format("<flexura.Campaign: {} runs>", of.design().runs()); });
}

}  // namespace flexura::python

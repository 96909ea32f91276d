#include <fmt/format.h>

#include "flexura/campaign/campaign_config.h"
#include "flexura/experiment/experiment.h"
#include "flexura/log/export_csv.h"
#include "flexura/log/export_mp4.h"
#include "flexura/log/export_png.h"
#include "flexura/log/results.h"
#include "flexura/log/results_log.h"
#include "flexura/store/schema.h"
#include "flexura/tasks/task_kinds.h"
#include "python/bindings/callbacks.h"
#include "python/bindings/module.h"
#include "python/bindings/paths.h"

namespace flexura::python {
namespace {

ExportResult export_as(const std::filesystem::path& results, const std::string& to, Progress& progress) {
  if (to == "csv") return export_csv(results, task_tables(), &progress);
  const Experiment experiment = load_experiment(file_of_results(results, experiment_file_name));
  const std::vector<CameraConfig> cameras = experiment.true_rig().cameras;
  return to == "mp4" ? export_mp4(results, cameras, &progress) : export_png(results, cameras, &progress);
}

py::object export_results(const py::object& results, const std::string& to, const py::object& on_progress) {
  if (to != "csv" && to != "mp4" && to != "png")
    throw py::value_error(fmt::format("to: \"{}\": expected \"csv\", \"mp4\" or \"png\"", to));
  const std::filesystem::path folder = path_of(results);
  const ExportResult written =
      with_progress(on_progress, [&](Progress& progress) { return export_as(folder, to, progress); });
  for (const std::string& note : written.notes)
    if (PyErr_WarnEx(PyExc_UserWarning, note.c_str(), 1) != 0) throw py::error_already_set();
  return python_path(written.folder);
}

py::object schema(const std::string& of) {
  if (of == "experiment")
    return python_value(json_schema(fields_of(static_cast<const Experiment*>(nullptr)).info()));
  if (of == "campaign")
    return python_value(json_schema(fields_of(static_cast<const CampaignConfig*>(nullptr)).info()));
  throw py::value_error(fmt::format("of: \"{}\": expected \"experiment\" or \"campaign\"", of));
}

}  // namespace

void bind_export(py::module_& module) {
  using py::arg;
  module.def(
      "export", &export_results, arg("results"), arg("to") = "csv", py::kw_only(),
      arg("on_progress") = py::none(),
      "Writes the log of a results folder as tables (\"csv\") or the films of its cameras (\"mp4\", which "
      "needs\nffmpeg, or \"png\", animated pictures) into a new folder. Returns this folder. Warns about "
      "gaps "
      "in the log.");
  module.def("schema", &schema, arg("of") = "experiment",
             "Returns the JSON Schema of experiment files, or of campaign files (\"campaign\"), as a dict.");
}

}  // namespace flexura::python

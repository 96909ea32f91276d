#include "python/bindings/run.h"

#include <fmt/format.h>

#include "flexura/log/logged_message.h"
#include "flexura/log/results.h"
#include "python/bindings/callbacks.h"
#include "python/bindings/convert.h"
#include "python/bindings/module.h"
#include "python/bindings/paths.h"

namespace flexura::python {
namespace {

class CallbackWatcher : public RunWatcher {
 public:
  CallbackWatcher(Caller& caller, const py::object& on_state, const py::object& on_event,
                  const py::object& on_message)
      : caller_(caller), on_state_(on_state), on_event_(on_event), on_message_(on_message) {}

  void state(double time, const ArmState& state, std::span<const CameraReading> /*cameras*/) override {
    if (!on_state_.is_none()) caller_.call([&] { on_state_(time, state_array(state)); });
  }
  void happened(double time, const std::string& level, const std::string& name,
                const std::string& text) override {
    if (!on_event_.is_none()) caller_.call([&] { on_event_(time, level, name, text); });
  }
  void logged(const LoggedMessage& message) override {
    if (on_message_.is_none()) return;
    caller_.call([&] {
      on_message_(py::str(message.topic().data(), message.topic().size()), message.time(),
                  python_value(message.node()));
    });
  }

 private:
  Caller& caller_;
  const py::object &on_state_, &on_event_, &on_message_;
};

std::filesystem::path folder_of(const Experiment& experiment, const py::object& out) {
  if (!out.is_none()) return path_of(out);
  return std::filesystem::path("results") / (experiment.title.empty() ? "experiment" : experiment.title);
}

}  // namespace

RunResult run(const Experiment& experiment, const py::object& out, const py::object& on_progress,
              const py::object& on_state, const py::object& on_event, const py::object& on_message) {
  const std::filesystem::path desired = folder_of(experiment, out);
  Caller caller;
  RunResult result;
  {
    const py::gil_scoped_release released;
    CallbackProgress progress(caller, on_progress);
    CallbackWatcher watcher(caller, on_state, on_event, on_message);
    result = run_experiment(experiment, make_new_folder(desired), progress, &watcher);
  }
  caller.rethrow();
  return result;
}

void bind_run(py::module_& module) {
  py::class_<RunResult>(module, "RunResult", "Result of a run.")
      .def_property_readonly(
          "outcome", [](const RunResult& result) { return name_of(result.outcome); },
          "\"done\", \"unsafe\", \"failed\" or \"cancelled\".")
      .def_readonly("reasons", &RunResult::reasons, "Why the outcome is not \"done\", a list of str.")
      .def_readonly("headline", &RunResult::headline, "The result in one line.")
      .def_property_readonly(
          "folder", [](const RunResult& result) { return python_path(result.folder); },
          "Folder with all files of the run, a pathlib.Path.")
      .def_property_readonly(
          "summary", [](const RunResult& result) { return python_value(result.summary); },
          "Content of summary.json, a dict.")
      .def_property_readonly(
          "tasks", [](const RunResult& result) { return python_value(outcomes_node(result.outcomes)); },
          "Results of the tasks: a list of dicts with task, kind, reached and text.")
      .def("__repr__", [](const RunResult& result) {
        return fmt::format("<flexura.RunResult: {}, {}>", name_of(result.outcome), result.folder.string());
      });
}

}  // namespace flexura::python

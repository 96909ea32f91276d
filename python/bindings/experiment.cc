#include "flexura/experiment/experiment.h"

#include <fmt/format.h>

#include <memory>
#include <mutex>

#include "flexura/rig/photographer.h"
#include "python/bindings/arm.h"
#include "python/bindings/camera.h"
#include "python/bindings/module.h"
#include "python/bindings/paths.h"
#include "python/bindings/picture.h"
#include "python/bindings/run.h"
#include "python/bindings/toml_text.h"

namespace flexura::python {
namespace {

Experiment load(const py::object& file, const py::dict& sets, const std::optional<std::int64_t>& seed) {
  const std::filesystem::path path = path_of(file);
  const Overrides overrides{.sets = set_texts(sets), .seed = seed};
  const py::gil_scoped_release released;
  return load_experiment(path, overrides);
}

Experiment made(const py::kwargs& table) {
  const Node document = node_of(table);
  const std::string text = toml_text(*document.as<Node::Table>());
  const py::gil_scoped_release released;
  return parse_experiment(text, "<experiment>");
}

std::vector<std::shared_ptr<Camera>> cameras_of(const std::vector<CameraConfig>& configs) {
  std::vector<std::shared_ptr<Camera>> cameras;
  for (const CameraConfig& config : configs) cameras.push_back(std::make_shared<Camera>(config));
  return cameras;
}

// Takes pictures with the true scene of an experiment.
class RigPhotographer {
 public:
  explicit RigPhotographer(const Experiment& experiment)
      : photographer_(experiment),
        true_rig_(experiment.true_rig()),
        seed_(experiment.seed),
        arm_(true_rig_.arm, true_rig_.drive) {
    for (const CameraConfig& config : true_rig_.cameras) cameras_.emplace_back(config);
  }

  // `shape`: a Backbone, or a state of the true arm.
  [[nodiscard]] py::array take(const py::object& camera, const py::object& shape, const py::object& stance,
                               std::int64_t frame, const std::optional<std::int64_t>& seed) {
    Shot shot;
    shot.camera = index_of(camera);
    shot.frame = frame;
    shot.seed = static_cast<std::uint64_t>(seed.value_or(seed_));
    shot.sensor = &cameras_[shot.camera].config().sensor;
    const View view = cameras_[shot.camera].view(stance_of(cameras_[shot.camera], stance));
    shot.view = [&view](double) { return view; };
    const Backbone backbone = backbone_of(shape);
    shot.backbone = [&backbone](double) { return backbone; };
    Picture picture;
    {
      const py::gil_scoped_release released;
      const std::lock_guard lock(mutex_);
      picture = photographer_.take(shot);
    }
    return std::visit([](auto& image) { return picture_array(std::move(image)); }, picture);
  }

 private:
  [[nodiscard]] std::size_t index_of(const py::object& camera) const {
    if (py::isinstance<py::str>(camera)) {
      for (std::size_t i = 0; i < cameras_.size(); ++i)
        if (cameras_[i].config().name == py::cast<std::string>(camera)) return i;
      throw py::value_error(fmt::format("there is no camera \"{}\"", py::cast<std::string>(camera)));
    }
    const auto index = py::cast<std::size_t>(camera);
    if (index >= cameras_.size()) throw py::index_error(fmt::format("there is no camera {}", index));
    return index;
  }
  [[nodiscard]] Backbone backbone_of(const py::object& shape) const {
    if (py::isinstance<Backbone>(shape)) return py::cast<Backbone>(shape);
    const StateArray states(py::cast<Reals>(shape), arm_.sections());
    if (!states.is_single()) throw py::value_error("shape: expected one state");
    ArmState state;
    states.read(0, state);
    return arm_.model.backbone(state);
  }

  std::mutex mutex_;
  Photographer photographer_;
  RigConfig true_rig_;
  std::int64_t seed_;
  DescribedArm arm_;
  std::vector<Camera> cameras_;
};

}  // namespace

void bind_experiment(py::module_& module) {
  using py::arg;
  const auto none = py::none();
  py::class_<RigPhotographer, std::shared_ptr<RigPhotographer>>(
      module, "Photographer",
      "Takes pictures of the simulated world of an experiment, with its cameras and sensors.")
      .def("take", &RigPhotographer::take, arg("camera"), arg("shape"), arg("stance") = none, py::kw_only(),
           arg("frame") = 0, arg("seed") = none,
           "Returns the picture of a camera (number or name) of the arm with `shape`, a Backbone or a state\n"
           "(sections, 3) of the true arm: an array of uint8 (uint16 for sensors with more than 8 bits) of "
           "shape\n"
           "(height, width) or (height, width, 3). frame and seed determine the noise.");
  py::class_<Experiment, std::shared_ptr<Experiment>>(
      module, "Experiment",
      "An experiment: a rig (arm, drives, cameras, surroundings) and its tasks, described by the keys of an\n"
      "experiment file.")
      .def(py::init([](const py::kwargs& table) { return std::make_shared<Experiment>(made(table)); }),
           "Makes an experiment from the keys of an experiment file: Experiment(arm={...}, task=[{...}]). "
           "Raises\n"
           "InputError for wrong keys or values.")
      .def_static("load", &load, arg("file"), arg("sets") = py::dict(), arg("seed") = none,
                  "Reads an experiment file. sets: changes as {\"arm.section.0.length\": 0.3}. seed: "
                  "replaces the file's\n"
                  "seed. Raises InputError with all problems of the file.")
      .def_static(
          "parse",
          [](const std::string& text, const std::string& source) {
            const py::gil_scoped_release released;
            return parse_experiment(text, source);
          },
          arg("text"), arg("source") = "<text>",
          "Reads an experiment from TOML text. source: its name in errors.")
      .def_readonly("title", &Experiment::title, "Title of the report.")
      .def_readonly("seed", &Experiment::seed, "Seed of all random numbers.")
      .def_property_readonly(
          "arm",
          [](const Experiment& experiment) {
            return std::make_shared<DescribedArm>(experiment.arm, experiment.drive);
          },
          "The model of the arm, an Arm.")
      .def_property_readonly(
          "true_arm",
          [](const Experiment& experiment) {
            const RigConfig rig = experiment.true_rig();
            return std::make_shared<DescribedArm>(rig.arm, rig.drive);
          },
          "The arm of the simulated world, which may differ from the model, an Arm.")
      .def_property_readonly(
          "cameras", [](const Experiment& experiment) { return cameras_of(experiment.cameras()); },
          "The models of the cameras, a list of Camera.")
      .def_property_readonly(
          "table",
          [](const Experiment& experiment) { return python_value(Codec<Experiment>::write(experiment)); },
          "The description as a dict with all keys, in base units.")
      .def(
          "to_toml", [](const Experiment& experiment) { return experiment_toml(experiment); },
          "Returns the experiment as the text of a file, with every value and default.")
      .def(
          "photographer",
          [](const Experiment& experiment) { return std::make_shared<RigPhotographer>(experiment); },
          "Returns a Photographer of the simulated world.")
      .def("run", &run, arg("out") = none, py::kw_only(), arg("on_progress") = none, arg("on_state") = none,
           arg("on_event") = none, arg("on_message") = none,
           "Runs the experiment and writes its results into a new folder `out` (default: results/NAME). "
           "Results are\n"
           "never overwritten: an existing folder's name gets a number. Callbacks: on_progress(fraction, "
           "what),\n"
           "which may return False to end the run; on_state(time, state) with state (sections, 3) at every "
           "clock step;\n"
           "on_event(time, level, source, text); on_message(topic, time, dict). An exception in a callback "
           "ends the run\n"
           "and is raised again. Returns a RunResult.");
}

}  // namespace flexura::python

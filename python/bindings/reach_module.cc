#include <cmath>
#include <memory>

#include "python/bindings/locked.h"
#include "python/bindings/module.h"
#include "python/bindings/reach_batch.h"

namespace flexura::python {
namespace {

using LockedReach = Locked<ReachBatch>;
using Owner = std::shared_ptr<LockedReach>;

Owner make(const std::shared_ptr<DescribedArm>& arm, const Experiment* experiment, std::size_t count,
           std::size_t threads, const std::string& target, bool elastic, double time_step, int substeps,
           int max_steps, double tolerance, double max_tension, double max_rate, bool pictures) {
  if (target != "tip" && target != "shape") throw py::value_error("target: expected \"tip\" or \"shape\"");
  if (pictures && experiment == nullptr)
    throw py::value_error("pictures: expected an Experiment with two cameras");
  const ReachConfig config{.is_shape = target == "shape",
                           .is_elastic = elastic,
                           .time_step = time_step,
                           .substeps = substeps,
                           .max_steps = max_steps,
                           .tolerance = tolerance,
                           .max_tension = max_tension,
                           .max_rate = max_rate,
                           .has_pictures = pictures};
  const py::gil_scoped_release released;
  return std::make_shared<LockedReach>(arm, experiment, config, count, threads);
}

void reset(LockedReach& of, const std::optional<std::uint64_t>& seed,
           const std::optional<py::array_t<bool, py::array::c_style | py::array::forcecast>>& chosen) {
  if (chosen && (chosen->ndim() != 1 || chosen->shape(0) != of.rows()))
    throw py::value_error("chosen: expected one bool per arm");
  std::unique_ptr<bool[]> all(new bool[of.batch.count()]);
  for (std::size_t i = 0; i < of.batch.count(); ++i) all[i] = chosen ? chosen->data()[i] : true;
  of.with([&](ReachBatch& batch) {
    if (seed) batch.seed(*seed);
    batch.reset({all.get(), batch.count()});
  });
}

py::tuple step(LockedReach& of, const Reals& actions) {
  of.require_rows(actions, of.batch.actions(), "actions");
  for (py::ssize_t i = 0; i < actions.size(); ++i)
    if (std::isnan(actions.data()[i])) throw py::value_error("actions: expected numbers, not NaN");
  py::array_t<double> rewards(of.rows()), errors(of.rows());
  py::array_t<bool> terminated(of.rows()), truncated(of.rows());
  const ReachBatch::Results results{rewards.mutable_data(), errors.mutable_data(), terminated.mutable_data(),
                                    truncated.mutable_data()};
  of.with([&](ReachBatch& batch) { batch.step(actions.data(), results); });
  return py::make_tuple(rewards, terminated, truncated, errors);
}

py::array_t<float> observe(LockedReach& of) {
  py::array_t<float> array(Sizes{of.rows(), static_cast<py::ssize_t>(of.batch.observations())});
  float* to = array.mutable_data();
  of.with([&](ReachBatch& batch) { batch.observe(to); });
  return array;
}

py::array_t<std::uint8_t> photograph(LockedReach& of) {
  const auto [width, height] = of.batch.picture_size();
  if (width == 0) throw py::value_error("made without pictures");
  py::array_t<std::uint8_t> array(Sizes{of.rows(), 4, height, width});
  std::uint8_t* to = array.mutable_data();
  of.with([&](ReachBatch& batch) { batch.photograph(to); });
  return array;
}

Backbone shape_of(LockedReach& of, std::size_t i, bool is_target) {
  of.require_arm(i);
  std::optional<Backbone> shape;
  of.with([&](const ReachBatch& batch) { shape = is_target ? batch.target(i) : batch.backbone(i); });
  return *shape;
}

}  // namespace

void bind_reach(py::module_& module) {
  using py::arg;
  py::class_<LockedReach, Owner>(
      module, "ReachBatch",
      "Arms that reach for targets: the core of flexura.env, which describes the arguments.")
      .def(py::init(&make), arg("arm"), arg("experiment"), arg("count"), arg("threads"), py::kw_only(),
           arg("target"), arg("elastic"), arg("time_step"), arg("substeps"), arg("max_steps"),
           arg("tolerance"), arg("max_tension"), arg("max_rate"), arg("pictures"))
      .def_property_readonly(
          "count", [](const LockedReach& of) { return of.batch.count(); }, "Number of arms.")
      .def_property_readonly(
          "actions", [](const LockedReach& of) { return of.batch.actions(); }, "Number of actions of an arm.")
      .def_property_readonly(
          "observations", [](const LockedReach& of) { return of.batch.observations(); },
          "Number of values of a state observation.")
      .def_property_readonly(
          "picture_size", [](const LockedReach& of) { return of.batch.picture_size(); },
          "Width and height of the pictures, px; 0 without pictures.")
      .def("reset", &reset, arg("seed") = py::none(), arg("chosen") = py::none(),
           "Starts an episode of all arms, or of those chosen (count,). seed: restarts the random streams.")
      .def("step", &step, arg("actions"),
           "Applies actions (count, actions) from -1 to 1. Returns rewards, terminated, truncated and "
           "errors, each\n"
           "(count,). An arm whose episode has ended starts the next one instead.")
      .def("observe", &observe, "Returns the state observations, float32, shape (count, observations).")
      .def("photograph", &photograph,
           "Returns pictures, uint8, shape (count, 4, height, width): the arm by two cameras, and the target "
           "shape.")
      .def(
          "backbone", [](LockedReach& of, std::size_t i) { return shape_of(of, i, false); }, arg("i"),
          "Returns the Backbone of arm i.")
      .def(
          "target", [](LockedReach& of, std::size_t i) { return shape_of(of, i, true); }, arg("i"),
          "Returns the Backbone of the target of arm i.");
}

}  // namespace flexura::python

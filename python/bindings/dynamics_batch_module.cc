#include <fmt/format.h>

#include <memory>
#include <vector>

#include "python/bindings/dynamics_batch.h"
#include "python/bindings/locked.h"
#include "python/bindings/module.h"

namespace flexura::python {
namespace {

using LockedBatch = Locked<DynamicsBatch>;
using Owner = std::shared_ptr<LockedBatch>;

py::array_t<bool> step(LockedBatch& of, const std::optional<Reals>& tensions,
                       const std::optional<Reals>& displacements, double h, int steps,
                       const py::object& out) {
  if (steps < 1) throw py::value_error("steps: expected at least 1");
  if (!(h > 0)) throw py::value_error("h: expected a number above 0");
  const TendonArray inputs(tensions, displacements, of.batch.count(), of.batch.tendons());
  py::array_t<bool> converged = result_array<bool>(out, {of.rows()}, "bool");
  const std::span<bool> to(converged.mutable_data(), of.batch.count());
  of.with([&](DynamicsBatch& batch) { batch.step(inputs, h, steps, to); });
  return converged;
}

template <void (DynamicsBatch::*fill)(double*)>
py::array_t<double> filled(LockedBatch& of, const py::object& out, const Sizes& sizes) {
  py::array_t<double> array = result_array(out, sizes);
  double* to = array.mutable_data();
  of.with([&](DynamicsBatch& batch) { (batch.*fill)(to); });
  return array;
}

py::array_t<double> modes(LockedBatch& of, const py::object& out) {
  py::array_t<double> array = result_array(out, {of.rows(), of.batch.size()});
  double* to = array.mutable_data();
  of.with([&](const DynamicsBatch& batch) {
    for (std::size_t i = 0; i < batch.count(); ++i, to += batch.size())
      Eigen::Map<Eigen::VectorXd>(to, batch.size()) = batch.state(i).q;
  });
  return array;
}

// Arms by their numbers, by an array of truth values, or all.
std::vector<std::size_t> chosen_arms(const LockedBatch& of, const py::object& arms) {
  std::vector<std::size_t> chosen;
  const std::size_t count = of.batch.count();
  if (arms.is_none()) {
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(i);
    return chosen;
  }
  const py::array array = py::array::ensure(arms);
  if (array && array.dtype().kind() == 'b') {
    if (array.ndim() != 1 || array.shape(0) != of.rows())
      throw py::value_error(fmt::format("arms: expected an array of shape ({},) of bool", count));
    const auto truth = py::cast<std::vector<bool>>(array);
    for (std::size_t i = 0; i < count; ++i)
      if (truth[i]) chosen.push_back(i);
    return chosen;
  }
  chosen = py::cast<std::vector<std::size_t>>(arms);
  for (const std::size_t i : chosen) of.require_arm(i);
  return chosen;
}

}  // namespace

void bind_dynamics_batch(py::module_& module) {
  using py::arg;
  py::class_<LockedBatch, Owner>(
      module, "DynamicsBatch",
      "Motion of `count` equal arms, advanced together on `threads` threads. Each arm moves\n"
      "as with Dynamics; results do not depend on the number of threads.")
      .def(py::init([](const DescribedArm& arm, std::size_t count, std::size_t threads,
                       double spectral_radius, double tolerance) {
             return std::make_shared<LockedBatch>(
                 arm, count, threads,
                 RodDynamicsConfig{.spectral_radius = spectral_radius, .tolerance = tolerance});
           }),
           arg("arm"), arg("count"), arg("threads") = 1, py::kw_only(), arg("spectral_radius") = 0.1,
           arg("tolerance") = 1e-7, "All arms start unloaded and at rest.")
      .def_property_readonly(
          "count", [](const LockedBatch& of) { return of.batch.count(); }, "Number of arms, N.")
      .def_property_readonly(
          "size", [](const LockedBatch& of) { return of.batch.size(); }, "Number of strain modes.")
      .def_property_readonly(
          "tendons", [](const LockedBatch& of) { return of.batch.tendons(); }, "Number of tendons.")
      .def("__len__", [](const LockedBatch& of) { return of.batch.count(); })
      .def(
          "step", &step, arg("tensions") = py::none(), arg("displacements") = py::none(), arg("h") = 0.01,
          arg("steps") = 1, arg("out") = py::none(),
          "Advances every arm by `steps` steps of h seconds with tensions, N, or displacements, m, of shape\n"
          "(N, tendons). Returns whether the steps of each arm converged, shape (N,). An arm whose step did "
          "not\n"
          "converge keeps the state before that step.")
      .def(
          "tips",
          [](LockedBatch& of, const py::object& out) {
            return filled<&DynamicsBatch::tips>(of, out, {of.rows(), 4, 4});
          },
          arg("out") = py::none(), "Returns the tips' poses X_WT in the world, shape (N, 4, 4).")
      .def("q", &modes, arg("out") = py::none(), "Returns the strain modes, shape (N, size).")
      .def(
          "velocities",
          [](LockedBatch& of, const py::object& out) {
            return filled<&DynamicsBatch::velocities>(of, out, {of.rows(), of.batch.size()});
          },
          arg("out") = py::none(), "Returns the rates of the modes, shape (N, size).")
      .def(
          "state",
          [](LockedBatch& of, std::size_t i) {
            RodState state;
            of.require_arm(i);
            of.with([&](const DynamicsBatch& batch) { state = batch.state(i); });
            return state;
          },
          arg("i"), "Returns a copy of the state of arm i, a RodState.")
      .def(
          "set_state",
          [](LockedBatch& of, std::size_t i, const RodState& state) {
            require_same_arm(state, of.batch.rest());
            of.require_arm(i);
            const RodState own = state;  // Other threads may use the given one.
            of.with([&](DynamicsBatch& batch) { batch.set(i, own); });
          },
          arg("i"), arg("state"), "Puts arm i into a state.")
      .def(
          "reset",
          [](LockedBatch& of, const py::object& arms) {
            const std::vector<std::size_t> chosen = chosen_arms(of, arms);
            of.with([&](DynamicsBatch& batch) {
              for (const std::size_t i : chosen) batch.reset(i);
            });
          },
          arg("arms") = py::none(),
          "Puts arms into their state at the start: those with these numbers, those with True in an array "
          "(N,) of\n"
          "bool, or all.");
}

}  // namespace flexura::python

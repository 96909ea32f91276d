#pragma once

#include <pybind11/pybind11.h>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"

namespace flexura::python {

/// Runs an experiment with callbacks; each may be None. Throws the first exception of a callback after the
/// run's end.
[[nodiscard]] RunResult run(const Experiment& experiment, const pybind11::object& out,
                            const pybind11::object& on_progress, const pybind11::object& on_state,
                            const pybind11::object& on_event, const pybind11::object& on_message);

}  // namespace flexura::python

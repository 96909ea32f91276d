#pragma once

#include <pybind11/pybind11.h>

namespace flexura::python {

/// Each function adds the classes and functions of one subject to the module.
void bind_errors(pybind11::module_& module);
void bind_arm(pybind11::module_& module);
void bind_inverse(pybind11::module_& module);
void bind_backbone(pybind11::module_& module);
void bind_statics(pybind11::module_& module);
void bind_dynamics(pybind11::module_& module);
void bind_dynamics_batch(pybind11::module_& module);
void bind_camera(pybind11::module_& module);
void bind_vision(pybind11::module_& module);
void bind_run(pybind11::module_& module);
void bind_experiment(pybind11::module_& module);
void bind_identify(pybind11::module_& module);
void bind_campaign(pybind11::module_& module);
void bind_export(pybind11::module_& module);
void bind_log(pybind11::module_& module);
void bind_calibration(pybind11::module_& module);
void bind_reach(pybind11::module_& module);

}  // namespace flexura::python

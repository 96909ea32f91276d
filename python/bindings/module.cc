#include "python/bindings/module.h"

#include <string>

#include "flexura/base/version.h"

PYBIND11_MODULE(_flexura, module) {
  module.doc() = "Flexura's library. Units are m, rad and s; frames are those of docs/conventions.md.";
  module.attr("__version__") = std::string(flexura::version());
  using namespace flexura::python;
  bind_errors(module);
  bind_arm(module);
  bind_inverse(module);
  bind_backbone(module);
  bind_statics(module);
  bind_dynamics(module);
  bind_dynamics_batch(module);
  bind_camera(module);
  bind_vision(module);
  bind_run(module);
  bind_experiment(module);
  bind_identify(module);
  bind_campaign(module);
  bind_export(module);
  bind_log(module);
  bind_calibration(module);
  bind_reach(module);
}

#pragma once

#include "flexura/camera/camera.h"
#include "python/bindings/convert.h"

namespace flexura::python {

/// Returns the stance with keys pan, tilt, zoom and stage; keys that are missing keep their initial values.
/// None: the initial stance. Throws py::value_error for other keys.
[[nodiscard]] CameraStance stance_of(const Camera& camera, const py::object& stance);

}  // namespace flexura::python

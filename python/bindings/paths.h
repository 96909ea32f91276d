#pragma once

#include <filesystem>

#include "python/bindings/convert.h"

namespace flexura::python {

/// Returns a str or os.PathLike as a path. Throws py::error_already_set for other types.
[[nodiscard]] inline std::filesystem::path path_of(const py::object& path) {
  return py::cast<std::string>(py::module_::import("os").attr("fspath")(path));
}

/// Returns a path as a pathlib.Path.
[[nodiscard]] inline py::object python_path(const std::filesystem::path& path) {
  return py::module_::import("pathlib").attr("Path")(path.string());
}

}  // namespace flexura::python

#include "python/bindings/camera.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "python/bindings/module.h"

namespace flexura::python {

CameraStance stance_of(const Camera& camera, const py::object& stance) {
  CameraStance found = camera.initial_stance();
  if (stance.is_none()) return found;
  for (const auto& [key, value] : py::cast<py::dict>(stance)) {
    const auto name = py::cast<std::string>(key);
    if (name == "pan") {
      found.head.pan = py::cast<double>(value);
    } else if (name == "tilt") {
      found.head.tilt = py::cast<double>(value);
    } else if (name == "zoom") {
      found.head.zoom = py::cast<double>(value);
    } else if (name == "stage") {
      found.stage.offset = vector_of(py::cast<Reals>(value), 3, "stage");
    } else {
      throw py::value_error(fmt::format("stance: {}: expected pan, tilt, zoom or stage", name));
    }
  }
  return found;
}

namespace {

py::dict stance_dict(const CameraStance& stance) {
  py::dict dict;
  dict["pan"] = stance.head.pan;
  dict["tilt"] = stance.head.tilt;
  dict["zoom"] = stance.head.zoom;
  dict["stage"] = vector_array(stance.stage.offset);
  return dict;
}

py::array_t<double> project(const Camera& camera, const Reals& points, const py::object& stance,
                            const py::object& out) {
  if (points.ndim() < 1 || points.shape(points.ndim() - 1) != 3)
    throw py::value_error("points: expected an array of shape (..., 3)");
  const View view = camera.view(stance_of(camera, stance));
  Sizes sizes(points.shape(), points.shape() + points.ndim());
  sizes.back() = 2;
  py::array_t<double> pixels = result_array(out, sizes);
  const double* from = points.data();
  double* to = pixels.mutable_data();
  const py::ssize_t count = points.size() / 3;
  const py::gil_scoped_release released;
  const Pose X_CW = view.X_WC.inverse();
  for (py::ssize_t i = 0; i < count; ++i)
    Eigen::Map<Eigen::Vector2d>{to + 2 * i} =
        view.lens.project(X_CW * Eigen::Map<const Eigen::Vector3d>(from + 3 * i))
            .value_or(Eigen::Vector2d::Constant(std::nan("")));
  return pixels;
}

py::object projection(const Camera& camera, const Reals& point, const py::object& stance) {
  const auto found = camera.project(vector_of(point, 3, "point"), stance_of(camera, stance));
  if (!found) return py::none();
  py::dict result;
  result["pixel"] = vector_array(found->pixel);
  result["by_point"] = matrix_array(found->by_point);
  result["by_mount"] = matrix_array(found->by_mount);
  result["by_stage"] = matrix_array(found->by_stage);
  result["by_pan"] = vector_array(found->by_pan);
  result["by_tilt"] = vector_array(found->by_tilt);
  result["by_zoom"] = vector_array(found->by_zoom);
  result["by_intrinsics"] = matrix_array(found->by_intrinsics);
  return result;
}

py::dict intrinsics(const Camera& camera, const py::object& stance) {
  const View view = camera.view(stance_of(camera, stance));
  const Intrinsics& found = view.lens.intrinsics();
  py::dict result;
  result["fx"] = found.fx;
  result["fy"] = found.fy;
  result["cx"] = found.cx;
  result["cy"] = found.cy;
  result["model"] = name_of(found.distortion.model());
  result["distortion"] = std::vector<double>(found.distortion.begin(), found.distortion.end());
  return result;
}

py::dict looking_at(const Camera& camera, const Reals& point, const py::object& stance) {
  CameraStance found = stance_of(camera, stance);
  // The pupil moves with the head, so the direction is found by repetition.
  for (int i = 0; i < 20; ++i)
    found.head =
        camera.looking_along(vector_of(point, 3, "point") - camera.pose(found).position, found.head.zoom);
  return stance_dict(found);
}

}  // namespace

void bind_camera(py::module_& module) {
  using py::arg;
  const auto none = py::none();
  py::class_<Camera, std::shared_ptr<Camera>>(
      module, "Camera",
      "A camera, described by the keys of a table [[camera]] of an experiment file.\n\n"
      "A stance is a dict with pan and tilt, rad, zoom, and stage (3,), m; missing keys have their initial "
      "values.\n"
      "None is the initial stance.")
      .def(py::init([](const py::kwargs& table) {
             return std::make_shared<Camera>(read_table<CameraConfig>(table));
           }),
           "Makes a camera from the keys of a table [[camera]]. Raises InputError for wrong keys or values.")
      .def_property_readonly(
          "name", [](const Camera& camera) { return camera.config().name; }, "Name of the camera.")
      .def_property_readonly(
          "width", [](const Camera& camera) { return camera.config().sensor.width; }, "Width, px.")
      .def_property_readonly(
          "height", [](const Camera& camera) { return camera.config().sensor.height; }, "Height, px.")
      .def_property_readonly(
          "table",
          [](const Camera& camera) { return python_value(Codec<CameraConfig>::write(camera.config())); },
          "The description as a dict with all keys of the table [[camera]], in base units.")
      .def_property_readonly(
          "initial", [](const Camera& camera) { return stance_dict(camera.initial_stance()); },
          "The initial stance, a dict.")
      .def(
          "pose",
          [](const Camera& camera, const py::object& stance) {
            return pose_array(camera.pose(stance_of(camera, stance)));
          },
          arg("stance") = none,
          "Returns the pose X_WC of the optical frame (x right, y down, z forward), shape (4, 4).")
      .def("intrinsics", &intrinsics, arg("stance") = none,
           "Returns fx, fy, cx, cy, px, the lens's model and its distortion coefficients as a dict.")
      .def("project", &project, arg("points"), arg("stance") = none, arg("out") = none,
           "Returns the pixels (u, v) of points in the world (..., 3), m, shape (..., 2), px; NaN for points "
           "that the\n"
           "lens cannot image. (0, 0) is the middle of the top-left pixel.")
      .def("projection", &projection, arg("point"), arg("stance") = none,
           "Returns the pixel of a point (3,) with its derivatives as a dict: pixel (2,), by_point (2, 3), "
           "px/m,\n"
           "by_mount (2, 6), by_stage (2, 3), by_pan, by_tilt, by_zoom (2,), by_intrinsics (2, 12). None for "
           "a point\n"
           "that the lens cannot image.")
      .def("looking_at", &looking_at, arg("point"), arg("stance") = none,
           "Returns the stance in which the optical axis passes through a point (3,), m, a dict. Ignores the "
           "limits of\n"
           "the head.")
      .def("__repr__", [](const Camera& camera) {
        return fmt::format("<flexura.Camera: {}, {} x {} px>", camera.config().name,
                           camera.config().sensor.width, camera.config().sensor.height);
      });
}

}  // namespace flexura::python

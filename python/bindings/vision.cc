#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "flexura/estimate/picture_observation.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/vision/arm_finder.h"
#include "flexura/vision/backbone_image.h"
#include "flexura/vision/picture_file.h"
#include "python/bindings/arm.h"
#include "python/bindings/camera.h"
#include "python/bindings/module.h"
#include "python/bindings/picture.h"

namespace flexura::python {

Picture picture_from(const py::array& array) {
  if (py::isinstance<py::array_t<std::uint8_t>>(array))
    return picture_of(py::array_t<std::uint8_t, py::array::c_style>::ensure(array));
  if (py::isinstance<py::array_t<std::uint16_t>>(array))
    return picture_of(py::array_t<std::uint16_t, py::array::c_style>::ensure(array));
  throw py::type_error("picture: expected an array of uint8 or uint16");
}

namespace {

template <class Enum>
Enum named(const std::string& name, const char* what) {
  const auto& names = names_of(static_cast<const Enum*>(nullptr));
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<Enum>(i);
  throw py::value_error(
      fmt::format("{}: \"{}\": expected one of \"{}\"", what, name, fmt::join(names, "\", \"")));
}

ArmFinderConfig finder_config(const std::string& threshold, double level,
                              const std::optional<std::string>& figure,
                              const std::optional<std::array<double, 2>>& base) {
  ArmFinderConfig config;
  config.threshold.method = named<ThresholdMethod>(threshold, "threshold");
  if (!std::isfinite(level)) throw py::value_error("level: expected a finite number");
  config.threshold.level = level;
  if (figure) config.threshold.figure = named<Figure>(*figure, "figure");
  if (base) config.base = Eigen::Vector2d((*base)[0], (*base)[1]);
  return config;
}

// The result of `measure`, with the picture's size.
struct Measurement {
  ArmObservation arm;
  Image<std::uint8_t> color;  // Empty for a gray picture.
};

int white_of(const Picture& picture, std::optional<int> white) {
  return white.value_or(std::holds_alternative<Image<std::uint8_t>>(picture) ? 255 : 65535);
}

Measurement find(const Picture& picture, int white, const ArmFinderConfig& config) {
  ArmFinder finder(config);
  Measurement found{finder.find(picture, white), {}};
  const auto* bytes = std::get_if<Image<std::uint8_t>>(&picture);
  if (bytes != nullptr && bytes->channels() == 3) found.color = *bytes;
  return found;
}

Measurement measure(const py::array& array, const std::string& threshold, double level,
                    const std::optional<std::string>& figure,
                    const std::optional<std::array<double, 2>>& base, std::optional<int> white) {
  const Picture picture = picture_from(array);
  const ArmFinderConfig config = finder_config(threshold, level, figure, base);
  const py::gil_scoped_release released;
  return find(picture, white_of(picture, white), config);
}

// One number, or a row of numbers, for each sample of the axis.
template <class Value>
py::array_t<double> of_axis(const std::vector<AxisSample>& axis, py::ssize_t columns, const Value& value) {
  Sizes sizes{static_cast<py::ssize_t>(axis.size())};
  if (columns > 1) sizes.push_back(columns);
  py::array_t<double> array(sizes);
  double* to = array.mutable_data();
  for (const AxisSample& sample : axis) {
    Eigen::Map<Eigen::VectorXd>(to, columns) = value(sample);
    to += columns;
  }
  return array;
}

Eigen::VectorXd one(double value) { return Eigen::VectorXd::Constant(1, value); }

py::array_t<bool> seen(const Measurement& of) {
  py::array_t<bool> array(static_cast<py::ssize_t>(of.arm.axis.size()));
  bool* to = array.mutable_data();
  for (const AxisSample& sample : of.arm.axis) *to++ = sample.is_seen;
  return array;
}

py::dict end_dict(const AxisEnd& end) {
  py::dict dict;
  dict["kind"] = names_of(static_cast<const AxisEndKind*>(nullptr))[static_cast<std::size_t>(end.kind)];
  dict["pixel"] = vector_array(end.pixel);
  dict["sigma"] = end.sigma;
  return dict;
}

py::array_t<double> backbone_image(const Measurement& of, const Camera& camera, const py::object& stance) {
  std::vector<AxisSample> axis = of.arm.axis;
  to_backbone_image(camera.view(stance_of(camera, stance)).lens, axis);
  return of_axis(axis, 2, [](const AxisSample& sample) { return sample.pixel; });
}

ShapeEstimate estimate(const DescribedArm& arm, const py::sequence& pictures,
                       const std::vector<std::shared_ptr<Camera>>& cameras, const py::object& stances,
                       const std::optional<Reals>& near, const std::string& threshold) {
  const std::size_t count = cameras.size();
  if (py::len(pictures) != count) throw py::value_error("expected one camera per picture");
  for (const auto& camera : cameras)
    if (!camera) throw py::value_error("cameras: expected a Camera for each picture, not None");
  if (!stances.is_none() && py::len(stances) != count)
    throw py::value_error("expected one stance per picture");
  std::vector<std::variant<Picture, Measurement>> given;
  std::vector<View> views;
  for (std::size_t i = 0; i < count; ++i) {
    const py::object picture = pictures[i];
    if (py::isinstance<Measurement>(picture)) {
      given.emplace_back(py::cast<Measurement>(picture));
    } else {
      given.emplace_back(picture_from(py::cast<py::array>(picture)));
    }
    const py::object stance = stances.is_none() ? py::object(py::none()) : py::object(stances[py::int_(i)]);
    views.push_back(cameras[i]->view(stance_of(*cameras[i], stance)));
  }
  std::optional<ArmState> start;
  if (near) {
    const StateArray state(*near, arm.sections());
    if (!state.is_single()) throw py::value_error("near: expected one state");
    state.read(0, start.emplace());
    const auto is_finite = [](const Eigen::Vector2d& bend) { return bend.allFinite(); };
    if (!std::ranges::all_of(start->bends, is_finite)) throw py::value_error("near: expected finite bends");
  }
  const ArmFinderConfig config = finder_config(threshold, 127.5, std::nullopt, std::nullopt);
  const py::gil_scoped_release released;
  std::vector<Observation> observations;
  for (std::size_t i = 0; i < count; ++i) {
    if (const auto* picture = std::get_if<Picture>(&given[i]))
      given[i] = find(*picture, white_of(*picture, {}), config);
    const auto& found = std::get<Measurement>(given[i]);
    observations.push_back(found.color.width() > 0 ? observation_of(found.arm, views[i], found.color)
                                                   : observation_of(found.arm, views[i]));
  }
  if (!are_enough(observations)) {
    ShapeEstimate missing;
    missing.reason = "no picture shows the arm's axis";
    return missing;
  }
  ShapeEstimator estimator(described_arm(arm.model.shaped()));
  return start ? estimator.follow(observations, {arm.model.shaped(), arm.model.actuation().shape(*start), {}})
               : estimator.estimate(observations);
}

void bind_measurement(py::module_& module) {
  using py::arg;
  py::class_<Measurement>(module, "Measurement", "An arm found in a picture.")
      .def_property_readonly(
          "found", [](const Measurement& of) { return of.arm.is_found(); }, "Whether an arm was found.")
      .def_property_readonly(
          "reason", [](const Measurement& of) { return of.arm.reason; }, "Why no arm was found, or \"\".")
      .def_property_readonly(
          "notes", [](const Measurement& of) { return of.arm.notes; }, "Remarks, a list of str.")
      .def_property_readonly(
          "axis",
          [](const Measurement& of) {
            return of_axis(of.arm.axis, 2, [](const AxisSample& sample) { return sample.pixel; });
          },
          "Centerline from base to tip, shape (m, 2), px.")
      .def_property_readonly(
          "normals",
          [](const Measurement& of) {
            return of_axis(of.arm.axis, 2, [](const AxisSample& sample) { return sample.normal; });
          },
          "Unit normals of the centerline, shape (m, 2).")
      .def_property_readonly(
          "widths",
          [](const Measurement& of) {
            return of_axis(of.arm.axis, 1, [](const AxisSample& sample) { return one(sample.width); });
          },
          "Widths of the arm, shape (m,), px.")
      .def_property_readonly(
          "sigmas",
          [](const Measurement& of) {
            return of_axis(of.arm.axis, 1, [](const AxisSample& sample) { return one(sample.sigma); });
          },
          "Standard deviations of the centerline along its normals, shape (m,), px.")
      .def_property_readonly("seen", &seen, "Whether both borders are visible, shape (m,), bool.")
      .def_property_readonly(
          "base", [](const Measurement& of) { return end_dict(of.arm.ends[0]); },
          "End at the base: a dict with kind (\"free\", \"border\" or \"lost\"), pixel (2,), sigma.")
      .def_property_readonly(
          "tip", [](const Measurement& of) { return end_dict(of.arm.ends[1]); }, "End at the tip, as `base`.")
      .def_property_readonly(
          "blur", [](const Measurement& of) { return of.arm.blur; }, "Blur of the borders, px.")
      .def_property_readonly(
          "noise", [](const Measurement& of) { return of.arm.noise; }, "Noise, on a scale from 0 to 255.")
      .def_property_readonly(
          "contrast", [](const Measurement& of) { return of.arm.contrast; },
          "Contrast across the borders, on a scale from 0 to 255.")
      .def_property_readonly(
          "threshold", [](const Measurement& of) { return of.arm.threshold.level; },
          "Threshold between arm and background, on a scale from 0 to 255.")
      .def("backbone_image", &backbone_image, arg("camera"), arg("stance") = py::none(),
           "Returns the centerline moved to the image of the backbone, shape (m, 2), px.");
  module.def("measure", &measure, arg("picture"), py::kw_only(), arg("threshold") = "otsu",
             arg("level") = 127.5, arg("figure") = py::none(), arg("base") = py::none(),
             arg("white") = py::none(),
             "Finds the arm in a picture, an array of uint8 or uint16 of shape (height, width) or (height, "
             "width, 3).\n"
             "threshold: \"otsu\", \"two_mode\", \"fixed\" (with `level`, 0 to 255) or \"by_block\". figure: "
             "\"dark\" or\n"
             "\"bright\"; default: the one that is not at the border. base: a pixel (u, v) near the arm's "
             "base. white:\n"
             "largest value. Returns a Measurement.");
}

}  // namespace

void bind_vision(py::module_& module) {
  using py::arg;
  bind_measurement(module);
  py::class_<ShapeEstimate>(module, "ShapeEstimate", "An arm's shape, estimated from pictures.")
      .def_readonly("found", &ShapeEstimate::is_found, "Whether a shape was found.")
      .def_readonly("reason", &ShapeEstimate::reason, "Why no shape was found, or \"\".")
      .def_readonly("notes", &ShapeEstimate::notes, "Reasons to distrust the estimate, a list of str.")
      .def_property_readonly("trusted", &ShapeEstimate::is_trusted,
                             "Whether the shape was found without notes.")
      .def_property_readonly(
          "shape", [](const ShapeEstimate& of) { return state_array(of.shape.state); },
          "Bend and stretch of each arc, shape (arcs, 3). If each section is one arc, the state.")
      .def_readonly("rms", &ShapeEstimate::rms,
                    "Root mean square distance of the points from the shape's images, px.")
      .def_readonly("iterations", &ShapeEstimate::iterations, "Number of iterations.")
      .def_property_readonly(
          "s", [](const ShapeEstimate& of) { return of.s; }, "Arc lengths of the knots, m.")
      .def_property_readonly(
          "sigma", [](const ShapeEstimate& of) { return of.sigma; },
          "Standard deviations of the positions at the knots, m.")
      .def_property_readonly(
          "covariance", [](const ShapeEstimate& of) { return matrix_array(of.covariance); },
          "Covariance of the unknowns: the bends, and one common stretch if sections can stretch.");
  const py::object arm_class = module.attr("Arm");
  arm_class.attr("estimate") = py::cpp_function(
      &estimate, py::name("estimate"), py::is_method(arm_class), arg("pictures"), arg("cameras"),
      arg("stances") = py::none(), arg("near") = py::none(), py::kw_only(), arg("threshold") = "otsu",
      "Estimates the arm's shape from pictures (arrays, or results of measure) by `cameras`, a list of "
      "Camera, in\n"
      "`stances`. near: a state (sections, 3) near the shape, from which the search starts. Returns a "
      "ShapeEstimate.");
}

}  // namespace flexura::python

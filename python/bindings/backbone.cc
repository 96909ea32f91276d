#include "flexura/model/backbone.h"

#include <fmt/format.h>

#include "python/bindings/arm.h"
#include "python/bindings/convert.h"
#include "python/bindings/module.h"

namespace flexura::python {
namespace {

// Positions or poses at fractions of the length, from 0 at the base to 1 at the tip.
std::vector<double> lengths_at(const Backbone& backbone, const Reals& fractions) {
  if (fractions.ndim() != 1) throw py::value_error("fractions: expected an array of shape (m,)");
  std::vector<double> lengths;
  for (py::ssize_t i = 0; i < fractions.size(); ++i) {
    const double fraction = *fractions.data(i);
    if (!(fraction >= 0 && fraction <= 1))
      throw py::value_error(fmt::format("fractions: {}: expected a number from 0 to 1", fraction));
    lengths.push_back(fraction * backbone.length());
  }
  return lengths;
}

py::array_t<double> backbone_points(const Backbone& backbone, const Reals& fractions, const py::object& out) {
  const std::vector<double> lengths = lengths_at(backbone, fractions);
  py::array_t<double> array = result_array(out, {fractions.size(), 3});
  double* to = array.mutable_data();
  for (const double s : lengths) {
    Eigen::Map<Eigen::Vector3d>{to} = backbone.pose(s).position;
    to += 3;
  }
  return array;
}

py::array_t<double> backbone_poses(const Backbone& backbone, const Reals& fractions, const py::object& out) {
  const std::vector<double> lengths = lengths_at(backbone, fractions);
  py::array_t<double> array = result_array(out, {fractions.size(), 4, 4});
  double* to = array.mutable_data();
  for (const double s : lengths) {
    write_pose(backbone.pose(s), to);
    to += 16;
  }
  return array;
}

}  // namespace

void bind_backbone(py::module_& module) {
  using py::arg;
  py::class_<Backbone>(module, "Backbone", "The arm's centerline in the world: a chain of circular arcs.")
      .def_property_readonly("length", &Backbone::length, "Length, with stretch, m.")
      .def_property_readonly(
          "tip", [](const Backbone& backbone) { return pose_array(backbone.tip()); },
          "Pose X_WT of the tip, shape (4, 4).")
      .def("points", &backbone_points, arg("fractions"), arg("out") = py::none(),
           "Returns positions at fractions (m,) of the length, from 0 at the base to 1 at the tip, m, shape "
           "(m, 3).")
      .def("poses", &backbone_poses, arg("fractions"), arg("out") = py::none(),
           "Returns frames at fractions (m,) of the length, shape (m, 4, 4). z is the tangent.");
  const py::object arm_class = module.attr("Arm");
  arm_class.attr("backbone") = py::cpp_function(
      [](const DescribedArm& arm, const Reals& given) {
        const StateArray states(given, arm.sections());
        if (!states.is_single()) throw py::value_error("state: expected one state");
        ArmState state;
        states.read(0, state);
        return arm.model.backbone(state);
      },
      py::name("backbone"), py::is_method(arm_class), arg("state"),
      "Returns the backbone of one state (sections, 3).");
}

}  // namespace flexura::python

#include "python/bindings/arm.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/shape.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/mechanics/arm_rod.h"
#include "python/bindings/convert.h"
#include "python/bindings/module.h"
#include "python/bindings/threads.h"

namespace flexura::python {

DescribedArm::DescribedArm(ArmConfig arm, std::optional<DriveConfig> with_drive)
    : config(std::move(arm)), drive(std::move(with_drive)), model(arm_model_of(config, drive)) {}

namespace {

using Holder = std::shared_ptr<DescribedArm>;

// Calls body(command, shape, index) for each state, on `threads` threads. The states passed are reused.
template <class Body>
void for_states(const DescribedArm& arm, const StateArray& states, std::size_t threads, const Body& body) {
  const bool is_identity = arm.model.actuation().is_identity();
  const auto work = [&](std::size_t begin, std::size_t end) {
    ArmState command, shape;
    auto local = body();
    for (std::size_t i = begin; i < end; ++i) {
      states.read(i, command);
      if (!is_identity) shape = arm.model.actuation().shape(command);
      local(command, is_identity ? command : shape, i);
    }
  };
  if (states.is_single()) return work(0, 1);
  const py::gil_scoped_release released;
  share_out(states.count(), arm.is_shareable() ? threads : 1, work);
}

py::array_t<double> tip(const DescribedArm& arm, const Reals& given, const py::object& out,
                        std::size_t threads) {
  const StateArray states(given, arm.sections());
  py::array_t<double> poses = result_array(out, states.with({4, 4}));
  states.require_apart(poses);
  double* to = poses.mutable_data();
  for_states(arm, states, threads, [&] {
    return [&arm, to](const ArmState&, const ArmState& shape, std::size_t i) {
      write_pose(tip_pose(arm.model.shaped(), shape), to + 16 * i);
    };
  });
  return poses;
}

py::array_t<double> frames(const DescribedArm& arm, const Reals& given, const py::object& out,
                           std::size_t threads) {
  const StateArray states(given, arm.sections());
  const std::size_t count = arm.sections() + 1;
  py::array_t<double> poses = result_array(out, states.with({static_cast<py::ssize_t>(count), 4, 4}));
  states.require_apart(poses);
  double* to = poses.mutable_data();
  const std::size_t arcs = arm.model.shaped().sections.size();
  // First arc of each section, and the tip.
  std::vector<std::size_t> first;
  for (std::size_t arc = 0; arc < arcs; ++arc)
    if (arm.model.actuation().section_of()[arc] == first.size()) first.push_back(arc);
  first.push_back(arcs);
  for_states(arm, states, threads, [&] {
    return [&, found = std::vector<Pose>(arcs + 1)](const ArmState&, const ArmState& shape,
                                                    std::size_t i) mutable {
      section_frames(arm.model.shaped(), shape, found);
      for (std::size_t section = 0; section < count; ++section)
        write_pose(found[first[section]], to + 16 * (count * i + section));
    };
  });
  return poses;
}

py::array_t<double> points(const DescribedArm& arm, const Reals& given, const Reals& fractions,
                           const py::object& out, std::size_t threads) {
  const StateArray states(given, arm.sections());
  if (fractions.ndim() != 1) throw py::value_error("fractions: expected an array of shape (m,)");
  const std::vector<double> at(fractions.data(), fractions.data() + fractions.size());
  for (const double fraction : at)
    if (!(fraction >= 0 && fraction <= 1))
      throw py::value_error(fmt::format("fractions: {}: expected a number from 0 to 1", fraction));
  py::array_t<double> array = result_array(out, states.with({fractions.size(), 3}));
  states.require_apart(array);
  double* to = array.mutable_data();
  for_states(arm, states, threads, [&] {
    return [&](const ArmState&, const ArmState& shape, std::size_t i) {
      const Backbone backbone = arm.model.backbone_of_shape(shape);
      double* point = to + 3 * at.size() * i;
      for (const double fraction : at) {
        Eigen::Map<Eigen::Vector3d>{point} = backbone.pose(fraction * backbone.length()).position;
        point += 3;
      }
    };
  });
  return array;
}

py::array_t<double> jacobian(const DescribedArm& arm, const Reals& given, const py::object& out,
                             std::size_t threads) {
  const StateArray states(given, arm.sections());
  const auto columns = static_cast<Eigen::Index>(3 * arm.sections());
  py::array_t<double> array = result_array(out, states.with({6, columns}));
  states.require_apart(array);
  double* to = array.mutable_data();
  const Arm& shaped = arm.model.shaped();
  for_states(arm, states, threads, [&] {
    return [&, columns, found = BackboneJacobian(), by_command = Eigen::MatrixXd(),
            J = Jacobian(6, static_cast<Eigen::Index>(3 * shaped.sections.size()))](
               const ArmState& command, const ArmState& shape, std::size_t i) mutable {
      found.set(shaped, shape);
      found.tip(J);
      Eigen::Map<RowMajor<6, Eigen::Dynamic>> result(to + 6 * static_cast<std::size_t>(columns) * i, 6,
                                                     columns);
      if (arm.model.actuation().is_identity()) {
        // Of fixed size, which is faster than a copy of the whole.
        for (Eigen::Index section = 0; section < columns; section += 3)
          result.template middleCols<3>(section) = J.middleCols<3>(section);
      } else {
        arm.model.actuation().by_command(J, command, by_command);
        result = by_command;
      }
    };
  });
  return array;
}

py::array_t<double> state(const DescribedArm& arm, const py::kwargs& table) {
  const Node document = node_of(table);
  Reader reader;
  ShapeConfig shape;
  if (fields_of(&shape).read(document, reader, shape))
    check_shape(shape, arm.config.kind, arm.sections(), "", reader);
  if (reader.problems().empty()) check_bends(arm.model.driven(), shape, "", reader);
  reader.throw_if_any();
  return state_array(arm_state(arm.model.driven(), shape));
}

// For each section, a number or a pair.
template <class Value>
py::array_t<double> per_section(const DescribedArm& arm, Sizes sizes, const Value& value) {
  sizes.insert(sizes.begin(), static_cast<py::ssize_t>(arm.sections()));
  py::array_t<double> array(sizes);
  double* to = array.mutable_data();
  for (const Section& section : arm.config.section) to = value(section, to);
  return array;
}

}  // namespace

void bind_arm(py::module_& module) {
  using py::arg;
  py::class_<DescribedArm, Holder>(
      module, "Arm",
      "An arm, described by the keys of the table [arm] of an experiment file.\n\n"
      "A state has a bend vector, rad, and a stretch for each section. An array of states "
      "has the shape\n(..., sections, 3) with (bend_x, bend_y, stretch), or (..., "
      "sections, 2) with the bends only. Functions on\nstates take any leading "
      "dimensions, write into `out` if given, and share the states among `threads`\n"
      "threads. Results do not depend on the number of threads.")
      .def(py::init([](const py::kwargs& table) {
             return std::make_shared<DescribedArm>(read_table<ArmConfig>(table), std::nullopt);
           }),
           "Makes an arm from the keys of the table [arm], such as Arm(kind=\"spatial\", "
           "section=[{\"length\": 0.3}]).\n"
           "Raises InputError for wrong keys or values.")
      .def_property_readonly(
          "kind",
          [](const DescribedArm& arm) { return arm.config.kind == ArmKind::planar ? "planar" : "spatial"; },
          "\"planar\" or \"spatial\".")
      .def_property_readonly("sections", &DescribedArm::sections, "Number of sections.")
      .def_property_readonly(
          "tendons",
          [](const DescribedArm& arm) {
            const auto has_material = [](const Section& section) { return section.material.has_value(); };
            if (!std::ranges::all_of(arm.config.section, has_material)) return std::size_t{0};
            return rod_of(arm.config, arm.drive).tendons.size();
          },
          "Number of tendons of an elastic arm, of the arm or of its drive; 0 without materials.")
      .def_property_readonly(
          "length", [](const DescribedArm& arm) { return arm.model.driven().length(); },
          "Length without stretch, m.")
      .def_property_readonly(
          "lengths",
          [](const DescribedArm& arm) {
            return per_section(arm, {}, [](const Section& section, double* to) {
              *to = section.length;
              return to + 1;
            });
          },
          "Lengths of the sections without stretch, m, shape (sections,).")
      .def_property_readonly(
          "max_bends",
          [](const DescribedArm& arm) {
            return per_section(arm, {}, [](const Section& section, double* to) {
              *to = section.max_bend;
              return to + 1;
            });
          },
          "Largest |bend| of each section, rad, shape (sections,); inf without a limit.")
      .def_property_readonly(
          "stretch_limits",
          [](const DescribedArm& arm) {
            return per_section(arm, {2}, [](const Section& section, double* to) {
              to[0] = section.stretch_limits[0];
              to[1] = section.stretch_limits[1];
              return to + 2;
            });
          },
          "Smallest and largest stretch of each section, shape (sections, 2).")
      .def_property_readonly(
          "base", [](const DescribedArm& arm) { return pose_array(arm.model.driven().X_WB); },
          "Pose X_WB of the base in the world, shape (4, 4), position in m.")
      .def_property_readonly(
          "table", [](const DescribedArm& arm) { return python_value(Codec<ArmConfig>::write(arm.config)); },
          "The description as a dict with all keys of the table [arm], in base units.")
      .def("state", &state,
           "Returns a state, shape (sections, 3), from bends, archings or cord_angles, and stretches, with "
           "the units of\n"
           "experiment files: state(bends_deg=[[60, 0], [0, 90]]). Without arguments: the straight arm.")
      .def_property_readonly(
          "initial",
          [](const DescribedArm& arm) {
            return state_array(arm_state(arm.model.driven(), arm.config.initial));
          },
          "State at the start of an experiment, shape (sections, 3).")
      .def("tip", &tip, arg("states"), arg("out") = py::none(), arg("threads") = 1,
           "Returns the tip's pose X_WT as a 4 x 4 matrix for each state, shape (..., 4, 4), position in m.")
      .def("frames", &frames, arg("states"), arg("out") = py::none(), arg("threads") = 1,
           "Returns the base frame X_WS of each section and, last, the tip's pose, shape (..., sections + 1, "
           "4, 4).")
      .def("points", &points, arg("states"), arg("fractions"), arg("out") = py::none(), arg("threads") = 1,
           "Returns points of the backbone at fractions (m,) of its length, from 0 at the base to 1 at the "
           "tip, as\n"
           "positions in the world, m, shape (..., m, 3).")
      .def("jacobian", &jacobian, arg("states"), arg("out") = py::none(), arg("threads") = 1,
           "Returns the tip's Jacobian for each state, shape (..., 6, 3 sections). Columns 3i, 3i + 1 and 3i "
           "+ 2 are\n"
           "twists [v; w] of the tip in the world, m/s and rad/s, per unit rate of bend_x, bend_y and "
           "stretch of\n"
           "section i.")
      .def("__repr__", [](const DescribedArm& arm) {
        return fmt::format("<flexura.Arm: {} {}, {:g} m>", arm.sections(),
                           arm.sections() == 1 ? "section" : "sections", arm.model.driven().length());
      });
}

}  // namespace flexura::python

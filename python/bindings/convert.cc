#include "python/bindings/convert.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace flexura::python {
namespace {

// Deeper values would exhaust the stack.
constexpr int max_depth = 64;

py::object list_value(const Node::Array& entries) {
  py::list list;
  for (const Node& entry : entries) list.append(python_value(entry));
  return list;
}

py::object dict_value(const Node::Table& members) {
  py::dict dict;
  for (const Node::Member& member : members) dict[py::str(member.key)] = python_value(member.node);
  return dict;
}

Node node_at(py::handle value, int depth);

Node dict_node(const py::dict& dict, int depth) {
  Node::Table members;
  for (const auto& [key, entry] : dict) {
    // A key without a value means that the field is omitted.
    if (!entry.is_none()) members.push_back({py::cast<std::string>(key), {}, node_at(entry, depth)});
  }
  return {std::move(members), {}};
}

Node list_node(const py::sequence& list, int depth) {
  Node::Array entries;
  for (const py::handle entry : list) entries.push_back(node_at(entry, depth));
  return {std::move(entries), {}};
}

Node node_at(py::handle value, int depth) {
  if (depth > max_depth) throw py::value_error("the value is nested too deeply");
  if (value.is_none()) return {};
  if (py::isinstance<py::bool_>(value)) return {py::cast<bool>(value), {}};
  if (py::isinstance<py::int_>(value)) return {py::cast<std::int64_t>(value), {}};
  if (py::isinstance<py::float_>(value)) return {py::cast<double>(value), {}};
  if (py::isinstance<py::str>(value)) return {py::cast<std::string>(value), {}};
  if (py::isinstance<py::dict>(value)) return dict_node(py::reinterpret_borrow<py::dict>(value), depth + 1);
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value))
    return list_node(py::reinterpret_borrow<py::sequence>(value), depth + 1);
  // NumPy's arrays and numbers.
  if (py::hasattr(value, "tolist")) return node_at(value.attr("tolist")(), depth + 1);
  throw py::type_error(
      fmt::format("{}: expected a number, str, list or dict", py::cast<std::string>(py::repr(value))));
}

}  // namespace

py::object python_value(const Node& node) {
  if (const auto* flag = node.as<bool>()) return py::bool_(*flag);
  if (const auto* integer = node.as<std::int64_t>()) return py::int_(*integer);
  if (const auto* number = node.as<double>()) return py::float_(*number);
  if (const auto* text = node.as<std::string>()) return py::str(*text);
  if (const auto* entries = node.as<Node::Array>()) return list_value(*entries);
  if (const auto* members = node.as<Node::Table>()) return dict_value(*members);
  return py::none();
}

Node node_of(py::handle value) { return node_at(value, 0); }

void refuse_result_array(const char* type, const Sizes& sizes) {
  throw py::value_error(fmt::format("out: expected a writable C-contiguous array of {} with shape ({}{})",
                                    type, fmt::join(sizes, ", "), sizes.size() == 1 ? "," : ""));
}

StateArray::StateArray(Reals states, std::size_t sections)
    : states_(std::move(states)), data_(states_.data()), sections_(sections) {
  const auto dimensions = states_.ndim();
  const bool fits = dimensions >= 2 && states_.shape(dimensions - 2) == static_cast<py::ssize_t>(sections) &&
                    (states_.shape(dimensions - 1) == 2 || states_.shape(dimensions - 1) == 3);
  if (!fits) {
    throw py::value_error(
        fmt::format("states: shape ({}): expected (..., {}, 2), the bends of each section, or "
                    "(..., {}, 3), its bends and stretch",
                    fmt::join(states_.shape(), states_.shape() + dimensions, ", "), sections, sections));
  }
  width_ = static_cast<std::size_t>(states_.shape(dimensions - 1));
  lead_.assign(states_.shape(), states_.shape() + dimensions - 2);
  for (const auto size : lead_) count_ *= static_cast<std::size_t>(size);
}

void StateArray::require_apart(const py::array& out) const {
  const auto range = [](const py::array& array) {
    const auto* const first = static_cast<const char*>(array.data());
    return std::pair(first, first + array.nbytes());
  };
  const auto [from, to] = range(states_);
  const auto [out_from, out_to] = range(out);
  if (from < out_to && out_from < to) throw py::value_error("out: shares memory with the states");
}

Sizes StateArray::with(const Sizes& sizes) const {
  Sizes all = lead_;
  all.insert(all.end(), sizes.begin(), sizes.end());
  return all;
}

py::array_t<double> state_array(const ArmState& state) {
  py::array_t<double> array(Sizes{static_cast<py::ssize_t>(state.bends.size()), 3});
  double* to = array.mutable_data();
  for (std::size_t i = 0; i < state.bends.size(); ++i) {
    *to++ = state.bends[i].x();
    *to++ = state.bends[i].y();
    *to++ = state.stretches[i];
  }
  return array;
}

py::array_t<double> pose_array(const Pose& pose) {
  py::array_t<double> array(Sizes{4, 4});
  write_pose(pose, array.mutable_data());
  return array;
}

Pose pose_of(const Reals& pose) {
  if (pose.ndim() != 2 || pose.shape(0) != 4 || pose.shape(1) != 4)
    throw py::value_error("a pose: expected an array of shape (4, 4)");
  const Eigen::Map<const RowMajor<4, 4>> matrix(pose.data());
  return {matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
}

Eigen::VectorXd vector_of(const Reals& values, py::ssize_t size, const char* name) {
  if (values.ndim() != 1 || values.shape(0) != size)
    throw py::value_error(fmt::format("{}: expected an array of shape ({},)", name, size));
  return Eigen::Map<const Eigen::VectorXd>(values.data(), size);
}

std::vector<double> list_of(const py::object& values) {
  if (values.is_none()) return {};
  const auto array = py::cast<Reals>(values);
  if (array.ndim() != 1) throw py::value_error("expected a list of numbers");
  return {array.data(), array.data() + array.size()};
}

py::array_t<double> matrix_array(const Eigen::MatrixXd& matrix) {
  py::array_t<double> array(Sizes{matrix.rows(), matrix.cols()});
  Eigen::Map<RowMajor<Eigen::Dynamic, Eigen::Dynamic>>(array.mutable_data(), matrix.rows(), matrix.cols()) =
      matrix;
  return array;
}

py::array_t<double> vector_array(const Eigen::VectorXd& vector) {
  return py::array_t<double>(static_cast<py::ssize_t>(vector.size()), vector.data());
}

}  // namespace flexura::python

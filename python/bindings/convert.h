#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/base/table.h"
#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

// Conversions between Python's values and those of the library, shared by the bindings.
namespace flexura::python {

namespace py = pybind11;

/// An array that the bindings read. NumPy copies only arrays of other types or orders.
using Reals = py::array_t<double, py::array::c_style | py::array::forcecast>;
/// Sizes of the dimensions of an array.
using Sizes = std::vector<py::ssize_t>;
/// Matrices in the order of a C array.
template <int rows, int columns>
using RowMajor = Eigen::Matrix<double, rows, columns, Eigen::RowMajor>;

/// Returns a node as Python's None, bool, int, float, str, list and dict.
[[nodiscard]] py::object python_value(const Node& node);
/// Returns a Python value as a node without a position. NumPy's numbers and arrays count as numbers and
/// lists. Throws py::type_error for other types, such as a set.
[[nodiscard]] Node node_of(py::handle value);

/// Reads a struct with a table of fields from keyword arguments or a dict. Throws InputError.
template <HasFields S>
[[nodiscard]] S read_table(py::handle table) {
  return read_as<S>(node_of(table));
}

/// Throws py::value_error: `out` is not an array for these results. `type`: the name of the array's type.
[[noreturn]] void refuse_result_array(const char* type, const Sizes& sizes);

/// Returns an array for results: `out`, or a new array if `out` is None. Throws py::value_error unless `out`
/// is a writable C-contiguous array of type T with these sizes. `type`: NumPy's name of T.
template <class T = double>
[[nodiscard]] py::array_t<T> result_array(const py::object& out, const Sizes& sizes,
                                          const char* type = "float64") {
  if (out.is_none()) return py::array_t<T>(sizes);
  if (py::isinstance<py::array_t<T, py::array::c_style>>(out)) {
    auto array = py::reinterpret_borrow<py::array_t<T>>(out);
    if (array.writeable() && Sizes(array.shape(), array.shape() + array.ndim()) == sizes) return array;
  }
  refuse_result_array(type, sizes);
}

/// States of an arm: an array of shape (..., sections, 2 or 3).
class StateArray {
 public:
  /// Throws py::value_error for an array of another shape.
  StateArray(Reals states, std::size_t sections);

  /// Throws py::value_error if the array `out` shares memory with the states.
  void require_apart(const py::array& out) const;
  /// Returns the number of states.
  [[nodiscard]] std::size_t count() const { return count_; }
  /// Returns whether the array has one state, without leading dimensions.
  [[nodiscard]] bool is_single() const { return lead_.empty(); }
  /// Returns the leading dimensions, followed by `sizes`.
  [[nodiscard]] Sizes with(const Sizes& sizes) const;
  /// Writes state `index` to `state`. Needs no GIL.
  void read(std::size_t index, ArmState& state) const {
    state.bends.resize(sections_);
    state.stretches.resize(sections_);
    const double* from = data_ + index * sections_ * width_;
    for (std::size_t i = 0; i < sections_; ++i, from += width_) {
      state.bends[i] = {from[0], from[1]};
      state.stretches[i] = width_ == 3 ? from[2] : 1.0;
    }
  }

 private:
  Reals states_;
  const double* data_;
  Sizes lead_;
  std::size_t count_ = 1, sections_, width_;
};

/// Returns a state as an array of shape (sections, 3).
[[nodiscard]] py::array_t<double> state_array(const ArmState& state);
/// Writes a pose as a 4 x 4 matrix in rows.
inline void write_pose(const Pose& pose, double* to) {
  for (Eigen::Index row = 0; row < 3; ++row, to += 4) {
    to[0] = pose.rotation(row, 0);
    to[1] = pose.rotation(row, 1);
    to[2] = pose.rotation(row, 2);
    to[3] = pose.position[row];
  }
  to[0] = to[1] = to[2] = 0;
  to[3] = 1;
}
/// Returns a pose as an array of shape (4, 4).
[[nodiscard]] py::array_t<double> pose_array(const Pose& pose);
/// Reads a pose. Throws py::value_error unless `pose` has the shape (4, 4).
[[nodiscard]] Pose pose_of(const Reals& pose);
/// Reads a vector of `size` numbers. `name`: the argument's name in errors.
[[nodiscard]] Eigen::VectorXd vector_of(const Reals& values, py::ssize_t size, const char* name);
/// Reads a list of numbers; None is an empty list.
[[nodiscard]] std::vector<double> list_of(const py::object& values);
/// Returns a matrix, or a vector with one dimension, as an array.
[[nodiscard]] py::array_t<double> matrix_array(const Eigen::MatrixXd& matrix);
[[nodiscard]] py::array_t<double> vector_array(const Eigen::VectorXd& vector);

}  // namespace flexura::python

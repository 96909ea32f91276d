#include <pybind11/pybind11.h>

#include <system_error>

#include "flexura/base/source.h"
#include "python/bindings/module.h"

namespace flexura::python {
namespace {

namespace py = pybind11;

py::object place_file(const SourcePosition& where) {
  if (where.source) return py::str(*where.source);
  return py::none();
}

py::object place_number(int number) {
  if (number > 0) return py::int_(number);
  return py::none();
}

// Lives as long as the interpreter, which may end before static objects do.
PyObject* input_error_class = nullptr;

// Raises InputError with the position of its first problem, and all problems as (file, line, column, what).
void raise(const InputError& error) {
  py::object raised = py::reinterpret_borrow<py::object>(input_error_class)(error.what());
  py::list problems;
  for (const Problem& problem : error.problems())
    problems.append(py::make_tuple(place_file(problem.where), place_number(problem.where.line),
                                   place_number(problem.where.column), problem.what));
  const SourcePosition where = error.problems().empty() ? SourcePosition{} : error.problems().front().where;
  raised.attr("file") = place_file(where);
  raised.attr("line") = place_number(where.line);
  raised.attr("column") = place_number(where.column);
  raised.attr("problems") = problems;
  PyErr_SetObject(input_error_class, raised.ptr());
}

void raise(const std::system_error& error) {
  const py::object raised =
      py::reinterpret_borrow<py::object>(PyExc_OSError)(error.code().value(), error.what());
  PyErr_SetObject(PyExc_OSError, raised.ptr());
}

}  // namespace

void bind_errors(py::module_& module) {
  input_error_class = PyErr_NewExceptionWithDoc(
      "flexura.InputError",
      "Unusable input. The text has one line for each problem, \"file:line:column: what is wrong\".\n\n"
      "file, line and column: place of the first problem; None where the input has no such place.\n"
      "problems: all problems as tuples (file, line, column, what), in the order found.",
      PyExc_ValueError, nullptr);
  module.add_object("InputError", py::reinterpret_borrow<py::object>(input_error_class));
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      raise(error);
    } catch (const std::system_error& error) {
      raise(error);
    } catch (const py::cast_error& error) {
      PyErr_SetString(PyExc_TypeError, error.what());
    }
  });
}

}  // namespace flexura::python

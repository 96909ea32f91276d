#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "python/bindings/convert.h"

namespace flexura::python {

/// Checks the numbers of arms and of threads of a batch. Throws std::invalid_argument unless both are
/// positive.
inline void require_some(std::size_t count, std::size_t threads) {
  if (count == 0) throw std::invalid_argument("count: 0: expected at least 1");
  if (threads == 0) throw std::invalid_argument("threads: 0: expected at least 1");
}

/// Many arms in one object, with the lock that admits one Python thread at a time.
template <class Batch>
struct Locked {
  template <class... Arguments>
  explicit Locked(Arguments&&... arguments) : batch(std::forward<Arguments>(arguments)...) {}

  /// Calls function(batch) without the GIL.
  template <class Function>
  void with(Function&& function) {
    const py::gil_scoped_release released;
    const std::lock_guard lock(mutex);
    function(batch);
  }
  /// Returns the number of arms, as NumPy counts rows.
  [[nodiscard]] py::ssize_t rows() const { return static_cast<py::ssize_t>(batch.count()); }
  /// Throws py::index_error if there is no arm i.
  void require_arm(std::size_t i) const {
    if (i >= batch.count())
      throw py::index_error(fmt::format("arm {}: expected 0 to {}", i, batch.count() - 1));
  }
  /// Throws py::value_error unless an array has a row of `width` numbers for each arm. `name`: the argument's
  /// name in errors.
  void require_rows(const Reals& values, std::size_t width, const char* name) const {
    if (values.ndim() != 2 || values.shape(0) != rows() || values.shape(1) != static_cast<py::ssize_t>(width))
      throw py::value_error(fmt::format("{}: expected an array of shape ({}, {})", name, rows(), width));
  }

  Batch batch;
  std::mutex mutex;
};

}  // namespace flexura::python

#pragma once

#include <exception>
#include <string_view>

#include "flexura/base/progress.h"
#include "python/bindings/convert.h"

namespace flexura::python {

/// Runs Python code during a long call without the GIL, and keeps its first exception. After an exception,
/// the call is asked to end.
class Caller {
 public:
  [[nodiscard]] bool has_failed() const { return error_ != nullptr; }
  void end() { is_ended_ = true; }
  [[nodiscard]] bool is_ended() const { return is_ended_ || has_failed(); }

  template <class Call>
  void call(const Call& function) {
    if (has_failed()) return;
    const py::gil_scoped_acquire acquired;
    try {
      function();
    } catch (...) {
      error_ = std::current_exception();
    }
  }
  /// Throws the kept exception, if there is one. Needs the GIL.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::exception_ptr error_;
  bool is_ended_ = false;
};

/// Passes progress to on_progress(fraction, what), which may be None. If it returns False, or if the user
/// presses Ctrl-C, the job is cancelled.
class CallbackProgress : public Progress {
 public:
  /// Keeps references to both.
  CallbackProgress(Caller& caller, const py::object& on_progress)
      : caller_(caller), on_progress_(on_progress) {}

  void update(double fraction, std::string_view what) override {
    if (on_progress_.is_none()) return;
    caller_.call([&] {
      const py::object answer = on_progress_(fraction, py::str(what.data(), what.size()));
      // Also NumPy's False, but not None.
      if (!answer.is_none() && PyObject_IsTrue(answer.ptr()) == 0) caller_.end();
    });
  }
  [[nodiscard]] bool is_cancelled() const override {
    // Ctrl-C.
    caller_.call([] {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    });
    return caller_.is_ended();
  }

 private:
  Caller& caller_;
  const py::object& on_progress_;
};

/// Calls work(progress) without the GIL and returns its result. Throws the first exception of on_progress,
/// after the work's end.
template <class Work>
[[nodiscard]] auto with_progress(const py::object& on_progress, const Work& work) {
  Caller caller;
  auto result = [&] {
    const py::gil_scoped_release released;
    CallbackProgress progress(caller, on_progress);
    return work(progress);
  }();
  caller.rethrow();
  return result;
}

}  // namespace flexura::python

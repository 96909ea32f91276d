#pragma once

namespace flexura {

/// Where llvmpipe fills its pixels.
enum class LlvmpipeThreads {
  none,         ///< In the thread that calls: everything in one.
  as_it_comes,  ///< In as many more as it finds processors.
};

/// An OpenGL context of Mesa's llvmpipe without a window or a display, current while it lives; one at a time.
/// std::runtime_error: there is none, or another renderer answers.
class EglContext {
 public:
  explicit EglContext(LlvmpipeThreads threads);
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;
  ~EglContext();

 private:
  void make_current();
  void close();

  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace flexura

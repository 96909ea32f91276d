#pragma once

namespace flexura {

/// The threads in which llvmpipe rasterises.
enum class LlvmpipeThreads {
  none,         ///< Everything in the calling thread.
  as_it_comes,  ///< llvmpipe's default: one more thread per processor.
};

/// An OpenGL context of Mesa's llvmpipe without a window or a display, current during its lifetime; only one
/// at a time. Throws std::runtime_error if there is none, or if another renderer answers.
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

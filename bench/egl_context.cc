#include "bench/egl_context.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace flexura {

EglContext::EglContext(LlvmpipeThreads threads) {
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  // Each new llvmpipe reads the variable, and each display has its own llvmpipe.
  if (threads == LlvmpipeThreads::none)
    setenv("LP_NUM_THREADS", "0", 1);
  else
    unsetenv("LP_NUM_THREADS");
  display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (eglInitialize(display_, nullptr, nullptr) != EGL_TRUE) throw std::runtime_error("EGL: no display");
  try {
    make_current();
  } catch (...) {
    close();
    throw;
  }
}

void EglContext::make_current() {
  eglBindAPI(EGL_OPENGL_API);
  context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
  if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE)
    throw std::runtime_error("EGL: no context without a surface");
  const std::string renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (!renderer.starts_with("llvmpipe")) throw std::runtime_error("EGL: not llvmpipe but " + renderer);
}

void EglContext::close() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (context_ != nullptr) eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

EglContext::~EglContext() { close(); }

}  // namespace flexura

// Preloaded into a program (LD_PRELOAD), this lets its multicasts reach programs on the same machine.
// libonvif forbids that, and its tools find cameras by multicasts only.
#include <dlfcn.h>
#include <netinet/in.h>
#include <sys/socket.h>

extern "C" int setsockopt(int socket, int level, int option, const void* value, socklen_t size) noexcept {
  if (level == IPPROTO_IP && option == IP_MULTICAST_LOOP) return 0;
  using Function = int (*)(int, int, int, const void*, socklen_t);
  static const auto next = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "setsockopt"));
  return next(socket, level, option, value, size);
}

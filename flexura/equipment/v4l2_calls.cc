#include "flexura/equipment/v4l2_calls.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace flexura {
namespace {

class SystemCalls : public V4l2Calls {
 public:
  int open(const std::string& path) override {
    const int device = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    return device < 0 ? -errno : device;
  }
  void close(int device) override { ::close(device); }
  int ioctl(int device, unsigned long request, void* argument) override {
    int result = 0;
    do {
      result = ::ioctl(device, request, argument);
    } while (result < 0 && errno == EINTR);
    return result < 0 ? -errno : result;
  }
  void* map(int device, std::size_t length, std::size_t offset) override {
    void* memory =
        ::mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, device, static_cast<off_t>(offset));
    return memory == MAP_FAILED ? nullptr : memory;
  }
  void unmap(void* memory, std::size_t length) override { ::munmap(memory, length); }
  int wait(int device, double timeout) override {
    pollfd waited{.fd = device, .events = POLLIN | POLLPRI, .revents = 0};
    return ::poll(&waited, 1, static_cast<int>(std::clamp(timeout, 0.0, 60.0) * 1e3)) > 0 ? 1 : 0;
  }
};

}  // namespace

std::shared_ptr<V4l2Calls> v4l2_system_calls() { return std::make_shared<SystemCalls>(); }

std::string v4l2_error(int negative) { return std::generic_category().message(-negative); }

}  // namespace flexura

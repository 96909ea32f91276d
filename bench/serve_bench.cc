// What the viewer's server costs at the pace of a viewer: CPU time of the whole process (the server's thread
// and the one that posts) over wall time. The client is a process of its own, and its time is not counted.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "flexura/serve/server.h"
#include "tests/support/raw_client.h"

namespace {

using Clock = std::chrono::steady_clock;
using flexura::ClientId;

constexpr int most_counted = 200;  // An exit status says no more.

class Listener : public flexura::Host {
 public:
  void opened(ClientId) override {}
  void closed(ClientId) override {}
  void on_message(ClientId, std::string) override {}
  void asked(std::string, std::function<void(flexura::HttpAnswer)>) override {}
};

/// A process that connects to the server whose request it gets through a pipe, and reads until the server
/// ends.
class Reader {
 public:
  Reader() {
    if (::pipe(pipe_.data()) != 0) std::abort();
    child_ = ::fork();
    if (child_ == 0) read();
  }
  void connect(const flexura::Server& server) const {
    const std::string request =
        "GET /socket HTTP/1.1\r\nHost: localhost:" + std::to_string(server.port()) +
        "\r\nAuthorization: Bearer " + server.token() +
        "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
    const std::uint16_t port = server.port();
    if (::write(pipe_[1], &port, sizeof port) != sizeof port) std::abort();
    if (::write(pipe_[1], request.data(), request.size()) != static_cast<ssize_t>(request.size()))
      std::abort();
    ::close(pipe_[1]);
  }
  /// How many messages it has read, when the server has gone; most_counted stands for more too.
  [[nodiscard]] int count() const {
    int status = 0;
    ::waitpid(child_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  [[noreturn]] void read() const {
    std::uint16_t port = 0;
    std::array<char, 4096> request{};
    const bool port_came = ::read(pipe_[0], &port, sizeof port) == sizeof port;
    const ssize_t length = ::read(pipe_[0], request.data(), request.size());
    if (!port_came || length <= 0) ::_exit(0);
    flexura::RawClient client(port);
    client.send({request.data(), static_cast<std::size_t>(length)});
    client.read_answer();
    int count = 0;
    while (client.read_frame().opcode != 0) ++count;
    ::_exit(std::min(count, most_counted));
  }

  std::array<int, 2> pipe_{};
  pid_t child_ = 0;
};

double cpu_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// `streams` messages of `size` bytes each, `rate` times a second.
void pace(benchmark::State& state, std::uint32_t streams, std::size_t size, int rate) {
  const Reader reader;
  double cpu = 0.0;
  double wall = 0.0;
  {
    Listener listener;
    flexura::Server server({}, {}, listener);
    reader.connect(server);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const auto message = std::make_shared<const std::string>(size, 'm');
    const Clock::time_point start = Clock::now();
    const double cpu_before = cpu_seconds();
    std::int64_t number = 0;
    for (auto _ : state) {
      std::this_thread::sleep_until(start + std::chrono::nanoseconds(1'000'000'000) * number++ / rate);
      for (std::uint32_t stream = 0; stream < streams; ++stream) server.post(1, stream, message);
    }
    cpu = cpu_seconds() - cpu_before;
    wall = std::chrono::duration<double>(Clock::now() - start).count();
  }
  state.counters["percent_of_a_core"] = 100.0 * cpu / wall;
  if (reader.count() < most_counted) state.SkipWithError("the client did not read what was sent");
}

void serve_state_60_hz(benchmark::State& state) { pace(state, 1, 2000, 60); }
void serve_two_images_30_hz(benchmark::State& state) { pace(state, 2, 40000, 30); }

BENCHMARK(serve_state_60_hz)->Iterations(600)->UseRealTime();
BENCHMARK(serve_two_images_30_hz)->Iterations(300)->UseRealTime();

}  // namespace

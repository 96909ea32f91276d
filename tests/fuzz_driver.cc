// Runs a fuzz target without libFuzzer: on the files of a corpus, then on seeded mutations of them or on
// random bytes.
//
//   TARGET --corpus DIR [--cases N] [--seed S] [--fresh SHARE]
//       corpus, then N more inputs; SHARE of them (0 to 1, default 0) random bytes, the others mutated, with
//       tokens from DIR.dict if it exists
//   TARGET FILE...
//       these inputs only, to reproduce a failure
//
// When the target crashes, its input is written to fuzz-failure.bin and the exit status is not 0. An escaping
// exception counts as a crash, as does more than half a minute of processor time for one input.

#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/fuzz_inputs.h"

// NOLINTBEGIN(readability-identifier-naming,bugprone-reserved-identifier): others' names.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

// Makes a sanitizer raise SIGABRT when it finds an error; the signal is caught below.
extern "C" const char* __asan_default_options() { return "abort_on_error=1"; }
extern "C" const char* __ubsan_default_options() { return "abort_on_error=1:print_stacktrace=1"; }
extern "C" const char* __tsan_default_options() { return "abort_on_error=1:halt_on_error=1"; }
// NOLINTEND(readability-identifier-naming,bugprone-reserved-identifier)

namespace {

using flexura::Input;
using flexura::Mutator;

// State for the signal handler, which can only reach globals.
const std::uint8_t* volatile current_data = nullptr;
volatile std::size_t current_size = 0;
volatile std::sig_atomic_t current_case = 0;
volatile std::sig_atomic_t case_at_last_tick = -1;

void say(std::string_view text) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
}

void dump_current_input() {
  const int file = ::open("fuzz-failure.bin", O_WRONLY | O_CREAT | O_TRUNC, 0644);
  std::size_t done = 0;
  while (file >= 0 && done < current_size) {
    const ssize_t count = ::write(file, current_data + done, current_size - done);
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  say(file >= 0 && done == current_size ? "\nFAILED: the input is in fuzz-failure.bin\n"
                                        : "\nFAILED: and the input could not be saved\n");
}

void on_death(int signal) {
  dump_current_input();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void on_tick(int) {
  if (case_at_last_tick == current_case) {
    say("\none input takes too long");
    dump_current_input();
    ::_exit(EXIT_FAILURE);
  }
  case_at_last_tick = current_case;
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction before{};
  ::sigaction(signal, nullptr, &before);
  if (before.sa_handler != SIG_DFL) return;  // Installed by a sanitizer: it reports better, then aborts.
  struct sigaction action{};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART | SA_ONSTACK;
  ::sigaction(signal, &action, nullptr);
}

void watch_for_death() {
  static std::array<std::uint8_t, 65536> stack;  // Separate stack: the normal one may have overflowed.
  stack_t other{};
  other.ss_sp = stack.data();
  other.ss_size = stack.size();
  stack_t before{};
  ::sigaltstack(nullptr, &before);
  if ((before.ss_flags & SS_DISABLE) != 0) ::sigaltstack(&other, nullptr);
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP}) handle(signal, on_death);
  handle(SIGVTALRM, on_tick);
  constexpr itimerval every_half_minute{{30, 0}, {30, 0}};
  ::setitimer(ITIMER_VIRTUAL, &every_half_minute, nullptr);
}

/// Calls the target with the input in a heap block of exactly its size, so that sanitizers detect reads past
/// its end.
void run(const Input& input) {
  const std::unique_ptr<std::uint8_t[]> exact(new std::uint8_t[input.size()]);
  std::ranges::copy(input, exact.get());
  current_data = exact.get();
  current_size = input.size();
  current_case = current_case + 1;
  LLVMFuzzerTestOneInput(exact.get(), input.size());
}

struct Options {
  std::filesystem::path corpus;
  std::uint64_t cases = 0;
  std::uint64_t seed = 1;
  double fresh_share = 0;
  std::vector<std::filesystem::path> files;
};

Options parse(int count, char** arguments) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string_view name = arguments[i];
    if (!name.starts_with("--")) {
      options.files.emplace_back(name);
      continue;
    }
    if (i + 1 == count) throw std::runtime_error(std::string(name) + " needs a value");
    const std::string value = arguments[++i];
    if (name == "--corpus") {
      options.corpus = value;
    } else if (name == "--cases") {
      options.cases = std::stoull(value);
    } else if (name == "--seed") {
      options.seed = std::stoull(value);
    } else if (name == "--fresh") {
      options.fresh_share = std::stod(value);
      const bool is_share = options.fresh_share >= 0 && options.fresh_share <= 1;
      if (!is_share) throw std::runtime_error("--fresh " + value + ": expected 0 to 1");
    } else {
      throw std::runtime_error("unknown option " + std::string(name));
    }
  }
  if (options.corpus.empty() == options.files.empty()) throw std::runtime_error("--corpus DIR, or files");
  return options;
}

/// Returns the files to run: the named ones, or the corpus sorted by name.
std::vector<Input> read_inputs(const Options& options) {
  std::vector<std::filesystem::path> files = options.files;
  if (files.empty()) {
    for (const auto& entry : std::filesystem::directory_iterator(options.corpus)) {
      files.push_back(entry.path());
    }
    if (files.empty()) throw std::runtime_error("no files in " + options.corpus.string());
  }
  std::ranges::sort(files);
  std::vector<Input> inputs;
  inputs.reserve(files.size());
  for (const auto& file : files) inputs.push_back(flexura::read_file(file));
  return inputs;
}

void run_mutations(Mutator mutator, std::uint64_t cases) {
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t i = 0; i < cases; ++i) run(mutator.next());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  if (cases > 0) std::printf("%.0f cases/s\n", static_cast<double>(cases) / took.count());
  if (mutator.fresh_count() > 0)
    std::printf("%llu random throughout\n", static_cast<unsigned long long>(mutator.fresh_count()));
  std::printf("%llu cases, no failure\n", static_cast<unsigned long long>(cases));
}

}  // namespace

int main(int count, char** arguments) {
  Options options;
  std::vector<Input> inputs;
  std::vector<Input> tokens;
  try {
    options = parse(count, arguments);
    inputs = read_inputs(options);
    tokens = flexura::read_dictionary(options.corpus.string() + ".dict");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
  std::printf("%zu files, seed %llu\n", inputs.size(), static_cast<unsigned long long>(options.seed));
  std::fflush(stdout);  // A crash would lose buffered output.
  watch_for_death();
  for (const Input& input : inputs) run(input);
  if (options.files.empty()) {
    run_mutations(Mutator(std::move(inputs), std::move(tokens), options.seed, options.fresh_share),
                  options.cases);
  }
  return EXIT_SUCCESS;
}

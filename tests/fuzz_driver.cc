// Runs a fuzz target without libFuzzer: on the files of a corpus, then on seeded mutations of them, or on
// bytes that are random throughout.
//
//   TARGET --corpus DIR [--cases N] [--seed S] [--fresh SHARE]
//       corpus, then N more inputs; SHARE of them (0 to 1, else none) random bytes, the others mutated, with
//       tokens from DIR.dict if it exists
//   TARGET FILE...
//       these inputs only, to see a failure again
//
// When the target dies, its input is written to fuzz-failure.bin and the exit status is not 0. Letting an
// exception out is dying; so is taking more than half a minute of processor time for one input.

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
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

// NOLINTBEGIN(readability-identifier-naming,bugprone-reserved-identifier): others' names.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

// A sanitizer that has found something then raises SIGABRT, which is caught below.
extern "C" const char* __asan_default_options() { return "abort_on_error=1"; }
extern "C" const char* __ubsan_default_options() { return "abort_on_error=1:print_stacktrace=1"; }
extern "C" const char* __tsan_default_options() { return "abort_on_error=1:halt_on_error=1"; }
// NOLINTEND(readability-identifier-naming,bugprone-reserved-identifier)

namespace {

using Input = std::vector<std::uint8_t>;

// What the signal handler needs; a handler has no other way to reach it.
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
  if (before.sa_handler != SIG_DFL) return;  // A sanitizer's: it reports better, then aborts.
  struct sigaction action{};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART | SA_ONSTACK;
  ::sigaction(signal, &action, nullptr);
}

void watch_for_death() {
  static std::array<std::uint8_t, 65536> stack;  // The usual one may be what overflowed.
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

/// Calls the target with the input in a block of its own size, so that a read past its end is seen.
void run(const Input& input) {
  const std::unique_ptr<std::uint8_t[]> exact(new std::uint8_t[input.size()]);
  std::ranges::copy(input, exact.get());
  current_data = exact.get();
  current_size = input.size();
  current_case = current_case + 1;
  LLVMFuzzerTestOneInput(exact.get(), input.size());
}

Input read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

/// SplitMix64 (Steele, Lea, Flood 2014): small, fast, and the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15U;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9U;
    z = (z ^ z >> 27) * 0x94D049BB133111EBU;
    return z ^ z >> 31;
  }
  /// From 0 to count - 1; 0 when there is nothing to choose from.
  std::size_t below(std::size_t count) { return count == 0 ? 0 : static_cast<std::size_t>(next() % count); }
  template <typename List>
  const auto& of(const List& list) {
    return list[below(std::size(list))];
  }

 private:
  std::uint64_t state_;
};

constexpr std::array<std::uint64_t, 20> numbers = {0,
                                                   1,
                                                   7,
                                                   8,
                                                   16,
                                                   32,
                                                   64,
                                                   100,
                                                   127,
                                                   128,
                                                   255,
                                                   256,
                                                   0x7FFF,
                                                   0xFFFF,
                                                   0x10000,
                                                   0x7FFF'FFFF,
                                                   0x8000'0000,
                                                   0xFFFF'FFFF,
                                                   0x7FFF'FFFF'FFFF'FFFF,
                                                   0xFFFF'FFFF'FFFF'FFFF};
constexpr std::array<std::string_view, 16> number_texts = {"0",
                                                           "-1",
                                                           "1e308",
                                                           "-1e308",
                                                           "1e309",
                                                           "1e-308",
                                                           "5e-324",
                                                           "nan",
                                                           "inf",
                                                           "-inf",
                                                           "-0.0",
                                                           "2147483648",
                                                           "9223372036854775808",
                                                           "18446744073709551616",
                                                           "0x7fffffff",
                                                           "0.1e1e1"};

/// The tokens of a dictionary in libFuzzer's form: lines [name=]"text" where text may hold \\, \" and \xNN.
std::vector<Input> read_dictionary(const std::filesystem::path& path) {
  std::vector<Input> tokens;
  std::ifstream in(path, std::ios::binary);
  for (std::string line; std::getline(in, line);) {
    const std::size_t open = line.find('"');
    const std::size_t close = line.rfind('"');
    if (line.starts_with('#') || open == close) continue;
    Input token;
    for (std::size_t i = open + 1; i < close; ++i) {
      const bool escaped = line[i] == '\\';
      if (escaped) ++i;
      if (escaped && line[i] == 'x') {
        token.push_back(static_cast<std::uint8_t>(std::stoul(line.substr(i + 1, 2), nullptr, 16)));
        i += 2;
      } else {
        token.push_back(static_cast<std::uint8_t>(line[i]));
      }
    }
    tokens.push_back(std::move(token));
  }
  return tokens;
}

class Mutator {
 public:
  Mutator(std::vector<Input> corpus, std::vector<Input> tokens, std::uint64_t seed, double fresh_share)
      : corpus_(std::move(corpus)), tokens_(std::move(tokens)), random_(seed), fresh_share_(fresh_share) {
    for (const std::string_view text : number_texts) tokens_.emplace_back(text.begin(), text.end());
    for (const Input& input : corpus_) {
      max_size_ = std::max(max_size_, 2 * input.size());
      fresh_size_ = std::max(fresh_size_, 2 * input.size());
    }
  }

  /// A corpus file after one to eight changes, or random bytes; valid until the next call.
  const Input& next() {
    if (fresh_share_ > 0 && static_cast<double>(random_.next() >> 11) * 0x1p-53 < fresh_share_) {
      ++fresh_;
      return fresh();
    }
    input_ = random_.of(corpus_);
    for (std::size_t changes = std::size_t{1} << random_.below(4); changes > 0; --changes) change();
    if (input_.size() > max_size_) input_.resize(max_size_);
    return input_;
  }

  /// How many inputs were random throughout.
  [[nodiscard]] std::uint64_t fresh_count() const { return fresh_; }

 private:
  // Twice as long as the longest file of the corpus: no target runs out of them on its way.
  const Input& fresh() {
    input_.resize(fresh_size_);
    for (std::uint8_t& byte : input_) byte = static_cast<std::uint8_t>(random_.next());
    return input_;
  }

  void change() {
    constexpr std::size_t short_piece = 16;
    const std::size_t at = random_.below(input_.size() + 1);
    const std::size_t left = input_.size() - at;
    const std::size_t length = random_.below(std::min(left, random_.below(4) == 0 ? left : short_piece) + 1);
    const auto byte = static_cast<std::uint8_t>(random_.next());
    switch (random_.below(10)) {
      case 0:
        if (left > 0) input_[at] = static_cast<std::uint8_t>(input_[at] ^ 1U << random_.below(8));
        break;
      case 1:
        if (left > 0) input_[at] = byte;
        break;
      case 2:
        insert(at, Input(1 + random_.below(short_piece), byte));
        break;
      case 3:
        erase(at, length);
        break;
      case 4:
        input_.resize(at);
        break;
      case 5:
        insert(random_.below(input_.size() + 1), piece(input_, at, length));
        break;
      case 6:
        splice(at);
        break;
      case 7:
        insert(at, random_.of(tokens_));
        break;
      case 8:
        overwrite(at, random_.of(tokens_));
        break;
      default:
        overwrite(at, number());
        break;
    }
  }

  static Input piece(const Input& of, std::size_t at, std::size_t length) {
    const auto first = of.begin() + static_cast<std::ptrdiff_t>(at);
    return {first, first + static_cast<std::ptrdiff_t>(length)};
  }
  void insert(std::size_t at, const Input& what) {
    input_.insert(input_.begin() + static_cast<std::ptrdiff_t>(at), what.begin(), what.end());
  }
  void erase(std::size_t at, std::size_t length) {
    const auto first = input_.begin() + static_cast<std::ptrdiff_t>(at);
    input_.erase(first, first + static_cast<std::ptrdiff_t>(length));
  }
  void overwrite(std::size_t at, const Input& what) {
    std::copy_n(what.begin(), std::min(what.size(), input_.size() - at),
                input_.begin() + static_cast<std::ptrdiff_t>(at));
  }
  /// Goes on with another corpus file from here, or puts a piece of it in.
  void splice(std::size_t at) {
    const Input& other = random_.of(corpus_);
    const std::size_t from = random_.below(other.size() + 1);
    const bool to_its_end = random_.below(2) == 0;
    if (to_its_end) input_.resize(at);
    insert(at, piece(other, from, to_its_end ? other.size() - from : random_.below(other.size() - from + 1)));
  }
  /// A number that breaks things, give or take one, in 1, 2, 4 or 8 bytes of either order.
  Input number() {
    const std::uint64_t value = random_.of(numbers) + random_.below(3) - 1;
    Input bytes(std::size_t{1} << random_.below(4));
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
    if (random_.below(2) == 0) std::ranges::reverse(bytes);
    return bytes;
  }

  std::vector<Input> corpus_;
  std::vector<Input> tokens_;
  Random random_;
  std::size_t max_size_ = 4096, fresh_size_ = 64;
  double fresh_share_;
  std::uint64_t fresh_ = 0;
  Input input_;
};

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

/// The files to run: those named, or the corpus in the order of its names.
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
  for (const auto& file : files) inputs.push_back(read_file(file));
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
    tokens = read_dictionary(options.corpus.string() + ".dict");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
  std::printf("%zu files, seed %llu\n", inputs.size(), static_cast<unsigned long long>(options.seed));
  std::fflush(stdout);  // A death would lose it.
  watch_for_death();
  for (const Input& input : inputs) run(input);
  if (options.files.empty()) {
    run_mutations(Mutator(std::move(inputs), std::move(tokens), options.seed, options.fresh_share),
                  options.cases);
  }
  return EXIT_SUCCESS;
}

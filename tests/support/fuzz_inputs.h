#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Inputs of fuzz_driver.cc: a corpus, a dictionary, and seeded mutations.
namespace flexura {

/// The bytes of one input.
using Input = std::vector<std::uint8_t>;

inline Input read_file(const std::filesystem::path& path) {
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
  /// Returns a number from 0 to count - 1; 0 if count is 0.
  std::size_t below(std::size_t count) { return count == 0 ? 0 : static_cast<std::size_t>(next() % count); }
  template <typename List>
  const auto& of(const List& list) {
    return list[below(std::size(list))];
  }

 private:
  std::uint64_t state_;
};

inline constexpr std::array<std::uint64_t, 20> numbers = {0,
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
inline constexpr std::array<std::string_view, 16> number_texts = {"0",
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

/// Reads the tokens of a dictionary in libFuzzer's format: lines [name=]"text" with the escapes \\, \" and
/// \xNN.
inline std::vector<Input> read_dictionary(const std::filesystem::path& path) {
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

  /// Returns a corpus file with one to eight changes, or random bytes; valid until the next call.
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

  /// Returns how many inputs were random bytes.
  [[nodiscard]] std::uint64_t fresh_count() const { return fresh_; }

 private:
  // Random bytes up to twice as long as the longest file of the corpus, so that targets rarely run out of
  // input.
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
  /// Continues with another corpus file from here, or inserts a piece of it.
  void splice(std::size_t at) {
    const Input& other = random_.of(corpus_);
    const std::size_t from = random_.below(other.size() + 1);
    const bool to_its_end = random_.below(2) == 0;
    if (to_its_end) input_.resize(at);
    insert(at, piece(other, from, to_its_end ? other.size() - from : random_.below(other.size() - from + 1)));
  }
  /// Returns a boundary value, give or take one, in 1, 2, 4 or 8 bytes of either byte order.
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

}  // namespace flexura

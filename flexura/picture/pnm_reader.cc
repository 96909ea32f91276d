#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

bool is_space(std::uint8_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool is_digit(std::uint8_t c) { return c >= '0' && c <= '9'; }

// Reads the text of a PNM file from the front.
class PnmText {
 public:
  explicit PnmText(std::span<const std::uint8_t> file) : file_(file) {}

  // Reads a number after spaces and comments. Returns large numbers as 2^31 or slightly more.
  std::int64_t number() {
    skip();
    std::int64_t value = 0;
    for (; at_ < file_.size() && is_digit(file_[at_]); ++at_)
      value = std::min<std::int64_t>(value * 10 + (file_[at_] - '0'), std::int64_t{1} << 31U);
    return value;
  }
  // Reads a bit; bits need no separators.
  std::int64_t bit() {
    skip();
    return file_[at_++] - '0';
  }
  // Returns the data after the header and one separating space.
  std::span<const std::uint8_t> raster() {
    if (at_ >= file_.size()) throw cut_short("PNM");
    if (!is_space(file_[at_])) throw strange();
    return file_.subspan(at_ + 1);
  }
  [[nodiscard]] std::size_t left() const { return file_.size() - at_; }

 private:
  // Skips to the next digit.
  void skip() {
    while (at_ < file_.size() && (is_space(file_[at_]) || file_[at_] == '#')) {
      if (file_[at_] == '#')
        while (at_ < file_.size() && file_[at_] != '\n' && file_[at_] != '\r') ++at_;
      else
        ++at_;
    }
    if (at_ >= file_.size()) throw cut_short("PNM");
    if (!is_digit(file_[at_])) throw strange();
  }
  [[nodiscard]] std::runtime_error strange() const {
    return damaged("PNM", fmt::format("no number at byte {}", at_));
  }

  std::span<const std::uint8_t> file_;
  std::size_t at_ = 2;  // Position after the two characters of the kind.
};

struct PnmHeader {
  bool is_plain = false, is_bits = false;
  int width = 0, height = 0, channels = 1;
  std::int64_t most = 1;  // Value of white.
};

PnmHeader read_header(std::uint8_t kind, PnmText& text, std::size_t most_pixels) {
  PnmHeader header;
  header.is_plain = kind <= '3';
  header.is_bits = kind == '1' || kind == '4';
  header.channels = kind == '3' || kind == '6' ? 3 : 1;
  const std::int64_t width = text.number(), height = text.number();
  check_picture_size(width, height, most_pixels);
  header.width = static_cast<int>(width), header.height = static_cast<int>(height);
  if (header.is_bits) return header;
  constexpr std::int64_t most_value = 65535;
  header.most = text.number();
  if (header.most < 1 || header.most > most_value)
    throw std::runtime_error(
        fmt::format("the PNM file has {} for white: expected 1 to {}", header.most, most_value));
  return header;
}

// Scales a value from the range 0 to `most` to the range 0 to 255.
std::uint8_t byte_of(std::int64_t value, std::int64_t most) {
  return static_cast<std::uint8_t>((value * 255 + most / 2) / most);
}

// Each call of `next` returns the next value of the file.
template <typename Value, typename Next>
Image<Value> image_of(const PnmHeader& header, Next&& next) {
  Image<Value> image(header.width, header.height, header.channels);
  const bool is_scaled = sizeof(Value) == 1 && header.most != 255;
  for (Value& value : image.values()) {
    const std::int64_t written = next();
    if (written > header.most)
      throw damaged("PNM",
                    fmt::format("a value of {}, which is above the value {} of white", written, header.most));
    value = is_scaled ? byte_of(written, header.most) : static_cast<Value>(written);
  }
  return image;
}

template <typename Next>
Picture picture_of(const PnmHeader& header, Next&& next) {
  if (header.most > 255) return image_of<std::uint16_t>(header, next);
  return image_of<std::uint8_t>(header, next);
}

// A bit of 1 is black.
Image<std::uint8_t> bits_of(const PnmHeader& header, std::span<const std::uint8_t> raster) {
  Image<std::uint8_t> image(header.width, header.height);
  const std::size_t row_size = (static_cast<std::size_t>(header.width) + 7) / 8;
  for (int v = 0; v < header.height; ++v) {
    const auto row = raster.subspan(static_cast<std::size_t>(v) * row_size, row_size);
    for (std::size_t u = 0; u < image.row(v).size(); ++u)
      image.row(v)[u] = (row[u / 8] >> (7 - u % 8) & 1) == 0 ? 255 : 0;
  }
  return image;
}

}  // namespace

Picture read_pnm(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  PnmText text(file);
  const PnmHeader header = read_header(file[1], text, most_pixels);
  const auto width = static_cast<std::size_t>(header.width), height = static_cast<std::size_t>(header.height);
  const std::size_t values = width * height * static_cast<std::size_t>(header.channels);
  if (header.is_plain) {
    if (text.left() < values) throw cut_short("PNM");  // Before allocating.
    if (header.is_bits)
      return image_of<std::uint8_t>(header, [&] {
        const std::int64_t bit = text.bit();
        if (bit > 1) throw damaged("PNM", "bits that are neither 0 nor 1");
        return 1 - bit;
      });
    return picture_of(header, [&] { return text.number(); });
  }
  const auto raster = text.raster();
  const std::size_t value_size = header.most > 255 ? 2 : 1;
  if (raster.size() < (header.is_bits ? (width + 7) / 8 * height : values * value_size))
    throw cut_short("PNM");
  if (header.is_bits) return bits_of(header, raster);
  const std::uint8_t* at = raster.data();
  if (value_size == 1) return picture_of(header, [&]() -> std::int64_t { return *at++; });
  return picture_of(header, [&]() -> std::int64_t {
    at += 2;
    return at[-2] * 256 + at[-1];
  });
}

}  // namespace flexura

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

// A number of `size` bytes, the lowest first.
std::int64_t number_at(std::span<const std::uint8_t> file, std::size_t at, std::size_t size) {
  if (at + size > file.size()) throw cut_short("BMP");
  std::int64_t value = 0;
  for (std::size_t i = size; i > 0; --i) value = value * 256 + file[at + i - 1];
  return value;
}

struct BmpHeader {
  std::int64_t width = 0, height = 0;
  bool is_top_first = false;
  std::size_t bits = 0;                                           // A pixel.
  std::size_t pixels = 0;                                         // Where they begin.
  std::size_t palette = 0, palette_size = 0, palette_colors = 0;  // Where; bytes a colour.
};

// Red, green and blue of 32 bits may be named by masks; these are the usual ones.
bool has_usual_masks(std::span<const std::uint8_t> file) {
  constexpr std::size_t masks = 54;
  return number_at(file, masks, 4) == 0xFF0000 && number_at(file, masks + 4, 4) == 0xFF00 &&
         number_at(file, masks + 8, 4) == 0xFF;
}

// The header of OS/2 has 12 bytes, that of Windows 40 or more.
BmpHeader read_header(std::span<const std::uint8_t> file) {
  constexpr std::size_t begin = 14, short_size = 12, usual_size = 40;
  BmpHeader header;
  header.pixels = static_cast<std::size_t>(number_at(file, 10, 4));
  const auto size = static_cast<std::size_t>(number_at(file, begin, 4));
  header.palette = begin + size;
  std::size_t used = 0;
  if (size == short_size) {
    header.width = number_at(file, 18, 2), header.height = number_at(file, 20, 2);
    header.bits = static_cast<std::size_t>(number_at(file, 24, 2));
    header.palette_size = 3;
  } else if (size >= usual_size) {
    const auto with_sign = [&](std::size_t at) {
      return static_cast<std::int64_t>(static_cast<std::int32_t>(number_at(file, at, 4)));
    };
    header.width = with_sign(18), header.height = with_sign(22);
    header.is_top_first = header.height < 0;
    header.height = std::abs(header.height);
    header.bits = static_cast<std::size_t>(number_at(file, 28, 2));
    const std::int64_t compression = number_at(file, 30, 4);
    constexpr std::int64_t none = 0, masks = 3;
    const bool has_masks = compression == masks && header.bits == 32 && has_usual_masks(file);
    if (compression != none && !has_masks)
      throw std::runtime_error("the BMP file is compressed, or has masks of its own: expected neither");
    used = static_cast<std::size_t>(number_at(file, 46, 4));
    header.palette_size = 4;
  } else {
    throw damaged("BMP", fmt::format("a header of {} bytes", size));
  }
  constexpr std::array<std::size_t, 5> known = {1, 4, 8, 24, 32};
  if (std::ranges::count(known, header.bits) == 0)
    throw std::runtime_error(
        fmt::format("the BMP file has {} bits a pixel: expected {}", header.bits, fmt::join(known, ", ")));
  const std::size_t all = header.bits <= 8 ? std::size_t{1} << header.bits : 0;
  header.palette_colors = used == 0 ? all : std::min(used, all);
  return header;
}

Palette palette_of(std::span<const std::uint8_t> file, const BmpHeader& header) {
  Palette palette{};
  if (header.palette + header.palette_colors * header.palette_size > file.size()) throw cut_short("BMP");
  for (std::size_t i = 0; i < header.palette_colors; ++i) {
    const auto from = file.subspan(header.palette + i * header.palette_size);
    palette[i] = {from[2], from[1], from[0]};
  }
  return palette;
}

// Pixels of 1, 4 or 8 bits: their indices; of more: red, green, blue.
Image<std::uint8_t> values_of(const BmpHeader& header, std::span<const std::uint8_t> pixels,
                              std::size_t row_size) {
  Image<std::uint8_t> image(static_cast<int>(header.width), static_cast<int>(header.height),
                            header.bits > 8 ? 3 : 1);
  const auto width = static_cast<std::size_t>(header.width);
  for (int v = 0; v < image.height(); ++v) {
    const int place = header.is_top_first ? v : image.height() - 1 - v;
    const std::uint8_t* from = pixels.data() + static_cast<std::size_t>(place) * row_size;
    std::uint8_t* to = image.row(v).data();
    if (header.bits > 8) {
      for (std::size_t u = 0; u < width; ++u, from += header.bits / 8, to += 3)
        to[0] = from[2], to[1] = from[1], to[2] = from[0];
    } else {
      const unsigned mask = (1U << header.bits) - 1U;
      for (std::size_t u = 0, bit = 0; u < width; ++u, bit += header.bits)
        to[u] = static_cast<std::uint8_t>(from[bit / 8] >> (8 - header.bits - bit % 8) & mask);
    }
  }
  return image;
}

}  // namespace

Picture read_bmp(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  const BmpHeader header = read_header(file);
  check_picture_size(header.width, header.height, most_pixels);
  // Rows are filled up to four bytes; the last one need not be.
  const std::size_t row_bits = static_cast<std::size_t>(header.width) * header.bits,
                    row_size = (row_bits + 31) / 32 * 4,
                    size = static_cast<std::size_t>(header.height - 1) * row_size + (row_bits + 7) / 8;
  if (header.pixels < header.palette) throw damaged("BMP", "pixels that begin within the header");
  if (header.pixels > file.size() || file.size() - header.pixels < size) throw cut_short("BMP");
  Image<std::uint8_t> values = values_of(header, file.subspan(header.pixels), row_size);
  return header.bits > 8 ? values : painted(std::move(values), palette_of(file, header));
}

}  // namespace flexura

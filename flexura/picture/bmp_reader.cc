#include <array>
#include <bit>
#include <utility>

#include "flexura/picture/bmp_header.h"
#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

Palette palette_of(std::span<const std::uint8_t> file, const BmpHeader& header) {
  Palette palette{};
  if (header.palette + header.palette_colors * header.palette_size > file.size()) throw cut_short("BMP");
  for (std::size_t i = 0; i < header.palette_colors; ++i) {
    const auto from = file.subspan(header.palette + i * header.palette_size);
    palette[i] = {from[2], from[1], from[0]};
  }
  return palette;
}

void read_indices(const std::uint8_t* from, std::size_t bits, std::span<std::uint8_t> to) {
  const unsigned mask = (1U << bits) - 1U;
  for (std::size_t u = 0, bit = 0; u < to.size(); ++u, bit += bits)
    to[u] = static_cast<std::uint8_t>(from[bit / 8] >> (8 - bits - bit % 8) & mask);
}

void read_bytes(const std::uint8_t* from, std::size_t step, std::span<std::uint8_t> to) {
  for (std::size_t i = 0; i < to.size(); i += 3, from += step)
    to[i] = from[2], to[i + 1] = from[1], to[i + 2] = from[0];
}

// A colour's bits: up to 8 of them by a table of what they are as a byte, more by their upper 8.
struct BitField {
  explicit BitField(std::uint32_t mask) : shift(std::countr_zero(mask)), size(std::popcount(mask)) {
    if (size > 8) shift += size - 8, size = 8;
    const unsigned most = (1U << static_cast<unsigned>(size)) - 1U;
    for (unsigned value = 0; value <= most; ++value) bytes[value] = byte_of(value, most);
  }
  [[nodiscard]] std::uint8_t of(std::uint32_t pixel) const {
    return bytes[pixel >> static_cast<unsigned>(shift) & ((1U << static_cast<unsigned>(size)) - 1U)];
  }
  int shift, size;
  std::array<std::uint8_t, 256> bytes{};
};

void read_fields(const std::uint8_t* from, std::size_t step, const std::array<BitField, 3>& fields,
                 std::span<std::uint8_t> to) {
  for (std::size_t i = 0; i < to.size(); i += 3, from += step) {
    std::uint32_t pixel = 0;
    for (std::size_t byte = step; byte > 0; --byte) pixel = pixel << 8U | from[byte - 1];
    for (std::size_t c = 0; c < 3; ++c) to[i + c] = fields[c].of(pixel);
  }
}

// Pixels of 1, 4 or 8 bits: their indices; of more: red, green, blue.
template <typename ReadRow>
Image<std::uint8_t> values_of(const BmpHeader& header, std::span<const std::uint8_t> pixels,
                              std::size_t row_size, ReadRow&& read_row) {
  Image<std::uint8_t> image(static_cast<int>(header.width), static_cast<int>(header.height),
                            header.bits > 8 ? 3 : 1);
  for (int v = 0; v < image.height(); ++v) {
    const int place = header.is_top_first ? v : image.height() - 1 - v;
    read_row(pixels.data() + static_cast<std::size_t>(place) * row_size, image.row(v));
  }
  return image;
}

// Rows are filled up to four bytes; the last one need not be.
Image<std::uint8_t> plain_values(std::span<const std::uint8_t> pixels, const BmpHeader& header) {
  const std::size_t row_bits = static_cast<std::size_t>(header.width) * header.bits,
                    row_size = (row_bits + 31) / 32 * 4,
                    size = static_cast<std::size_t>(header.height - 1) * row_size + (row_bits + 7) / 8;
  if (pixels.size() < size) throw cut_short("BMP");
  const auto values = [&](auto&& read_row) { return values_of(header, pixels, row_size, read_row); };
  using Row = std::span<std::uint8_t>;
  if (header.bits <= 8)
    return values([&](const std::uint8_t* from, Row to) { read_indices(from, header.bits, to); });
  const std::size_t step = header.bits / 8;
  constexpr std::array<std::uint32_t, 3> bytes = {0xFF0000, 0xFF00, 0xFF};
  if (header.bits == 24 || (header.bits == 32 && header.fields == bytes))
    return values([&](const std::uint8_t* from, Row to) { read_bytes(from, step, to); });
  const auto& masks = header.fields;
  const std::array fields = {BitField(masks[0]), BitField(masks[1]), BitField(masks[2])};
  return values([&](const std::uint8_t* from, Row to) { read_fields(from, step, fields, to); });
}

}  // namespace

Picture read_bmp(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  const BmpHeader header = read_bmp_header(file);
  check_picture_size(header.width, header.height, most_pixels);
  if (header.pixels < header.palette) throw damaged("BMP", "pixels that begin within the header");
  if (header.pixels > file.size()) throw cut_short("BMP");
  const auto pixels = file.subspan(header.pixels);
  Image<std::uint8_t> values =
      header.is_in_runs ? read_bmp_runs(pixels, header) : plain_values(pixels, header);
  return header.bits > 8 ? values : painted(std::move(values), palette_of(file, header));
}

}  // namespace flexura

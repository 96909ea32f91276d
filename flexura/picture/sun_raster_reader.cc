#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

// Sun's rasterfile(5): eight numbers, a palette, the rows.
struct SunHeader {
  std::int64_t width = 0, height = 0, bits = 0, type = 0, map_type = 0;
  std::size_t map_size = 0, row_size = 0;

  static constexpr std::size_t size = 32;
  static constexpr std::int64_t in_runs = 2, red_first = 3;  // Of `type`; 0 and 1 are the usual ones.
  static constexpr std::int64_t no_map = 0, rgb_map = 1;
};

SunHeader read_sun_header(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  const auto number = [&](std::size_t index) { return high_first_number(file, 4 * index, 4, "Sun raster"); };
  SunHeader header{.width = number(1), .height = number(2), .bits = number(3)};
  header.type = number(5), header.map_type = number(6);
  const std::int64_t map_size = number(7);
  check_picture_size(header.width, header.height, most_pixels);
  constexpr std::array<std::int64_t, 4> known = {1, 8, 24, 32};
  if (std::ranges::count(known, header.bits) == 0)
    throw std::runtime_error(fmt::format("the Sun raster file has {} bits a pixel: expected {}", header.bits,
                                         fmt::join(known, ", ")));
  if (header.type > SunHeader::red_first)
    throw std::runtime_error(fmt::format("the Sun raster file is of type {}: expected 0 to {}", header.type,
                                         SunHeader::red_first));
  const std::int64_t most_map = header.bits <= 8 ? std::int64_t{3} << header.bits : 0;
  const bool is_plain = header.map_type == SunHeader::no_map && map_size == 0,
             is_painted = header.map_type == SunHeader::rgb_map && map_size <= most_map && map_size % 3 == 0;
  if (!is_plain && !is_painted)
    throw std::runtime_error(
        fmt::format("the Sun raster file has a palette of type {} and {} bytes: expected none, or one of "
                    "red, green and blue for 1 or 8 bits a pixel",
                    header.map_type, map_size));
  header.map_size = static_cast<std::size_t>(map_size);
  header.row_size = static_cast<std::size_t>((header.width * header.bits + 15) / 16 * 2);
  return header;
}

// 128 begins a run: 128, count - 1, value; or 128, 0 for a 128 alone. Runs go over the ends of rows.
std::vector<std::uint8_t> without_runs(std::span<const std::uint8_t> packed, std::size_t size) {
  constexpr std::uint8_t sign = 128;
  constexpr std::size_t most_run = 256, run_size = 3;
  if (packed.size() < size / most_run * run_size) throw cut_short("Sun raster");  // Before room is made.
  std::vector<std::uint8_t> values;
  values.reserve(size);
  for (std::size_t at = 0; values.size() < size;) {
    const auto next = [&] {
      return static_cast<std::uint8_t>(high_first_number(packed, at++, 1, "Sun raster"));
    };
    const std::uint8_t value = next();
    const std::size_t count = value == sign ? next() : 0;
    if (count == 0)
      values.push_back(value);
    else
      values.insert(values.end(), std::min(count + 1, size - values.size()), next());
  }
  return values;
}

// The palette's reds come first, then its greens, then its blues.
Palette palette_of(const SunHeader& header, std::span<const std::uint8_t> map) {
  Palette palette{};
  const std::size_t count = map.size() / 3;
  for (std::size_t i = 0; i < count; ++i) palette[i] = {map[i], map[count + i], map[2 * count + i]};
  // Without one, bits are ink on paper, bytes are gray.
  if (header.map_type == SunHeader::no_map && header.bits == 1) palette[0] = {255, 255, 255};
  if (header.map_type == SunHeader::no_map && header.bits == 8)
    for (std::size_t i = 0; i < palette.size(); ++i) palette[i].fill(static_cast<std::uint8_t>(i));
  return palette;
}

// Pixels of 1 or 8 bits: their indices; of 24 or 32 (the first byte of those is for nothing): red, green,
// blue.
Image<std::uint8_t> values_of(const SunHeader& header, std::span<const std::uint8_t> rows) {
  const bool has_colors = header.bits > 8;
  Image<std::uint8_t> image(static_cast<int>(header.width), static_cast<int>(header.height),
                            has_colors ? 3 : 1);
  const auto width = static_cast<std::size_t>(header.width);
  const std::size_t red = header.type == SunHeader::red_first ? 0 : 2, blue = 2 - red;
  for (int v = 0; v < image.height(); ++v) {
    const std::uint8_t* from = rows.data() + static_cast<std::size_t>(v) * header.row_size;
    std::uint8_t* to = image.row(v).data();
    if (header.bits == 8) std::copy_n(from, width, to);
    if (header.bits == 1)
      for (std::size_t u = 0; u < width; ++u) to[u] = from[u / 8] >> (7 - u % 8) & 1;
    if (header.bits == 32) ++from;
    for (std::size_t u = 0; has_colors && u < width; ++u, from += header.bits / 8, to += 3)
      to[0] = from[red], to[1] = from[1], to[2] = from[blue];
  }
  return image;
}

}  // namespace

Picture read_sun_raster(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  const SunHeader header = read_sun_header(file, most_pixels);
  if (file.size() - SunHeader::size < header.map_size) throw cut_short("Sun raster");
  const auto map = file.subspan(SunHeader::size, header.map_size);
  auto rows = file.subspan(SunHeader::size + header.map_size);
  // Rows are filled up to two bytes; the last one need not be.
  const std::size_t size = static_cast<std::size_t>(header.height - 1) * header.row_size +
                           static_cast<std::size_t>((header.width * header.bits + 7) / 8);
  std::vector<std::uint8_t> unpacked;
  if (header.type == SunHeader::in_runs) rows = unpacked = without_runs(rows, size);
  if (rows.size() < size) throw cut_short("Sun raster");
  Image<std::uint8_t> values = values_of(header, rows);
  return header.bits > 8 ? values : painted(std::move(values), palette_of(header, map));
}

}  // namespace flexura

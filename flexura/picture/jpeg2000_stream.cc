#include "flexura/picture/jpeg2000_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

// ITU-T T.800, annexes A (the stream) and I (JP2's boxes).
constexpr std::int64_t start_of_stream = 0xFF4F, size_marker = 0xFF51, start_of_tile = 0xFF90,
                       start_of_data = 0xFF93, end_of_stream = 0xFFD9, all_components = 0xFF52,
                       one_component = 0xFF53, contiguous_stream = 0x6A703263;

std::int64_t number_at(std::span<const std::uint8_t> file, std::size_t at, std::size_t size) {
  return high_first_number(file, at, size, "JPEG 2000");
}

// The stream in a file of boxes: a length, a name, what is in it.
std::span<const std::uint8_t> stream_in_boxes(std::span<const std::uint8_t> file) {
  for (std::size_t at = 0;;) {
    auto length = static_cast<std::size_t>(number_at(file, at, 4));
    const std::int64_t name = number_at(file, at + 4, 4);
    std::size_t begin = 8;
    constexpr std::size_t is_long = 1, is_last = 0;
    if (length == is_long) {
      if (number_at(file, at + 8, 4) != 0) throw cut_short("JPEG 2000");
      length = static_cast<std::size_t>(number_at(file, at + 12, 4));
      begin = 16;
    } else if (length == is_last) {
      length = file.size() - at;
    }
    if (length < begin) throw damaged("JPEG 2000", fmt::format("a box of {} bytes", length));
    if (file.size() - at < length) throw cut_short("JPEG 2000");
    if (name == contiguous_stream) return file.subspan(at + begin, length - begin);
    at += length;
  }
}

std::int64_t tiles_along(std::int64_t end, std::int64_t begin, std::int64_t size) {
  return (end - begin + size - 1) / size;
}

struct Jpeg2000Size {
  std::int64_t width = 0, height = 0, tile_width = 0, tile_height = 0, tiles = 0;
};

// What the size marker's segment says.
Jpeg2000Size read_size(std::span<const std::uint8_t> stream, std::size_t most_pixels) {
  constexpr std::size_t numbers = 8, components = 40;
  const auto number = [&](std::size_t index) { return number_at(stream, numbers + 4 * index, 4); };
  const std::int64_t right = number(0), bottom = number(1), left = number(2), top = number(3),
                     tile_left = number(6), tile_top = number(7);
  Jpeg2000Size size{right - left, bottom - top, number(4), number(5)};
  check_picture_size(size.width, size.height, most_pixels);
  const std::int64_t count = number_at(stream, components, 2);
  constexpr std::int64_t most_components = 4;
  if (count < 1 || count > most_components)
    throw std::runtime_error(fmt::format(
        "the JPEG 2000 file has {} values a pixel: expected gray or colours, with alpha or without", count));
  constexpr std::int64_t most_tiles = 65535;
  if (size.tile_width < 1 || size.tile_height < 1 || tile_left > left || tile_top > top)
    throw damaged("JPEG 2000", "tiles beside the picture");
  const std::int64_t columns = tiles_along(right, tile_left, size.tile_width),
                     rows = tiles_along(bottom, tile_top, size.tile_height);
  if (columns > most_tiles / rows) throw damaged("JPEG 2000", "too many tiles");
  size.tiles = columns * rows;
  return size;
}

// The packets that a segment on how components are coded makes of one of so many pixels, or somewhat fewer:
// one for each precinct of each of its sizes, in every layer.
double least_packets(std::span<const std::uint8_t> stream, std::size_t at, double width, double height) {
  const bool is_for_all = number_at(stream, at, 2) == all_components;
  const std::size_t style = at + (is_for_all ? 4 : 5), halvings_at = at + (is_for_all ? 9 : 6),
                    precincts = halvings_at + 5;
  if (number_at(stream, style, 1) % 2 == 0) return 0;  // The largest there are.
  const std::int64_t halvings = number_at(stream, halvings_at, 1),
                     layers = is_for_all ? number_at(stream, at + 6, 2) : 1;
  const auto along = [](double side, std::int64_t power) {
    return std::floor(std::ldexp(side, -static_cast<int>(power)));
  };
  double count = 0;
  for (std::int64_t i = 0; i <= halvings; ++i) {
    const std::int64_t sides = number_at(stream, precincts + static_cast<std::size_t>(i), 1);
    count += along(width, halvings - i + sides % 16) * along(height, halvings - i + sides / 16);
  }
  return count * static_cast<double>(layers);
}

// Goes over segments (a marker, a length, what is in it) to the marker `stop`. OpenJPEG makes room for every
// precinct; each has a byte in the file at least.
std::size_t skip_segments(std::span<const std::uint8_t> stream, std::size_t at, std::int64_t stop,
                          std::int64_t width, std::int64_t height) {
  for (std::int64_t marker = 0; (marker = number_at(stream, at, 2)) != stop;) {
    constexpr std::int64_t any_marker = 0xFF00;
    const std::int64_t length = number_at(stream, at + 2, 2);
    if (marker < any_marker || length < 2)
      throw damaged("JPEG 2000", fmt::format("no marker at byte {} of the stream", at));
    const bool is_coding = marker == all_components || marker == one_component;
    if (is_coding && least_packets(stream, at, static_cast<double>(width), static_cast<double>(height)) >
                         static_cast<double>(stream.size()))
      throw cut_short("JPEG 2000");
    at += 2 + static_cast<std::size_t>(length);
  }
  return at;
}

// Every tile has a part at least, and a part 14 bytes: what a file claims is bounded by what it has.
void check_tiles(std::span<const std::uint8_t> stream, const Jpeg2000Size& size) {
  constexpr std::size_t least_part = 14, tile_at = 4, length_at = 6, marker_size = 2, part_header = 12;
  const auto tiles = static_cast<std::size_t>(size.tiles);
  if (stream.size() / least_part < tiles) throw cut_short("JPEG 2000");
  std::vector<bool> is_there(tiles);
  std::size_t at = skip_segments(stream, marker_size, start_of_tile, size.width, size.height);
  while (number_at(stream, at, marker_size) == start_of_tile) {
    const auto tile = static_cast<std::size_t>(number_at(stream, at + tile_at, 2));
    auto length = static_cast<std::size_t>(number_at(stream, at + length_at, 4));
    if (length == 0) length = std::max(stream.size() - at, marker_size) - marker_size;  // To the end.
    if (tile >= is_there.size() || length < least_part)
      throw damaged("JPEG 2000", fmt::format("no tile's part at byte {} of the stream", at));
    (void)skip_segments(stream, at + part_header, start_of_data, std::min(size.width, size.tile_width),
                        std::min(size.height, size.tile_height));
    is_there[tile] = true;
    at += length;
  }
  if (number_at(stream, at, marker_size) != end_of_stream)
    throw damaged("JPEG 2000", fmt::format("no marker at byte {} of the stream", at));
  if (!std::ranges::all_of(is_there, [](bool is) { return is; }))
    throw damaged("JPEG 2000", "a tile is missing");
}

}  // namespace

bool is_jpeg2000_stream(std::span<const std::uint8_t> file) {
  return number_at(file, 0, 2) == start_of_stream;
}

void check_jpeg2000(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  const auto stream = is_jpeg2000_stream(file) ? file : stream_in_boxes(file);
  if (number_at(stream, 0, 2) != start_of_stream || number_at(stream, 2, 2) != size_marker)
    throw damaged("JPEG 2000", "a stream without a size");
  check_tiles(stream, read_size(stream, most_pixels));
}

}  // namespace flexura

#include "flexura/picture/bmp_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <stdexcept>

#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

// Where the parts stand; OS/2's header has 12 bytes, that of Windows 40 or more.
constexpr std::size_t header_begin = 14, short_header = 12, usual_header = 40, fields_begin = 54;

std::int64_t bmp_number(std::span<const std::uint8_t> file, std::size_t at, std::size_t size) {
  return low_first_number(file, at, size, "BMP");
}

std::int64_t signed_number(std::span<const std::uint8_t> file, std::size_t at) {
  return static_cast<std::int32_t>(bmp_number(file, at, 4));
}

// Without a word on them 16 bits are 5 for each colour, the highest left out, and 32 are bytes.
void read_fields(std::span<const std::uint8_t> file, bool has_own, BmpHeader* header) {
  if (!has_own) {
    if (header->bits == 16) header->fields = {0x7C00, 0x3E0, 0x1F};
    if (header->bits == 32) header->fields = {0xFF0000, 0xFF00, 0xFF};
    return;
  }
  for (std::size_t c = 0; c < 3; ++c)
    header->fields[c] = static_cast<std::uint32_t>(bmp_number(file, fields_begin + 4 * c, 4));
  for (const std::uint32_t field : header->fields) {
    const std::uint32_t low = field >> static_cast<unsigned>(std::countr_zero(field) % 32);
    const bool is_one_run = field != 0 && (low & (low + 1U)) == 0;
    if (!is_one_run || static_cast<std::size_t>(std::bit_width(field)) > header->bits)
      throw std::runtime_error(
          fmt::format("the BMP file has the bit field {:#x}: expected bits in one run, within {} bits", field,
                      header->bits));
  }
}

void read_compression(std::span<const std::uint8_t> file, BmpHeader* header) {
  constexpr std::int64_t none = 0, runs_of_8 = 1, runs_of_4 = 2, bit_fields = 3;
  const std::int64_t compression = bmp_number(file, 30, 4);
  header->is_in_runs =
      (compression == runs_of_8 && header->bits == 8) || (compression == runs_of_4 && header->bits == 4);
  const bool has_fields = compression == bit_fields && (header->bits == 16 || header->bits == 32);
  if (compression != none && !header->is_in_runs && !has_fields)
    throw std::runtime_error(
        fmt::format("the BMP file has compression {} of {} bits a pixel: expected none, runs (RLE4, RLE8) or "
                    "bit fields",
                    compression, header->bits));
  read_fields(file, has_fields, header);
}

}  // namespace

BmpHeader read_bmp_header(std::span<const std::uint8_t> file) {
  BmpHeader header;
  header.pixels = static_cast<std::size_t>(bmp_number(file, 10, 4));
  const auto size = static_cast<std::size_t>(bmp_number(file, header_begin, 4));
  if (size != short_header && size < usual_header)
    throw damaged("BMP", fmt::format("a header of {} bytes", size));
  const bool is_short = size == short_header;
  header.palette = header_begin + size;
  header.palette_size = is_short ? 3 : 4;
  header.width = is_short ? bmp_number(file, 18, 2) : signed_number(file, 18);
  header.height = is_short ? bmp_number(file, 20, 2) : signed_number(file, 22);
  header.is_top_first = header.height < 0;
  header.height = std::abs(header.height);
  header.bits = static_cast<std::size_t>(bmp_number(file, is_short ? 24 : 28, 2));
  constexpr std::array<std::size_t, 6> known = {1, 4, 8, 16, 24, 32};
  if (std::ranges::count(known, header.bits) == 0)
    throw std::runtime_error(
        fmt::format("the BMP file has {} bits a pixel: expected {}", header.bits, fmt::join(known, ", ")));
  if (is_short)
    read_fields(file, false, &header);
  else
    read_compression(file, &header);
  const auto used = is_short ? 0 : static_cast<std::size_t>(bmp_number(file, 46, 4));
  const std::size_t all = header.bits <= 8 ? std::size_t{1} << header.bits : 0;
  header.palette_colors = used == 0 ? all : std::min(used, all);
  return header;
}

}  // namespace flexura

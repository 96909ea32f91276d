#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "flexura/base/source.h"
#include "flexura/picture/image_file.h"
#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

using namespace std::string_view_literals;

struct KnownKind {
  std::string_view begin;
  Picture (*read)(std::span<const std::uint8_t> file, std::size_t most_pixels);
};

Picture read_png_file(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  return read_png({reinterpret_cast<const char*>(file.data()), file.size()}, most_pixels);
}

// The rest of PNG's signature, and of JPEG 2000's, tells what a transfer as text has done to the file: the
// libraries say so.
constexpr std::array known_kinds = {KnownKind{"\x89PNG"sv, read_png_file},
                                    KnownKind{"\xFF\xD8\xFF"sv, read_jpeg},
                                    KnownKind{"\0\0\0\x0CjP  "sv, read_jpeg2000},
                                    KnownKind{"\xFF\x4F\xFF\x51"sv, read_jpeg2000},
                                    KnownKind{"II*\0"sv, read_tiff},
                                    KnownKind{"MM\0*"sv, read_tiff},
                                    KnownKind{"II+\0"sv, read_tiff},
                                    KnownKind{"MM\0+"sv, read_tiff},
                                    KnownKind{"P7\n"sv, read_pam},
                                    KnownKind{"P7\r"sv, read_pam},
                                    KnownKind{"BM"sv, read_bmp},
                                    KnownKind{"\x59\xA6\x6A\x95"sv, read_sun_raster}};

constexpr std::string_view blanks = " \t\n\v\f\r"sv;

bool is_pnm(std::string_view text) {
  return text.size() > 2 && text[0] == 'P' && text[1] >= '1' && text[1] <= '6' &&
         (text[2] == '#' || blanks.find(text[2]) != std::string_view::npos);
}

// RIFF holds sound and films too; four bytes of it tell its length.
bool is_webp(std::string_view text) {
  constexpr std::size_t kind = 8;
  return text.starts_with("RIFF") && text.size() > kind && text.substr(kind).starts_with("WEBP");
}

// Pictures, but not of whole values, or not for us: their names help more than "not a picture".
std::string_view other_kind(std::string_view text) {
  const bool is_pfm = text.size() > 2 && (text.starts_with("PF") || text.starts_with("Pf")) &&
                      blanks.find(text[2]) != std::string_view::npos;
  if (is_pfm) return "PFM";
  if (text.starts_with("\x76\x2F\x31\x01")) return "OpenEXR";
  if (text.starts_with("#?RADIANCE") || text.starts_with("#?RGBE")) return "Radiance HDR";
  return {};
}

// Told apart by the first bytes: a file's name says nothing.
Picture read_any(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (text.empty()) throw std::runtime_error("the file is empty");
  for (const KnownKind& kind : known_kinds)
    if (text.starts_with(kind.begin)) return kind.read(file, most_pixels);
  if (is_pnm(text)) return read_pnm(file, most_pixels);
  if (is_webp(text)) return read_webp(file, most_pixels);
  if (const std::string_view other = other_kind(text); !other.empty())
    throw std::runtime_error(fmt::format(
        "the {} file has floating point values: expected a kind of file with whole ones of 1 to 16 bits",
        other));
  throw std::runtime_error(
      "not a picture that can be read: expected PNG, JPEG, JPEG 2000, TIFF, WebP, PNM, PAM, BMP or Sun "
      "raster");
}

}  // namespace

Picture read_picture(std::span<const std::uint8_t> file, const std::string& name, std::size_t most_pixels) {
  try {
    return read_any(file, most_pixels);
  } catch (const std::runtime_error& error) {
    throw input_error(name, error.what());
  }
}

void check_picture_size(std::int64_t width, std::int64_t height, std::size_t most_pixels) {
  if (width < 1 || height < 1)
    throw std::runtime_error(fmt::format("{} x {} px: expected one pixel at least", width, height));
  if (static_cast<std::size_t>(width) > most_pixels / static_cast<std::size_t>(height))
    throw std::runtime_error(fmt::format("{} x {} px: expected at most {} px", width, height, most_pixels));
}

std::runtime_error cut_short(std::string_view kind) {
  return std::runtime_error(fmt::format("the {} file is cut short", kind));
}

std::runtime_error damaged(std::string_view kind, std::string_view text) {
  std::string line(text);
  std::ranges::replace_if(line, [](char c) { return c < ' ' || c > '~'; }, '?');
  return std::runtime_error(
      fmt::format("the {} file is damaged, or of a sort that cannot be read: {}", kind, line));
}

std::int64_t low_first_number(std::span<const std::uint8_t> file, std::size_t at, std::size_t size,
                              std::string_view kind) {
  if (at > file.size() || file.size() - at < size) throw cut_short(kind);
  std::int64_t value = 0;
  for (std::size_t i = size; i > 0; --i) value = value * 256 + file[at + i - 1];
  return value;
}

std::int64_t high_first_number(std::span<const std::uint8_t> file, std::size_t at, std::size_t size,
                               std::string_view kind) {
  if (at > file.size() || file.size() - at < size) throw cut_short(kind);
  std::int64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value * 256 + file[at + i];
  return value;
}

Image<std::uint8_t> painted(Image<std::uint8_t> indices, const Palette& palette) {
  const bool is_gray = std::ranges::all_of(
      palette, [](const auto& color) { return color[0] == color[1] && color[1] == color[2]; });
  if (is_gray) {
    for (std::uint8_t& value : indices.values()) value = palette[value][0];
    return indices;
  }
  Image<std::uint8_t> colors(indices.width(), indices.height(), 3);
  std::uint8_t* to = colors.values().data();
  for (const std::uint8_t index : indices.values()) to = std::ranges::copy(palette[index], to).out;
  return colors;
}

}  // namespace flexura

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "flexura/base/source.h"
#include "flexura/picture/image_file.h"
#include "flexura/picture/orientation.h"
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

// The rest of PNG's signature detects a transfer in text mode, which libpng reports.
constexpr std::array known_kinds = {
    KnownKind{"\x89PNG"sv, read_png_file}, KnownKind{"\xFF\xD8\xFF"sv, read_jpeg},
    KnownKind{"II*\0"sv, read_tiff},       KnownKind{"MM\0*"sv, read_tiff},
    KnownKind{"II+\0"sv, read_tiff},       KnownKind{"MM\0+"sv, read_tiff}};

bool is_pnm(std::string_view text) {
  constexpr std::string_view blanks = " \t\n\v\f\r"sv;
  return text.size() > 2 && text[0] == 'P' && text[1] >= '1' && text[1] <= '6' &&
         (text[2] == '#' || blanks.find(text[2]) != std::string_view::npos);
}

struct OtherKind {
  std::string_view begin, name;
  std::size_t at = 0;
};

// Kinds of pictures that are not supported, which the error message names.
constexpr std::array other_kinds = {OtherKind{"\0\0\0\x0CjP  "sv, "JPEG 2000"},
                                    OtherKind{"\xFF\x4F\xFF\x51"sv, "JPEG 2000"},
                                    OtherKind{"WEBPVP8"sv, "WebP", 8},
                                    OtherKind{"P7\n"sv, "PAM"},
                                    OtherKind{"BM"sv, "BMP"},
                                    OtherKind{"\x59\xA6\x6A\x95"sv, "Sun raster"},
                                    OtherKind{"PF\n"sv, "PFM"},
                                    OtherKind{"Pf\n"sv, "PFM"},
                                    OtherKind{"\x76\x2F\x31\x01"sv, "OpenEXR"},
                                    OtherKind{"#?RADIANCE"sv, "Radiance HDR"},
                                    OtherKind{"#?RGBE"sv, "Radiance HDR"}};

// The first bytes identify the kind; the file's name does not matter.
Picture read_any(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (text.empty()) throw std::runtime_error("the file is empty");
  for (const KnownKind& kind : known_kinds)
    if (text.starts_with(kind.begin)) return upright(kind.read(file, most_pixels), orientation_in(file));
  if (is_pnm(text)) return read_pnm(file, most_pixels);
  for (const OtherKind& kind : other_kinds)
    if (text.substr(std::min(kind.at, text.size())).starts_with(kind.begin))
      throw std::runtime_error(
          fmt::format("{} files are not read: expected PNG, JPEG, TIFF or PNM", kind.name));
  throw std::runtime_error("not a picture that can be read: expected PNG, JPEG, TIFF or PNM");
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
    throw std::runtime_error(fmt::format("{} x {} px: expected at least one pixel", width, height));
  if (static_cast<std::size_t>(width) > most_pixels / static_cast<std::size_t>(height))
    throw std::runtime_error(fmt::format("{} x {} px: expected at most {} px", width, height, most_pixels));
}

std::runtime_error cut_short(std::string_view kind) {
  return std::runtime_error(fmt::format("the {} file is truncated", kind));
}

std::runtime_error damaged(std::string_view kind, std::string_view text) {
  std::string line(text);
  std::ranges::replace_if(line, [](char c) { return c < ' ' || c > '~'; }, '?');
  return std::runtime_error(
      fmt::format("the {} file is damaged, or of a kind that is not supported: {}", kind, line));
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

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "flexura/base/source.h"
#include "flexura/picture/image_file.h"
#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

// Told apart by the first bytes: a file's name says nothing.
Picture read_any(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (text.empty()) throw std::runtime_error("the file is empty");
  // The rest of PNG's signature tells what a transfer as text has done to the file: libpng says so.
  if (text.starts_with("\x89PNG")) return read_png(text, most_pixels);
  if (text.starts_with("\xFF\xD8\xFF")) return read_jpeg(file, most_pixels);
  using namespace std::string_view_literals;
  for (const std::string_view tiff : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv})
    if (text.starts_with(tiff)) return read_tiff(file, most_pixels);
  if (text.size() > 2 && text[0] == 'P' && text[1] >= '1' && text[1] <= '6' &&
      " \t\n\v\f\r#"sv.find(text[2]) != std::string_view::npos)
    return read_pnm(file, most_pixels);
  if (text.starts_with("BM")) return read_bmp(file, most_pixels);
  throw std::runtime_error("not a picture that can be read: expected PNG, JPEG, TIFF, PNM or BMP");
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

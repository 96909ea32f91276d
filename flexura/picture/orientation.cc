#include "flexura/picture/orientation.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>
#include <variant>

namespace flexura {
namespace {

using Bytes = std::span<const std::uint8_t>;

std::string_view text_at(Bytes bytes, std::size_t at, std::size_t size) {
  if (at > bytes.size() || bytes.size() - at < size) return {};
  return {reinterpret_cast<const char*>(bytes.data()) + at, size};
}

// Unsigned numbers of 2 or 4 bytes; 0 beyond the end.
std::size_t number_at(Bytes bytes, std::size_t at, std::size_t size, bool is_little) {
  if (at > bytes.size() || bytes.size() - at < size) return 0;
  std::size_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8U | bytes[at + (is_little ? size - 1 - i : i)];
  return value;
}

// Of the first directory of a TIFF structure, which EXIF data use, too.
int orientation_in_tiff(Bytes tiff) {
  constexpr std::size_t orientation_tag = 274, short_kind = 3, entry_size = 12;
  const std::string_view order = text_at(tiff, 0, 2);
  const bool is_little = order == "II";
  if ((!is_little && order != "MM") || number_at(tiff, 2, 2, is_little) != 42) return 1;
  const std::size_t start = number_at(tiff, 4, 4, is_little), count = number_at(tiff, start, 2, is_little);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t entry = start + 2 + entry_size * i;
    if (number_at(tiff, entry, 2, is_little) != orientation_tag) continue;
    const std::size_t value = number_at(tiff, entry + 8, 2, is_little);
    const bool is_valid = number_at(tiff, entry + 2, 2, is_little) == short_kind && value >= 1 && value <= 8;
    return is_valid ? static_cast<int>(value) : 1;
  }
  return 1;
}

int orientation_in_jpeg(Bytes file) {
  constexpr std::string_view exif("Exif\0\0", 6);
  constexpr std::uint8_t mark = 0xFF, application_1 = 0xE1, scan = 0xDA;
  for (std::size_t at = 2; at + 4 <= file.size() && file[at] == mark;) {
    const std::uint8_t kind = file[at + 1];
    if (kind == mark) {
      ++at;  // A fill byte.
      continue;
    }
    const std::size_t size = number_at(file, at + 2, 2, false);
    if (kind == scan || size < 2) break;
    const std::size_t end = std::min(file.size(), at + 2 + size);
    if (kind == application_1 && text_at(file, at + 4, exif.size()) == exif && end > at + 4 + exif.size())
      return orientation_in_tiff(file.subspan(at + 4 + exif.size(), end - at - 4 - exif.size()));
    at += 2 + size;
  }
  return 1;
}

int orientation_in_png(Bytes file) {
  constexpr std::size_t head = 8, around = 12;  // A chunk has length, name and checksum.
  for (std::size_t at = head; at < file.size() && file.size() - at >= around;) {
    const std::size_t size = number_at(file, at, 4, false);
    if (size > file.size() - at - around) break;
    if (text_at(file, at + 4, 4) == "eXIf") return orientation_in_tiff(file.subspan(at + 8, size));
    at += around + size;
  }
  return 1;
}

template <typename Value>
Image<Value> turned(const Image<Value>& stored, int orientation) {
  // From 5 on, the file's rows are the picture's columns.
  const bool is_swapped = orientation >= 5;
  const int width = is_swapped ? stored.height() : stored.width(),
            height = is_swapped ? stored.width() : stored.height(), channels = stored.channels();
  const bool is_right_first = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7,
             is_bottom_first = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
  Image<Value> picture(width, height, channels);
  for (int v = 0; v < height; ++v) {
    Value* to = picture.row(v).data();
    for (int u = 0; u < width; ++u) {
      const int x = is_right_first ? width - 1 - u : u, y = is_bottom_first ? height - 1 - v : v;
      const Value* from = stored.row(is_swapped ? x : y).data() +
                          static_cast<std::ptrdiff_t>(channels) * (is_swapped ? y : x);
      to = std::copy_n(from, channels, to);
    }
  }
  return picture;
}

}  // namespace

int orientation_in(Bytes file) {
  if (text_at(file, 0, 3) == "\xFF\xD8\xFF") return orientation_in_jpeg(file);
  if (text_at(file, 0, 4) == "\x89PNG") return orientation_in_png(file);
  return orientation_in_tiff(file);
}

Picture upright(Picture picture, int orientation) {
  if (orientation == 1) return picture;
  return std::visit([&](const auto& image) -> Picture { return turned(image, orientation); }, picture);
}

}  // namespace flexura

#pragma once

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "flexura/base/image.h"
#include "flexura/picture/image_file.h"

namespace flexura {

/// Returns EXIF data, a TIFF structure with one tag: the orientation.
inline std::string exif_orientation(int orientation, bool is_little) {
  const auto number = [&](std::size_t value, std::size_t size) {
    std::string bytes;
    for (std::size_t i = 0; i < size; ++i)
      bytes += static_cast<char>(value >> (8 * (is_little ? i : size - 1 - i)) & 0xFFU);
    return bytes;
  };
  return (is_little ? "II" : "MM") + number(42, 2) + number(8, 4) + number(1, 2) + number(274, 2) +
         number(3, 2) + number(1, 4) + number(static_cast<std::size_t>(orientation), 2) + number(0, 2) +
         number(0, 4);
}

/// Returns the picture as a JPEG file that states the orientation.
inline std::string oriented_jpeg(const Image<std::uint8_t>& picture, int orientation, bool is_little = true) {
  const std::string file = jpeg(picture, {.quality = 95});
  const std::string data = std::string("Exif\0\0", 6) + exif_orientation(orientation, is_little);
  const std::size_t size = data.size() + 2;
  return file.substr(0, 2) + "\xFF\xE1" + static_cast<char>(size >> 8U) + static_cast<char>(size & 0xFFU) +
         data + file.substr(2);
}

/// Returns the picture as a PNG file that states the orientation.
inline std::string oriented_png(const Image<std::uint8_t>& picture, int orientation, bool is_little = true) {
  constexpr std::size_t after_header = 33;
  const std::string file = png(picture), chunk = "eXIf" + exif_orientation(orientation, is_little);
  const auto number = [](std::uint32_t value) {
    std::string bytes;
    for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>(value >> shift & 0xFFU);
    return bytes;
  };
  const auto sum = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(chunk.data()), static_cast<uInt>(chunk.size())));
  return file.substr(0, after_header) + number(static_cast<std::uint32_t>(chunk.size() - 4)) + chunk +
         number(sum) + file.substr(after_header);
}

}  // namespace flexura

#pragma once

#include <gtest/gtest.h>
#include <png.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>
// jpeglib.h requires FILE and size_t to be declared before it.
#include <jpeglib.h>

#include "flexura/base/image.h"
#include "tests/support/random_cases.h"

// Picture files in every supported format, written by the libraries or byte by byte.
namespace flexura {

using Colors = std::vector<std::array<std::uint8_t, 3>>;

inline std::span<const std::uint8_t> file_bytes(const std::string& file) {
  return {reinterpret_cast<const std::uint8_t*>(file.data()), file.size()};
}

/// Returns a picture of random values from 0 to `most`.
template <typename T>
Image<T> random_values(TestRandom& random, int width, int height, int channels, int most) {
  Image<T> image(width, height, channels);
  for (T& value : image.values()) value = static_cast<T>(random.integer(0, most));
  return image;
}

/// Returns a smooth gray or colour picture, which JPEG compression nearly preserves.
inline Image<std::uint8_t> smooth_picture(int width, int height, int channels) {
  Image<std::uint8_t> image(width, height, channels);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      for (int c = 0; c < channels; ++c)
        image.at(u, v, c) = static_cast<std::uint8_t>(60 + (2 * u + v + 20 * c) % 160);
  return image;
}

/// Packs a row's values of `bits` each, most significant bit first; words are little-endian.
template <typename T>
std::string packed(std::span<const T> values, int bits) {
  std::string row((values.size() * static_cast<std::size_t>(bits) + 7) / 8, '\0');
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t bit = i * static_cast<std::size_t>(bits);
    if (bits == 16) {
      row[2 * i] = static_cast<char>(values[i] & 0xFF);
      row[2 * i + 1] = static_cast<char>(values[i] >> 8);
    } else {
      for (std::size_t b = bit; b < bit + static_cast<std::size_t>(bits); ++b)
        if ((values[i] >> (bit + static_cast<std::size_t>(bits) - 1 - b) & 1) == 1)
          row[b / 8] = static_cast<char>(row[b / 8] | 0x80 >> b % 8);
    }
  }
  return row;
}

struct PngForm {
  int bits = 8;
  bool is_interlaced = false;
  Colors palette = {};
};

/// Writes a PNG file: gray, gray and alpha, RGB, or RGB and alpha by the number of channels. With a palette
/// the values are its indices.
template <typename T>
std::string png_file(const Image<T>& image, const PngForm& form) {
  constexpr std::array<int, 5> kinds = {0, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                        PNG_COLOR_TYPE_RGB_ALPHA};
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &file,
      [](png_structp writer, png_bytep data, png_size_t size) {
        static_cast<std::string*>(png_get_io_ptr(writer))->append(reinterpret_cast<char*>(data), size);
      },
      [](png_structp) {});
  png_set_IHDR(
      png, info, static_cast<png_uint_32>(image.width()), static_cast<png_uint_32>(image.height()), form.bits,
      form.palette.empty() ? kinds[static_cast<std::size_t>(image.channels())] : PNG_COLOR_TYPE_PALETTE,
      form.is_interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
      PNG_FILTER_TYPE_DEFAULT);
  std::vector<png_color> colors;
  for (const auto& [red, green, blue] : form.palette) colors.push_back({red, green, blue});
  if (!colors.empty()) png_set_PLTE(png, info, colors.data(), static_cast<int>(colors.size()));
  png_write_info(png, info);
  if (form.bits == 16) png_set_swap(png);
  std::vector<std::string> rows;
  std::vector<png_bytep> places;
  for (int v = 0; v < image.height(); ++v) rows.push_back(packed<T>(image.row(v), form.bits));
  for (std::string& row : rows) places.push_back(reinterpret_cast<png_bytep>(row.data()));
  png_write_image(png, places.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return file;
}

/// Writes a JPEG file: one channel for gray, three for RGB, four for CMYK (YCCK if `is_luma`).
inline std::string jpeg_file(const Image<std::uint8_t>& image, bool is_progressive, bool is_luma = false) {
  constexpr std::array<J_COLOR_SPACE, 5> spaces = {JCS_UNKNOWN, JCS_GRAYSCALE, JCS_UNKNOWN, JCS_RGB,
                                                   JCS_CMYK};
  jpeg_compress_struct job{};
  jpeg_error_mgr errors{};
  job.err = jpeg_std_error(&errors);
  jpeg_create_compress(&job);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&job, &bytes, &size);
  job.image_width = static_cast<JDIMENSION>(image.width());
  job.image_height = static_cast<JDIMENSION>(image.height());
  job.input_components = image.channels();
  job.in_color_space = spaces[static_cast<std::size_t>(image.channels())];
  jpeg_set_defaults(&job);
  if (is_luma && image.channels() == 4) jpeg_set_colorspace(&job, JCS_YCCK);
  jpeg_set_quality(&job, 95, TRUE);
  if (is_progressive) jpeg_simple_progression(&job);
  jpeg_start_compress(&job, TRUE);
  while (job.next_scanline < job.image_height) {
    auto* row = const_cast<JSAMPROW>(image.row(static_cast<int>(job.next_scanline)).data());
    jpeg_write_scanlines(&job, &row, 1);
  }
  jpeg_finish_compress(&job);
  jpeg_destroy_compress(&job);
  std::string file(reinterpret_cast<char*>(bytes), size);
  std::free(bytes);
  return file;
}

struct TiffForm {
  int bits = 8;
  int compression = COMPRESSION_NONE;
  int photometric = PHOTOMETRIC_MINISBLACK;
  int tile = 0;  ///< Tile size, px; 0 for strips of `rows` rows.
  int rows = 5;
  bool is_separate = false;
  bool is_high_first = false;
  Colors palette = {};
};

/// An in-memory file for libtiff's I/O callbacks.
struct TiffMemory {
  std::string bytes;
  std::size_t at = 0;

  static tmsize_t read(thandle_t handle, void* data, tmsize_t size) {
    auto& file = *static_cast<TiffMemory*>(handle);
    const std::size_t count = std::min(static_cast<std::size_t>(size), file.bytes.size() - file.at);
    std::memcpy(data, file.bytes.data() + file.at, count);
    file.at += count;
    return static_cast<tmsize_t>(count);
  }
  static tmsize_t write(thandle_t handle, void* data, tmsize_t size) {
    auto& file = *static_cast<TiffMemory*>(handle);
    const auto count = static_cast<std::size_t>(size);
    file.bytes.resize(std::max(file.bytes.size(), file.at + count));
    std::memcpy(file.bytes.data() + file.at, data, count);
    file.at += count;
    return size;
  }
  static toff_t seek(thandle_t handle, toff_t offset, int from) {
    auto& file = *static_cast<TiffMemory*>(handle);
    file.at = offset + (from == SEEK_CUR ? file.at : from == SEEK_END ? file.bytes.size() : 0);
    return file.at;
  }
  static int close(thandle_t) { return 0; }
  static toff_t size(thandle_t handle) { return static_cast<TiffMemory*>(handle)->bytes.size(); }
};

/// Returns the values of a block of the picture, padded with zeros; of one channel if `plane` is not
/// negative.
template <typename T>
std::string tiff_block(const Image<T>& image, int u0, int v0, int width, int height, int plane, int bits) {
  std::string block;
  for (int v = v0; v < v0 + height; ++v) {
    std::vector<T> row;
    for (int u = u0; u < u0 + width; ++u)
      for (int c = std::max(0, plane); c <= (plane < 0 ? image.channels() - 1 : plane); ++c)
        row.push_back(u < image.width() && v < image.height() ? image.at(u, v, c) : T{0});
    block += packed<T>(row, bits);
  }
  return block;
}

template <typename T>
std::string tiff_file(const Image<T>& image, const TiffForm& form) {
  TiffMemory file;
  TIFF* open =
      TIFFClientOpen("memory", form.is_high_first ? "wmb" : "wml", &file, TiffMemory::read, TiffMemory::write,
                     TiffMemory::seek, TiffMemory::close, TiffMemory::size, nullptr, nullptr);
  TIFFSetField(open, TIFFTAG_IMAGEWIDTH, image.width());
  TIFFSetField(open, TIFFTAG_IMAGELENGTH, image.height());
  TIFFSetField(open, TIFFTAG_BITSPERSAMPLE, form.bits);
  TIFFSetField(open, TIFFTAG_SAMPLESPERPIXEL, image.channels());
  TIFFSetField(open, TIFFTAG_PHOTOMETRIC, form.photometric);
  TIFFSetField(open, TIFFTAG_PLANARCONFIG, form.is_separate ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
  TIFFSetField(open, TIFFTAG_COMPRESSION, form.compression);
  if (form.photometric == PHOTOMETRIC_YCBCR && form.compression == COMPRESSION_JPEG)
    TIFFSetField(open, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  else if (form.photometric == PHOTOMETRIC_YCBCR)
    TIFFSetField(open, TIFFTAG_YCBCRSUBSAMPLING, 1, 1);
  const std::uint16_t alpha = EXTRASAMPLE_UNASSALPHA;
  if (image.channels() % 2 == 0 && form.photometric != PHOTOMETRIC_SEPARATED)
    TIFFSetField(open, TIFFTAG_EXTRASAMPLES, 1, &alpha);
  std::array<std::vector<std::uint16_t>, 3> map;
  for (std::size_t c = 0; c < 3; ++c) {
    for (const auto& color : form.palette) map[c].push_back(static_cast<std::uint16_t>(color[c] * 257));
    map[c].resize(std::size_t{1} << form.bits);
  }
  if (!form.palette.empty())
    TIFFSetField(open, TIFFTAG_COLORMAP, map[0].data(), map[1].data(), map[2].data());
  const bool is_tiled = form.tile > 0;
  if (is_tiled) {
    TIFFSetField(open, TIFFTAG_TILEWIDTH, form.tile);
    TIFFSetField(open, TIFFTAG_TILELENGTH, form.tile);
  } else {
    TIFFSetField(open, TIFFTAG_ROWSPERSTRIP, form.rows);
  }
  const int width = is_tiled ? form.tile : image.width(), height = is_tiled ? form.tile : form.rows;
  std::uint32_t number = 0;
  for (int plane = form.is_separate ? 0 : -1; plane < (form.is_separate ? image.channels() : 0); ++plane)
    for (int v = 0; v < image.height(); v += height)
      for (int u = 0; u < image.width(); u += width, ++number) {
        const int rows = is_tiled ? height : std::min(height, image.height() - v);
        std::string block = tiff_block(image, u, v, width, rows, plane, form.bits);
        const auto size = static_cast<tmsize_t>(block.size());
        EXPECT_EQ(is_tiled ? TIFFWriteEncodedTile(open, number, block.data(), size)
                           : TIFFWriteEncodedStrip(open, number, block.data(), size),
                  size);
      }
  TIFFClose(open);
  return file.bytes;
}

/// Writes P2 or P3 if `is_plain`, otherwise P5 or P6, with a comment.
template <typename T>
std::string pnm_file(const Image<T>& image, int most, bool is_plain) {
  std::string file = "P" + std::to_string((is_plain ? 2 : 5) + (image.channels() == 3 ? 1 : 0)) +
                     "\n# made \n" + std::to_string(image.width()) + " " + std::to_string(image.height()) +
                     "\n" + std::to_string(most) + "\n";
  for (const T value : image.values()) {
    if (is_plain) file += std::to_string(value) + "\n";
    if (!is_plain && most > 255) file += static_cast<char>(value >> 8);
    if (!is_plain) file += static_cast<char>(value & 0xFF);
  }
  return file;
}

/// Writes P1 if `is_plain`, otherwise P4, from values 0 (white) and 1.
inline std::string pbm_file(const Image<std::uint8_t>& image, bool is_plain) {
  std::string file = std::string(is_plain ? "P1" : "P4") + "\n# made\n" + std::to_string(image.width()) +
                     " " + std::to_string(image.height()) + "\n";
  for (int v = 0; v < image.height(); ++v) {
    if (!is_plain) file += packed<std::uint8_t>(image.row(v), 1);
    for (const std::uint8_t value : image.row(v))
      if (is_plain) file += value == 1 ? '1' : '0';
  }
  return file;
}

}  // namespace flexura

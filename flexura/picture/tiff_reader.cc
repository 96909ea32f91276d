#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include "flexura/picture/picture_kinds.h"
#include "flexura/picture/tiff_input.h"

namespace flexura {
namespace {

// Layout of a TIFF picture. Its blocks are strips of the picture's width or tiles. The channels are in one
// plane, or each channel in its own plane.
struct TiffLayout {
  std::uint32_t width = 0, height = 0, block_width = 0, block_height = 0;
  std::uint16_t bits = 1, samples = 1, photometric = 0;
  bool is_tiled = false, is_separate = false;
  std::size_t row_size = 0, block_size = 0;  // Bytes.

  [[nodiscard]] std::size_t samples_in_block() const { return is_separate ? 1 : samples; }
  // Whether libtiff converts the colours.
  [[nodiscard]] bool is_mixed() const {
    return bits == 8 && (photometric == PHOTOMETRIC_SEPARATED || photometric == PHOTOMETRIC_YCBCR ||
                         photometric == PHOTOMETRIC_CIELAB);
  }
  [[nodiscard]] int channels() const { return photometric == PHOTOMETRIC_RGB ? 3 : 1; }
};

template <typename Number>
Number field(TIFF* open, std::uint32_t tag, Number otherwise) {
  Number value{};
  return TIFFGetFieldDefaulted(open, tag, &value) == 1 ? value : otherwise;
}

[[noreturn]] void refuse_tiff(const std::string& what, const char* expected) {
  throw std::runtime_error("the TIFF file has " + what + ": expected " + expected);
}

void read_values(TIFF* open, TiffLayout* layout) {
  layout->bits = field<std::uint16_t>(open, TIFFTAG_BITSPERSAMPLE, 1);
  layout->samples = field<std::uint16_t>(open, TIFFTAG_SAMPLESPERPIXEL, 1);
  layout->is_separate =
      layout->samples > 1 && field<std::uint16_t>(open, TIFFTAG_PLANARCONFIG, 0) == PLANARCONFIG_SEPARATE;
  const auto format = field<std::uint16_t>(open, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  const bool is_whole = format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID;
  constexpr std::array<std::uint16_t, 8> known = {1, 2, 4, 8, 10, 12, 14, 16};
  if (is_whole && std::ranges::count(known, layout->bits) == 1) return;
  const char* name = is_whole ? "" : "signed ";
  if (format == SAMPLEFORMAT_IEEEFP) name = "floating point ";
  refuse_tiff(fmt::format("{}values of {} bits", name, layout->bits),
              "unsigned integers of 1, 2, 4, 8, 10, 12, 14 or 16 bits");
}

// Reads the format of the values and checks that it is supported.
void read_form(TIFF* open, TiffLayout* layout) {
  const auto compression = field<std::uint16_t>(open, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  // JBIG is not supported, because libjbig ends the whole program if memory is exhausted. The old JPEG
  // compression is ambiguous.
  if (TIFFIsCODECConfigured(compression) == 0 || compression == COMPRESSION_JBIG ||
      compression == COMPRESSION_OJPEG)
    refuse_tiff(fmt::format("compression {}", compression), "a common compression");
  read_values(open, layout);
  layout->photometric = field<std::uint16_t>(open, TIFFTAG_PHOTOMETRIC,
                                             layout->samples < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
  // libtiff converts the YCbCr colours of JPEG to red, green and blue.
  if (layout->photometric == PHOTOMETRIC_YCBCR && compression == COMPRESSION_JPEG && !layout->is_separate &&
      TIFFSetField(open, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB) == 1)
    layout->photometric = PHOTOMETRIC_RGB;
  if (layout->photometric > PHOTOMETRIC_PALETTE && !layout->is_mixed())
    refuse_tiff(fmt::format("colours of kind {}", layout->photometric),
                "gray, RGB, a palette, or CMYK, YCbCr or CIELab of 8 bits");
  constexpr int most_samples = 8;  // Red, green, blue, and ignored channels.
  if (layout->samples < layout->channels() || layout->samples > most_samples ||
      (layout->bits < 8 && layout->samples > 1) ||
      (layout->bits > 8 && layout->photometric == PHOTOMETRIC_PALETTE))
    refuse_tiff(fmt::format("{} values of {} bits per pixel", layout->samples, layout->bits),
                "gray, RGB or a palette");
}

void read_blocks(TIFF* open, TiffLayout* layout, std::size_t most_pixels) {
  layout->is_tiled = TIFFIsTiled(open) != 0;
  layout->block_width = layout->is_tiled ? field<std::uint32_t>(open, TIFFTAG_TILEWIDTH, 0) : layout->width;
  layout->block_height = layout->is_tiled
                             ? field<std::uint32_t>(open, TIFFTAG_TILELENGTH, 0)
                             : std::min(layout->height, field<std::uint32_t>(open, TIFFTAG_ROWSPERSTRIP, 0));
  check_picture_size(layout->block_width, layout->block_height, most_pixels);
  if (layout->is_mixed()) return;  // Such files can have fewer values than pixels.
  layout->row_size = (layout->block_width * layout->samples_in_block() * layout->bits + 7) / 8;
  layout->block_size = layout->row_size * layout->block_height;
  const auto size = static_cast<std::size_t>(layout->is_tiled ? TIFFTileSize64(open) : TIFFStripSize64(open));
  if (size != layout->block_size) throw damaged("TIFF", "the size of a block does not match its pixels");
}

// Returns a value of 1 to 14 bits, stored with the highest bit first, or of 16 bits in this machine's byte
// order, which libtiff provides.
template <typename Value>
Value value_in(const std::uint8_t* row, std::size_t index, std::size_t bits) {
  Value value{};
  if (bits == 8 || bits == 16) {
    std::memcpy(&value, row + index * sizeof(Value), sizeof(Value));
  } else if (bits > 8) {
    // All bit counts here are even. A value occupies two bytes, or three if it begins late in the first byte.
    const std::size_t at = index * bits, end = at % 8 + bits;
    auto window = static_cast<std::uint32_t>(row[at / 8] << 16U | row[at / 8 + 1] << 8U);
    if (end > 16) window |= row[at / 8 + 2];
    value = static_cast<Value>(window >> (24 - end) & ((1U << bits) - 1U));
  } else {
    const std::size_t at = index * bits;
    value = static_cast<Value>(row[at / 8] >> (8 - bits - at % 8) & ((1U << bits) - 1U));
  }
  return value;
}

template <typename Value>
Image<Value> values_of(TIFF* open, const TiffLayout& layout, const TiffInput& input) {
  Image<Value> image(static_cast<int>(layout.width), static_cast<int>(layout.height), layout.channels());
  std::vector<std::uint8_t> block(layout.block_size);
  const int planes = layout.is_separate ? layout.channels() : 1,
            in_plane = layout.is_separate ? 1 : layout.channels();
  const auto read_block = [&](std::uint32_t u, std::uint32_t v, std::uint16_t plane) {
    const auto size = static_cast<tmsize_t>(block.size());
    return layout.is_tiled
               ? TIFFReadEncodedTile(open, TIFFComputeTile(open, u, v, 0, plane), block.data(), size)
               : TIFFReadEncodedStrip(open, TIFFComputeStrip(open, v, plane), block.data(), size);
  };
  const auto copy_block = [&](std::uint32_t u0, std::uint32_t v0, std::uint32_t rows, int plane) {
    const std::uint32_t columns = std::min(layout.block_width, layout.width - u0);
    for (std::uint32_t v = 0; v < rows; ++v)
      for (std::uint32_t u = 0; u < columns; ++u)
        for (int c = 0; c < in_plane; ++c)
          image.at(static_cast<int>(u0 + u), static_cast<int>(v0 + v), plane + c) =
              value_in<Value>(block.data() + v * layout.row_size,
                              u * layout.samples_in_block() + static_cast<std::size_t>(c), layout.bits);
  };
  for (int plane = 0; plane < planes; ++plane)
    for (std::uint32_t v = 0; v < layout.height; v += std::min(layout.block_height, layout.height - v))
      for (std::uint32_t u = 0; u < layout.width; u += std::min(layout.block_width, layout.width - u)) {
        const std::uint32_t rows = std::min(layout.block_height, layout.height - v);
        if (read_block(u, v, static_cast<std::uint16_t>(plane)) <
            static_cast<tmsize_t>(rows * layout.row_size))
          throw input.problem();
        copy_block(u, v, rows, plane);
      }
  return image;
}

// Converts gray values of 1 to 16 bits to 8-bit or 16-bit values. In the file, 0 may be black or white.
template <typename Value>
void make_gray(Image<Value>* image, const TiffLayout& layout) {
  const int most = (1 << layout.bits) - 1, scale = sizeof(Value) == 1 ? 255 / most : 1;
  const bool is_turned = layout.photometric == PHOTOMETRIC_MINISWHITE;
  for (Value& value : image->values()) value = static_cast<Value>((is_turned ? most - value : value) * scale);
}

Palette palette_of(TIFF* open, const TiffLayout& layout) {
  const std::uint16_t *red = nullptr, *green = nullptr, *blue = nullptr;
  if (TIFFGetField(open, TIFFTAG_COLORMAP, &red, &green, &blue) != 1) throw damaged("TIFF", "no palette");
  Palette palette{};
  for (std::size_t i = 0; i < std::size_t{1} << layout.bits; ++i)
    palette[i] = {static_cast<std::uint8_t>(red[i] >> 8U), static_cast<std::uint8_t>(green[i] >> 8U),
                  static_cast<std::uint8_t>(blue[i] >> 8U)};
  return palette;
}

}  // namespace

Picture read_tiff(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  // Tiles may extend beyond the picture, and libtiff stores a block together with its compressed bytes.
  constexpr std::size_t usual_tile = std::size_t{1} << 20U, most_pixel_bytes = 16;
  const std::size_t most_block = std::max(most_pixels, usual_tile);
  TiffInput input{file};
  const OpenTiff open = open_tiff(&input, most_block * most_pixel_bytes + file.size());
  TiffLayout layout;
  layout.width = field<std::uint32_t>(open.get(), TIFFTAG_IMAGEWIDTH, 0);
  layout.height = field<std::uint32_t>(open.get(), TIFFTAG_IMAGELENGTH, 0);
  check_picture_size(layout.width, layout.height, most_pixels);
  read_form(open.get(), &layout);
  read_blocks(open.get(), &layout, most_block);
  if (layout.is_mixed()) return read_mixed_tiff(open.get(), input);
  if (layout.bits > 8) {
    auto image = values_of<std::uint16_t>(open.get(), layout, input);
    if (layout.channels() == 1) make_gray(&image, layout);
    return image;
  }
  auto image = values_of<std::uint8_t>(open.get(), layout, input);
  if (layout.photometric == PHOTOMETRIC_PALETTE)
    return painted(std::move(image), palette_of(open.get(), layout));
  if (layout.channels() == 1) make_gray(&image, layout);
  return image;
}

}  // namespace flexura

#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <csetjmp>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

#include "flexura/picture/image_file.h"

namespace flexura {
namespace {

void append(png_structp writer, png_bytep data, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(writer))->append(reinterpret_cast<const char*>(data), size);
}

void nothing_to_flush(png_structp /*writer*/) {}

struct Writer {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  Writer() = default;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

struct Header {
  png_uint_32 width, height;
  int bits, color;
};

// Settings of the compression.
struct Effort {
  int level, filter, strategy;
};

// Returns the entropy of a sample of the picture's bytes, in bits per byte. Uses the bytes themselves, or
// their differences from the bytes one pixel before.
template <typename T>
double entropy(const Image<T>& image, bool is_difference) {
  constexpr int every = 8;  // Rows.
  const std::size_t pixel = static_cast<std::size_t>(image.channels()) * sizeof(T);
  std::array<std::size_t, 256> counts = {};
  std::size_t all = 0;
  for (int v = 0; v < image.height(); v += every) {
    const auto row = std::as_bytes(image.row(v));
    for (std::size_t i = 0; i < row.size(); ++i) {
      const auto before = is_difference && i >= pixel ? std::to_integer<unsigned>(row[i - pixel]) : 0U;
      ++counts[(std::to_integer<unsigned>(row[i]) - before) & 0xFFU];
    }
    all += row.size();
  }
  double bits = 0;
  for (const std::size_t count : counts) {
    if (count == 0) continue;
    const double share = static_cast<double>(count) / static_cast<double>(all);
    bits -= share * std::log2(share);
  }
  return bits;
}

// Sensor noise does not repeat, and the difference of two pixels has more noise than one pixel. Hence files
// of noisy pictures are smaller, and are written faster, without filter and without search for repetitions.
template <typename T>
Effort effort_of(const Image<T>& image, int level) {
  constexpr int most_quick = 2;
  constexpr double least_noise = 2;  // Bits.
  if (level > most_quick) return {level, PNG_ALL_FILTERS, Z_DEFAULT_STRATEGY};
  const double as_is = entropy(image, false), differences = entropy(image, true);
  if (std::min(as_is, differences) < least_noise) return {level, PNG_FILTER_SUB, Z_DEFAULT_STRATEGY};
  return {level, as_is < differences ? PNG_FILTER_NONE : PNG_FILTER_SUB, Z_RLE};
}

// Returns false on an error of libpng, which leaves this function by longjmp. No local object here has a
// destructor, because longjmp would not run it.
bool write(const Writer& writer, const Header& header, png_bytepp rows, const Effort& effort,
           std::string* out) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  png_set_write_fn(writer.png, out, append, nothing_to_flush);
  png_set_compression_level(writer.png, effort.level);
  png_set_compression_strategy(writer.png, effort.strategy);
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, effort.filter);
  png_set_IHDR(writer.png, writer.info, header.width, header.height, header.bits, header.color,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  if (header.bits == 16 && std::endian::native == std::endian::little) png_set_swap(writer.png);
  png_write_image(writer.png, rows);
  png_write_end(writer.png, nullptr);
  return true;
}

template <typename T>
std::string png_of(const Image<T>& image, PngConfig config) {
  if (image.width() <= 0 || image.height() <= 0) throw std::invalid_argument("a PNG file needs pixels");
  if (image.channels() != 1 && image.channels() != 3)
    throw std::invalid_argument("a PNG file is gray or RGB: not " + std::to_string(image.channels()) +
                                " channels");
  // libpng takes mutable rows but does not modify them when writing.
  std::vector<png_bytep> rows;
  rows.reserve(static_cast<std::size_t>(image.height()));
  for (int v = 0; v < image.height(); ++v)
    rows.push_back(const_cast<png_bytep>(reinterpret_cast<png_const_bytep>(image.row(v).data())));
  const Header header{static_cast<png_uint_32>(image.width()), static_cast<png_uint_32>(image.height()),
                      static_cast<int>(8 * sizeof(T)),
                      image.channels() == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB};
  std::string bytes;
  const Writer writer;
  if (writer.png == nullptr || writer.info == nullptr ||
      !write(writer, header, rows.data(), effort_of(image, config.level), &bytes))
    throw std::runtime_error("libpng failed to write the image");
  return bytes;
}

}  // namespace

std::string png(const Image<std::uint8_t>& image, PngConfig config) { return png_of(image, config); }
std::string png(const Image<std::uint16_t>& image, PngConfig config) { return png_of(image, config); }

}  // namespace flexura

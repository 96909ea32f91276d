#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "flexura/picture/image_file.h"

namespace flexura {
namespace {

void take(png_structp reader, png_bytep data, png_size_t size) {
  auto* rest = static_cast<std::string_view*>(png_get_io_ptr(reader));
  if (size > rest->size()) png_error(reader, "it ends early");
  std::memcpy(data, rest->data(), size);
  rest->remove_prefix(size);
}

// Nobody wants to read on stderr what libpng thinks of a file; errors are told by the exception.
void keep_quiet(png_structp /*reader*/, png_const_charp /*text*/) {}

void give_up(png_structp reader, png_const_charp /*text*/) { png_longjmp(reader, 1); }

struct PngReader {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, give_up, keep_quiet);
  png_infop info = png_create_info_struct(png);
  PngReader() = default;
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct ReadHeader {
  png_uint_32 width = 0, height = 0;
  int bits = 0, channels = 0, color = 0, interlace = 0;
};

// These two are false when libpng gave up. It does so by a jump that runs no destructors: nothing here has
// one.
bool read_header(const PngReader& reader, std::string_view* bytes, ReadHeader* header) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_read_fn(reader.png, bytes, take);
  png_read_info(reader.png, reader.info);
  png_get_IHDR(reader.png, reader.info, &header->width, &header->height, &header->bits, &header->color,
               &header->interlace, nullptr, nullptr);
  header->channels = png_get_channels(reader.png, reader.info);
  if (header->bits == 16 && std::endian::native == std::endian::little) png_set_swap(reader.png);
  return true;
}

bool read_rows(const PngReader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

template <typename T>
Image<T> image_of(const PngReader& reader, const ReadHeader& header) {
  Image<T> image(static_cast<int>(header.width), static_cast<int>(header.height), header.channels);
  std::vector<png_bytep> rows;
  rows.reserve(header.height);
  for (int v = 0; v < image.height(); ++v) rows.push_back(reinterpret_cast<png_bytep>(image.row(v).data()));
  if (!read_rows(reader, rows.data())) throw std::runtime_error("the PNG file is damaged");
  return image;
}

}  // namespace

std::variant<Image<std::uint8_t>, Image<std::uint16_t>> read_png(std::string_view bytes,
                                                                 std::size_t most_pixels) {
  const PngReader reader;
  ReadHeader header;
  if (reader.png == nullptr || reader.info == nullptr || !read_header(reader, &bytes, &header))
    throw std::runtime_error("the PNG file is damaged, or none");
  if (static_cast<std::size_t>(header.width) > most_pixels / header.height)
    throw std::runtime_error("the PNG file has too many pixels");
  const bool is_known = (header.color == PNG_COLOR_TYPE_GRAY || header.color == PNG_COLOR_TYPE_RGB) &&
                        header.interlace == PNG_INTERLACE_NONE;
  if (is_known && header.bits == 8) return image_of<std::uint8_t>(reader, header);
  if (is_known && header.bits == 16) return image_of<std::uint16_t>(reader, header);
  throw std::runtime_error("the PNG file is not plain gray or RGB of 8 or 16 bits");
}

}  // namespace flexura

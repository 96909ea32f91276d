#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "flexura/picture/image_file.h"
#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

// State shared by libpng's callbacks. It has no destructor, because libpng's longjmp would not run it.
struct PngInput {
  std::string_view rest;
  bool is_cut_short = false;
  char text[120] = {};
};

void take(png_structp reader, png_bytep data, png_size_t size) {
  auto* input = static_cast<PngInput*>(png_get_io_ptr(reader));
  if (size > input->rest.size()) {
    input->is_cut_short = true;
    png_error(reader, "the file ends early");
  }
  std::memcpy(data, input->rest.data(), size);
  input->rest.remove_prefix(size);
}

// Keeps libpng's warnings from stderr; errors are reported by the exception.
void keep_quiet(png_structp /*reader*/, png_const_charp /*text*/) {}

void give_up(png_structp reader, png_const_charp text) {
  auto* input = static_cast<PngInput*>(png_get_error_ptr(reader));
  std::strncpy(input->text, text, sizeof input->text - 1);
  png_longjmp(reader, 1);
}

struct PngReader {
  explicit PngReader(std::string_view bytes) : input{bytes} {}
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }

  PngInput input;
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, give_up, keep_quiet);
  png_infop info = png_create_info_struct(png);
};

struct ReadHeader {
  png_uint_32 width = 0, height = 0;
  int bits = 0, color = 0;
  png_const_colorp colors = nullptr;  // Owned by libpng; null without a palette.
  int color_count = 0;
};

// The next three functions return false on an error of libpng, which leaves them by longjmp. Their local
// objects have no destructors, because longjmp would not run them.
bool read_header(PngReader* reader, ReadHeader* header) {
  png_structp png = reader->png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, &reader->input, take);
  // libpng limits each side to a million pixels; here the number of pixels is limited instead.
  constexpr png_uint_32 any_side = std::numeric_limits<std::int32_t>::max();
  png_set_user_limits(png, any_side, any_side);
  // Text, time and profile chunks are ignored.
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_read_info(png, reader->info);
  png_get_IHDR(png, reader->info, &header->width, &header->height, &header->bits, &header->color, nullptr,
               nullptr, nullptr);
  return true;
}

// Makes libpng return one value of 8 or 16 bits per channel, in this machine's byte order.
bool choose_form(const PngReader& reader, ReadHeader* header) {
  png_structp png = reader.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  if (header->color == PNG_COLOR_TYPE_PALETTE) {
    png_set_packing(png);
    png_colorp colors = nullptr;
    png_get_PLTE(png, reader.info, &colors, &header->color_count);
    header->colors = colors;
  } else if (header->bits < 8) {
    png_set_expand_gray_1_2_4_to_8(png);
  }
  if (header->bits == 16 && std::endian::native == std::endian::little) png_set_swap(png);
  png_set_strip_alpha(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, reader.info);
  return true;
}

bool read_rows(const PngReader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

std::runtime_error png_problem(const PngReader& reader) {
  return reader.input.is_cut_short ? cut_short("PNG") : damaged("PNG", reader.input.text);
}

template <typename T>
Image<T> image_of(const PngReader& reader, const ReadHeader& header) {
  Image<T> image(static_cast<int>(header.width), static_cast<int>(header.height),
                 png_get_channels(reader.png, reader.info));
  if (png_get_rowbytes(reader.png, reader.info) != image.row(0).size_bytes())
    throw std::logic_error("libpng returned rows in another format than requested");
  std::vector<png_bytep> rows;
  rows.reserve(header.height);
  for (int v = 0; v < image.height(); ++v) rows.push_back(reinterpret_cast<png_bytep>(image.row(v).data()));
  if (!read_rows(reader, rows.data())) throw png_problem(reader);
  return image;
}

// Checks the size that the file claims, except a size of 0, for which libpng has its own message. Does not
// check a file that does not begin with IHDR.
void check_claim(std::string_view bytes, std::size_t most_pixels) {
  constexpr std::size_t name = 12, width = 16, height = 20, end = 24;
  if (bytes.size() < end || bytes.substr(name, 4) != "IHDR") return;
  const auto* at = reinterpret_cast<png_const_bytep>(bytes.data());
  check_picture_size(png_get_uint_32(at + width), png_get_uint_32(at + height), most_pixels);
}

}  // namespace

Picture read_png(std::string_view bytes, std::size_t most_pixels) {
  check_claim(bytes, most_pixels);
  PngReader reader(bytes);
  ReadHeader header;
  if (reader.png == nullptr || reader.info == nullptr) throw std::bad_alloc();
  if (!read_header(&reader, &header)) throw png_problem(reader);
  check_picture_size(header.width, header.height, most_pixels);
  if (!choose_form(reader, &header)) throw png_problem(reader);
  if (header.bits == 16) return image_of<std::uint16_t>(reader, header);
  auto image = image_of<std::uint8_t>(reader, header);
  if (header.colors == nullptr) return image;
  Palette palette{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(header.color_count); ++i)
    palette[i] = {header.colors[i].red, header.colors[i].green, header.colors[i].blue};
  return painted(std::move(image), palette);
}

}  // namespace flexura

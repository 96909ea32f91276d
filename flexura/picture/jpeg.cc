#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
// jpeglib.h needs FILE and size_t before it.
#include <jpeglib.h>

#include <csetjmp>
#include <memory>
#include <stdexcept>
#include <string>

#include "flexura/picture/image_file.h"

namespace flexura {
namespace {

// libjpeg passes its errors to a function that must not return.
struct Errors {
  // Must be the first member, because libjpeg passes its address as that of the struct.
  jpeg_error_mgr manager;
  std::jmp_buf back;
  char text[JMSG_LENGTH_MAX];
};

void give_up(j_common_ptr job) {
  auto* errors = reinterpret_cast<Errors*>(job->err);
  (*job->err->format_message)(job, errors->text);
  std::longjmp(errors->back, 1);
}

void ignore_message(j_common_ptr /*job*/) {}

struct Output {
  unsigned char* bytes = nullptr;  // Allocated by libjpeg with malloc.
  unsigned long size = 0;
};

// Returns false on an error of libjpeg, which leaves this function by longjmp. No local object here has a
// destructor, because longjmp would not run it.
bool write(const Image<std::uint8_t>& image, int quality, jpeg_compress_struct* job, Errors* errors,
           Output* out) {
  if (setjmp(errors->back) != 0) return false;
  jpeg_create_compress(job);
  jpeg_mem_dest(job, &out->bytes, &out->size);
  job->image_width = static_cast<JDIMENSION>(image.width());
  job->image_height = static_cast<JDIMENSION>(image.height());
  job->input_components = image.channels();
  job->in_color_space = image.channels() == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(job);
  jpeg_set_quality(job, quality, TRUE);
  jpeg_start_compress(job, TRUE);
  while (job->next_scanline < job->image_height) {
    // libjpeg takes mutable rows but does not modify them when writing.
    auto* row = const_cast<JSAMPROW>(image.row(static_cast<int>(job->next_scanline)).data());
    jpeg_write_scanlines(job, &row, 1);
  }
  jpeg_finish_compress(job);
  return true;
}

}  // namespace

std::string jpeg(const Image<std::uint8_t>& image, JpegConfig config) {
  if (image.width() <= 0 || image.height() <= 0) throw std::invalid_argument("a JPEG file needs pixels");
  if (image.width() > JPEG_MAX_DIMENSION || image.height() > JPEG_MAX_DIMENSION)
    throw std::invalid_argument("a JPEG file has at most " + std::to_string(JPEG_MAX_DIMENSION) +
                                " pixels per side");
  if (image.channels() != 1 && image.channels() != 3)
    throw std::invalid_argument("a JPEG file is gray or RGB: not " + std::to_string(image.channels()) +
                                " channels");
  if (config.quality < 1 || config.quality > 100)
    throw std::invalid_argument("the quality of a JPEG file is 1 to 100: not " +
                                std::to_string(config.quality));
  jpeg_compress_struct job{};
  Errors errors{};
  job.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = give_up;
  errors.manager.output_message = ignore_message;
  Output out;
  const bool is_written = write(image, config.quality, &job, &errors, &out);
  jpeg_destroy_compress(&job);
  const std::unique_ptr<unsigned char, decltype(&std::free)> owner(out.bytes, &std::free);
  if (!is_written) throw std::runtime_error(std::string("libjpeg failed to write the image: ") + errors.text);
  return {reinterpret_cast<const char*>(out.bytes), out.size};
}

}  // namespace flexura

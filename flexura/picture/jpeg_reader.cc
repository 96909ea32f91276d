#include <cstddef>
#include <cstdio>
// jpeglib.h needs FILE and size_t before it.
#include <jpeglib.h>
// Must be included after jpeglib.h.
#include <jerror.h>

#include <array>
#include <csetjmp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

// libjpeg passes its errors to a function that must not return.
struct JpegInput {
  // Must be the first member, because libjpeg passes its address as that of the struct.
  jpeg_error_mgr manager;
  std::jmp_buf back;
  jpeg_progress_mgr progress;
  char text[JMSG_LENGTH_MAX];
};

void stop_reading(j_common_ptr job) {
  auto* input = reinterpret_cast<JpegInput*>(job->err);
  (*job->err->format_message)(job, input->text);
  std::longjmp(input->back, 1);
}

// After these warnings libjpeg would continue with gray or wrong pixels. Other warnings are harmless.
void weigh_warning(j_common_ptr job, int level) {
  if (level >= 0) return;
  switch (job->err->msg_code) {
    case JWRN_JPEG_EOF:
    case JWRN_HIT_MARKER:
    case JWRN_HUFF_BAD_CODE:
    case JWRN_ARITH_BAD_CODE:
    case JWRN_MUST_RESYNC:
      stop_reading(job);
      break;
    default:
      break;
  }
}

void write_nothing(j_common_ptr /*job*/) {}

// Limit on the number of scans. A scan of ten bytes makes libjpeg process the whole picture; ordinary files
// have about ten scans.
void bound_scans(j_common_ptr job) {
  constexpr int most_scans = 500;
  if (reinterpret_cast<j_decompress_ptr>(job)->input_scan_number <= most_scans) return;
  auto* input = reinterpret_cast<JpegInput*>(job->err);
  std::snprintf(input->text, sizeof input->text, "more than %d scans", most_scans);
  std::longjmp(input->back, 1);
}

// The next two functions return false on an error of libjpeg, which leaves them by longjmp. Their local
// objects have no destructors, because longjmp would not run them.
bool read_header(std::span<const std::uint8_t> file, jpeg_decompress_struct* job, JpegInput* input) {
  if (setjmp(input->back) != 0) return false;
  jpeg_create_decompress(job);
  job->progress = &input->progress;
  jpeg_mem_src(job, file.data(), file.size());
  jpeg_read_header(job, TRUE);
  return true;
}

// Converts cyan, magenta, yellow and black to red, green and blue. Files store inks inverted (255: no ink),
// as introduced by Adobe. The rounding is that of OpenCV.
void mix_inks(std::span<const std::uint8_t> inks, std::uint8_t* to) {
  constexpr std::size_t count = 4;
  for (; !inks.empty(); inks = inks.subspan(count)) {
    const int light = inks[3];
    for (std::size_t c = 0; c < 3; ++c)
      *to++ = static_cast<std::uint8_t>(light - ((255 - inks[c]) * light >> 8));
  }
}

// `inks` has the size of one row of inks; it is empty if the file does not use inks.
bool read_rows(jpeg_decompress_struct* job, JpegInput* input, std::span<std::uint8_t> inks,
               Image<std::uint8_t>* image) {
  if (setjmp(input->back) != 0) return false;
  jpeg_start_decompress(job);
  while (job->output_scanline < job->output_height) {
    std::uint8_t* values = image->row(static_cast<int>(job->output_scanline)).data();
    JSAMPROW row = inks.empty() ? values : inks.data();
    jpeg_read_scanlines(job, &row, 1);
    if (!inks.empty()) mix_inks(inks, values);
  }
  jpeg_finish_decompress(job);
  return true;
}

struct JpegReader {
  JpegReader() {
    job.err = jpeg_std_error(&input.manager);
    input.manager.error_exit = stop_reading;
    input.manager.emit_message = weigh_warning;
    input.manager.output_message = write_nothing;
    input.progress.progress_monitor = bound_scans;
  }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  ~JpegReader() { jpeg_destroy_decompress(&job); }

  [[nodiscard]] std::runtime_error problem() const {
    const int code = input.manager.msg_code;
    const bool has_ended = code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER || code == JERR_INPUT_EOF;
    return has_ended ? cut_short("JPEG") : damaged("JPEG", input.text);
  }

  jpeg_decompress_struct job{};
  JpegInput input{};
};

}  // namespace

Picture read_jpeg(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  JpegReader reader;
  const bool has_header = read_header(file, &reader.job, &reader.input);
  if (has_header || reader.input.manager.msg_code == JERR_EMPTY_IMAGE)
    check_picture_size(reader.job.image_width, reader.job.image_height, most_pixels);
  if (!has_header) throw reader.problem();
  const int channels = reader.job.num_components;
  if (channels != 1 && channels != 3 && channels != 4)
    throw std::runtime_error("the JPEG file has " + std::to_string(channels) +
                             " values per pixel: expected gray, colours or four inks (CMYK)");
  constexpr std::array<J_COLOR_SPACE, 5> spaces = {JCS_UNKNOWN, JCS_GRAYSCALE, JCS_UNKNOWN, JCS_RGB,
                                                   JCS_CMYK};
  reader.job.out_color_space = spaces[static_cast<std::size_t>(channels)];
  Image<std::uint8_t> image(static_cast<int>(reader.job.image_width),
                            static_cast<int>(reader.job.image_height), channels == 1 ? 1 : 3);
  std::vector<std::uint8_t> inks(channels == 4 ? std::size_t{4} * reader.job.image_width : 0);
  if (!read_rows(&reader.job, &reader.input, inks, &image)) throw reader.problem();
  return image;
}

}  // namespace flexura

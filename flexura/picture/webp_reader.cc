#include <webp/decode.h>

#include <stdexcept>
#include <string>

#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

// What to throw for what libwebp answers.
std::runtime_error webp_problem(VP8StatusCode status) {
  switch (status) {
    case VP8_STATUS_NOT_ENOUGH_DATA:
    case VP8_STATUS_SUSPENDED:
      return cut_short("WebP");
    case VP8_STATUS_OUT_OF_MEMORY:
      return std::runtime_error("there is no memory for the picture of the WebP file");
    case VP8_STATUS_UNSUPPORTED_FEATURE:
      return damaged("WebP", "a feature that libwebp does not know");
    default:
      return damaged("WebP", "values that no encoder writes");
  }
}

}  // namespace

Picture read_webp(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  WebPDecoderConfig config;
  if (WebPInitDecoderConfig(&config) == 0) throw std::logic_error("libwebp is of another version");
  const VP8StatusCode header = WebPGetFeatures(file.data(), file.size(), &config.input);
  if (header != VP8_STATUS_OK) throw webp_problem(header);
  check_picture_size(config.input.width, config.input.height, most_pixels);
  if (config.input.has_animation != 0)
    throw std::runtime_error("the WebP file has moving pictures: expected a single one");
  Image<std::uint8_t> image(config.input.width, config.input.height, 3);
  config.output.colorspace = MODE_RGB;
  config.output.is_external_memory = 1;
  config.output.u.RGBA = {image.values().data(), static_cast<int>(image.row(0).size()),
                          image.values().size()};
  const VP8StatusCode status = WebPDecode(file.data(), file.size(), &config);
  if (status != VP8_STATUS_OK) throw webp_problem(status);
  return image;
}

}  // namespace flexura

#include <fmt/format.h>
#include <openjpeg.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include "flexura/picture/jpeg2000_stream.h"
#include "flexura/picture/picture_kinds.h"

namespace flexura {
namespace {

// A file in memory, as OpenJPEG reads it, and what it first found wrong with it.
struct Jpeg2000Input {
  std::span<const std::uint8_t> bytes;
  std::size_t at = 0;
  char text[200] = {};
};

// OpenJPEG's names for a stream and for a codec are of one type.
template <typename T, void (*destroy)(T*)>
struct DestroyOpj {
  void operator()(T* what) const { destroy(what); }
};
using OpjStream = std::unique_ptr<opj_stream_t, DestroyOpj<opj_stream_t, opj_stream_destroy>>;
using OpjCodec = std::unique_ptr<opj_codec_t, DestroyOpj<opj_codec_t, opj_destroy_codec>>;
using OpjImage = std::unique_ptr<opj_image_t, DestroyOpj<opj_image_t, opj_image_destroy>>;

OPJ_SIZE_T take_bytes(void* data, OPJ_SIZE_T size, void* user) {
  auto* input = static_cast<Jpeg2000Input*>(user);
  const std::size_t count = std::min<std::size_t>(size, input->bytes.size() - input->at);
  if (count == 0) return static_cast<OPJ_SIZE_T>(-1);
  std::memcpy(data, input->bytes.data() + input->at, count);
  input->at += count;
  return count;
}

OPJ_OFF_T pass_bytes(OPJ_OFF_T size, void* user) {
  auto* input = static_cast<Jpeg2000Input*>(user);
  if (size < 0 || static_cast<std::size_t>(size) > input->bytes.size() - input->at) return -1;
  input->at += static_cast<std::size_t>(size);
  return size;
}

OPJ_BOOL go_to_byte(OPJ_OFF_T at, void* user) {
  auto* input = static_cast<Jpeg2000Input*>(user);
  if (at < 0 || static_cast<std::size_t>(at) > input->bytes.size()) return OPJ_FALSE;
  input->at = static_cast<std::size_t>(at);
  return OPJ_TRUE;
}

void note_opj_error(const char* text, void* user) {
  auto* input = static_cast<Jpeg2000Input*>(user);
  if (input->text[0] == '\0') std::snprintf(input->text, sizeof input->text, "%s", text);
}

void pass_opj_message(const char* /*text*/, void* /*user*/) {}

std::runtime_error jpeg2000_problem(const Jpeg2000Input& input) {
  std::string_view text = input.text;
  while (text.ends_with('\n')) text.remove_suffix(1);
  return damaged("JPEG 2000", text.empty() ? "OpenJPEG does not say why" : text);
}

OpjImage decoded(Jpeg2000Input* input, std::size_t most_pixels) {
  const OpjStream stream(opj_stream_create(std::size_t{1} << 16U, OPJ_TRUE));
  const OpjCodec codec(
      opj_create_decompress(is_jpeg2000_stream(input->bytes) ? OPJ_CODEC_J2K : OPJ_CODEC_JP2));
  if (!stream || !codec) throw std::bad_alloc();
  opj_stream_set_user_data(stream.get(), input, nullptr);
  opj_stream_set_user_data_length(stream.get(), input->bytes.size());
  opj_stream_set_read_function(stream.get(), take_bytes);
  opj_stream_set_skip_function(stream.get(), pass_bytes);
  opj_stream_set_seek_function(stream.get(), go_to_byte);
  opj_set_error_handler(codec.get(), note_opj_error, input);
  opj_set_warning_handler(codec.get(), pass_opj_message, nullptr);
  opj_set_info_handler(codec.get(), pass_opj_message, nullptr);
  opj_dparameters_t parameters;
  opj_set_default_decoder_parameters(&parameters);
  // Without threads of its own, whatever the environment says.
  if (opj_setup_decoder(codec.get(), &parameters) == OPJ_FALSE ||
      opj_decoder_set_strict_mode(codec.get(), OPJ_TRUE) == OPJ_FALSE ||
      opj_codec_set_threads(codec.get(), 0) == OPJ_FALSE)
    throw std::logic_error("OpenJPEG does not take its settings");
  opj_image_t* read = nullptr;
  const bool has_header = opj_read_header(stream.get(), codec.get(), &read) == OPJ_TRUE;
  OpjImage image(read);
  if (!has_header || !image) throw jpeg2000_problem(*input);
  check_picture_size(std::int64_t{image->x1} - image->x0, std::int64_t{image->y1} - image->y0, most_pixels);
  if (opj_decode(codec.get(), stream.get(), image.get()) == OPJ_FALSE ||
      opj_end_decompress(codec.get(), stream.get()) == OPJ_FALSE)
    throw jpeg2000_problem(*input);
  return image;
}

// The values of the channels that count: gray, or red, green and blue.
struct Jpeg2000Values {
  std::array<const OPJ_INT32*, 3> channels = {};
  std::size_t count = 0;
  int width = 0, height = 0;
  int most = 0;
  bool is_luma = false;  // Brightness and two differences of colours.
};

Jpeg2000Values values_of(const opj_image_t& image, std::size_t most_pixels) {
  if (image.color_space == OPJ_CLRSPC_CMYK || image.color_space == OPJ_CLRSPC_EYCC)
    throw std::runtime_error(
        fmt::format("the JPEG 2000 file has colours of kind {}: expected gray, sRGB or sYCC",
                    image.color_space == OPJ_CLRSPC_CMYK ? "CMYK" : "e-sYCC"));
  Jpeg2000Values values;
  if (image.numcomps < 1) throw damaged("JPEG 2000", "no values");
  values.count = image.numcomps >= 3 && image.color_space != OPJ_CLRSPC_GRAY ? 3 : 1;
  values.is_luma = values.count == 3 && image.color_space == OPJ_CLRSPC_SYCC;
  const opj_image_comp_t& first = image.comps[0];
  check_picture_size(first.w, first.h, most_pixels);
  for (std::size_t c = 0; c < values.count; ++c) {
    const opj_image_comp_t& channel = image.comps[c];
    constexpr OPJ_UINT32 most_bits = 16;
    if (channel.sgnd != 0 || channel.prec < 1 || channel.prec > most_bits || channel.prec != first.prec)
      throw std::runtime_error(
          fmt::format("the JPEG 2000 file has {}values of {} bits: expected 1 to 16, as many in each "
                      "channel, without a sign",
                      channel.sgnd != 0 ? "signed " : "", channel.prec));
    if (channel.dx != 1 || channel.dy != 1 || channel.w != first.w || channel.h != first.h)
      throw std::runtime_error(
          "the JPEG 2000 file has channels of fewer pixels than the picture: expected a value a pixel in "
          "each");
    if (channel.data == nullptr) throw damaged("JPEG 2000", "a channel without values");
    values.channels[c] = channel.data;
  }
  values.width = static_cast<int>(first.w), values.height = static_cast<int>(first.h);
  values.most = (1 << first.prec) - 1;
  return values;
}

// The colours of sYCC, IEC 61966-2-1's annex F.
std::array<int, 3> from_luma(const std::array<int, 3>& values, int most) {
  const int none = (most + 1) / 2;
  const double y = values[0], blue = values[1] - none, red = values[2] - none;
  std::array<int, 3> colors{};
  const std::array<double, 3> mixed = {y + 1.402 * red, y - 0.344136 * blue - 0.714136 * red,
                                       y + 1.772 * blue};
  for (std::size_t c = 0; c < 3; ++c)
    colors[c] = static_cast<int>(std::lround(std::clamp(mixed[c], 0.0, static_cast<double>(most))));
  return colors;
}

template <typename Value>
Image<Value> image_of(const Jpeg2000Values& values) {
  Image<Value> image(values.width, values.height, static_cast<int>(values.count));
  Value* to = image.values().data();
  const std::size_t pixels = image.values().size() / values.count;
  for (std::size_t i = 0; i < pixels; ++i) {
    std::array<int, 3> colors{};
    for (std::size_t c = 0; c < values.count; ++c)
      colors[c] = std::clamp<int>(values.channels[c][i], 0, values.most);
    if (values.is_luma) colors = from_luma(colors, values.most);
    for (std::size_t c = 0; c < values.count; ++c)
      *to++ = sizeof(Value) == 1 ? byte_of(colors[c], values.most) : static_cast<Value>(colors[c]);
  }
  return image;
}

}  // namespace

Picture read_jpeg2000(std::span<const std::uint8_t> file, std::size_t most_pixels) {
  check_jpeg2000(file, most_pixels);
  Jpeg2000Input input{.bytes = file};
  const OpjImage image = decoded(&input, most_pixels);
  const Jpeg2000Values values = values_of(*image, most_pixels);
  if (values.most > 255) return image_of<std::uint16_t>(values);
  return image_of<std::uint8_t>(values);
}

}  // namespace flexura

#pragma once

#include <gtest/gtest.h>
#include <openjpeg.h>
#include <webp/encode.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "tests/support/picture_files.h"
#include "tests/support/random_cases.h"

// Picture files of the rarer kinds; see picture_files.h.
namespace flexura {

/// A number of `size` bytes, the highest first.
inline std::string high_first(std::int64_t number, int size) {
  std::string bytes = low_first(number, size);
  std::ranges::reverse(bytes);
  return bytes;
}

/// A BMP file's two headers: of `bits` a pixel, of a compression by its number, with what comes before the
/// pixels.
inline std::string bmp_begin(int width, int height, int bits, int compression, const std::string& between) {
  const auto begin = static_cast<std::int64_t>(54 + between.size());
  return "BM" + std::string(8, '\0') + low_first(begin, 4) + low_first(40, 4) + low_first(width, 4) +
         low_first(height, 4) + low_first(1, 2) + low_first(bits, 2) + low_first(compression, 4) +
         std::string(20, '\0') + between;
}

/// Indices of 4 or 8 bits as BMP's runs, mixed with pixels as they are; `palette` has a colour for each.
inline std::string bmp_runs_file(TestRandom& random, const Image<std::uint8_t>& image, int bits,
                                 const Colors& palette) {
  std::string file;
  for (const auto& [red, green, blue] : palette)
    file += {static_cast<char>(blue), static_cast<char>(green), static_cast<char>(red), '\0'};
  file = bmp_begin(image.width(), image.height(), bits, bits == 8 ? 1 : 2, file);
  const auto put = [&](int count, int value) {
    file += {static_cast<char>(count), static_cast<char>(value)};
  };
  for (int v = image.height() - 1; v >= 0; --v) {
    const auto row = image.row(v);
    for (std::size_t u = 0; u < row.size();) {
      const std::size_t left = row.size() - u;
      std::size_t same = 1;
      while (same < left && same < 255 && row[u + same] == row[u]) ++same;
      if (left > 2 && random.integer(0, 1) == 1) {
        const auto count =
            static_cast<std::size_t>(random.integer(3, static_cast<int>(std::min<std::size_t>(left, 255))));
        put(0, static_cast<int>(count));
        std::string values = packed<std::uint8_t>(row.subspan(u, count), bits);
        values.resize((values.size() + 1) / 2 * 2);
        file += values;
        u += count;
      } else {
        put(static_cast<int>(same), bits == 8 ? row[u] : row[u] * 17);
        u += same;
      }
    }
    put(0, 0);
  }
  put(0, 1);
  return file;
}

/// 16 or 32 bits a pixel, each colour's value in the run of bits that its mask names; without masks, if
/// `has_masks` is not set.
inline std::string bmp_fields_file(const Image<std::uint16_t>& image, int bits,
                                   const std::array<std::uint32_t, 3>& masks, bool has_masks) {
  std::string between;
  for (std::size_t c = 0; has_masks && c < 3; ++c) between += low_first(masks[c], 4);
  std::string file = bmp_begin(image.width(), image.height(), bits, has_masks ? 3 : 0, between);
  for (int v = image.height() - 1; v >= 0; --v) {
    std::string row;
    for (int u = 0; u < image.width(); ++u) {
      std::uint32_t pixel = 0;
      for (int c = 0; c < 3; ++c)
        pixel |= std::uint32_t{image.at(u, v, c)}
                 << static_cast<unsigned>(std::countr_zero(masks[static_cast<std::size_t>(c)]));
      row += low_first(pixel, bits / 8);
    }
    row.resize((row.size() + 3) / 4 * 4);
    file += row;
  }
  return file;
}

struct SunForm {
  int bits = 8;
  int type = 1;
  Colors palette = {};
};

/// Indices (one channel) of 1 or 8 bits, or colours of 24 or 32 bits.
inline std::string sun_raster_file(const Image<std::uint8_t>& image, const SunForm& form) {
  std::string map, rows;
  for (std::size_t c = 0; c < 3; ++c)
    for (const auto& color : form.palette) map += static_cast<char>(color[c]);
  for (int v = 0; v < image.height(); ++v) {
    std::string row;
    if (form.bits <= 8) row = packed<std::uint8_t>(image.row(v), form.bits);
    for (int u = 0; form.bits > 8 && u < image.width(); ++u) {
      if (form.bits == 32) row += '\x7F';
      for (int c = 0; c < 3; ++c) row += static_cast<char>(image.at(u, v, form.type == 3 ? c : 2 - c));
    }
    row.resize((row.size() + 1) / 2 * 2);
    rows += row;
  }
  if (form.type == 2) {
    std::string runs;
    for (std::size_t i = 0; i < rows.size();) {
      std::size_t same = 1;
      while (i + same < rows.size() && same < 256 && rows[i + same] == rows[i]) ++same;
      if (same > 2)
        runs += {'\x80', static_cast<char>(same - 1), rows[i]};
      else if (same = 1; rows[i] == '\x80')
        runs += {'\x80', '\0'};
      else
        runs += rows[i];
      i += same;
    }
    rows = runs;
  }
  return "\x59\xA6\x6A\x95" + high_first(image.width(), 4) + high_first(image.height(), 4) +
         high_first(form.bits, 4) + high_first(static_cast<std::int64_t>(rows.size()), 4) +
         high_first(form.type, 4) + high_first(map.empty() ? 0 : 1, 4) +
         high_first(static_cast<std::int64_t>(map.size()), 4) + map + rows;
}

/// Gray, gray and alpha, RGB or RGB and alpha by the channels; `tuples` may be empty.
template <typename T>
std::string pam_file(const Image<T>& image, int most, const std::string& tuples) {
  std::string file = "P7\n# made\nWIDTH " + std::to_string(image.width()) + "\nHEIGHT " +
                     std::to_string(image.height()) + "\nDEPTH " + std::to_string(image.channels()) +
                     "\nMAXVAL " + std::to_string(most) + "\n" +
                     (tuples.empty() ? "" : "TUPLTYPE " + tuples + "\n") + "ENDHDR\n";
  for (const T value : image.values()) file += high_first(value, most > 255 ? 2 : 1);
  return file;
}

/// RGB or RGB and alpha, lossless or of quality 90.
inline std::string webp_file(const Image<std::uint8_t>& image, bool is_lossless) {
  const std::uint8_t* values = image.values().data();
  const int width = image.width(), height = image.height(), stride = width * image.channels();
  constexpr float quality = 90;
  std::uint8_t* bytes = nullptr;
  std::size_t size = 0;
  if (image.channels() == 3)
    size = is_lossless ? WebPEncodeLosslessRGB(values, width, height, stride, &bytes)
                       : WebPEncodeRGB(values, width, height, stride, quality, &bytes);
  else
    size = is_lossless ? WebPEncodeLosslessRGBA(values, width, height, stride, &bytes)
                       : WebPEncodeRGBA(values, width, height, stride, quality, &bytes);
  EXPECT_GT(size, 0U);
  std::string file(reinterpret_cast<char*>(bytes), size);
  WebPFree(bytes);
  return file;
}

struct Jpeg2000Form {
  int bits = 8;
  bool is_stream = false;                          ///< Without JP2's boxes.
  int tile = 0;                                    ///< Its side, px; 0 for one tile.
  OPJ_COLOR_SPACE space = OPJ_CLRSPC_UNSPECIFIED;  ///< By the channels, if it is not named.
  bool is_signed = false;
  int precinct = 0;  ///< Its side, px; 0 for the usual.
  int step = 1;      ///< The second channel and those after it have a value for so many columns and rows.
};

/// A growing file in memory, as OpenJPEG writes it.
struct Jpeg2000Memory {
  std::string bytes;
  std::size_t at = 0;

  static void tell(const char* text, void* /*user*/) { ADD_FAILURE() << text; }
  static OPJ_SIZE_T write(void* data, OPJ_SIZE_T size, void* user) {
    auto& file = *static_cast<Jpeg2000Memory*>(user);
    file.bytes.resize(std::max<std::size_t>(file.bytes.size(), file.at + size));
    std::memcpy(file.bytes.data() + file.at, data, size);
    file.at += size;
    return size;
  }
  static OPJ_OFF_T skip(OPJ_OFF_T size, void* user) {
    static_cast<Jpeg2000Memory*>(user)->at += static_cast<std::size_t>(size);
    return size;
  }
  static OPJ_BOOL seek(OPJ_OFF_T at, void* user) {
    static_cast<Jpeg2000Memory*>(user)->at = static_cast<std::size_t>(at);
    return OPJ_TRUE;
  }
};

/// Gray, gray and alpha, RGB or RGB and alpha by the channels; lossless.
template <typename T>
std::string jpeg2000_file(const Image<T>& image, const Jpeg2000Form& form) {
  const auto channels = static_cast<OPJ_UINT32>(image.channels());
  std::vector<opj_image_cmptparm_t> components(channels);
  for (auto& component : components) {
    component = {};
    component.dx = component.dy = static_cast<OPJ_UINT32>(&component == components.data() ? 1 : form.step);
    component.w = (static_cast<OPJ_UINT32>(image.width()) + component.dx - 1) / component.dx;
    component.h = (static_cast<OPJ_UINT32>(image.height()) + component.dy - 1) / component.dy;
    component.prec = static_cast<OPJ_UINT32>(form.bits), component.sgnd = form.is_signed ? 1 : 0;
  }
  const OPJ_COLOR_SPACE usual = channels < 3 ? OPJ_CLRSPC_GRAY : OPJ_CLRSPC_SRGB;
  opj_image_t* made = opj_image_create(channels, components.data(),
                                       form.space == OPJ_CLRSPC_UNSPECIFIED ? usual : form.space);
  made->x1 = components[0].w, made->y1 = components[0].h;
  if (channels % 2 == 0) made->comps[channels - 1].alpha = 1;
  for (std::size_t i = 0; i < image.values().size(); ++i)
    if (const auto& component = made->comps[i % channels];
        i / channels < std::size_t{component.w} * component.h)
      component.data[i / channels] = image.values()[i];
  opj_cparameters_t parameters;
  opj_set_default_encoder_parameters(&parameters);
  parameters.tcp_numlayers = 1, parameters.cp_disto_alloc = 1, parameters.tcp_rates[0] = 0;
  const int side = std::min({image.width(), image.height(), form.tile > 0 ? form.tile : image.width()});
  parameters.numresolution = std::min(3, static_cast<int>(std::bit_width(static_cast<unsigned>(side))));
  parameters.tcp_mct = channels >= 3 && form.space == OPJ_CLRSPC_UNSPECIFIED ? 1 : 0;
  if (form.precinct > 0) {
    parameters.csty |= 1, parameters.res_spec = 1;
    parameters.prcw_init[0] = parameters.prch_init[0] = form.precinct;
  }
  if (form.tile > 0) {
    parameters.tile_size_on = OPJ_TRUE;
    parameters.cp_tdx = parameters.cp_tdy = form.tile;
  }
  Jpeg2000Memory file;
  opj_codec_t* codec = opj_create_compress(form.is_stream ? OPJ_CODEC_J2K : OPJ_CODEC_JP2);
  opj_stream_t* stream = opj_stream_default_create(OPJ_FALSE);
  opj_set_error_handler(codec, Jpeg2000Memory::tell, nullptr);
  opj_stream_set_user_data(stream, &file, nullptr);
  opj_stream_set_write_function(stream, Jpeg2000Memory::write);
  opj_stream_set_skip_function(stream, Jpeg2000Memory::skip);
  opj_stream_set_seek_function(stream, Jpeg2000Memory::seek);
  EXPECT_TRUE(opj_setup_encoder(codec, &parameters, made) == OPJ_TRUE &&
              opj_start_compress(codec, made, stream) == OPJ_TRUE && opj_encode(codec, stream) == OPJ_TRUE &&
              opj_end_compress(codec, stream) == OPJ_TRUE);
  opj_stream_destroy(stream);
  opj_destroy_codec(codec);
  opj_image_destroy(made);
  return file.bytes;
}

}  // namespace flexura

#include "flexura/vision/picture_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/source.h"

namespace flexura {
namespace {

// OpenCV keeps colours as blue, green, red.
template <typename Value>
Image<Value> image_of(const cv::Mat& mat) {
  const int channels = mat.channels() >= 3 ? 3 : 1;
  Image<Value> image(mat.cols, mat.rows, channels);
  for (int v = 0; v < mat.rows; ++v) {
    const auto* from = mat.ptr<Value>(v);
    Value* to = image.row(v).data();
    for (int u = 0; u < mat.cols; ++u, from += mat.channels(), to += channels)
      for (int c = 0; c < channels; ++c) to[c] = from[channels == 3 ? 2 - c : 0];
  }
  return image;
}

template <typename Value>
Image<Value> gray_of_colors(const Image<Value>& picture) {
  if (picture.channels() == 1) return picture;
  Image<Value> gray(picture.width(), picture.height());
  const Value* from = picture.values().data();
  // In 1/65536: 0.2126, 0.7152, 0.0722.
  for (Value& value : gray.values()) {
    const std::uint64_t sum =
        13933U * std::uint64_t{from[0]} + 46871U * std::uint64_t{from[1]} + 4732U * std::uint64_t{from[2]};
    value = static_cast<Value>((sum + 32768U) >> 16U);
    from += 3;
  }
  return gray;
}

// What a JPEG file's header says; zeros for other files.
struct JpegHeader {
  std::int64_t width = 0, height = 0;
  std::size_t scan = 0;  // Where the picture itself begins.
};
JpegHeader jpeg_header(std::span<const std::uint8_t> file) {
  JpegHeader header;
  if (file.size() < 4 || file[0] != 0xFF || file[1] != 0xD8) return header;
  for (std::size_t at = 2; at + 9 < file.size();) {
    if (file[at] != 0xFF) break;
    const std::uint8_t marker = file[at + 1];
    if (marker == 0xFF) {
      ++at;
      continue;
    }
    const auto pair = [&](std::size_t i) { return file[i] * 256 + file[i + 1]; };
    const bool is_frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (is_frame) header.height = pair(at + 5), header.width = pair(at + 7);
    at += 2 + static_cast<std::size_t>(pair(at + 2));
    if (marker != 0xDA) continue;
    header.scan = at;
    break;
  }
  return header;
}

// The size that a PNG, PNM, BMP or JPEG file claims to have: a small file can claim a huge picture, and the
// decoder would make room for it. (Others it refuses beyond 2^30 px.)
std::array<std::int64_t, 2> claimed_size(std::span<const std::uint8_t> file) {
  constexpr std::array<std::uint8_t, 8> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  const auto number = [&](std::size_t at, bool is_low_first) {
    std::int64_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value * 256 + file[is_low_first ? at + 3 - i : at + i];
    return value;
  };
  if (file.size() >= 26 && std::ranges::equal(file.first(8), png))
    return {number(16, false), number(20, false)};
  if (file.size() >= 26 && file[0] == 'B' && file[1] == 'M') {
    const auto height = static_cast<std::int32_t>(static_cast<std::uint32_t>(number(22, true)));
    return {number(18, true), std::abs(static_cast<std::int64_t>(height))};
  }
  const JpegHeader jpeg = jpeg_header(file);
  std::array<std::int64_t, 2> size = {jpeg.width, jpeg.height};
  if (file.size() < 3 || file[0] != 'P' || file[1] < '1' || file[1] > '6') return size;
  std::size_t at = 2;
  for (std::int64_t& value : size) {
    while (at < file.size() && (file[at] < '0' || file[at] > '9')) {
      if (file[at] == '#')
        while (at < file.size() && file[at] != '\n') ++at;
      if (at < file.size()) ++at;
    }
    for (; at < file.size() && file[at] >= '0' && file[at] <= '9'; ++at)
      value = std::min<std::int64_t>(value * 10 + (file[at] - '0'), std::int64_t{1} << 31);
  }
  return size;
}

void refuse_huge(std::int64_t width, std::int64_t height, const std::string& name) {
  if (height > 0 && width > most_pixels / height)
    throw input_error(name, fmt::format("{} x {} px: expected at most {} px", width, height, most_pixels));
}

// JPEG and PNM pictures that end early are decoded as far as they go, and gray or black from there on.
bool is_cut_short(std::span<const std::uint8_t> file, std::int64_t width, std::int64_t height) {
  constexpr std::array<std::uint8_t, 2> jpeg_begin = {0xFF, 0xD8}, jpeg_end = {0xFF, 0xD9};
  if (file.size() >= 4 && std::ranges::equal(file.first(2), jpeg_begin)) {
    const std::size_t scan = jpeg_header(file).scan;
    return scan == 0 || scan >= file.size() || std::ranges::search(file.subspan(scan), jpeg_end).empty();
  }
  if (file.size() < 3 || file[0] != 'P' || width <= 0 || height <= 0) return false;
  const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  switch (file[1]) {
    case '4':
      return file.size() < static_cast<std::uint64_t>((width + 7) / 8) * static_cast<std::uint64_t>(height);
    case '5':
      return file.size() < pixels;
    case '6':
      return file.size() < 3 * pixels;
    default:
      return false;
  }
}

// OpenCV 4.6 and libpng write what they think of a damaged file on the standard error, which is the program's
// to use: it is closed to them while they decode.
class QuietErrors {
 public:
  QuietErrors() : kept_(::dup(STDERR_FILENO)) {
    const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (kept_ >= 0 && nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
    if (nowhere >= 0) ::close(nowhere);
  }
  ~QuietErrors() {
    if (kept_ < 0) return;
    ::dup2(kept_, STDERR_FILENO);
    ::close(kept_);
  }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  int kept_;
};

cv::Mat decode(std::span<const std::uint8_t> file, const std::string& name) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  if (file.empty()) throw input_error(name, "the file is empty");
  const auto [width, height] = claimed_size(file);
  refuse_huge(width, height, name);
  if (is_cut_short(file, width, height)) throw input_error(name, "the picture is cut short");
  // imdecode reads only.
  const cv::Mat bytes(1, static_cast<int>(file.size()), CV_8U, const_cast<std::uint8_t*>(file.data()));
  cv::Mat mat;
  static std::mutex one_at_a_time;  // The standard error belongs to the whole process.
  const std::lock_guard lock(one_at_a_time);
  const QuietErrors quiet;
  try {
    mat = cv::imdecode(bytes, cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    mat.release();
  }
  if (mat.empty())
    throw input_error(name, "not a picture that can be read: of an unknown kind, damaged, or cut short");
  return mat;
}

bool has_two_values(const Image<std::uint8_t>& picture) {
  if (picture.channels() != 1) return false;
  const auto [least, most] = std::ranges::minmax(picture.values());
  const auto is_either = [low = least, high = most](std::uint8_t value) {
    return value == low || value == high;
  };
  return least < most && std::ranges::all_of(picture.values(), is_either);
}

// Stretched to 0 and 255, and blurred by a pixel: a staircase has no place to a part of a pixel, but its mean
// over some steps has.
Image<std::uint8_t> softened_mask(const Image<std::uint8_t>& mask) {
  constexpr std::array<int, 5> kernel = {1, 4, 6, 4, 1};
  const std::uint8_t most = std::ranges::max(mask.values());
  Image<std::uint16_t> rows(mask.width(), mask.height());
  Image<std::uint8_t> soft(mask.width(), mask.height());
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      int sum = 0;
      for (int i = 0; i < 5; ++i)
        sum += kernel[static_cast<std::size_t>(i)] *
               (mask.at(std::clamp(u + i - 2, 0, mask.width() - 1), v) == most ? 255 : 0);
      rows.at(u, v) = static_cast<std::uint16_t>(sum);
    }
  }
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      int sum = 128;
      for (int i = 0; i < 5; ++i)
        sum += kernel[static_cast<std::size_t>(i)] * rows.at(u, std::clamp(v + i - 2, 0, mask.height() - 1));
      soft.at(u, v) = static_cast<std::uint8_t>(sum / 256);
    }
  }
  return soft;
}

// Sensors of 10 or 12 bits write their values as they are; a few hot pixels do not tell of how many.
int white_of(const Image<std::uint16_t>& words) {
  constexpr std::size_t hot = 10000;  // One of so many may be.
  std::vector<std::uint16_t> values(words.values().begin(), words.values().end());
  const auto place = values.end() - 1 - static_cast<std::ptrdiff_t>(values.size() / hot);
  std::ranges::nth_element(values, place);
  return std::max(255, static_cast<int>(std::bit_ceil(*place + 1U)) - 1);
}

}  // namespace

Photograph decode_picture(std::span<const std::uint8_t> file, const std::string& name) {
  const cv::Mat mat = decode(file, name);
  refuse_huge(mat.cols, mat.rows, name);
  Photograph photograph;
  if (mat.depth() == CV_8U) {
    photograph.bytes = image_of<std::uint8_t>(mat);
  } else if (mat.depth() == CV_16U) {
    photograph.words = image_of<std::uint16_t>(mat);
    photograph.white = white_of(photograph.words);
    photograph.bytes = Image<std::uint8_t>(mat.cols, mat.rows, photograph.words.channels());
    std::ranges::transform(photograph.words.values(), photograph.bytes.values().begin(),
                           [&](std::uint16_t value) {
                             return static_cast<std::uint8_t>(
                                 std::min(255, (value * 255 + photograph.white / 2) / photograph.white));
                           });
  } else {
    throw input_error(name, "values that are not of 8 or 16 bits: expected one of these");
  }
  photograph.is_mask = has_two_values(photograph.bytes);
  if (photograph.is_mask) photograph.bytes = softened_mask(photograph.bytes), photograph.words = {};
  return photograph;
}

Image<std::uint8_t> gray_picture(const Image<std::uint8_t>& picture) { return gray_of_colors(picture); }
Image<std::uint16_t> gray_picture(const Image<std::uint16_t>& picture) { return gray_of_colors(picture); }

}  // namespace flexura

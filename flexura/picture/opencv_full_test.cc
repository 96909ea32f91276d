// Compares with OpenCV's results for equal files. Its imgcodecs is linked neither to the program nor to the
// quick tests. Debian's build of it loads GDAL, and with it Poppler, which is under the GPL.
#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <variant>

#include "flexura/picture/image_file.h"
#include "tests/support/picture_files.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// OpenCV orders colours as blue, green, red. It returns three channels for a palette of grays, or gray with
// alpha.
template <typename T>
void expect_same(const Image<T>& own, const cv::Mat& other) {
  ASSERT_EQ(other.depth(), sizeof(T) == 1 ? CV_8U : CV_16U);
  ASSERT_EQ(other.cols, own.width());
  ASSERT_EQ(other.rows, own.height());
  ASSERT_GE(other.channels(), own.channels());
  for (int v = 0; v < own.height(); ++v)
    for (int u = 0; u < own.width(); ++u)
      for (int c = 0; c < other.channels(); ++c)
        ASSERT_EQ(own.at(u, v, own.channels() == 1 ? 0 : 2 - c), other.ptr<T>(v)[u * other.channels() + c])
            << u << " " << v << " " << c;
}

cv::Mat read_by_opencv(const std::string& file) {
  const cv::Mat bytes(1, static_cast<int>(file.size()), CV_8U, const_cast<char*>(file.data()));
  return cv::imdecode(bytes, cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
}

void compare(const std::string& file) {
  const Picture picture = read_picture(file_bytes(file), "file", 1U << 16U);
  const cv::Mat other = read_by_opencv(file);
  ASSERT_FALSE(other.empty()) << file.substr(0, 20);
  std::visit([&](const auto& image) { expect_same(image, other); }, picture);
}

int side(TestRandom& random) { return random.integer(1, 40); }

Colors random_colors(TestRandom& random, int bits) {
  Colors colors(std::size_t{1} << bits);
  for (auto& color : colors)
    for (std::uint8_t& value : color) value = static_cast<std::uint8_t>(random.integer(0, 255));
  return colors;
}

TEST(OpenCv, ReadsTheSamePng) {
  for_random_cases(40, [](TestRandom& random) {
    for (const bool is_interlaced : {false, true}) {
      for (const int bits : {1, 2, 4, 8}) {
        const auto gray = random_values<std::uint8_t>(random, side(random), side(random), 1, (1 << bits) - 1);
        compare(png_file(gray, {bits, is_interlaced}));
        compare(png_file(gray, {bits, is_interlaced, random_colors(random, bits)}));
      }
      for (const int channels : {1, 2, 3, 4}) {
        compare(png_file(random_values<std::uint8_t>(random, side(random), side(random), channels, 255),
                         {8, is_interlaced}));
        compare(png_file(random_values<std::uint16_t>(random, side(random), side(random), channels, 65535),
                         {16, is_interlaced}));
      }
    }
  });
}

TEST(OpenCv, ReadsTheSameJpeg) {
  for_random_cases(40, [](TestRandom& random) {
    for (const int channels : {1, 3})
      for (const bool is_progressive : {false, true})
        compare(jpeg_file(random_values<std::uint8_t>(random, side(random), side(random), channels, 255),
                          is_progressive));
  });
}

TEST(OpenCv, ReadsTheSameTiff) {
  for_random_cases(40, [](TestRandom& random) {
    for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE})
      for (const int channels : {1, 3}) {
        TiffForm form;
        form.compression = compression;
        form.photometric = channels == 1 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB;
        form.tile = random.integer(0, 1) * 32;  // OpenCV 4.6 does not read uncompressed tiles of 16 px.
        compare(
            tiff_file(random_values<std::uint8_t>(random, side(random), side(random), channels, 255), form));
        form.bits = 16;
        compare(tiff_file(random_values<std::uint16_t>(random, side(random), side(random), channels, 65535),
                          form));
      }
    TiffForm form;
    form.photometric = PHOTOMETRIC_PALETTE, form.palette = random_colors(random, 8);
    compare(tiff_file(random_values<std::uint8_t>(random, side(random), side(random), 1, 255), form));
  });
}

TEST(OpenCv, ReadsTheSamePnm) {
  for_random_cases(40, [](TestRandom& random) {
    for (const bool is_plain : {false, true}) {
      compare(pbm_file(random_values<std::uint8_t>(random, side(random), side(random), 1, 1), is_plain));
      for (const int channels : {1, 3}) {
        compare(pnm_file(random_values<std::uint8_t>(random, side(random), side(random), channels, 255), 255,
                         is_plain));
        compare(pnm_file(random_values<std::uint16_t>(random, side(random), side(random), channels, 65535),
                         65535, is_plain));
      }
    }
  });
}

TEST(OpenCv, ReadsTheSameTiffOfOtherColors) {
  for_random_cases(40, [](TestRandom& random) {
    for (const int photometric : {PHOTOMETRIC_SEPARATED, PHOTOMETRIC_YCBCR, PHOTOMETRIC_CIELAB})
      compare(tiff_file(random_values<std::uint8_t>(random, side(random), side(random),
                                                    photometric == PHOTOMETRIC_SEPARATED ? 4 : 3, 255),
                        {.photometric = photometric, .tile = random.integer(0, 1) * 32}));
  });
}

// OpenCV shifts the values to the upper bits of 16; this library keeps them unchanged.
TEST(OpenCv, ReadsTheSameTiffOfTenToFourteenBitsButShifted) {
  for_random_cases(40, [](TestRandom& random) {
    for (const int bits : {10, 12, 14}) {
      const auto words = random_values<std::uint16_t>(random, side(random), side(random), 1, (1 << bits) - 1);
      const std::string file = tiff_file(words, {.bits = bits});
      auto own = std::get<Image<std::uint16_t>>(read_picture(file_bytes(file), "file", 1U << 16U));
      for (std::uint16_t& value : own.values()) value = static_cast<std::uint16_t>(value << (16 - bits));
      expect_same(own, read_by_opencv(file));
    }
  });
}

TEST(OpenCv, ReadsTheSameInksOfAJpeg) {
  for_random_cases(40, [](TestRandom& random) {
    for (const bool is_luma : {false, true})
      for (const bool is_progressive : {false, true})
        compare(jpeg_file(random_values<std::uint8_t>(random, side(random), side(random), 4, 255),
                          is_progressive, is_luma));
  });
}

}  // namespace
}  // namespace flexura

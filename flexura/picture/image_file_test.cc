#include "flexura/picture/image_file.h"

#include <gtest/gtest.h>
#include <png.h>
#include <tiffio.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

// jpeglib.h needs FILE and size_t before it.
#include <jpeglib.h>

#include "tests/support/random_cases.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

// Reads a file's bytes with libpng, in this machine's byte order.
template <typename T>
Image<T> read_png(const std::string& bytes) {
  png_structp reader = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(reader);
  const char* at = bytes.data();
  png_set_read_fn(reader, static_cast<void*>(&at), [](png_structp png, png_bytep data, png_size_t size) {
    const char*& from = *static_cast<const char**>(png_get_io_ptr(png));
    std::memcpy(data, from, size);
    from += size;
  });
  png_read_png(reader, info, PNG_TRANSFORM_SWAP_ENDIAN, nullptr);
  EXPECT_EQ(png_get_bit_depth(reader, info), 8 * sizeof(T));
  Image<T> image(static_cast<int>(png_get_image_width(reader, info)),
                 static_cast<int>(png_get_image_height(reader, info)), png_get_channels(reader, info));
  for (int v = 0; v < image.height(); ++v)
    std::memcpy(image.row(v).data(), png_get_rows(reader, info)[v], image.row(v).size_bytes());
  png_destroy_read_struct(&reader, &info, nullptr);
  return image;
}

template <typename T>
Image<T> random_image(TestRandom& random, int channels) {
  Image<T> image(static_cast<int>(random.uniform(1, 40)), static_cast<int>(random.uniform(1, 40)), channels);
  for (T& value : image.values())
    value = static_cast<T>(random.uniform(0, static_cast<double>(std::numeric_limits<T>::max()) + 0.99));
  return image;
}

TEST(ImageFile, KeepsEveryValueOfAPng) {
  for_random_cases(40, [](TestRandom& random) {
    for (const int channels : {1, 3}) {
      const auto bytes = random_image<std::uint8_t>(random, channels);
      EXPECT_EQ(read_png<std::uint8_t>(png(bytes)), bytes);
      EXPECT_EQ(read_png<std::uint8_t>(png(bytes, {.level = 1})), bytes);
      EXPECT_EQ(png(bytes), png(bytes));
      const auto words = random_image<std::uint16_t>(random, channels);
      EXPECT_EQ(read_png<std::uint16_t>(png(words)), words);
    }
  });
}

TEST(ImageFile, QuicklyWrittenIsSmallWithNoiseAndWithout) {
  constexpr int width = 200, height = 100;
  TestRandom random(1);
  Image<std::uint8_t> noisy(width, height, 3, 0), flat(width, height, 3, 77);
  Image<std::uint16_t> deep(width, height, 1, 0);
  for (int v = 0; v < height; ++v) {
    for (std::uint8_t& value : noisy.row(v)) value = static_cast<std::uint8_t>(100 + random.uniform(-6, 6));
    for (std::uint16_t& value : deep.row(v))
      value = static_cast<std::uint16_t>(3000 + random.uniform(-90, 90));
  }
  const std::string noisy_file = png(noisy, {.level = 1}), flat_file = png(flat, {.level = 1}),
                    deep_file = png(deep, {.level = 1});
  EXPECT_LT(noisy_file.size(), noisy.values().size() / 2) << "3.6 bits of 8 are noise";
  EXPECT_LT(flat_file.size(), 1000U);
  EXPECT_EQ(read_png<std::uint8_t>(noisy_file), noisy);
  EXPECT_EQ(read_png<std::uint8_t>(flat_file), flat);
  EXPECT_EQ(read_png<std::uint16_t>(deep_file), deep);
  EXPECT_EQ(png(noisy, {.level = 1}), noisy_file) << "equal pictures, equal bytes";
}

TEST(ImageFile, ReadsBackEveryValueOfAPng) {
  for_random_cases(40, [](TestRandom& random) {
    for (const int channels : {1, 3}) {
      const auto bytes = random_image<std::uint8_t>(random, channels);
      EXPECT_EQ(std::get<Image<std::uint8_t>>(flexura::read_png(png(bytes))), bytes);
      const auto words = random_image<std::uint16_t>(random, channels);
      EXPECT_EQ(std::get<Image<std::uint16_t>>(flexura::read_png(png(words))), words);
    }
  });
}

TEST(ImageFile, RefusesADamagedPng) {
  for_random_cases(60, [](TestRandom& random) {
    const std::string whole = png(random_image<std::uint8_t>(random, 3));
    const auto at = [&] {
      return static_cast<std::size_t>(random.uniform(0, static_cast<double>(whole.size())));
    };
    EXPECT_THROW((void)flexura::read_png(whole.substr(0, at())), std::runtime_error);
    std::string changed = whole;
    char& byte = changed[at()];
    byte = static_cast<char>(byte ^ 0x10);
    EXPECT_THROW((void)flexura::read_png(changed), std::runtime_error);
  });
  EXPECT_THROW((void)flexura::read_png(png(Image<std::uint8_t>(9, 9)), 80), std::runtime_error);
}

// Reads a file's bytes with libjpeg.
Image<std::uint8_t> read_jpeg(const std::string& bytes) {
  jpeg_decompress_struct job{};
  jpeg_error_mgr errors{};
  job.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&job);
  jpeg_mem_src(&job, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&job, TRUE);
  jpeg_start_decompress(&job);
  Image<std::uint8_t> image(static_cast<int>(job.output_width), static_cast<int>(job.output_height),
                            job.output_components);
  while (job.output_scanline < job.output_height) {
    JSAMPROW row = image.row(static_cast<int>(job.output_scanline)).data();
    jpeg_read_scanlines(&job, &row, 1);
  }
  jpeg_finish_decompress(&job);
  jpeg_destroy_decompress(&job);
  return image;
}

TEST(ImageFile, KeepsASmoothPictureInAJpegNearly) {
  for (const int channels : {1, 3}) {
    Image<std::uint8_t> image(61, 43, channels);
    for (int v = 0; v < image.height(); ++v)
      for (int u = 0; u < image.width(); ++u)
        for (int c = 0; c < channels; ++c) image.at(u, v, c) = static_cast<std::uint8_t>(2 * u + v + 20 * c);
    const std::string file = jpeg(image, {.quality = 95});
    EXPECT_EQ(file, jpeg(image, {.quality = 95}));
    EXPECT_LT(jpeg(image, {.quality = 30}).size(), file.size());
    const Image<std::uint8_t> back = read_jpeg(file);
    ASSERT_EQ(back.width(), image.width());
    ASSERT_EQ(back.height(), image.height());
    ASSERT_EQ(back.channels(), channels);
    for (std::size_t i = 0; i < image.values().size(); ++i)
      ASSERT_NEAR(back.values()[i], image.values()[i], 6) << i;
  }
}

TEST(ImageFile, KeepsEveryValueOfATiff) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "depth.tiff";
  Image<float> image(37, 21);
  for (std::size_t i = 0; i < image.values().size(); ++i)
    image.values()[i] = 1.0F / static_cast<float>(i);  // The first is infinite.
  std::ofstream(file, std::ios::binary) << tiff(image);
  EXPECT_EQ(tiff(image), tiff(image));
  TIFF* open = TIFFOpen(file.c_str(), "r");
  ASSERT_NE(open, nullptr);
  std::vector<float> row(37);
  for (int v = 0; v < image.height(); ++v) {
    ASSERT_EQ(TIFFReadScanline(open, row.data(), static_cast<std::uint32_t>(v)), 1);
    for (int u = 0; u < image.width(); ++u) EXPECT_EQ(row[static_cast<std::size_t>(u)], image.at(u, v));
  }
  TIFFClose(open);
}

TEST(ImageFile, RefusesWhatIsNoPicture) {
  EXPECT_THROW((void)png(Image<std::uint8_t>()), std::invalid_argument);
  EXPECT_THROW((void)png(Image<std::uint8_t>(3, 3, 2)), std::invalid_argument);
  EXPECT_THROW((void)tiff(Image<float>()), std::invalid_argument);
  EXPECT_THROW((void)jpeg(Image<std::uint8_t>()), std::invalid_argument);
  EXPECT_THROW((void)jpeg(Image<std::uint8_t>(3, 3, 2)), std::invalid_argument);
  EXPECT_THROW((void)jpeg(Image<std::uint8_t>(65501, 1)), std::invalid_argument);
  EXPECT_THROW((void)jpeg(Image<std::uint8_t>(3, 3), {.quality = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace flexura

#include "flexura/vision/picture_hints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

namespace flexura {
namespace {

using testing::HasSubstr;

TEST(PictureHints, TellForWhichSizeOfPicturesALensIsDescribed) {
  const Lens lens(Intrinsics{.fx = 800, .fy = 800, .cx = 319.5, .cy = 239.5});
  EXPECT_EQ(hint_of_size(lens, 640, 480), std::nullopt);
  EXPECT_THAT(hint_of_size(lens, 320, 240).value_or(""), HasSubstr("of another size, 2 times as large?"));
  // A crop of a picture is not a picture of another size.
  EXPECT_THAT(hint_of_size(lens, 400, 480).value_or(""), HasSubstr("of another size?"));
}

TEST(PictureHints, TellOfSaturation) {
  Image<std::uint8_t> gray(20, 10, 1, 254);
  for (int v = 0; v < 2; ++v)
    for (int u = 0; u < 10; ++u) gray.at(u, v) = 255;
  EXPECT_EQ(hint_of_exposure(gray), std::nullopt) << "a tenth";
  gray.at(0, 9) = 255;
  EXPECT_THAT(hint_of_exposure(gray).value_or(""), HasSubstr("10 % of the picture is saturated"));
}

}  // namespace
}  // namespace flexura

#include <tiffio.h>

#include <stdexcept>
#include <vector>

#include "flexura/picture/picture_kinds.h"
#include "flexura/picture/tiff_input.h"

namespace flexura {
namespace {

struct EndMixing {
  void operator()(TIFFRGBAImage* mixer) const { TIFFRGBAImageEnd(mixer); }
};

}  // namespace

Image<std::uint8_t> read_mixed_tiff(TIFF* open, const TiffInput& input) {
  char text[1024] = {};
  TIFFRGBAImage mixer;
  constexpr int stops_at_errors = 1;
  if (TIFFRGBAImageOK(open, text) == 0 || TIFFRGBAImageBegin(&mixer, open, stops_at_errors, text) == 0)
    throw damaged("TIFF", text);
  const std::unique_ptr<TIFFRGBAImage, EndMixing> end(&mixer);
  mixer.orientation = mixer.req_orientation = ORIENTATION_TOPLEFT;  // Prevents rotation by libtiff.
  Image<std::uint8_t> image(static_cast<int>(mixer.width), static_cast<int>(mixer.height), 3);
  std::vector<std::uint32_t> pixels(image.values().size() / 3);
  if (TIFFRGBAImageGet(&mixer, pixels.data(), mixer.width, mixer.height) == 0) throw input.problem();
  std::uint8_t* to = image.values().data();
  for (const std::uint32_t pixel : pixels) {
    *to++ = static_cast<std::uint8_t>(TIFFGetR(pixel));
    *to++ = static_cast<std::uint8_t>(TIFFGetG(pixel));
    *to++ = static_cast<std::uint8_t>(TIFFGetB(pixel));
  }
  return image;
}

}  // namespace flexura

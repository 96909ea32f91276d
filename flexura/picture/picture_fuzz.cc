// Interprets any bytes as a picture file: the result must be a small picture, or one error in one line of
// ASCII.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <variant>

#include "flexura/base/source.h"
#include "flexura/picture/image_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t most_pixels = 4096;
  try {
    const flexura::Picture picture = flexura::read_picture({data, size}, "fuzz", most_pixels);
    std::visit(
        [](const auto& image) {
          const auto width = static_cast<std::size_t>(image.width()),
                     height = static_cast<std::size_t>(image.height());
          if (width == 0 || height == 0 || width > most_pixels / height) std::abort();
          if (image.channels() != 1 && image.channels() != 3) std::abort();
          if (image.values().size() != width * height * static_cast<std::size_t>(image.channels()))
            std::abort();
        },
        picture);
  } catch (const flexura::InputError& error) {
    const std::string line = error.what();
    const auto is_plain = [](char c) { return c >= ' ' && c <= '~'; };
    if (error.problems().size() != 1 || !std::ranges::all_of(line, is_plain)) std::abort();
  }
  return 0;
}

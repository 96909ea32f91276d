// Fuzzes the measurement of pictures. The bytes are a picture file, or the pixels of a small picture, with
// any settings. Required: an error, or one JSON document that can be read back, and the same result when run
// again.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include "flexura/app/measure.h"
#include "flexura/base/source.h"
#include "flexura/store/json.h"

namespace {

// Returns a PGM or PPM file of the bytes after the first three.
std::string small_picture(std::span<const std::uint8_t> data) {
  const int channels = data[0] % 2 == 0 ? 1 : 3, width = 1 + data[1] % 48;
  const auto pixels = data.subspan(3);
  const int height = std::min(48, std::max(1, static_cast<int>(pixels.size()) / (width * channels)));
  std::string file =
      (channels == 1 ? "P5\n" : "P6\n") + std::to_string(width) + " " + std::to_string(height) + "\n255\n";
  for (int i = 0; i < width * height * channels; ++i) {
    // Each byte sets several pixels, which makes figures likely.
    const std::size_t from = static_cast<std::size_t>(i) / (1 + data[2] % 6);
    file += static_cast<char>(from < pixels.size() ? pixels[from] : 200);
  }
  return file;
}

std::string answer(const std::string& file, flexura::MeasureTarget what, bool by_block) {
  flexura::MeasureConfig config;
  config.what = what;
  if (by_block) config.finder.threshold.method = flexura::ThresholdMethod::by_block;
  config.camera = flexura::MeasuredCamera{};
  config.radius = 0.02;
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(file.data()), file.size());
  try {
    const flexura::Measurement found = flexura::measure_picture(bytes, "fuzz", config, true);
    if (found.is_found == (found.answer.find("reason") != nullptr)) std::abort();
    return flexura::write_json(found.answer);
  } catch (const flexura::InputError& error) {
    return std::string("\"") + (error.problems().empty() ? "" : "problem") + "\"";
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 4 || size > 20000) return 0;
  const std::span<const std::uint8_t> input(data, size);
  const bool is_file =
      data[0] == 0xFF || data[0] == 0x89 || data[0] == 'P' || data[0] == 'B' || data[0] == 'I';
  const std::string file =
      is_file ? std::string(reinterpret_cast<const char*>(data), size) : small_picture(input);
  const auto what = static_cast<flexura::MeasureTarget>(data[2] / 2 % 4);
  const std::string once = answer(file, what, data[2] % 2 == 0);
  (void)flexura::parse_json(once, "answer");
  if (data[2] % 16 < 2 && once != answer(file, what, data[2] % 2 == 0)) std::abort();
  return 0;
}

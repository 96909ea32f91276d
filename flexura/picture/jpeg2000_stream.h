#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace flexura {

/// Goes over a JPEG 2000 file's parts without decoding any, a JP2 file or the stream within one. OpenJPEG
/// takes memory for what a file claims, and takes what is there for the whole. Throws std::runtime_error with
/// one line: cut short, damaged, a tile missing, without pixels or with more than `most_pixels`, of more
/// than four values a pixel.
void check_jpeg2000(std::span<const std::uint8_t> file, std::size_t most_pixels);

/// Whether `file` is a stream without the boxes of JP2.
[[nodiscard]] bool is_jpeg2000_stream(std::span<const std::uint8_t> file);

}  // namespace flexura

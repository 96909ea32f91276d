#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "flexura/base/image.h"

// Internals of read_picture(): a reader for each kind of file (read_png is in image_file.h), and shared
// functions. Each reader throws std::runtime_error with one line for a file that it does not read.
namespace flexura {

[[nodiscard]] Picture read_jpeg(std::span<const std::uint8_t> file, std::size_t most_pixels);
[[nodiscard]] Picture read_tiff(std::span<const std::uint8_t> file, std::size_t most_pixels);
[[nodiscard]] Picture read_pnm(std::span<const std::uint8_t> file, std::size_t most_pixels);

/// Throws for a size without pixels, or with more than `most_pixels`. Call it before allocating: a small file
/// can claim a huge picture.
void check_picture_size(std::int64_t width, std::int64_t height, std::size_t most_pixels);

/// Exceptions to throw: `kind` is "PNG", ...; `text` is a library's message, of which printable ASCII is
/// kept.
[[nodiscard]] std::runtime_error cut_short(std::string_view kind);
[[nodiscard]] std::runtime_error damaged(std::string_view kind, std::string_view text);

/// The colours of a file's indices; those that it does not list are black.
using Palette = std::array<std::array<std::uint8_t, 3>, 256>;

/// Returns the picture of `indices` (one channel): gray if the palette has grays alone.
[[nodiscard]] Image<std::uint8_t> painted(Image<std::uint8_t> indices, const Palette& palette);

}  // namespace flexura

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
// functions. Each reader throws std::runtime_error with a message of one line for a file that the reader does
// not support.
namespace flexura {

[[nodiscard]] Picture read_jpeg(std::span<const std::uint8_t> file, std::size_t most_pixels);
[[nodiscard]] Picture read_tiff(std::span<const std::uint8_t> file, std::size_t most_pixels);
[[nodiscard]] Picture read_pnm(std::span<const std::uint8_t> file, std::size_t most_pixels);

/// Throws std::runtime_error for a size without pixels or with more than `most_pixels` pixels. Must be called
/// before allocating memory, because a small file can claim a huge size.
void check_picture_size(std::int64_t width, std::int64_t height, std::size_t most_pixels);

/// Returns the exception to throw for a truncated file. `kind` is the kind of file, such as "PNG".
[[nodiscard]] std::runtime_error cut_short(std::string_view kind);
/// Returns the exception to throw for a damaged file. `kind` is the kind of file, such as "PNG". `text` is a
/// library's message, of which only printable ASCII is kept.
[[nodiscard]] std::runtime_error damaged(std::string_view kind, std::string_view text);

/// The colour of each index of a file with a palette. Indices that the file's palette does not contain are
/// black.
using Palette = std::array<std::array<std::uint8_t, 3>, 256>;

/// Returns the picture with the palette's colours, from a picture of indices (one channel). The result is
/// gray if the palette has only grays.
[[nodiscard]] Image<std::uint8_t> painted(Image<std::uint8_t> indices, const Palette& palette);

}  // namespace flexura

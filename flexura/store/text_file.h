#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace flexura {

/// Returns true if nothing exists at a path. A path that cannot be checked, such as a link to itself, counts
/// as existing. A later attempt to open such a path reports the reason.
[[nodiscard]] bool is_missing(const std::filesystem::path& path);

/// Returns the bytes of a file or of a pipe. Throws InputError if the file cannot be read or has more than
/// `max_bytes`, and for a folder or a device. Also throws InputError for a named pipe (FIFO) into which
/// nothing is written for `longest_silence`, s. Waits without limit for the standard input.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes,
                                         double longest_silence = 10);

/// Returns the path of the file `name` in `folder` or below it, after resolving links. Throws InputError,
/// without a position, if the file is outside `folder` or is not a regular file.
[[nodiscard]] std::filesystem::path file_inside(const std::filesystem::path& folder, const std::string& name);

/// Writes a new file completely or not at all. Throws std::runtime_error with the path if the file exists or
/// cannot be written.
void write_new_file(const std::filesystem::path& file, std::string_view text);

/// Writes a new or an existing file. An existing file keeps its old content until the new content has been
/// written completely. Throws std::runtime_error with the path on a system error.
void replace_file(const std::filesystem::path& file, std::string_view text);

}  // namespace flexura

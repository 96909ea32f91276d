#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace flexura {

/// Whether nothing is at a path. What cannot be looked at (a link to itself) is there: whoever opens it
/// learns why not.
[[nodiscard]] bool is_missing(const std::filesystem::path& path);

/// The bytes of a file. Throws InputError when it cannot be read, is no regular file or holds more than
/// `max_bytes`.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file, std::size_t max_bytes);

/// The file `name` in `folder` or below it, once links are resolved. Throws InputError, without a place, when
/// it lies outside or is no file.
[[nodiscard]] std::filesystem::path file_inside(const std::filesystem::path& folder, const std::string& name);

/// Writes a new file, whole or none; std::runtime_error with the path when it exists or cannot be written.
void write_new_file(const std::filesystem::path& file, std::string_view text);

/// Writes a file that may be there already: it keeps its old content until all of the new is written.
/// std::runtime_error with the path when the system refuses.
void replace_file(const std::filesystem::path& file, std::string_view text);

}  // namespace flexura

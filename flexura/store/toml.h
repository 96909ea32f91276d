#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/field.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"

namespace flexura {

/// Largest file, bytes: experiments are smaller, and a wrong file should not fill the memory.
inline constexpr std::size_t max_toml_bytes = std::size_t{16} << 20;

/// Parses a TOML document into nodes with positions. Throws InputError (source:line:column) at the first
/// error: invalid TOML, text that is not UTF-8, nesting that is too deep. Repeated keys are reported
/// together, up to 20. If `repeated` is given, they are appended there instead. The document is then read
/// with only the first of each key, so that the rest can be checked in the same run.
[[nodiscard]] Node parse_toml(std::string_view text, const std::string& source,
                              std::vector<Problem>* repeated = nullptr);

/// Parses one TOML value, as given by `--set path=value`; a bare word is a text.
[[nodiscard]] Node parse_toml_value(std::string_view text, const std::string& source, int line, int column);

/// Reads a TOML file. `include = ["rig.toml", ...]` overlays the file's own values on those of the named
/// files, which must be in the file's folder or below. Tables are merged key by key, arrays are replaced.
/// Throws InputError for the errors of parse_toml, a missing or unreadable file, and an include outside the
/// folder, in a circle or too deep. `repeated`: as for parse_toml, for all files.
[[nodiscard]] Node read_toml_file(const std::filesystem::path& file,
                                  std::vector<Problem>* repeated = nullptr);

/// Returns the table as a TOML document that parses back to equal values. `info` gives the units in comments.
[[nodiscard]] std::string write_toml(const Node& table, const TableInfo& info);

}  // namespace flexura

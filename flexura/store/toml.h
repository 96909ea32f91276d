#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/field.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"

namespace flexura {

/// Largest size of a file, bytes. Experiments are smaller. The limit prevents a wrong file from filling the
/// memory.
inline constexpr std::size_t max_toml_bytes = std::size_t{16} << 20;

/// Parses a TOML document into nodes with positions. Throws InputError (source:line:column) at the first
/// error: invalid TOML, text that is not UTF-8, or nesting that is too deep. Up to 20 repeated keys are
/// reported together. If `repeated` is given, repeated keys are appended to it instead of being thrown. With
/// `repeated`, the document has only the first value of each key, so that the caller can check the other
/// keys.
[[nodiscard]] Node parse_toml(std::string_view text, const std::string& source,
                              std::vector<Problem>* repeated = nullptr);

/// Parses one TOML value, as given by `--set path=value`. A word without quotes is a text.
[[nodiscard]] Node parse_toml_value(std::string_view text, const std::string& source, int line, int column);

/// Reads a TOML file. `include = ["rig.toml", ...]` takes values from the named files, which must be in the
/// file's folder or below. The file's own values replace included values: tables are merged key by key,
/// arrays are replaced. Throws InputError for the errors of parse_toml and for a missing or unreadable file.
/// Also throws InputError for an include that is outside the folder, circular or nested too deeply.
/// `repeated`: as in parse_toml(), for all files.
[[nodiscard]] Node read_toml_file(const std::filesystem::path& file,
                                  std::vector<Problem>* repeated = nullptr);

/// Returns the table as a TOML document that parses to equal values, with comments. `info`: description of
/// the table, with the units for the comments.
[[nodiscard]] std::string write_toml(const Node& table, const TableInfo& info);

}  // namespace flexura

#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/base/field.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"

namespace flexura {

/// Files larger than this are refused: no experiment needs it, and a wrong file should not fill the memory.
inline constexpr std::size_t max_toml_bytes = std::size_t{16} << 20;

/// Parses a TOML document into nodes with positions. Throws InputError (source:line:column) on the first
/// thing that is not TOML: text that is not UTF-8, nesting deeper than a person would write; or on the keys
/// that are written twice, up to 20 at once. With `repeated` these are appended there instead, and the
/// document is read as if only the first of each were there, so that the rest can be judged in the same go.
[[nodiscard]] Node parse_toml(std::string_view text, const std::string& source,
                              std::vector<Problem>* repeated = nullptr);

/// Parses one TOML value, as `--set path=value` gives it; a bare word is taken as a text.
[[nodiscard]] Node parse_toml_value(std::string_view text, const std::string& source, int line, int column);

/// Reads a TOML file. `include = ["rig.toml", ...]` lays the file's own values upon those of the files named,
/// which must lie in the file's folder or below; tables are merged key by key, arrays replaced whole. Throws
/// InputError: what parse_toml throws, a missing or unreadable file, an include outside the folder, in a
/// circle or too deep. `repeated`: as for parse_toml, of all files.
[[nodiscard]] Node read_toml_file(const std::filesystem::path& file,
                                  std::vector<Problem>* repeated = nullptr);

/// The table as a TOML document that parses back to the same values. `info` gives the units that go into
/// comments.
[[nodiscard]] std::string write_toml(const Node& table, const TableInfo& info);

}  // namespace flexura

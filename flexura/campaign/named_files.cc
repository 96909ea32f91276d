#include "flexura/campaign/named_files.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <optional>
#include <set>
#include <system_error>

#include "flexura/base/source.h"
#include "flexura/store/text_file.h"
#include "flexura/store/toml.h"

namespace flexura {
namespace {

// G. Fowler, L. C. Noll, P. Vo: FNV-1a with 64 bits.
std::optional<std::string> digest_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::uint64_t digest = 0xcbf29ce484222325;
  std::array<char, 65536> bytes{};
  while (file) {
    file.read(bytes.data(), bytes.size());
    for (std::streamsize i = 0; i < file.gcount(); ++i) {
      digest ^= static_cast<unsigned char>(bytes[static_cast<std::size_t>(i)]);
      digest *= 0x100000001b3;
    }
  }
  if (!file.eof()) return std::nullopt;
  return fmt::format("{:016x}", digest);
}

void add_texts(const Node& node, std::set<std::string>& texts) {
  if (const auto* text = node.as<std::string>()) texts.insert(*text);
  if (const auto* list = node.as<Node::Array>())
    for (const Node& one : *list) add_texts(one, texts);
  if (const auto* table = node.as<Node::Table>())
    for (const Node::Member& member : *table) add_texts(member.node, texts);
}

std::optional<std::string> digest_in(const std::filesystem::path& folder, const std::string& name) {
  try {
    return digest_of(file_inside(folder, name));
  } catch (const InputError&) {
    return std::nullopt;  // No file: another text.
  } catch (const std::system_error&) {
    return std::nullopt;
  }
}

}  // namespace

std::vector<NamedFile> named_files(const Node& document, const CampaignConfig& config,
                                   const std::filesystem::path& folder) {
  std::set<std::string> texts;
  add_texts(document, texts);
  for (const ParameterConfig& parameter : config.parameter)
    if (const auto* choice = std::get_if<ChoiceParameter>(&parameter))
      for (const std::string& value : choice->choices)
        add_texts(parse_toml_value(value, "choice", 1, 1), texts);
  std::vector<NamedFile> files;
  for (const std::string& text : texts)
    if (const auto digest = digest_in(folder, text)) files.push_back({text, *digest});
  return files;
}

std::string change_of(const NamedFile& file, const std::filesystem::path& folder) {
  const auto digest = digest_in(folder, file.name);
  if (!digest) return "is missing";
  return *digest == file.digest ? "" : "has changed";
}

}  // namespace flexura

#include "flexura/base/table.h"

#include <fmt/format.h>

#include <stdexcept>

namespace flexura {
namespace {

// An array that must not be empty in a file is empty by default if the file omits the array.
bool is_default(const Node& node, const Spec& spec) {
  const auto* entries = node.as<Node::Array>();
  return node.empty() || (entries != nullptr && entries->empty() && spec.count.min > 0);
}

}  // namespace

AnyTable::AnyTable(std::string name, std::string meaning) {
  info_.name = std::move(name), info_.meaning = std::move(meaning);
}

void AnyTable::add(std::string name, std::size_t offset, const ValueCodec& codec, const void* default_value,
                   Spec spec) {
  FieldInfo info{std::move(name), codec.type(), std::move(spec), {}};
  if (!info.spec.required) {
    info.default_text =
        info.spec.default_text.empty() ? codec.write(default_value).literal() : info.spec.default_text;
  }
  info_.fields.push_back(std::move(info));
  bindings_.push_back({offset, &codec});
}

void AnyTable::add_renamed(std::string old_name, std::string name) {
  if (info_.find(name) == nullptr || info_.find(old_name) != nullptr)
    throw std::logic_error(fmt::format("{}: {} cannot be renamed {}", info_.name, old_name, name));
  info_.renamed.push_back({std::move(old_name), std::move(name)});
}

bool AnyTable::read_at(const Node& node, Reader& reader, void* value, std::string_view tag) const {
  const std::size_t problems_before = reader.problems().size();
  const std::vector<FoundField> found = find_fields(node, info_, reader, tag);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].member == nullptr) continue;
    const Node::Member& member = *found[i].member;
    // Position of the key, to which problems refer. Positions within texts are after the key.
    SourcePosition where = member.where;
    if (member.node.where.source == where.source && member.node.where.line == where.line)
      where.text_column = member.node.where.text_column;
    const Reader::Scope scope(reader, info_.fields[i].name, member.key, where);
    reader.spelling = found[i].spelling;
    bindings_[i].codec->read(member.node, info_.fields[i].spec, reader,
                             static_cast<char*>(value) + bindings_[i].offset);
    reader.spelling = {"", 1.0, ""};
  }
  if (reader.problems().size() == problems_before) {
    for (const auto& rule : checks_) rule(value, reader);
  }
  return reader.problems().size() == problems_before;
}

Node AnyTable::write_at(const void* value) const {
  Node::Table members;
  for (std::size_t i = 0; i < bindings_.size(); ++i) {
    Node node = bindings_[i].codec->write(static_cast<const char*>(value) + bindings_[i].offset);
    if (!is_default(node, info_.fields[i].spec))
      members.push_back({info_.fields[i].name, {}, std::move(node)});
  }
  return {std::move(members), {}};
}

}  // namespace flexura

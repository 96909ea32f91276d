#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "flexura/base/field.h"
#include "flexura/base/node.h"
#include "flexura/base/source.h"
#include "flexura/base/unit.h"

namespace flexura {

/// Tracks the current position in a document that is read into typed values, and collects problems. Tables of
/// fields (table.h) change the current position. Checks across fields report problems at the position of a
/// field.
class Reader {
 public:
  /// Makes a part of the document the reader's current position during the lifetime of this object.
  class Scope {
   public:
    Scope(Reader& reader, std::string_view name, const SourcePosition& where);
    /// Enters a field. Messages show the field as written in the file (`key`); checks across fields refer to
    /// its `name`.
    Scope(Reader& reader, std::string_view name, std::string_view key, const SourcePosition& where);
    /// Enters the entry `index`, counted from 0, of the array at the current position.
    Scope(Reader& reader, std::size_t index, const SourcePosition& where);
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    ~Scope();

   private:
    Reader& reader_;
    std::size_t path_size_;
  };

  /// Reports a problem at the current position: "PATH: what".
  void problem(std::string what);
  /// Reports a problem at `path`, relative to the current position ("task[0].to.bends"). If the document does
  /// not contain the path, the reader reports the position of the longest part of the path that the document
  /// contains.
  void problem_at(std::string_view path, std::string what);
  /// Reports a problem at the character `offset`, counted from 0, of the text at `path`. The message has the
  /// character's position in the file if known; otherwise "at character N of TEXT" is appended.
  void problem_in_text(std::string_view path, const std::string& text, std::size_t offset, std::string what);
  /// Reports "PATH = VALUE: expected ...".
  void unexpected(const Node& node, std::string_view expected);
  /// Reports that one of `choices` is expected, and suggests the choice that is nearest to the written text.
  void unexpected_choice(const Node& node, const std::vector<std::string>& choices);

  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }
  /// Throws all problems as one InputError, if there are any.
  void throw_if_any() const;

  // --- used by the codecs (table.h) ---

  /// The unit in which the current field is written.
  UnitSpelling spelling = {"", 1.0, ""};

  /// Reads a finite number within the range, in base units; otherwise reports a problem and returns false.
  bool number(const Node& node, const Spec& spec, double& value);
  /// Reads an integer within the range, without conversion of units. Otherwise reports a problem and returns
  /// false. 3.0 is not an integer.
  bool integer(const Node& node, const Spec& spec, std::int64_t& value);
  /// Reads a text. Reports a problem and returns false if the text has control characters, which could make
  /// its printed form misleading.
  bool text(const Node& node, std::string& value);
  /// Returns the array if the node is an array with an accepted number of entries; otherwise reports a
  /// problem and returns null. `item` is the kind of the entries. For tables, the message shows how to write
  /// an array of tables instead of a single table.
  const Node::Array* array(const Node& node, const Count& count, Type::Kind item);

 private:
  [[nodiscard]] std::string below(std::string_view name) const;
  [[nodiscard]] SourcePosition place_of(std::string path) const;

  std::string path_;
  std::unordered_map<std::string, SourcePosition> written_;  ///< Position of every path read so far.
  std::vector<Problem> problems_;
};

/// A field found in a document, with the unit of its key.
struct FoundField {
  /// Key and value in the document; null if the field was omitted. The document must outlive this pointer.
  const Node::Member* member = nullptr;
  UnitSpelling spelling;  ///< The unit given by the key.
};

/// Returns one entry for each field of `table`, in the table's order; `member` is null if the field is
/// omitted. Reports a node that is not a table, unknown keys with a suggested name, wrong units, fields
/// written in two units, and missing required fields. `tag` is an additional accepted key ("kind" of a
/// one_of), or "".
[[nodiscard]] std::vector<FoundField> find_fields(const Node& node, const TableInfo& table, Reader& reader,
                                                  std::string_view tag = {});

}  // namespace flexura

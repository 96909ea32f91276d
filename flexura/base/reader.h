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

/// Position of a typed read in the document, and the problems found so far. Tables of fields (table.h) drive
/// it; checks across fields use it to report at the position of a field.
class Reader {
 public:
  /// Makes the part of the document named `name` the current place while in scope.
  class Scope {
   public:
    Scope(Reader& reader, std::string_view name, const SourcePosition& where);
    /// A field, which messages show as written (`key`) and checks by its `name`.
    Scope(Reader& reader, std::string_view name, std::string_view key, const SourcePosition& where);
    /// The entry `index`, from 0, of the array that is the current place.
    Scope(Reader& reader, std::size_t index, const SourcePosition& where);
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    ~Scope();

   private:
    Reader& reader_;
    std::size_t path_size_;
  };

  /// Reports a problem at the current place: "PATH: what".
  void problem(std::string what);
  /// Reports a problem at `path`, relative to the current place ("task[0].to.bends"), or at its nearest
  /// written part.
  void problem_at(std::string_view path, std::string what);
  /// Reports a problem for the character `offset` (from 0) of the text at `path`. It is reported at its
  /// position in the file if that is known, otherwise followed by "at character N of TEXT".
  void problem_in_text(std::string_view path, const std::string& text, std::size_t offset, std::string what);
  /// Reports "PATH = VALUE: expected ...".
  void unexpected(const Node& node, std::string_view expected);
  /// Reports that one of `choices` is expected, with the one that is probably meant.
  void unexpected_choice(const Node& node, const std::vector<std::string>& choices);

  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }
  /// Throws all problems as one InputError, if there are any.
  void throw_if_any() const;

  // --- used by the codecs (table.h) ---

  /// The unit in which the current field is written.
  UnitSpelling spelling = {"", 1.0, ""};

  /// Reads a finite number within the range, in base units; otherwise reports a problem and returns false.
  bool number(const Node& node, const Spec& spec, double& value);
  /// Reads an integer within the range, without conversion of units; otherwise reports a problem and returns
  /// false. 3.0 is not an integer.
  bool integer(const Node& node, const Spec& spec, std::int64_t& value);
  /// Reads a text without control characters, so that its printed form cannot be misleading.
  bool text(const Node& node, std::string& value);
  /// Returns the array if the node is one with the right number of entries; otherwise reports a problem and
  /// returns null. `item` is the kind of its entries: the message shows how to write an array of tables
  /// instead of a single table.
  const Node::Array* array(const Node& node, const Count& count, Type::Kind item);

 private:
  [[nodiscard]] std::string below(std::string_view name) const;
  [[nodiscard]] SourcePosition place_of(std::string path) const;

  std::string path_;
  std::unordered_map<std::string, SourcePosition> written_;  ///< Every place read so far.
  std::vector<Problem> problems_;
};

/// A field of `table` found in a document, its spelling and value.
struct FoundField {
  /// Null if the field was omitted; otherwise it points into the document, which must outlive it.
  const Node::Member* member = nullptr;
  UnitSpelling spelling;  ///< The unit given by the key.
};

/// Finds each field of `table` (in its order; `member` null if omitted). Reports: not a table, unknown keys
/// with the probable name, wrong units, a field written in two units, missing required fields. `tag` is an
/// additional accepted key ("kind" of a one_of), or "".
[[nodiscard]] std::vector<FoundField> find_fields(const Node& node, const TableInfo& table, Reader& reader,
                                                  std::string_view tag = {});

}  // namespace flexura

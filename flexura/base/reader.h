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

/// Where a typed read stands in the document, and the problems found so far. Tables of fields (table.h) drive
/// it; checks across fields use it to report at the place a field was written.
class Reader {
 public:
  /// Makes the part of the document named `name` the current place while in scope.
  class Scope {
   public:
    Scope(Reader& reader, std::string_view name, const SourcePosition& where);
    /// A field, which messages name as it was spelt (`key`) and checks by its `name`.
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
  /// Reports a problem at `path`, relative to the current place ("task[0].to.bends"), or at its nearest part
  /// that was written.
  void problem_at(std::string_view path, std::string what);
  /// The same for the character `offset` (from 0) of the text at `path`: at its place in the file where that
  /// is known, else followed by "at character N of TEXT".
  void problem_in_text(std::string_view path, const std::string& text, std::size_t offset, std::string what);
  /// "PATH = VALUE: expected ...".
  void unexpected(const Node& node, std::string_view expected);
  /// The same where a word out of `choices` is expected, with the one that may be meant.
  void unexpected_choice(const Node& node, const std::vector<std::string>& choices);

  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }
  /// Throws every problem as one InputError, if there are any.
  void throw_if_any() const;

  // --- used by the codecs (table.h) ---

  /// The unit in which the current field is written.
  UnitSpelling spelling = {"", 1.0, ""};

  /// A finite number within the range, in base units; a problem and false otherwise.
  bool number(const Node& node, const Spec& spec, double& value);
  /// The same of a whole number, within the range as it stands: units are not counted in. 3.0 is no whole
  /// one.
  bool integer(const Node& node, const Spec& spec, std::int64_t& value);
  /// A text without control characters: one that is printed cannot pass for more than it is.
  bool text(const Node& node, std::string& value);
  /// The array, when the node is one and has the right number of entries; a problem and null otherwise. One
  /// of `item`s, which tells how to write an array of tables where a single table stands.
  const Node::Array* array(const Node& node, const Count& count, Type::Kind item);

 private:
  [[nodiscard]] std::string below(std::string_view name) const;
  [[nodiscard]] SourcePosition place_of(std::string path) const;

  std::string path_;
  std::unordered_map<std::string, SourcePosition> written_;  ///< Every place read so far.
  std::vector<Problem> problems_;
};

/// A field of `table` found in a document: which, how it was spelt, and its value.
struct FoundField {
  /// Null where the field was left out; else it points into the document, which has to live longer.
  const Node::Member* member = nullptr;
  UnitSpelling spelling;  ///< The unit in which the key says it is written.
};

/// Finds each field of `table` (in its order; `member` null where left out). Problems: not a table, unknown
/// keys with the name meant, units that do not fit, a field written twice in two units, required ones
/// missing. `tag` is one more key to accept ("kind" of a one_of), "" for none.
[[nodiscard]] std::vector<FoundField> find_fields(const Node& node, const TableInfo& table, Reader& reader,
                                                  std::string_view tag = {});

}  // namespace flexura

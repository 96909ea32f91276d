#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "flexura/base/node.h"
#include "flexura/experiment/experiment.h"

namespace flexura {

/// Returns a document with the changes from the command line. Throws InputError with all problems of changes.
[[nodiscard]] Node with_overrides(Node document, const Overrides& overrides);

/// A new value of an experiment file.
struct Setting {
  std::string path;  ///< As in `--set`: "arm.section.0.length".
  Node value;        ///< The position of errors is the value's position.
};

/// An experiment file that is read once. Many experiments with different values can be made from it.
class ExperimentDocument {
 public:
  /// Reads a file and makes the changes. Throws InputError if the file is missing or is not TOML, or if a
  /// change is not possible. Values are not checked.
  explicit ExperimentDocument(const std::filesystem::path& file, const Overrides& overrides = {});
  /// Uses a document that was read before. `folder`: folder of the files that the document names. `title`:
  /// title if the document has none.
  ExperimentDocument(Node document, std::filesystem::path folder, std::string title);

  /// Returns the document with its included files and changes.
  [[nodiscard]] const Node& document() const { return document_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// Returns the title of experiments without a title: the name of the file.
  [[nodiscard]] const std::string& title() const { return title_; }

  /// Returns the experiment with these values, checked. Reads the files that it names. May be called from
  /// several threads. Throws InputError with all problems.
  [[nodiscard]] Experiment experiment(std::span<const Setting> settings) const;

 private:
  Node document_;
  std::filesystem::path folder_;
  std::string title_;
};

}  // namespace flexura

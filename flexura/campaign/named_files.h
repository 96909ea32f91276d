#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/campaign/campaign_config.h"

namespace flexura {

/// A file that an experiment names, such as keyframes or a picture.
struct NamedFile {
  std::string name;    ///< As in the experiment.
  std::string digest;  ///< Of its bytes: FNV-1a, 64 bits, hexadecimal. It detects accidental changes, not
                       ///< deliberate ones.

  friend bool operator==(const NamedFile&, const NamedFile&) = default;
};

/// Returns the files in `folder` or its subfolders whose names are texts in the document or in a choice of
/// the campaign. Each file is listed once; the files are sorted by name.
[[nodiscard]] std::vector<NamedFile> named_files(const Node& document, const CampaignConfig& config,
                                                 const std::filesystem::path& folder);

/// Returns what has happened to a file since: "" (nothing), "is missing" or "has changed".
[[nodiscard]] std::string change_of(const NamedFile& file, const std::filesystem::path& folder);

}  // namespace flexura

#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace flexura {

/// Arguments of `flexura render`.
struct RenderArguments {
  std::string experiment;
  std::string camera;
  double time = 0;  ///< Start of the exposure, s.
  std::string out;
  bool model = false;  ///< Whether to render the nominal rig and ignore [truth].
  bool truth = false;  ///< Whether to write exact depth, labels and curves too.
  std::vector<std::string> sets;
};

/// Writes the image of a camera whose exposure starts at the given time of the experiment's run. The image
/// equals the image that the run would record. If `truth` is true, also writes exact data for the middle of
/// the exposure: depth (NAME_depth.tiff, m), labels (NAME_labels.png, 16 bits) and curves (NAME_truth.json).
/// Prints the names of the files. Throws InputError for bad input, and std::runtime_error if a file cannot be
/// written.
int render_command(const RenderArguments& arguments, std::ostream& out);

}  // namespace flexura

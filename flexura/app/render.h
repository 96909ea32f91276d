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
  bool model = false;  ///< Render the rig's model and ignore [truth].
  bool truth = false;  ///< Also write exact depth, labels and curves.
  std::vector<std::string> sets;
};

/// Writes the image that a camera exposes from the given time of the experiment's run on, as the run films
/// it. With `truth`, also writes exact data for the middle of that exposure: depth (NAME_depth.tiff, m),
/// labels (NAME_labels.png, 16 bits) and curves (NAME_truth.json). Prints the files' names. Throws InputError
/// for bad input, and std::runtime_error if the system refuses a file.
int render_command(const RenderArguments& arguments, std::ostream& out);

}  // namespace flexura

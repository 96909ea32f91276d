#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace flexura {

/// What `flexura render` is told.
struct RenderArguments {
  std::string experiment;
  std::string camera;
  double time = 0;  ///< When the exposure begins, s.
  std::string out;
  bool model = false;  ///< Of the rig as tasks believe it to be, whatever [truth] says.
  bool truth = false;  ///< Write beside the image what it shows, from the geometry.
  std::vector<std::string> sets;
};

/// Writes the image that a camera exposes from a time of the experiment's run on, as the run films it; with
/// `truth` also what is true in the middle of that exposure: depth (NAME_depth.tiff, m), labels
/// (NAME_labels.png, 16 bits) and curves (NAME_truth.json). Prints the files'
/// names. InputError for bad input; std::runtime_error when the system refuses a file.
int render_command(const RenderArguments& arguments, std::ostream& out);

}  // namespace flexura

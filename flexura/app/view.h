#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "flexura/view/view_server.h"

namespace flexura {

/// Page of a program that was built without the viewer.
inline constexpr std::string_view no_page_text =
    "This flexura was built without the viewer's page: build it with -DFLEXURA_VIEWER=ON, which needs Node "
    "and npm.\n";

/// Settings for access to a viewer.
struct ViewerArguments {
  std::optional<std::uint16_t> port;  ///< Port; default: 8421, or any free port if 8421 is in use.
  bool browser = true;                ///< Whether to open a browser if there is a display.
  std::string address = "127.0.0.1";  ///< Address of the interface to listen on.
  std::vector<std::string> names;     ///< Further host names by which browsers may address the viewer.
};

/// Arguments of `flexura view`.
struct ViewArguments {
  /// An experiment file, a results folder, the results of a campaign, or picture files; empty: the paper's
  /// arm.
  std::vector<std::string> what = {};
  ViewerArguments viewer;
};

/// Serves a viewer and prints its address to `out`. Returns after SIGINT or SIGTERM.
int view_command(const ViewArguments& arguments, std::ostream& out, std::ostream& err);

/// A running viewer, which shows `start` first. Prints the viewer's address to `out` and opens it in a
/// browser.
class OpenViewer {
 public:
  OpenViewer(ViewStart start, const ViewerArguments& arguments, std::ostream& out);
  ~OpenViewer();
  OpenViewer(const OpenViewer&) = delete;
  OpenViewer& operator=(const OpenViewer&) = delete;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace flexura

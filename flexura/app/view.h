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

/// What is served where the program was built without the page.
inline constexpr std::string_view no_page_text =
    "This flexura was built without the viewer's page: build it with -DFLEXURA_VIEWER=ON, which needs Node "
    "and npm.\n";

/// How a viewer is reached.
struct ViewerArguments {
  std::optional<std::uint16_t> port;  ///< Left out: 8421, or any that is free.
  bool browser = true;                ///< Open it, where there is a screen.
  std::string address = "127.0.0.1";  ///< Of the interface to listen on.
  std::vector<std::string> names;     ///< Further hosts by which it may be called.
};

/// What `flexura view` is told.
struct ViewArguments {
  std::string what;  ///< An experiment file, or a results folder; "" for the paper's arm.
  ViewerArguments viewer;
};

/// Serves a viewer, prints its address to `out`, and ends well when it gets SIGINT or SIGTERM.
int view_command(const ViewArguments& arguments, std::ostream& out, std::ostream& err);

/// A viewer that begins with `start`, its address printed to `out` and opened in a browser.
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

#pragma once

#include <filesystem>
#include <string>

namespace flexura {

/// Opens a URL in the user's browser if there is a display. The browser opens a temporary file that redirects
/// to the URL, because other users can read a program's arguments. Only the user who runs the program can
/// read this file. The destructor deletes it.
class BrowserPage {
 public:
  explicit BrowserPage(const std::string& url);
  ~BrowserPage();
  BrowserPage(const BrowserPage&) = delete;
  BrowserPage& operator=(const BrowserPage&) = delete;

 private:
  std::filesystem::path file_;  // Empty if no file was written.
};

}  // namespace flexura

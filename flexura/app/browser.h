#pragma once

#include <filesystem>
#include <string>

namespace flexura {

/// Opens a URL in the user's browser if there is a display. Other users can read the process list, so the URL
/// is not passed as an argument. Instead, the browser opens a small file that redirects to the URL. Only this
/// user can read the file, and the destructor deletes it.
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

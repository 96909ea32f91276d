#pragma once

#include <filesystem>
#include <string>

namespace flexura {

/// Opens an address in the user's browser, where there is a screen, and keeps it out of the list of
/// processes, which others can read: what is opened is a small file of this user that leads there. It goes
/// with this object.
class BrowserPage {
 public:
  explicit BrowserPage(const std::string& url);
  ~BrowserPage();
  BrowserPage(const BrowserPage&) = delete;
  BrowserPage& operator=(const BrowserPage&) = delete;

 private:
  std::filesystem::path file_;  // empty: none
};

}  // namespace flexura

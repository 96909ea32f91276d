#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "flexura/campaign/campaign_histograms.h"
#include "flexura/serve/server.h"
#include "flexura/view/background.h"
#include "flexura/view/messenger.h"

namespace flexura {

/// Reads the results of a campaign, which may be running, about once a second while there are clients. Sends
/// the clients a message `campaign` (docs/viewer-protocol.md) after each change. Not thread-safe.
class CampaignWatcher {
 public:
  CampaignWatcher(std::filesystem::path file, Messenger& messenger, Background& background);

  /// Adds a client, and sends it the progress that was read last.
  void opened(ClientId client);
  void closed(ClientId client);
  /// Starts to read the results if it is time. `now`: time that never decreases, s.
  void advance(double now);
  /// Calls `answer` once, on any thread, with the report of the rows that the file has now.
  void give_report(std::function<void(HttpAnswer)> answer);

 private:
  // What was read at one time.
  struct Reading {
    double time = 0;         // Time at which the reading started, s.
    std::int64_t total = 0;  // Number of runs of the whole campaign.
    CampaignCounts counts;
    std::vector<CampaignHistogram> histograms;
    std::string error;  // Why the file cannot be read; "" if it was read.
  };
  static Reading read(const std::filesystem::path& file, double time);
  void take(const Reading& reading);
  [[nodiscard]] std::optional<double> rate(const Reading& reading);

  std::filesystem::path file_;
  Messenger& messenger_;
  Background& background_;
  std::set<ClientId> clients_;
  std::string text_;  // Last message; "": nothing was read yet.
  double clock_ = 0;  // Time of advance(), s.
  double next_ = 0;   // Time of the next reading, s.
  bool is_reading_ = false;
  std::deque<std::pair<double, std::int64_t>> grown_;  // Times at which the number of rows had grown, s.
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace flexura

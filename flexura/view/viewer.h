#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "flexura/view/background.h"
#include "flexura/view/campaign_watcher.h"
#include "flexura/view/file_session.h"
#include "flexura/view/live_session.h"
#include "flexura/view/messenger.h"
#include "flexura/view/recording_session.h"
#include "flexura/view/session.h"

namespace flexura {

/// An experiment that a viewer offers to open.
struct ViewExample {
  std::string name;                    ///< Name by which clients request the example.
  std::string title;                   ///< Title for users.
  std::function<ViewedRigPtr()> load;  ///< Loads the example's rig; never returns null.
  std::filesystem::path results;       ///< Folder for the results of runs of this experiment.
  std::string text = {};               ///< Text of the experiment.
};

/// Initial content of a viewer: a recording, a rig or pictures.
struct ViewStart {
  std::string session;                 ///< Identifier that is different at every start of the program.
  ViewedRigPtr rig = {};               ///< The rig; null only if there is a recording or there are pictures.
  RecordingPtr recording = {};         ///< The recording; may be null.
  std::filesystem::path results = {};  ///< Folder for the results of task runs; default: results/view.
  std::shared_ptr<RunLink> run = {};  ///< An active run. After the run's end, the viewer opens its recording.
  double speed = 0;                   ///< Speed of `run` relative to real time; 0: as fast as possible.
  /// Experiments that the viewer offers to open; empty if the user gave a file.
  std::vector<ViewExample> examples = {};
  std::string text = {};                ///< Text of the rig's experiment file; "": unknown.
  std::filesystem::path folder = {};    ///< Folder for saved experiments.
  std::string stem = "experiment";      ///< Beginning of the names of saved experiments.
  std::filesystem::path campaign = {};  ///< Results of a campaign, whose progress is shown; "": none.
  /// Picture files to show; empty: there is a recording or a rig.
  std::vector<ViewedPicture> pictures = {};
};

/// Parses the requests of clients, answers them, and switches between rig and recording. Not thread-safe.
class Viewer {
 public:
  /// `now`: present time of the clock of advance(), s.
  Viewer(ViewStart start, Messenger& messenger, Background& background, double now);

  void opened(ClientId client);
  void closed(ClientId client);
  /// Handles a message of a client. The viewer releases `debt` when the client has received the answer, or
  /// can no longer receive one.
  void on_message(ClientId client, const std::string& text,
                  const std::shared_ptr<const void>& debt = nullptr);
  void asked(const std::string& target, const std::function<void(HttpAnswer)>& answer);
  void advance(double now);

  /// Reports an error to a client, or to all clients. If an error is repeated, it is reported only once.
  void failed(std::optional<ClientId> client, std::string why);

  /// Cancels a run of tasks.
  void cancel();

  /// Returns whether the caller must call advance(), because a client is connected or a run has a given
  /// speed.
  [[nodiscard]] bool is_watched() const {
    return !clients_.empty() || (live_ != nullptr && live_->is_pacing());
  }

 private:
  void greet(ClientId client);
  /// Returns whether the report is that of the campaign.
  [[nodiscard]] bool is_campaign_shown() const { return campaign_ != nullptr && shown_ == live_.get(); }
  [[nodiscard]] Reply reply_to(ClientId client, std::int64_t id, std::shared_ptr<const void> debt);
  void take(ClientId client, const Request& request, const std::shared_ptr<const void>& debt);
  void open_last(Reply reply);
  void open_example(const std::string& name, const Reply& reply);
  void give_text(ClientId client, const ExperimentRequest& request, const Reply& reply);
  void check(const std::string& text, const Reply& reply);
  void save(const SaveRequest& request, const Reply& reply);
  void answer_later(std::function<ViewAnswer()> work, const Reply& reply);
  void branch(double time, const Reply& reply);
  void replace_rig(ViewedRigPtr rig, std::filesystem::path results, std::string text, const Reply& reply);
  void open(const std::filesystem::path& folder, Reply reply);
  void go_live(const Reply& reply);
  /// Returns whether there is a live rig; false for pictures, and after the end of a watched run.
  [[nodiscard]] bool has_rig() const;
  [[nodiscard]] bool has_recording() const;
  void show(Session& session);

  ViewStart start_;
  Messenger& messenger_;
  Background& background_;
  double clock_ = 0;  // Time of advance(), s.
  std::set<ClientId> clients_;
  std::map<ClientId, std::string> failures_;     // Last failure reported to each client.
  std::unique_ptr<LiveSession> live_;            // May be null if a recording was opened first.
  std::unique_ptr<RecordingSession> recording_;  // The last opened recording; may be null.
  std::unique_ptr<FileSession> files_;           // Null unless picture files are shown.
  Session* shown_ = nullptr;                     // Points to *live_, *recording_ or *files_.
  std::unique_ptr<CampaignWatcher> campaign_;    // Null without a campaign.
  bool is_opening_ = false;
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace flexura

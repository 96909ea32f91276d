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
#include "flexura/view/live_session.h"
#include "flexura/view/messenger.h"
#include "flexura/view/recording_session.h"
#include "flexura/view/session.h"

namespace flexura {

/// An experiment that a viewer offers to open.
struct ViewExample {
  std::string name;                    ///< Name that clients use to request it.
  std::string title;                   ///< Title for users.
  std::function<ViewedRigPtr()> load;  ///< Loads its rig; never returns null.
  std::filesystem::path results;       ///< Folder for the results of its tasks' runs.
};

/// Initial content of a viewer: a recording, or else a rig.
struct ViewStart {
  std::string session;                     ///< Differs for each start of the program.
  ViewedRigPtr rig = {};                   ///< Never null without a recording.
  RecordingPtr recording = {};             ///< May be null.
  std::filesystem::path results = {};      ///< Folder for the results of task runs.
  std::shared_ptr<RunLink> run = {};       ///< An active run, whose recording is opened at its end.
  std::vector<ViewExample> examples = {};  ///< Other experiments to open; empty if a file was given.
};

/// Parses the requests of clients, answers them, and switches between rig and recording. To be used by one
/// thread.
class Viewer {
 public:
  /// `now` is in s by the clock of advance().
  Viewer(ViewStart start, Messenger& messenger, Background& background, double now);

  void opened(ClientId client);
  void closed(ClientId client);
  /// `debt` is released when the client has its answer, or can get none any more.
  void on_message(ClientId client, const std::string& text,
                  const std::shared_ptr<const void>& debt = nullptr);
  void asked(const std::string& target, const std::function<void(HttpAnswer)>& answer);
  void advance(double now);

  /// Reports to a client, or to all, what failed while sending to them; a repeated failure is reported once.
  void failed(std::optional<ClientId> client, std::string why);

  /// Cancels a run of tasks.
  void cancel();

  /// Returns whether any client is connected, so that advance() is needed.
  [[nodiscard]] bool is_watched() const { return !clients_.empty(); }

 private:
  void greet(ClientId client);
  [[nodiscard]] Reply reply_to(ClientId client, std::int64_t id, std::shared_ptr<const void> debt);
  void take(ClientId client, const Request& request, const std::shared_ptr<const void>& debt);
  void open_last(Reply reply);
  void open_example(const std::string& name, const Reply& reply);
  void open(const std::filesystem::path& folder, Reply reply);
  void go_live(const Reply& reply);
  /// Returns whether there is a live rig; false if the watched run is over.
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
  std::unique_ptr<RecordingSession> recording_;  // The last one opened; may be null.
  Session* shown_ = nullptr;                     // Points to *live_ or *recording_.
  bool is_opening_ = false;
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace flexura

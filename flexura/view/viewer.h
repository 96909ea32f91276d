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
  std::string name;                    ///< By which clients ask for it.
  std::string title;                   ///< For people.
  std::function<ViewedRigPtr()> load;  ///< Its rig; never null.
  std::filesystem::path results;       ///< Where runs of its tasks put their results.
};

/// What a viewer begins with: a recording, or else a rig.
struct ViewStart {
  std::string session;                     ///< Another for each start of the program.
  ViewedRigPtr rig = {};                   ///< Never null where there is no recording.
  RecordingPtr recording = {};             ///< May be null.
  std::filesystem::path results = {};      ///< Where runs of tasks put their results.
  std::shared_ptr<RunLink> run = {};       ///< A run that is going on, whose recording is opened at its end.
  std::vector<ViewExample> examples = {};  ///< What else can be opened; empty where a file was given.
};

/// What the viewer says and does: reads what clients say, answers, and leads them from rig to recording and
/// back. One thread uses it.
class Viewer {
 public:
  /// `now`: s by the clock of advance().
  Viewer(ViewStart start, Messenger& messenger, Background& background, double now);

  void opened(ClientId client);
  void closed(ClientId client);
  /// `debt`: is let go of when the client has its answer, or none can come any more.
  void on_message(ClientId client, const std::string& text,
                  const std::shared_ptr<const void>& debt = nullptr);
  void asked(const std::string& target, const std::function<void(HttpAnswer)>& answer);
  void advance(double now);

  /// Tells a client, or all of them, what failed on the way to them; what fails again and again, once.
  void failed(std::optional<ClientId> client, std::string why);

  /// Ends a run of tasks early.
  void cancel();

  /// Whether time must go on for anybody.
  [[nodiscard]] bool is_watched() const { return !clients_.empty(); }

 private:
  void greet(ClientId client);
  [[nodiscard]] Reply reply_to(ClientId client, std::int64_t id, std::shared_ptr<const void> debt);
  void take(ClientId client, const Request& request, const std::shared_ptr<const void>& debt);
  void open_last(Reply reply);
  void open_example(const std::string& name, const Reply& reply);
  void open(const std::filesystem::path& folder, Reply reply);
  void go_live(const Reply& reply);
  /// Whether there is a rig to go to: none where the run that was watched is over.
  [[nodiscard]] bool has_rig() const;
  [[nodiscard]] bool has_recording() const;
  void show(Session& session);

  ViewStart start_;
  Messenger& messenger_;
  Background& background_;
  double clock_ = 0;  // of advance(), s
  std::set<ClientId> clients_;
  std::map<ClientId, std::string> failures_;     // the last that a client was told of
  std::unique_ptr<LiveSession> live_;            // may be null where a recording was opened first
  std::unique_ptr<RecordingSession> recording_;  // the last one opened; may be null
  Session* shown_ = nullptr;                     // one of these
  bool is_opening_ = false;
  std::shared_ptr<const bool> alive_ = std::make_shared<const bool>(true);
};

}  // namespace flexura

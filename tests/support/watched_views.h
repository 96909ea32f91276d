#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "flexura/store/json.h"
#include "flexura/view/live_session.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/view_fakes.h"

namespace flexura {

/// A run watched by a session, with the folder of its recording.
struct WatchedView {
  TemporaryFolder folder;
  ViewedRigPtr rig;
  FakeMessenger live;
};

/// Runs an experiment's text to its end. `Run`: a RunLink whose member `look` is called on the run's thread
/// when there is something new to see.
template <class Run>
std::unique_ptr<WatchedView> watched_view(const std::string& text) {
  auto seen = std::make_unique<WatchedView>();
  seen->rig = viewed_rig(text);
  auto run = std::make_shared<Run>();
  FakeBackground background;
  LiveSession session(seen->rig, seen->live, background, {.start = 0, .results = {}, .run = run});
  session.opened(me);
  double clock = 0;
  run->look = [&] { session.advance(clock += 0.1); };
  run_linked(seen->rig->experiment, seen->folder.path(), *run);
  run->look();
  return seen;
}

/// Returns the content of an extras message.
inline Node extras_in(const std::string& message) {
  if (message.empty() || message[0] != 3) return ADD_FAILURE() << "no extras", Node{};
  return parse_json(message.substr(1), "extras");
}

}  // namespace flexura

#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/view/live_session.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/view_fakes.h"

namespace flexura {

/// A session with a client, whose clock the test advances.
class LiveSessionTest : public ::testing::Test {
 protected:
  explicit LiveSessionTest(const std::string& text = viewed_text)
      : rig_(viewed_rig(text)),
        session_(rig_, messenger_, background_, {.start = 100, .results = folder_.path() / "run"}) {
    session_.opened(me);
  }

  // Returns the answer to a request, which may be an error.
  ViewAnswer ask(const Ask& ask, ClientId client = me) {
    answer_.reset();
    try {
      session_.take(client, ask, [this](const ViewAnswer& answer) { answer_ = answer; });
    } catch (const ViewRefusal& refusal) {
      return {{}, refusal.what()};
    }
    return answer_.value_or(ViewAnswer{{}, "no answer yet"});
  }
  // Advances by `seconds` at 60 steps per second.
  StateMessage pass(double seconds) {
    for (const double end = clock_ + seconds; clock_ < end - 1e-9;) session_.advance(clock_ += 1.0 / 60);
    return messenger_.state(me);
  }
  [[nodiscard]] std::string last_image(ClientId client, std::uint32_t stream) {
    return *messenger_.posts[{client, stream}].back();
  }
  [[nodiscard]] std::string last_event() {
    const Node event = messenger_.last(me, "event");
    return event.empty() ? "" : *event.find("text")->as<std::string>();
  }
  static ArmRequest bends(const std::vector<std::array<double, 2>>& bends, double duration = 0) {
    ArmRequest request;
    request.bends = bends;
    request.duration = duration;
    return request;
  }

  TemporaryFolder folder_;
  ViewedRigPtr rig_;
  FakeMessenger messenger_;
  FakeBackground background_;
  LiveSession session_;
  double clock_ = 100;
  std::optional<ViewAnswer> answer_;
};

}  // namespace flexura

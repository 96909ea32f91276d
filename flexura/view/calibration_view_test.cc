#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "flexura/log/logged_message.h"
#include "flexura/log/results.h"
#include "flexura/store/json.h"
#include "flexura/store/mcap_reader.h"
#include "flexura/tasks/calibrate/calibration_messages.h"
#include "flexura/view/calibration_extras.h"
#include "flexura/view/live_session.h"
#include "flexura/view/recording_session.h"
#include "tests/support/loop_files.h"
#include "tests/support/random_cases.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/view_fakes.h"
#include "tests/support/watched_views.h"

namespace flexura {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// Lets a session look at the messages of a calibration, on the run's own thread.
class SeenCalibration : public RunLink {
 public:
  std::function<void()> look = [] {};
  void logged(const LoggedMessage& message) override {
    RunLink::logged(message);
    if (message.as<CalibrationObservationMessage>() != nullptr ||
        message.as<CalibrationDecisionMessage>() != nullptr)
      look();
  }
};

// A calibration loop in front of the cylinder with pictures of half the size, followed by a rest.
std::string calibration_and_rest() {
  TestRandom random(7);
  LoopRig rig;
  rig.wrong = {wrong_start(random, 0.3), wrong_start(random, 0.3)}, rig.size = 0.5;
  return etalon_rig("method = \"etalon\"\nname = \"cylinder\"\n", rig) +
         "[[task]]\nkind = \"hold\"\nduration = 1\n[record]\nreport = false\n";
}

// One watched run with its recording, shared by all tests.
class CalibrationView : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { seen = watched_view<SeenCalibration>(calibration_and_rest()); }
  static void TearDownTestSuite() { seen.reset(); }

  static std::string text_in(const Node& node, const char* key) { return *node.find(key)->as<std::string>(); }
  static const Node::Array& overlays_of(const Node& extras) {
    return *extras.find("overlays")->as<Node::Array>();
  }
  static std::set<std::string> layers_of(const Node& overlay) {
    std::set<std::string> ids;
    for (const Node& layer : *overlay.find("layers")->as<Node::Array>()) ids.insert(text_in(layer, "label"));
    return ids;
  }
  // Returns the extras of the recording at a time.
  static Node extras_at(RecordingSession& session, FakeMessenger& messenger, double time) {
    session.take(me, AtRequest{time}, [](const ViewAnswer&) {});
    return extras_in(*messenger.posts[{me, extras_stream}].back());
  }

  static inline std::unique_ptr<WatchedView> seen;
};

TEST_F(CalibrationView, ShowsWhatIsMeasuredAndDecidedWhileARunGoesOn) {
  std::vector<std::string> reported;
  std::size_t both = 0;
  Node last;
  for (const auto& message : seen->live.posts[{me, extras_stream}]) {
    last = extras_in(*message);
    reported.push_back(text_in(last, "text"));
    if (overlays_of(last).size() < 2) continue;
    ++both;
    for (const Node& overlay : overlays_of(last)) {
      if (overlay.find("reason") != nullptr) continue;
      EXPECT_EQ(layers_of(overlay), (std::set<std::string>{"Seen", "Markers"}));
    }
  }
  EXPECT_THAT(reported, Contains(HasSubstr("horizontal orientation of front: ")));
  EXPECT_THAT(reported, Contains(HasSubstr(" px; pan by ")));
  EXPECT_GT(both, 3U);
  EXPECT_THAT(overlays_of(last), IsEmpty()) << "with the calibration its measurements are gone";
  EXPECT_EQ(text_in(last, "title"), "");
}

TEST_F(CalibrationView, IsInTheRecordingUponThePicturesThatItMeasured) {
  FakeMessenger messenger;
  FakeBackground background;
  RecordingSession session(std::make_shared<const Recording>(seen->folder.path()), messenger, background);
  session.opened(me);
  const McapReader log(seen->folder.path() / log_file_name);
  const auto time_of = [](const McapMessage& message) { return static_cast<double>(message.log_time) / 1e9; };
  std::optional<double> ended;
  for (const McapMessage& message : log.messages())
    if (message.channel->topic == calibration_decisions_topic) ended = time_of(message);
  ASSERT_TRUE(ended);
  int compared = 0;
  for (const McapMessage& message : log.messages()) {
    const double time = time_of(message);
    // The rig's clock stands still while the last picture is evaluated.
    if (message.channel->topic == calibration_observations_topic && time < *ended) {
      const Node observation = parse_json(message.text(), "sighting");
      const Node extras = extras_at(session, messenger, time);
      EXPECT_EQ(text_in(extras, "title"), "Calibration");
      for (const Node& overlay : overlays_of(extras)) {
        if (text_in(overlay, "camera") != text_in(observation, "camera")) continue;
        ++compared;
        ASSERT_NE(overlay.find("number"), nullptr);
        const Node::Array& layers = *overlay.find("layers")->as<Node::Array>();
        ASSERT_FALSE(layers.empty());
        EXPECT_THAT(*layers[0].find("points")->as<Node::Array>(),
                    SizeIs(observation.find("points")->as<Node::Array>()->size()));
      }
    }
  }
  EXPECT_GT(compared, 5);
  EXPECT_THAT(overlays_of(extras_at(session, messenger, *ended + 0.5)), IsEmpty()) << "it is over";
}

}  // namespace
}  // namespace flexura

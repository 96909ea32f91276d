// Sessions with an arm that no model of one arc a section fits: what is seen is the arm as it is.
#include <gtest/gtest.h>

#include <string>

#include "flexura/experiment/run.h"
#include "flexura/view/recording_session.h"
#include "tests/support/live_sessions.h"
#include "tests/support/quiet.h"

namespace flexura {
namespace {

// Sections that truly bend more near their bases.
const std::string uneven_text = viewed_text +
                                "[[truth.arm.section]]\nbend_profile = [1.4, 1, 0.6]\n"
                                "[[truth.arm.section]]\nbend_profile = [1.4, 1, 0.6]\n";

Eigen::Vector3d tip_of(const StateMessage& state) { return state.samples.back().X_WS.position; }

class UnevenView : public LiveSessionTest {
 protected:
  UnevenView() : LiveSessionTest(uneven_text) {}
};

TEST_F(UnevenView, DrawsTheArmAsItIsAndSaysWhatItsDrivesSay) {
  EXPECT_EQ(ask(bends({{0.8, 0.5}, {-0.4, 0.7}}, 1)).error, "");
  const StateMessage state = pass(1.5);
  const ArmState given{{{0.8, 0.5}, {-0.4, 0.7}}, {1, 1}};
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(state.arm.bends[i].isApprox(given.bends[i], 1e-6));
  const Eigen::Vector3d truth = rig_->experiment.true_rig().arm.model().backbone(given).tip().position;
  const Eigen::Vector3d nominal = rig_->experiment.arm.model().backbone(given).tip().position;
  EXPECT_LT((tip_of(state) - truth).norm(), 1e-5);
  EXPECT_GT((truth - nominal).norm(), 0.02);
  EXPECT_GE(state.samples.size(), 7U) << "the ends of six arcs";
}

TEST(UnevenRecording, ReplaysWhatWasRunOnIt) {
  TemporaryFolder folder;
  Quiet quiet;
  const Experiment experiment = parse_experiment(uneven_text + "[record]\ncameras = true\n", "x.toml");
  EXPECT_EQ(run_experiment(experiment, folder.path(), quiet).outcome, RunOutcome::done);
  FakeMessenger messenger;
  FakeBackground background;
  RecordingSession session(std::make_shared<const Recording>(folder.path()), messenger, background);
  session.opened(me);
  session.take(me, AtRequest{1}, [](const ViewAnswer& answer) { EXPECT_EQ(answer.error, ""); });
  const ArmState end{{{0.8, 0.5}, {-0.4, 0.7}}, {1, 1}};
  const Eigen::Vector3d sent = experiment.arm.model().backbone(end).tip().position;
  EXPECT_LT((tip_of(messenger.state(me)) - sent).norm(), 1e-5) << "as commanded: the run's /arm/state";
  EXPECT_EQ(session.hello().duration, 1);
}

}  // namespace
}  // namespace flexura

// A session whose true arm finds no equilibrium.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/live_sessions.h"
#include "tests/support/rod_files.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

// Far more friction than the solver can handle (docs/mechanics.md): with large bends it finds no equilibrium.
class RustyRod : public LiveSessionTest {
 protected:
  RustyRod() : LiveSessionTest(viewed_rod(0.5, 10)) {}
};

TEST_F(RustyRod, IsPutBackWhereItFindsNoRest) {
  const int leaps = pass(0.1).leaps;
  EXPECT_EQ(ask(bends({{-2, 0}, {2, 0}}, 3)).error, "");
  const StateMessage state = pass(2.5);
  EXPECT_THAT(last_event(), HasSubstr("everything is reset to the start: at "));
  EXPECT_EQ(state.leaps, leaps + 1);
  EXPECT_EQ(state.arm.bends[0].norm(), 0);
  EXPECT_NEAR(state.time, 2.6, 1e-6) << "time goes on";
}

}  // namespace
}  // namespace flexura

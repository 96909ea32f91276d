#include <gtest/gtest.h>

#include "tests/support/faulty_rig.h"

// A minute of faults, in simulated time.
namespace flexura {
namespace {

TEST(RigFaults, GrblAndHeadsNeitherHangNorMoveWhenTheyMustRest) { run_faulty_rig<GrblUnderTest>(1, 60); }

TEST(RigFaults, Cia402AndHeadsNeitherHangNorMoveWhenTheyMustRest) { run_faulty_rig<Cia402UnderTest>(2, 60); }

TEST(RigFaults, Cia402DrivesWithoutATimeoutAreStoppedByTheGuard) {
  run_faulty_rig<TrustingCia402UnderTest>(3, 60);
}

}  // namespace
}  // namespace flexura

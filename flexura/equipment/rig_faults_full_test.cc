#include <gtest/gtest.h>

#include "tests/support/faulty_rig.h"

// Ten minutes of faults, in simulated time.
namespace flexura {
namespace {

TEST(LongRigFaults, GrblAndHeadsNeitherHangNorMoveWhenTheyMustRest) { run_faulty_rig<GrblUnderTest>(1, 600); }

TEST(LongRigFaults, Cia402AndHeadsNeitherHangNorMoveWhenTheyMustRest) {
  run_faulty_rig<Cia402UnderTest>(2, 600);
}

TEST(LongRigFaults, Cia402DrivesWithoutATimeoutAreStoppedByTheGuard) {
  run_faulty_rig<TrustingCia402UnderTest>(3, 600);
}

}  // namespace
}  // namespace flexura

// Of the program without MPI: this test links mpi_missing.cc.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "flexura/base/source.h"
#include "flexura/campaign/mpi_engine.h"

namespace flexura {
namespace {

TEST(MissingMpi, IsNamedWithItsPackage) {
  try {
    const MpiSession session;
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("mpirun: this program was built without MPI"));
    EXPECT_THAT(error.what(), testing::HasSubstr("libopenmpi-dev"));
  }
  EXPECT_EQ(MpiSession::hear(), "");
}

}  // namespace
}  // namespace flexura

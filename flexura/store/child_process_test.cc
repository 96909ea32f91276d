#include "flexura/store/child_process.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "flexura/store/text_file.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

TEST(ChildProcess, ReadsAllThatItIsGiven) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "out";
  const std::string bytes(3'000'000, 'x');
  ChildProcess child({"tee", file.string()});
  EXPECT_TRUE(child.write(bytes));
  EXPECT_EQ(child.finish(), 0);
  EXPECT_EQ(read_text_file(file, 1 << 24), bytes);
}

TEST(ChildProcess, TellsItsStatusAndThatItNoLongerReads) {
  ChildProcess child({"sh", "-c", "exit 3"});
  while (child.write("x")) {
  }
  EXPECT_EQ(child.finish(), 3);
  ChildProcess killed({"sh", "-c", "kill -9 $$"});
  EXPECT_EQ(killed.finish(), 128 + 9);
}

TEST(ChildProcess, SaysWhatCannotBeStarted) {
  EXPECT_THROW(ChildProcess({"no-such-program-anywhere"}), std::runtime_error);
  EXPECT_FALSE(has_program("no-such-program-anywhere"));
  EXPECT_TRUE(has_program("sh"));
}

}  // namespace
}  // namespace flexura

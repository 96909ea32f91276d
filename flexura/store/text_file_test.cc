#include "flexura/store/text_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "flexura/base/source.h"
#include "tests/support/full_disk.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

class TextFileTest : public ::testing::Test {
 protected:
  // Returns the reason why a file cannot be read.
  static std::string refusal(const std::filesystem::path& file) {
    try {
      (void)read_text_file(file, 100);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  TemporaryFolder folder_;
};

TEST_F(TextFileTest, SaysWhyAFileCannotBeRead) {
  std::filesystem::create_symlink("loop", folder_.path() / "loop");
  EXPECT_THAT(refusal(folder_.path() / "loop"),
              HasSubstr("cannot be read: Too many levels of symbolic links"));
  EXPECT_THAT(refusal(folder_.path() / "loop" / "file"), HasSubstr("cannot be read: Too many levels"));
  EXPECT_THAT(refusal(folder_.path() / "nothing"), HasSubstr("no such file"));
  EXPECT_THAT(refusal(folder_.path()), HasSubstr("is a folder"));
  EXPECT_THAT(refusal("/dev/zero"), HasSubstr("is a device: expected a file"));
  write_new_file(folder_.path() / "long", std::string(101, 'x'));
  EXPECT_THAT(refusal(folder_.path() / "long"), HasSubstr("is larger"));
}

TEST_F(TextFileTest, DoesNotWaitForEverForAWriterOfAPipe) {
  const auto pipe = folder_.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  try {
    (void)read_text_file(pipe, 100, 0.02);
    ADD_FAILURE() << "nothing was written";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("pipe: is a pipe into which nothing was written for 0.02 s: expected a file"));
  }
  std::thread writer([&] { std::ofstream(pipe) << "first " << std::flush << "and second"; });
  EXPECT_EQ(read_text_file(pipe, 100, 60), "first and second");
  writer.join();
  std::thread writer_of_more([&] { std::ofstream(pipe) << std::string(101, 'x'); });
  EXPECT_THAT(refusal(pipe), HasSubstr("is larger than"));
  writer_of_more.join();
}

TEST_F(TextFileTest, LooksForNoFileInAFolderThatIsALinkToItself) {
  std::filesystem::create_symlink("loop", folder_.path() / "loop");
  try {
    (void)file_inside(folder_.path() / "loop", "log.mcap");
    ADD_FAILURE() << "found";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("cannot read its folder: Too many levels of symbolic links"));
  }
}

TEST_F(TextFileTest, FindsNoFileByAFolderThatIsNotThere) {
  write_new_file(folder_.path() / "file", "here");
  EXPECT_EQ(file_inside(folder_.path(), "./file"), folder_.path() / "./file");
  try {
    (void)file_inside(folder_.path(), "none/../file");
    ADD_FAILURE() << "found";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "no file \"none/../file\"");
  }
}

TEST_F(TextFileTest, FindsMissingOnlyWhatIsNotThere) {
  EXPECT_TRUE(is_missing(folder_.path() / "nothing"));
  EXPECT_FALSE(is_missing(folder_.path()));
  std::filesystem::create_symlink("nothing", folder_.path() / "link");
  EXPECT_TRUE(is_missing(folder_.path() / "link"));
  std::filesystem::create_symlink("loop", folder_.path() / "loop");
  EXPECT_FALSE(is_missing(folder_.path() / "loop"));
}

TEST_F(TextFileTest, LeavesNoPieceOfAFileWhenTheDiskIsFull) {
  const auto file = folder_.path() / "long";
  write_new_file(folder_.path() / "kept", "old");
  {
    const FullDisk disk(1000);
    EXPECT_THROW(write_new_file(file, std::string(3000, 'x')), std::runtime_error);
    EXPECT_THROW(replace_file(folder_.path() / "kept", std::string(3000, 'x')), std::runtime_error);
  }
  EXPECT_TRUE(is_missing(file));
  EXPECT_EQ(std::ranges::distance(std::filesystem::directory_iterator(folder_.path())), 1);
  EXPECT_EQ(read_text_file(folder_.path() / "kept", 100), "old");
  // A previous file is not an incomplete one.
  EXPECT_THROW(write_new_file(folder_.path() / "kept", "new"), std::runtime_error);
  EXPECT_EQ(read_text_file(folder_.path() / "kept", 100), "old");
}

TEST_F(TextFileTest, AFileThatCannotBeReplacedLeavesNothingBesideIt) {
  std::filesystem::create_directories(folder_.path() / "taken" / "by a folder");
  EXPECT_THROW(replace_file(folder_.path() / "taken", "new"), std::runtime_error);
  EXPECT_EQ(std::ranges::distance(std::filesystem::directory_iterator(folder_.path())), 1);
}

// Only the program's own temporary files may be removed, whatever the others' names are.
TEST_F(TextFileTest, ReplacingLeavesAllOtherFilesAsTheyAre) {
  write_new_file(folder_.path() / "a.png.new", "precious");
  write_new_file(folder_.path() / fmt::format(".flexura-{}-0", ::getpid()), "precious too");
  const std::string longest(255, 'n');
  for (const std::string& name : {std::string("a.png"), longest}) {
    for (const char* text : {"one", "two"}) {
      replace_file(folder_.path() / name, text);
      EXPECT_EQ(read_text_file(folder_.path() / name, 100), text);
    }
  }
  EXPECT_EQ(read_text_file(folder_.path() / "a.png.new", 100), "precious");
  EXPECT_EQ(read_text_file(folder_.path() / fmt::format(".flexura-{}-0", ::getpid()), 100), "precious too");
  EXPECT_EQ(std::ranges::distance(std::filesystem::directory_iterator(folder_.path())), 4);
}

}  // namespace
}  // namespace flexura

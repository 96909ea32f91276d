#include "flexura/app/kept_token.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "flexura/store/text_file.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

namespace fs = std::filesystem;

constexpr std::uint16_t port = 8421;

class KeptToken : public ::testing::Test {
 protected:
  [[nodiscard]] std::string token() const { return kept_token(folder_, port); }

  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path() / "runtime" / "flexura";
  fs::path file_ = folder_ / "token-8421";
};

TEST_F(KeptToken, IsTheSameForAPortAndAnotherForEachPort) {
  const std::string first = token();
  EXPECT_EQ(first.size(), 32);
  EXPECT_EQ(token(), first);
  EXPECT_NE(kept_token(folder_, 8422), first);
  EXPECT_EQ(token(), first);
}

TEST_F(KeptToken, LiesWhereNobodyElseReads) {
  (void)token();
  EXPECT_EQ(fs::status(folder_).permissions(), fs::perms::owner_all);
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(KeptToken, IsNotKeptInAFolderThatOthersSee) {
  (void)token();
  fs::permissions(folder_, fs::perms::owner_all | fs::perms::group_read);
  const std::string fresh = token();
  EXPECT_NE(token(), fresh);
  EXPECT_NE(read_text_file(file_, 100), fresh);
}

TEST_F(KeptToken, IsNotKeptThroughALink) {
  fs::create_directories(folder_.parent_path());
  fs::create_directory(temporary_.path() / "elsewhere");
  fs::permissions(temporary_.path() / "elsewhere", fs::perms::owner_all);
  fs::create_directory_symlink(temporary_.path() / "elsewhere", folder_);
  EXPECT_NE(token(), token());
  EXPECT_TRUE(fs::is_empty(temporary_.path() / "elsewhere"));
}

TEST_F(KeptToken, IsMadeAnewWhereOthersReadTheFile) {
  const std::string first = token();
  fs::permissions(file_, fs::perms::others_read, fs::perm_options::add);
  EXPECT_NE(token(), first);
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(KeptToken, IsMadeAnewWhereTheFileIsALink) {
  const std::string first = token();
  const fs::path other = temporary_.path() / "other";
  fs::rename(file_, other);
  fs::create_symlink(other, file_);
  EXPECT_NE(token(), first);
  EXPECT_EQ(read_text_file(other, 100), first) << "nothing is written through a link";
}

TEST_F(KeptToken, IsMadeAnewWhereTheFileHoldsNoToken) {
  for (const char* text : {"", "short", "0011223344556677889900112233445",
                           "00112233445566778899001122334455x", "0011223344556677889900112233445G"}) {
    (void)token();
    std::ofstream(file_, std::ios::trunc) << text;
    const std::string fresh = token();
    EXPECT_EQ(fresh.size(), 32) << text;
    EXPECT_EQ(token(), fresh) << text;
  }
}

TEST_F(KeptToken, IsMadeAnewAfterADay) {
  const std::string first = token();
  fs::last_write_time(file_, fs::file_time_type::clock::now() - std::chrono::hours(23));
  EXPECT_EQ(token(), first);
  fs::last_write_time(file_, fs::file_time_type::clock::now() - std::chrono::hours(25));
  EXPECT_NE(token(), first);
}

TEST_F(KeptToken, IsKeptNowhereWithoutAFolder) { EXPECT_NE(kept_token("", port), kept_token("", port)); }

}  // namespace
}  // namespace flexura

// A viewer of a campaign.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "flexura/store/text_file.h"
#include "flexura/view/viewer.h"
#include "tests/support/campaign_files.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

class ViewerOfACampaign : public ::testing::Test {
 protected:
  ViewerOfACampaign() : campaign_(folder_.campaign()), path_(folder_.path("a.db")) {
    file_ = std::make_unique<CampaignFile>(path_, campaign_);
    viewer_ = std::make_unique<Viewer>(
        ViewStart{.session = "1",
                  .rig = std::make_shared<const ViewedRig>(campaign_.experiment(first_readable())),
                  .results = folder_.path("run"),
                  .campaign = path_},
        messenger_, background_, 0);
  }
  // Some runs of the campaign have an experiment that cannot be read.
  [[nodiscard]] std::int64_t first_readable() const {
    for (std::int64_t id = 0;; ++id) {
      try {
        (void)campaign_.experiment(id);
        return id;
      } catch (const InputError&) {
      }
    }
  }
  // Adds `count` rows, the last of which failed.
  void add_rows(int count) {
    std::vector<CampaignRow> rows;
    for (int i = 0; i < count; ++i, ++next_) {
      rows.push_back({.id = next_,
                      .seed = campaign_.design().seed(next_),
                      .parameters = campaign_.design().values(next_),
                      .status = i + 1 == count ? "failed" : "done",
                      .error = {},
                      .measures = {{0.01 * static_cast<double>(next_), {}}, text_node("done"), {next_, {}}},
                      .seconds = 0.1});
    }
    file_->add(rows);
  }
  [[nodiscard]] Node progress() { return messenger_.last(me, "campaign"); }
  [[nodiscard]] std::int64_t runs() { return *progress().find("runs")->as<std::int64_t>(); }
  [[nodiscard]] std::string reason() { return *progress().find("reason")->as<std::string>(); }
  [[nodiscard]] double number(const char* key) { return *progress().find(key)->as<double>(); }
  [[nodiscard]] HttpAnswer report() {
    HttpAnswer got;
    viewer_->asked("/report", [&](const HttpAnswer& answer) { got = answer; });
    return got;
  }
  [[nodiscard]] bool says(const char* key) { return *messenger_.last(me, "hello").find(key)->as<bool>(); }

  CampaignFolder folder_;
  Campaign campaign_;
  std::string path_;
  std::unique_ptr<CampaignFile> file_;
  std::int64_t next_ = 0;
  FakeMessenger messenger_;
  FakeBackground background_;
  std::unique_ptr<Viewer> viewer_;
};

TEST_F(ViewerOfACampaign, FollowsTheRows) {
  viewer_->advance(0);
  EXPECT_EQ(background_.jobs[Lane::campaign], 0) << "nobody looks";
  viewer_->opened(me);
  EXPECT_TRUE(says("campaign"));
  EXPECT_TRUE(says("report"));
  viewer_->advance(1);
  EXPECT_EQ(runs(), 0);
  EXPECT_EQ(*progress().find("total")->as<std::int64_t>(), 60);
  EXPECT_TRUE(progress().find("rate")->empty());
  EXPECT_TRUE(progress().find("measures")->as<Node::Array>()->empty());
  add_rows(5);
  viewer_->advance(1.5);
  EXPECT_EQ(runs(), 0) << "a reading a second is enough";
  viewer_->advance(2);
  EXPECT_EQ(runs(), 5);
  EXPECT_EQ(*progress().find("statuses")->find("done")->as<std::int64_t>(), 4);
  EXPECT_EQ(*progress().find("statuses")->find("failed")->as<std::int64_t>(), 1);
  EXPECT_EQ(number("rate"), 5);
  EXPECT_EQ(number("left"), 11);
  const Node message = progress();
  const Node& height = message.find("measures")->as<Node::Array>()->front();
  EXPECT_EQ(*height.find("name")->as<std::string>(), "height");
  EXPECT_EQ(*height.find("high")->as<double>(), 0.04);
  add_rows(9);
  viewer_->advance(4);
  EXPECT_EQ(runs(), 14);
  EXPECT_NEAR(number("rate"), 14.0 / 3, 1e-12);
}

TEST_F(ViewerOfACampaign, SaysThatItIsCompleteOnce) {
  add_rows(7);
  file_->complete(7, "the required precision is reached after 7 runs");
  viewer_->opened(me);
  viewer_->advance(1);
  EXPECT_EQ(runs(), 7);
  EXPECT_EQ(reason(), "the required precision is reached after 7 runs");
  EXPECT_TRUE(progress().find("rate")->empty());
  EXPECT_TRUE(progress().find("left")->empty());
  const std::size_t texts = messenger_.texts[me].size();
  for (int i = 2; i < 9; ++i) viewer_->advance(i);
  EXPECT_EQ(messenger_.texts[me].size(), texts);
  viewer_->opened(other);
  EXPECT_FALSE(messenger_.last(other, "campaign").empty()) << "others need not wait";
}

TEST_F(ViewerOfACampaign, SeesThatNoMoreRunsFinish) {
  viewer_->opened(me);
  viewer_->advance(0);
  add_rows(20);
  viewer_->advance(10);
  EXPECT_EQ(number("rate"), 2);
  viewer_->advance(20);
  EXPECT_EQ(number("rate"), 1) << "too early to tell";
  viewer_->advance(60);
  EXPECT_EQ(number("rate"), 0);
  EXPECT_TRUE(progress().find("left")->empty());
  add_rows(10);
  viewer_->advance(61);
  EXPECT_GT(number("rate"), 0) << "it goes on";
}

TEST_F(ViewerOfACampaign, OutlivesADamagedFile) {
  add_rows(5);
  viewer_->opened(me);
  viewer_->advance(1);
  EXPECT_EQ(progress().find("error"), nullptr);
  file_.reset();
  const std::string whole = read_text_file(path_, 1 << 24);
  const auto put = [&](const std::string& bytes) {
    std::filesystem::remove(path_);
    folder_.write("a.db", bytes);
  };
  std::string torn = whole;
  for (std::size_t i = 4096; i < torn.size(); i += 7) torn[i] = static_cast<char>(torn[i] + 77);
  double now = 1;
  for (const std::string& bytes :
       {std::string("no file of SQLite"), std::string(), torn, whole.substr(0, 5000)}) {
    put(bytes);
    viewer_->advance(now += 2);
    ASSERT_NE(progress().find("error"), nullptr);
    EXPECT_THAT(*progress().find("error")->as<std::string>(), HasSubstr("a.db"));
    EXPECT_EQ(report().status, 500);
  }
  std::filesystem::remove(path_);
  viewer_->advance(now += 2);
  EXPECT_THAT(*progress().find("error")->as<std::string>(), HasSubstr("no such file"));
  put(whole);
  viewer_->advance(now += 2);
  EXPECT_EQ(progress().find("error"), nullptr);
  EXPECT_EQ(runs(), 5);
}

TEST_F(ViewerOfACampaign, GivesItsReportAlsoWhileItRuns) {
  add_rows(30);
  viewer_->opened(me);
  HttpAnswer got = report();
  EXPECT_EQ(got.status, 200);
  EXPECT_THAT(got.body, HasSubstr("The campaign is not complete."));
  EXPECT_THAT(got.body, HasSubstr("flexura run --from " + path_ + " --row "));
  EXPECT_THAT(got.policy, HasSubstr("sandbox"));
  EXPECT_EQ(background_.jobs[Lane::checks], 0) << "a long report must not delay checks of motions";
  add_rows(30);
  file_->complete(60, "all 60 runs are done");
  EXPECT_THAT(report().body, HasSubstr("Complete: all 60 runs are done"));
}

TEST_F(ViewerOfACampaign, ShowsARunOfItsRigLikeAnyOther) {
  viewer_->opened(me);
  viewer_->on_message(me, R"({"id":1,"do":"run","speed":0})");
  viewer_->advance(1);
  viewer_->on_message(me, R"({"id":2,"do":"open"})");
  EXPECT_EQ(*messenger_.last(me, "hello").find("mode")->as<std::string>(), "recording");
  EXPECT_FALSE(says("campaign"));
  EXPECT_EQ(says("report"), report().status == 200);
  EXPECT_THAT(report().body, ::testing::Not(HasSubstr("The campaign is not complete.")));
  viewer_->on_message(me, R"({"id":3,"do":"live"})");
  EXPECT_TRUE(says("campaign"));
  EXPECT_THAT(report().body, HasSubstr("The campaign is not complete."));
}

TEST_F(ViewerOfACampaign, ReadsOnceAtATime) {
  background_.is_prompt = false;
  viewer_->opened(me);
  for (int i = 0; i < 9; ++i) viewer_->advance(i);
  EXPECT_EQ(background_.jobs[Lane::campaign], 1);
  background_.work();
  EXPECT_EQ(runs(), 0);
  viewer_->advance(9);
  EXPECT_EQ(background_.jobs[Lane::campaign], 1) << "a slow reading is followed by a pause";
  viewer_->advance(100);
  EXPECT_EQ(background_.jobs[Lane::campaign], 2);
  viewer_.reset();
  background_.work();
}

}  // namespace
}  // namespace flexura

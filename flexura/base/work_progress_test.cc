#include "flexura/base/work_progress.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

namespace flexura {
namespace {

class Last : public Progress {
 public:
  void update(double fraction, std::string_view what) override {
    EXPECT_GE(fraction, last) << what;
    last = fraction, text = what;
  }
  [[nodiscard]] bool is_cancelled() const override { return cancelled; }

  double last = 0;
  std::string text;
  bool cancelled = false;
};

TEST(WorkProgress, IsTheShareOfAllWork) {
  Last last;
  WorkProgress job(last, {1, 2, 1});
  job.piece(1).update(0.5, "two");
  EXPECT_DOUBLE_EQ(last.last, 0.25);
  EXPECT_EQ(last.text, "two");
  job.piece(0).update(1, "one");
  EXPECT_DOUBLE_EQ(last.last, 0.5);
  job.piece(1).update(0.1, "two");  // Does not go back.
  EXPECT_DOUBLE_EQ(last.last, 0.5);
  job.finish(1, "two");
  job.piece(2).update(7, "three");
  EXPECT_DOUBLE_EQ(last.last, 1);
}

TEST(WorkProgress, OfPiecesPassesOnThatTheJobIsCancelled) {
  Last last;
  WorkProgress job(last, {1});
  EXPECT_FALSE(job.piece(0).is_cancelled());
  last.cancelled = true;
  EXPECT_TRUE(job.piece(0).is_cancelled());
  EXPECT_THROW((void)job.piece(1), std::out_of_range);
}

TEST(WorkProgress, WithoutWorkStaysAtNothing) {
  Last last;
  WorkProgress job(last, {0, -1});
  job.finish(0, "a");
  EXPECT_EQ(last.last, 0);
}

}  // namespace
}  // namespace flexura

#include "flexura/report/page.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace flexura {
namespace {

TEST(Filled, PutsValuesInAndLooksAtThemOnlyOnce) {
  EXPECT_EQ(filled("<a>{{x}}</a>{{y}}{{x}}.", {{"x", "{{y}}"}, {"y", "2"}}), "<a>{{y}}</a>2{{y}}.");
  EXPECT_EQ(filled("nothing", {}), "nothing");
  EXPECT_THROW((void)filled("{{z}}", {{"x", ""}}), std::out_of_range);
}

TEST(CspHash, IsTheHashInBase64) {
  // SHA-256 of nothing.
  EXPECT_EQ(csp_hash("e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"),
            "'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='");
}

TEST(MotionJson, HoldsNumbersOnly) {
  ReportData data;
  data.arm.kind = ArmKind::spatial;
  data.arm.sections.resize(1);
  data.times = {0.0, 0.5};
  data.states = {ArmState::straight(1), {{{0.25, -1.0 / 3.0}}, {1.0}}};
  const std::string json = motion_json(motion_of(data));
  EXPECT_NE(json.find("\"bends\":[0,0,0.25,-0.333333333]"), std::string::npos) << json;
  EXPECT_NE(json.find("\"stretches\":[]"), std::string::npos) << json;
  data.states[1].stretches[0] = 1.5;
  EXPECT_NE(motion_json(motion_of(data)).find("\"stretches\":[1,1.5]"), std::string::npos);
}

}  // namespace
}  // namespace flexura

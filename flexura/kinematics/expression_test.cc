#include "flexura/kinematics/expression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace flexura {
namespace {

using ::testing::HasSubstr;

struct Wrong {
  std::string what = "no error";
  std::size_t position = 0;
};

Wrong wrong(const std::string& text) {
  try {
    const Expression expression(text);
  } catch (const ExpressionError& error) {
    return {error.what(), error.position()};
  }
  return {};
}

TEST(Expression, KnowsTimeDurationSectionAndPi) {
  EXPECT_DOUBLE_EQ(Expression("0.3*sin(2*pi*t/T)").value(0.25, 1, 1), 0.3);
  EXPECT_DOUBLE_EQ(Expression("i + t/T").value(1, 4, 3), 3.25);
  EXPECT_EQ(Expression("pi").value(0, 1, 1), std::numbers::pi);
  EXPECT_DOUBLE_EQ(Expression("ln(exp(1))").value(0, 1, 1), 1);
  EXPECT_DOUBLE_EQ(Expression("t < 1 ? 5 : t^2").value(3, 4, 1), 9);
}

TEST(Expression, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(wrong("sin(t").what, HasSubstr("parenthesis"));
  EXPECT_THAT(wrong("2*phi").what, HasSubstr("phi"));
  EXPECT_EQ(wrong("2*phi").position, 2U);
  EXPECT_THAT(wrong("").what, HasSubstr("is empty"));
  EXPECT_THAT(wrong("t = 3").what, HasSubstr("assigns a value"));
  EXPECT_EQ(wrong("t = 3").position, 2U);
  EXPECT_EQ(wrong("t == 3 ? 1 : (t >= 2) + (t != 1)").what, "no error");
  EXPECT_EQ(wrong("sin(\"t\")").what, "contains a text in quotes: expected numbers, names and operators");
  EXPECT_EQ(wrong("t + \"1\"").position, 4U);
  EXPECT_EQ(wrong("2*_pi").what, "unexpected token \"_pi\"") << "muParser's own, which has 12 digits";
  EXPECT_EQ(wrong("_e").what, "unexpected token \"_e\"");
  EXPECT_THAT(wrong("1, 2").what, HasSubstr("several values"));
  EXPECT_THAT(wrong("2*\n3").what, HasSubstr("character"));
  EXPECT_THAT(wrong(std::string(1001, '1')).what, HasSubstr("longer than"));
}

TEST(Expression, TellsOnePlaceAndOnlyBesideTheMessage) {
  const std::vector<std::pair<std::string, std::size_t>> formulas = {
      {"2*phi", 2},          {"sin(t", 5},
      {"1 + sin(t,2)", 4},   {"max()", 0},
      {"sin(cos(t), 2)", 0}, {"t+", 2},
      {"(t))", 3},           {"t t", 2},
      {"sin(t)*cos()", 7},   {"\"abc", 0},
      {"2*(t+)", 5},         {"1 : 2", 3},
      {"2**3", 2},           {"max(1, cos(t), sin(1, 2))", 15},
      {"t ? 1", 0}};
  for (const auto& [formula, position] : formulas) {
    EXPECT_EQ(wrong(formula).position, position) << formula;
    EXPECT_EQ(wrong(formula).what.find("position"), std::string::npos) << wrong(formula).what;
  }
  EXPECT_EQ(wrong("2*phi").what, "unexpected token \"phi\"");
  EXPECT_EQ(wrong("3 @ t").what, "unexpected token \"@ t\"");
}

TEST(Expression, HasNoFiniteValueWhereTheFormulaHasNone) {
  EXPECT_TRUE(std::isinf(Expression("1/t").value(0, 1, 1)));
  EXPECT_TRUE(std::isnan(Expression("sqrt(t)").value(-1, 1, 1)));
  EXPECT_FALSE(std::isfinite(Expression("ln(t)").value(0, 1, 1)));
  EXPECT_DOUBLE_EQ(Expression("1/t").value(2, 1, 1), 0.5);
}

}  // namespace
}  // namespace flexura

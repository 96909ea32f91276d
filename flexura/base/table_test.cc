#include "flexura/base/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <stdexcept>

namespace flexura {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

enum class Colour { red, green };
const std::vector<std::string>& names_of(const Colour*) {
  static const std::vector<std::string> names{"red", "green"};
  return names;
}

struct Wheel {
  double radius = 0.5;
  std::array<double, 2> width = {0.1, 0.1};
};
struct Bell {
  std::string sound = "ding";
};
struct Cart {
  Colour colour = Colour::red;
  std::int64_t seats = 2;
  bool open = false;
  double tilt = 0;
  double top_speed = std::numeric_limits<double>::infinity();
  std::optional<std::vector<double>> notes;
  std::vector<Wheel> wheel;
  std::vector<std::variant<Wheel, Bell>> part;
};

const Table<Wheel>& fields_of(const Wheel*) {
  static const auto table =
      Table<Wheel>("wheel", "Turns.")
          .field("radius", &Wheel::radius,
                 {.meaning = "Its radius.", .unit = Unit::metre, .range = above(0), .required = true})
          .field("width", &Wheel::width, {.unit = Unit::metre, .one_for_all = true});
  return table;
}
const Table<Bell>& fields_of(const Bell*) {
  static const auto table = Table<Bell>("bell", "Rings.").field("sound", &Bell::sound, {});
  return table;
}
const Table<Cart>& fields_of(const Cart*) {
  static const auto table = Table<Cart>("cart", "Rolls.")
                                .field("colour", &Cart::colour, {})
                                .field("seats", &Cart::seats, {.range = between(1, 8)})
                                .field("open", &Cart::open, {})
                                .field("tilt", &Cart::tilt, {.unit = Unit::radian, .range = between(-1, 1)})
                                .field("top_speed", &Cart::top_speed, {.default_text = "no limit"})
                                .field("notes", &Cart::notes, {.count = {1, 3}})
                                .field("wheel", &Cart::wheel, {})
                                .field("part", &Cart::part, {})
                                .check([](const Cart& cart, Reader& reader) {
                                  if (cart.open && cart.seats > 4)
                                    reader.problem_at("seats", "too many for an open cart");
                                });
  return table;
}

struct Street {
  std::int64_t seat = 0;
  std::vector<Cart> cart;
};

const Table<Street>& fields_of(const Street*) {
  static const auto table =
      Table<Street>("street", "Lies.").field("seat", &Street::seat, {}).field("cart", &Street::cart, {});
  return table;
}

SourcePosition at(int line, int column) {
  static const auto source = std::make_shared<const std::string>("cart.toml");
  return {source, line, column};
}

// A member with its key in column 1 of `line` and its value in column 10.
Node::Member member(std::string key, Node::Value value, int line = 1) {
  return {std::move(key), at(line, 1), {std::move(value), at(line, 10)}};
}

Node table(Node::Table members) { return {std::move(members), at(1, 1)}; }

std::vector<std::string> problems_of(Node::Table members) {
  try {
    (void)read_as<Cart>(table(std::move(members)));
  } catch (const InputError& error) {
    std::vector<std::string> texts;
    for (const Problem& problem : error.problems()) texts.push_back(problem.text());
    return texts;
  }
  return {};
}

Node::Table one_wheel(double radius) { return {member("radius", radius)}; }

TEST(Table, FillsAStructAndLeavesDefaultsAlone) {
  const auto cart = read_as<Cart>(table({member("colour", "green"), member("seats", std::int64_t{3}),
                                         member("notes", Node::Array{{1.5, {}}, {std::int64_t{2}, {}}})}));
  EXPECT_EQ(cart.colour, Colour::green);
  EXPECT_EQ(cart.seats, 3);
  EXPECT_FALSE(cart.open);
  EXPECT_THAT(*cart.notes, ElementsAre(1.5, 2.0));
}

TEST(Table, ReadsAQuantityInEachOfItsUnits) {
  EXPECT_DOUBLE_EQ(read_as<Cart>(table({member("tilt", 0.5)})).tilt, 0.5);
  EXPECT_DOUBLE_EQ(read_as<Cart>(table({member("tilt_deg", std::int64_t{30})})).tilt, std::numbers::pi / 6);
  EXPECT_DOUBLE_EQ(read_as<Cart>(table({member("tilt_pi", 0.25)})).tilt, std::numbers::pi / 4);
}

TEST(Table, TakesOneNumberForAllWhereItMay) {
  const auto cart = read_as<Cart>(table({member(
      "wheel",
      Node::Array{{Node::Table{member("radius", 1.0), member("width_mm", std::int64_t{250})}, at(2, 1)}})}));
  EXPECT_DOUBLE_EQ(cart.wheel.at(0).width[0], 0.25);
  EXPECT_DOUBLE_EQ(cart.wheel.at(0).width[1], 0.25);
}

TEST(Table, ReadsOneOfSeveralTablesByItsKind) {
  const auto cart = read_as<Cart>(table({member(
      "part", Node::Array{{Node::Table{member("kind", "bell"), member("sound", "dong")}, at(2, 1)},
                          {Node::Table{member("radius", 2.0), member("kind", "wheel")}, at(3, 1)}})}));
  EXPECT_EQ(std::get<Bell>(cart.part.at(0)).sound, "dong");
  EXPECT_EQ(std::get<Wheel>(cart.part.at(1)).radius, 2.0);
}

TEST(Table, ReportsEveryProblemWithPlaceValueAndExpectation) {
  EXPECT_THAT(
      problems_of({member("seats", std::int64_t{9}, 2), member("open", "yes", 3), member("colour", "blue", 4),
                   member("tilt_deg", 90.0, 5)}),
      ElementsAre(
          "cart.toml:4:10: colour = \"blue\": expected one of \"red\", \"green\"",
          "cart.toml:2:10: seats = 9: expected a whole number from 1 to 8",
          "cart.toml:3:10: open = \"yes\": expected true or false",
          "cart.toml:5:10: tilt_deg = 90: expected a number from -57.2957795131 deg to 57.2957795131 deg"));
}

TEST(Table, NamesTheKeyThatWasMeant) {
  EXPECT_THAT(problems_of({member("colur", "red", 7)}),
              ElementsAre("cart.toml:7:1: colur: unknown key; did you mean \"colour\"?"));
  EXPECT_THAT(
      problems_of({member("tilt_mm", 1.0, 7)}),
      ElementsAre(
          "cart.toml:7:1: tilt_mm: wrong unit: expected tilt (rad), tilt_deg (deg), tilt_pi (pi rad)"));
  EXPECT_THAT(problems_of({member("seats_m", 1.0, 7)}),
              ElementsAre("cart.toml:7:1: seats_m: unknown key: seats has no unit, write seats"));
  EXPECT_THAT(problems_of({member("xyzzy", 1.0)}),
              ElementsAre(HasSubstr("unknown key; expected one of: colour, seats, open")));
}

struct Bench {
  double height = 0;
  std::optional<Bell> horn;
};

const Table<Bench>& fields_of(const Bench*) {
  static const auto table = Table<Bench>("bench", "Seats.")
                                .field("height", &Bench::height, {.unit = Unit::metre, .required = true})
                                .field("horn", &Bench::horn, {})
                                .renamed("tallness", "height")
                                .renamed("bell", "horn");
  return table;
}

TEST(Table, NamesTheNewNameOfARenamedKey) {
  Node::Table members = {member("tallness_mm", 2.0), member("bell", Node::Table{}, 2)};
  try {
    (void)read_as<Bench>(table(std::move(members)));
    FAIL() << "old names are refused";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "cart.toml:1:1: tallness_mm: is now called \"height_mm\"\n"
                 "cart.toml:2:1: bell: is now called \"horn\"");
  }
  EXPECT_THROW(Table<Bell>("bell", "").renamed("sound", "noise"), std::logic_error)
      << "no field has this name";
}

TEST(Table, NamesTheTableWhereAKeyBelongs) {
  EXPECT_THAT(problems_of({member("radius_mm", 20.0, 7)}),
              ElementsAre("cart.toml:7:1: radius_mm: unknown key; it belongs in each \"wheel\""));
  // A misspelt key of this table gets a hint to that key.
  try {
    (void)read_as<Street>(table({member("seats", std::int64_t{3}, 7)}));
    ADD_FAILURE() << "read";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "cart.toml:7:1: seats: unknown key; did you mean \"seat\"?");
  }
}

TEST(Table, RefusesAQuantityWrittenInTwoUnits) {
  EXPECT_THAT(problems_of({member("tilt", 0.5, 3), member("tilt_deg", 3.0, 4)}),
              ElementsAre("cart.toml:4:1: tilt_deg: occurs twice: tilt is already in line 3"));
}

TEST(Table, RefusesNumbersThatAreNotFinite) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  EXPECT_THAT(problems_of({member("top_speed", inf)}),
              ElementsAre(HasSubstr("top_speed = inf: expected a finite number")));
  EXPECT_THAT(problems_of({member("top_speed", -std::numeric_limits<double>::quiet_NaN())}),
              ElementsAre(HasSubstr("top_speed = nan")));
}

TEST(Table, SaysWhereSomethingIsMissing) {
  EXPECT_THAT(
      problems_of({member("wheel", Node::Array{{Node::Table{}, at(5, 1)}})}),
      ElementsAre("cart.toml:5:1: wheel[0].radius: missing: expected a number above 0 m (Its radius.)"));
  EXPECT_THAT(problems_of({member("part", Node::Array{{Node::Table{}, at(5, 1)}})}),
              ElementsAre("cart.toml:5:1: part[0]: kind is missing: expected one of \"wheel\", \"bell\""));
}

TEST(Table, CallsNothingMissingThatIsMisspelt) {
  const auto problems_of_wheel = [](const char* key) {
    Node wheel{Node::Table{{key, at(5, 3), {1.0, at(5, 9)}}}, at(5, 1)};
    return problems_of({member("wheel", Node::Array{std::move(wheel)})});
  };
  EXPECT_THAT(problems_of_wheel("raduis"),
              ElementsAre("cart.toml:5:3: wheel[0].raduis: unknown key; did you mean \"radius\"?"));
  EXPECT_THAT(problems_of_wheel("radius_deg"), ElementsAre(HasSubstr("wrong unit: expected radius (m)")));
  EXPECT_THAT(problems_of_wheel("weight"),
              ElementsAre(HasSubstr("weight: unknown key; expected"), HasSubstr("radius: missing")));
}

TEST(Table, ReportsBadEntriesOfArrays) {
  EXPECT_THAT(problems_of({member("notes", Node::Array{{1.0, at(2, 3)}, {"la", at(2, 7)}})}),
              ElementsAre("cart.toml:2:7: notes[1] = \"la\": expected a finite number"));
  EXPECT_THAT(problems_of({member("notes", Node::Array{})}),
              ElementsAre("cart.toml:1:10: notes is an empty array: expected an array of 1 to 3"));
  EXPECT_THAT(problems_of({member("wheel", 3.0)}),
              ElementsAre("cart.toml:1:10: wheel = 3: expected an array"));
}

TEST(Table, ChecksAcrossFieldsOnlyWhatWasReadWell) {
  EXPECT_THAT(problems_of({member("open", true), member("seats", std::int64_t{5}, 4)}),
              ElementsAre("cart.toml:4:1: seats: too many for an open cart"));
  EXPECT_THAT(problems_of({member("open", true), member("seats", std::int64_t{50})}).size(), 1);
}

TEST(Table, WritesWhatItReads) {
  Cart cart;
  cart.tilt = 0.3;
  cart.notes = {{1, 2}};
  cart.wheel.push_back({.radius = 3, .width = {0.1, 0.2}});
  cart.part.emplace_back(Bell{"dong"});
  const Node written = Codec<Cart>::write(cart);
  const auto again = read_as<Cart>(written);
  EXPECT_EQ(again.tilt, cart.tilt);
  EXPECT_EQ(again.notes, cart.notes);
  EXPECT_EQ(again.wheel.at(0).width, cart.wheel[0].width);
  EXPECT_EQ(std::get<Bell>(again.part.at(0)).sound, "dong");
  EXPECT_EQ(written.find("top_speed"), nullptr) << "a bound that is none is left out";
}

TEST(InputError, ListsTheFirstProblemsAndCountsTheRest) {
  const InputError error(std::vector<Problem>(25, {{}, "wrong"}));
  EXPECT_THAT(error.what(), HasSubstr("... and 5 more"));
}

TEST(NearestName, FindsMisspeltAndNothingElse) {
  const std::vector<std::string> names{"length", "radius", "max_bend"};
  EXPECT_EQ(nearest_name("lenght", names), "length");
  EXPECT_EQ(nearest_name("raduis", names), "radius");
  EXPECT_EQ(nearest_name("maxbend", names), "max_bend");
  EXPECT_EQ(nearest_name("colour", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name(std::string(100000, 'l'), names), "");
}

TEST(SetAtPath, ReplacesAValueInWhateverUnitItStands) {
  Node root{Node::Table{{"length", {}, {2.0, {}}}, {"mass", {}, {1.0, {}}}}, {}};
  EXPECT_EQ(set_at_path(root, "length_mm", {2.5, {}}), "");
  EXPECT_EQ(root.find("length"), nullptr);
  ASSERT_NE(root.find("length_mm"), nullptr);
  EXPECT_NE(root.find("mass"), nullptr);
  EXPECT_EQ(set_at_path(root, "length", {2.0, {}}), "");
  EXPECT_EQ(root.find("length_mm"), nullptr);
}

TEST(SetAtPath, ChangesEntriesAndMakesTables) {
  Node root = table({member("wheel", Node::Array{{one_wheel(1), at(1, 1)}})});
  EXPECT_EQ(set_at_path(root, "wheel.0.radius", {2.5, {}}), "");
  EXPECT_EQ(*root.find("wheel")->as<Node::Array>()->at(0).find("radius")->as<double>(), 2.5);
  EXPECT_EQ(set_at_path(root, "wheel[0].radius", {3.5, {}}), "") << "as messages write it";
  EXPECT_EQ(*root.find("wheel")->as<Node::Array>()->at(0).find("radius")->as<double>(), 3.5);
  EXPECT_EQ(set_at_path(root, "new.deep", {true, {}}), "");
  EXPECT_TRUE(*root.find("new")->find("deep")->as<bool>());
  EXPECT_EQ(set_at_path(root, "wheel.1.radius", {2.5, {}}), "the index 1 is outside an array of size 1");
  EXPECT_EQ(set_at_path(root, "wheel.x", {2.5, {}}),
            "\"x\" refers to an entry of an array: expected the entry's index, counted from 0");
  EXPECT_EQ(set_at_path(root, "wheel.0.radius.x", {2.5, {}}), "nothing named \"x\" inside 3.5");
  EXPECT_THAT(set_at_path(root, "wheel..radius", {2.5, {}}), HasSubstr("is not a path"));
}

TEST(Merge, LaysTablesUponTablesAndReplacesTheRest) {
  Node under = table(
      {member("a", Node::Table{member("x", 1.0), member("y", 2.0)}), member("b", Node::Array{{1.0, {}}})});
  merge(under, table({member("a", Node::Table{member("y", 3.0)}), member("b", Node::Array{})}));
  EXPECT_EQ(*under.find("a")->find("x")->as<double>(), 1.0);
  EXPECT_EQ(*under.find("a")->find("y")->as<double>(), 3.0);
  EXPECT_TRUE(under.find("b")->as<Node::Array>()->empty());
}

}  // namespace
}  // namespace flexura

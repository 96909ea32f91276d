#include "flexura/store/schema.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "flexura/base/table.h"
#include "flexura/store/json.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Lamp {
  double height = 1.0;
  std::array<double, 2> reach = {1, 2};
};
struct Room {
  std::vector<std::variant<Lamp>> thing;
};

const Table<Lamp>& fields_of(const Lamp*) {
  static const auto table =
      Table<Lamp>("lamp", "Gives light.")
          .field("height", &Lamp::height,
                 {.meaning = "How high it is.", .unit = Unit::metre, .range = above(0), .required = true})
          .field("reach", &Lamp::reach, {.meaning = "How far.", .range = at_least(0), .one_for_all = true});
  return table;
}
const Table<Room>& fields_of(const Room*) {
  static const auto table = Table<Room>("room", "A room.")
                                .field("thing", &Room::thing, {.meaning = "What is in it.", .count = {1, 5}});
  return table;
}

TEST(JsonSchema, DescribesKindsUnitsRangesAndCounts) {
  const Node schema = json_schema(fields_of(static_cast<const Room*>(nullptr)).info());
  const std::string expected =
      R"({"$schema":"http://json-schema.org/draft-07/schema#","title":"room","type":"object","description":"A room.",)"
      R"("properties":{"thing":{"type":"array","items":{"anyOf":[{"type":"object","description":"Gives light.",)"
      R"("properties":{"kind":{"const":"lamp"},)"
      R"("height":{"type":"number","exclusiveMinimum":0,"description":"How high it is. [m]"},)"
      R"("height_mm":{"type":"number","exclusiveMinimum":0,"description":"How high it is. [mm]"},)"
      R"("reach":{"anyOf":[{"type":"number","minimum":0},)"
      R"({"type":"array","items":{"type":"number","minimum":0},"minItems":2,"maxItems":2}],)"
      R"("description":"How far. Default: [1, 2]."}},)"
      R"("additionalProperties":false,"required":["kind"],)"
      R"("allOf":[{"anyOf":[{"required":["height"]},{"required":["height_mm"]}]}]}]},)"
      R"("minItems":1,"maxItems":5,"description":"What is in it. Default: []."}},"additionalProperties":false})";
  EXPECT_EQ(write_json(schema), expected);
}

TEST(MarkdownReference, HasASectionATableAndARowAField) {
  const std::string page = markdown_reference(fields_of(static_cast<const Room*>(nullptr)).info());
  EXPECT_THAT(page, StartsWith("# room\n"));
  EXPECT_THAT(page, HasSubstr("\n\nA room.\n"));
  EXPECT_THAT(page, HasSubstr("## `[[thing]]`, `kind = \"lamp\"`\n\nGives light.\n"));
  EXPECT_THAT(page, HasSubstr("| `height`, `height_mm` | number, > 0 m | required | How high it is. |\n"));
  EXPECT_THAT(page, HasSubstr("| `reach` | number or 2 numbers, >= 0 | [1, 2] | How far. |\n"));
}

struct House {
  std::vector<Room> room;
  Lamp porch, path;
};

const Table<House>& fields_of(const House*) {
  static const auto table = Table<House>("house", "A house.")
                                .field("room", &House::room, {.meaning = "Its rooms."})
                                .field("porch", &House::porch, {.meaning = "At the door."})
                                .field("path", &House::path, {.meaning = "Along the path."});
  return table;
}

TEST(MarkdownReference, DescribesATableOnceAndLinksToIt) {
  const std::string page = markdown_reference(fields_of(static_cast<const House*>(nullptr)).info());
  const std::string link = "Keys: see [`[[room.thing]]`, `kind = \"lamp\"`](#roomthing-kind--lamp).\n";
  EXPECT_THAT(page, HasSubstr("## `[porch]`\n\n" + link));
  EXPECT_THAT(page, HasSubstr("## `[path]`\n\n" + link));
  EXPECT_EQ(page.find("How high it is."), page.rfind("How high it is."));
}

struct Sphere {
  double size = 1, x = 0, y = 0, z = 0, speed = 2e6;
};
struct Ball {
  double size = 1, speed = 2e6;
};
struct Place {
  double x = 0, y = 0, z = 0;
};
struct Toys {
  Place place;
  std::vector<std::variant<Sphere, Ball>> toy;
};

template <class S>
Table<S> moving_table(const char* kind) {
  return Table<S>(kind, "Rolls.")
      .field("size", &S::size, {.meaning = "Its size."})
      .field("speed", &S::speed, {.meaning = "Its speed.", .range = between(0, 3e6)});
}
template <class S>
Table<S> placed(Table<S> table) {
  for (const auto& [name, member] : {std::pair{"x", &S::x}, std::pair{"y", &S::y}, std::pair{"z", &S::z}})
    table.field(name, member, {.meaning = "Its place."});
  return table;
}
const Table<Sphere>& fields_of(const Sphere*) {
  static const auto table = placed(moving_table<Sphere>("sphere"));
  return table;
}
const Table<Ball>& fields_of(const Ball*) {
  static const auto table = moving_table<Ball>("ball");
  return table;
}
const Table<Place>& fields_of(const Place*) {
  static const auto table = placed(Table<Place>("place", "Where."));
  return table;
}
const Table<Toys>& fields_of(const Toys*) {
  static const auto table = Table<Toys>("toys", "Toys.")
                                .field("place", &Toys::place, {.meaning = "Where they are."})
                                .field("toy", &Toys::toy, {.meaning = "The toys."});
  return table;
}

TEST(MarkdownReference, DescribesFieldsOnceThatSeveralTablesHave) {
  const std::string page = markdown_reference(fields_of(static_cast<const Toys*>(nullptr)).info());
  EXPECT_THAT(page, HasSubstr("## `[[toy]]`\n\nKeys of every kind:\n"));
  EXPECT_THAT(page, HasSubstr("| `speed` | number, [0, 3e6] | 2000000 | Its speed. |\n"));
  EXPECT_EQ(page.find("Its size."), page.rfind("Its size."));
  EXPECT_THAT(page, HasSubstr("Rolls. This table also accepts the keys of [`[place]`](#place).\n"));
  EXPECT_EQ(page.find("| `x` |"), page.rfind("| `x` |"));
}

}  // namespace
}  // namespace flexura

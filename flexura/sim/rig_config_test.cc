#include "flexura/sim/rig_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

namespace flexura {
namespace {

using ::testing::HasSubstr;

Node::Member member(std::string key, Node::Value value) {
  return {std::move(key), {}, {std::move(value), {}}};
}
Node table(Node::Table members) { return {std::move(members), {}}; }
Node::Member entries(std::string key, std::vector<Node> nodes) {
  return member(std::move(key), std::move(nodes));
}

double number(const Node* node) { return *node->as<double>(); }

TEST(Truth, IsTheDocumentItselfWhereThereIsNone) {
  const Node node = truth_of(table({member("seed", 1.0)}));
  EXPECT_EQ(number(node.find("seed")), 1.0);
}

TEST(Truth, IsLaidUponTheRestInAnyUnit) {
  const Node node = truth_of(table({
      member("arm", Node::Table{member("length", 2.0), member("radius", 0.1)}),
      member("truth", Node::Table{member("arm", Node::Table{member("length_mm", 2010.0)})}),
  }));
  EXPECT_EQ(node.find("truth"), nullptr);
  EXPECT_EQ(node.find("arm")->find("length"), nullptr);
  EXPECT_EQ(number(node.find("arm")->find("length_mm")), 2010.0);
  EXPECT_EQ(number(node.find("arm")->find("radius")), 0.1);
}

TEST(Truth, FindsCamerasByNameAndSectionsByPlace) {
  const Node node = truth_of(table({
      entries("camera", {table({member("name", "front"), member("fx", 800.0)}),
                         table({member("name", "side"), member("fx", 800.0)})}),
      entries("section", {table({member("length", 1.0)}), table({member("length", 2.0)})}),
      member("truth",
             Node::Table{
                 entries("camera", {table({member("name", "side"), member("fx", 810.0)})}),
                 entries("section", {table({}), table({member("length", 2.1)})}),
             }),
  }));
  const auto& cameras = *node.find("camera")->as<Node::Array>();
  EXPECT_EQ(number(cameras[0].find("fx")), 800.0);
  EXPECT_EQ(number(cameras[1].find("fx")), 810.0);
  const auto& sections = *node.find("section")->as<Node::Array>();
  EXPECT_EQ(number(sections[0].find("length")), 1.0);
  EXPECT_EQ(number(sections[1].find("length")), 2.1);
}

TEST(Truth, ReplacesNumbersAndArraysOfAnotherLength) {
  const Node node = truth_of(table({
      member("position", Node::Array{{1.0, {}}, {2.0, {}}}),
      entries("zoom", {table({member("ratio", 1.0)}), table({member("ratio", 2.0)})}),
      member("truth", Node::Table{member("position", Node::Array{{3.0, {}}, {4.0, {}}}),
                                  entries("zoom", {table({member("ratio", 5.0)})})}),
  }));
  EXPECT_EQ(node.find("position")->as<Node::Array>()->at(1).literal(), "4");
  EXPECT_EQ(node.find("zoom")->as<Node::Array>()->size(), 1);
}

TEST(Truth, ChoosesHowAMountSaysItsTurn) {
  const auto mount_of = [](Node::Table below, Node::Table above) {
    const Node node = truth_of(table({
        entries("camera", {table({member("name", "front"), member("mount", std::move(below))})}),
        member("truth", Node::Table{entries("camera", {table({member("name", "front"),
                                                              member("mount", std::move(above))})})}),
    }));
    return *node.find("camera")->as<Node::Array>()->at(0).find("mount");
  };
  const Node turned = mount_of({member("look_at", 1.0), member("roll_deg", 2.0), member("position", 3.0)},
                               {member("rotation", 4.0)});
  EXPECT_EQ(turned.find("look_at"), nullptr);
  EXPECT_EQ(turned.find("roll_deg"), nullptr);
  EXPECT_EQ(number(turned.find("rotation")), 4.0);
  EXPECT_EQ(number(turned.find("position")), 3.0);
  const Node looking = mount_of({member("rotation", 4.0)}, {member("look_at_mm", 1.0), member("roll", 0.1)});
  EXPECT_EQ(looking.find("rotation"), nullptr);
  EXPECT_EQ(number(looking.find("look_at_mm")), 1.0);
  EXPECT_EQ(number(looking.find("roll")), 0.1);
  // Two alternatives that are both in the upper document are both kept, so that the reader can report it.
  const Node both = mount_of({}, {member("rotation", 4.0), member("look_at", 1.0)});
  EXPECT_NE(both.find("rotation"), nullptr);
  EXPECT_NE(both.find("look_at"), nullptr);
}

TEST(Truth, RefusesTwoEntriesOfAName) {
  const Node front = table({member("name", "front")});
  try {
    (void)truth_of(
        table({entries("camera", {front}), member("truth", Node::Table{entries("camera", {front, front})})}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("truth.camera[1].name: \"front\" is the name of another entry"));
  }
}

TEST(Truth, SaysWhereItNamesNothing) {
  const auto source = std::make_shared<const std::string>("x.toml");
  Node wrong = table({member("name", "sied")});
  wrong.where = {source, 7, 1};
  wrong.find("name")->where = {source, 8, 8};
  Node document = table({entries("camera", {table({member("name", "side")})}),
                         member("truth", Node::Table{entries("camera", {wrong})})});
  try {
    (void)truth_of(document);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("x.toml:8:8: truth.camera: no entry outside [truth] has the name \"sied\""));
  }
  EXPECT_THROW((void)truth_of(table({member("truth", 3.0)})), InputError);
}

}  // namespace
}  // namespace flexura

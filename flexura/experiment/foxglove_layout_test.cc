// The layout for Foxglove, against a log of the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "flexura/base/table.h"
#include "flexura/log/scene_messages.h"
#include "tests/support/checkout.h"
#include "tests/support/runs.h"

namespace flexura {
namespace {

// Adds every text and key below a node that names a topic, with its path into the message.
void collect_topics(const Node& node, std::set<std::string>& found) {
  const auto add = [&](const std::string& text) {
    if (text.starts_with('/')) found.insert(text);
  };
  if (const auto* text = node.as<std::string>()) add(*text);
  if (const auto* array = node.as<Node::Array>())
    for (const Node& element : *array) collect_topics(element, found);
  if (const auto* table = node.as<Node::Table>()) {
    for (const Node::Member& member : *table) {
      add(member.key);
      collect_topics(member.node, found);
    }
  }
}

// Adds the panels in a tree of splits.
void collect_panels(const Node& node, std::set<std::string>& found) {
  if (const auto* panel = node.as<std::string>()) {
    EXPECT_TRUE(found.insert(*panel).second) << *panel << " is there twice";
    return;
  }
  const Node *first = node.find("first"), *second = node.find("second"), *direction = node.find("direction");
  ASSERT_TRUE(first != nullptr && second != nullptr && direction != nullptr);
  EXPECT_THAT(*direction->as<std::string>(), testing::AnyOf("row", "column"));
  collect_panels(*first, found);
  collect_panels(*second, found);
}

Node layout() {
  return parse_json(read_text_file(checkout_file("examples/foxglove_layout.json"), std::size_t{1} << 20),
                    "foxglove_layout.json");
}

TEST(FoxgloveLayout, HasTheTopicsOfALog) {
  Runs runs;
  Experiment experiment = load_experiment(checkout_file("examples/03_cameras/experiment.toml"));
  std::get<MoveTask>(experiment.task.front()).duration = 0.5;
  const RunResult result = runs.run(experiment);
  std::map<std::string, Node> messages;  // The last one of each topic.
  const McapReader log = open_log(result.folder);
  for (const McapMessage& message : log.messages())
    messages[message.channel->topic] = parse_json(message.text(), "log");
  // The cameras do not move: their frames are logged at the start only.
  const auto all_frames = logged<FramesMessage>(result, "/frames");
  ASSERT_EQ(all_frames.size(), 1U);
  const Node frames = Codec<FramesMessage>::write(all_frames.front());
  std::set<std::string> topics;
  collect_topics(layout(), topics);
  EXPECT_GT(topics.size(), 10U);
  for (const std::string& path : topics) {
    const std::size_t dot = path.find('.');
    const auto message = messages.find(path.substr(0, dot));
    ASSERT_NE(message, messages.end()) << path;
    if (dot == std::string::npos) continue;
    const std::string field = path.substr(dot + 1, path.find_first_of(".[", dot + 1) - dot - 1);
    EXPECT_NE(message->second.find(field), nullptr) << path;
  }
  for (const char* frame : {"upright", "camera/front", "camera/side"})
    EXPECT_THAT(write_json(frames), testing::HasSubstr(frame)) << "a panel follows it";
}

TEST(FoxgloveLayout, PlacesEachOfItsPanelsOnce) {
  const Node read = layout();
  std::set<std::string> placed, configured;
  collect_panels(*read.find("layout"), placed);
  for (const Node::Member& panel : *read.find("configById")->as<Node::Table>()) {
    configured.insert(panel.key);
    EXPECT_THAT(panel.key.substr(0, panel.key.find('!')), testing::AnyOf("3D", "Image", "Plot", "RosOut"));
  }
  EXPECT_EQ(placed, configured);
}

}  // namespace
}  // namespace flexura

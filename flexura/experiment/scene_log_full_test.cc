// A run's log read by @mcap/core, an independent program (tests/node).
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/log/results.h"
#include "flexura/store/json.h"
#include "tests/support/checkout.h"
#include "tests/support/quiet.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

TEST(RunsLog, OpensElsewhereUnderFoxglovesNames) {
  const std::filesystem::path reader = checkout_file("tests/node/read_mcap.mjs");
  const bool is_there = std::filesystem::exists(reader.parent_path() / "node_modules/fzstd") &&
                        std::system("node --version > /dev/null 2>&1") == 0;
  if (!is_there && std::getenv("FLEXURA_REQUIRE_NODE") == nullptr)
    GTEST_SKIP() << "needs node and `npm ci` in tests/node";
  const TemporaryFolder folder;
  Quiet quiet;
  Experiment experiment = load_experiment(checkout_file("examples/01_paper_arm/experiment.toml"));
  experiment.record.cameras = true;
  std::get<MoveTask>(experiment.task.front()).duration = 0.5;
  (void)run_experiment(experiment, folder.path(), quiet);

  const std::string command =
      "node '" + reader.string() + "' '" + (folder.path() / log_file_name).string() + "'";
  FILE* const pipe = ::popen(command.c_str(), "r");
  std::string output;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) output += static_cast<char>(c);
  ASSERT_EQ(::pclose(pipe), 0);
  const Node reported = parse_json(output, "read_mcap.mjs");
  std::map<std::string, std::string> schemas;
  for (const Node& channel : *reported.find("indexed")->find("channels")->as<Node::Array>()) {
    EXPECT_GT(*channel.find("count")->as<std::int64_t>(), 0);
    EXPECT_EQ(*channel.find("schemaEncoding")->as<std::string>(), "jsonschema");
    schemas[*channel.find("topic")->as<std::string>()] = *channel.find("schema")->as<std::string>();
  }
  const std::map<std::string, std::string> expected{{"/arm/state", "flexura.ArmState"},
                                                    {"/arm/poses", "foxglove.PosesInFrame"},
                                                    {"/arm/truth", "foxglove.PosesInFrame"},
                                                    {"/arm/reading", "flexura.ArmReading"},
                                                    {"/events", "foxglove.Log"},
                                                    {"/scene", "foxglove.SceneUpdate"},
                                                    {"/frames", "foxglove.FrameTransforms"},
                                                    {"/intrinsics/front", "foxglove.CameraCalibration"},
                                                    {"/intrinsics/side", "foxglove.CameraCalibration"},
                                                    {"/camera/front", "foxglove.CompressedImage"},
                                                    {"/camera/side", "foxglove.CompressedImage"},
                                                    {"/head/front", "flexura.HeadReading"},
                                                    {"/head/side", "flexura.HeadReading"},
                                                    {"/stage/front", "flexura.StageReading"},
                                                    {"/stage/side", "flexura.StageReading"}};
  EXPECT_EQ(schemas, expected);
}

}  // namespace
}  // namespace flexura

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/log/export_csv.h"
#include "flexura/log/logged_message.h"
#include "flexura/log/messages.h"
#include "flexura/rig/filming.h"
#include "flexura/store/text_file.h"
#include "flexura/tasks/task_kinds.h"
#include "tests/support/checkout.h"
#include "tests/support/experiment_files.h"
#include "tests/support/runs.h"

// Runs whose true arm is an elastic rod in motion.
namespace flexura {
namespace {

using ::testing::HasSubstr;

class DynamicArm : public Runs, public testing::Test {
 protected:
  RunResult example(const std::string& name) {
    return run(load_experiment(checkout_file("examples/" + name + "/experiment.toml"), {{}, {}}));
  }
};

TEST_F(DynamicArm, SwingsWhenItIsLetGoAndComesToRest) {
  const RunResult result = example("12_hanging_tentacle");
  ASSERT_EQ(result.outcome, RunOutcome::done);
  const auto energy = logged<EnergyMessage>(result, arm_energy_topic);
  const auto truth = logged<PosesMessage>(result, arm_truth_topic);
  ASSERT_EQ(energy.size(), truth.size());
  const auto total = [](const EnergyMessage& at) { return at.kinetic + at.strain + at.gravity; };
  const auto side = [&](std::size_t i) { return truth[i].poses.back().position.x; };
  EXPECT_EQ(energy.front().kinetic, 0);
  double greatest = 0, least = 0, most = 0;
  for (std::size_t i = 0; i < energy.size(); ++i) {
    greatest = std::max(greatest, energy[i].kinetic);
    least = std::min(least, side(i)), most = std::max(most, side(i));
    // The tendons remove energy while they are paid out, and nothing adds any afterwards.
    if (energy[i].time > 0.35) {
      EXPECT_LE(total(energy[i]), total(energy[i - 1]) + 1e-5) << energy[i].time;
    }
  }
  EXPECT_GT(greatest, 0.02);
  EXPECT_LT(least, -0.05);
  EXPECT_GT(most, 0.05);
  EXPECT_LT(energy.back().kinetic, greatest / 4);
  const ExportResult exported = export_csv(result.folder, task_tables());
  EXPECT_THAT(read_text_file(exported.folder / "energy.csv", 1 << 20),
              HasSubstr("time,kinetic,strain,gravity\n"));
}

TEST_F(DynamicArm, GraspsAPostAndHoldsOnToIt) {
  const RunResult result = example("13_grasp");
  ASSERT_EQ(result.outcome, RunOutcome::done);
  const auto contacts = logged<ContactsMessage>(result, arm_contacts_topic);
  ASSERT_FALSE(contacts.empty());
  EXPECT_GT(contacts.front().time, 0.3);
  ASSERT_GE(contacts.back().contacts.size(), 3U);
  // It is bent around the post, which pushes back from the side and from above.
  double left = 0, up = 0;
  for (const ContactMessage& contact : contacts.back().contacts) {
    EXPECT_EQ(contact.with, "post");
    EXPECT_LT(contact.depth, 0.006);
    left = std::min(left, contact.force.x), up = std::max(up, contact.force.y);
  }
  EXPECT_LT(left, -0.05);
  EXPECT_GT(up, 0.05);
  EXPECT_THAT(read_text_file(result.folder / "report.html", 1 << 26), HasSubstr("contact forces"));
}

// A move of 0.15 s against a post of 2 mm radius, thinner than the way of the arm in a step of 20 or 50 ms.
TEST_F(DynamicArm, IsHeldByAThinPostWhateverTheStep) {
  std::vector<Eigen::Vector3d> tips;
  for (const double step : {0.005, 0.02, 0.05}) {
    std::string text = fmt::format(
        "[arm]\nkind = 'spatial'\nmodel = 'dynamic'\ngravity = [0, 0, 0]\ntime_step = {}\n"
        "[[arm.section]]\nlength = 0.5\nradius = 0.015\nmax_bend_deg = 150\nmax_bend_rate_deg = 2000\n"
        "material = {{ youngs_modulus = 3e7, density = 1000, damping_time = 0.01 }}\n"
        "[arm.contact]\nstiffness = 1e6\nfriction = 0\n"
        "[[obstacle]]\nkind = 'capsule'\nname = 'post'\nfrom = [0.14, 0.32, -0.3]\nto = [0.14, 0.32, 0.3]\n"
        "radius = 0.002\nmay_touch = true\n"
        "[[task]]\nkind = 'move'\nduration = 0.15\nto.bends_deg = [[120, 0]]\n"
        "[[task]]\nkind = 'hold'\nduration = 1\n",
        step);
    for (const int angle : {0, 120, 240})
      text += fmt::format("[[arm.tendon]]\nsection = 1\nradius_mm = 10\nangle_deg = {}\n", angle);
    const auto file = folder_.path() / "post.toml";
    std::ofstream(file) << text;
    const RunResult result = run(load_experiment(file, {{"record.report=false"}, {}}));
    ASSERT_EQ(result.outcome, RunOutcome::done);
    const auto tip = logged<PosesMessage>(result, arm_truth_topic).back().poses.back().position;
    tips.emplace_back(tip.x, tip.y, tip.z);
    EXPECT_FALSE(logged<ContactsMessage>(result, arm_contacts_topic).back().contacts.empty());
  }
  for (const Eigen::Vector3d& tip : tips) EXPECT_LT((tip - tips.front()).norm(), 1e-3);
}

TEST_F(DynamicArm, GivesTheSameBytesAgain) {
  const RunResult one = example("13_grasp"), other = example("13_grasp");
  EXPECT_EQ(read_text_file(one.folder / "log.mcap", 1 << 28),
            read_text_file(other.folder / "log.mcap", 1 << 28));
}

// An arm with tendon friction bends onto a ball, rubs on it and itself, and is filmed.
constexpr const char* filmed_touch = R"(seed = 11
[record]
cameras = true
[arm]
kind = "spatial"
model = "dynamic"
gravity = [0, -9.81, 0]
[[arm.section]]
length = 0.3
radius = 0.012
max_bend_deg = 360
max_bend_rate_deg = 720
material = { youngs_modulus = 1e6, density = 1100, damping_time = 0.02, modes = { bend = 3 } }
[[arm.tendon]]
section = 1
radius_mm = 8
friction = 0.2
[[arm.tendon]]
section = 1
radius_mm = 8
angle_deg = 120
friction = 0.2
[[arm.tendon]]
section = 1
radius_mm = 8
angle_deg = 240
friction = 0.2
[arm.contact]
friction = 0.4
itself = true
[arm.drag]
density = 1000
[[obstacle]]
kind = "sphere"
name = "ball"
center = [0.08, 0.22, 0]
radius = 0.05
may_touch = true
[[camera]]
name = "front"
mount = { position = [0, 0.15, 1], look_at = [0, 0.15, 0] }
lens = { fx = 80, fy = 80, cx = 31.5, cy = 23.5 }
sensor = { width = 64, height = 48, frame_rate = 10, read_noise = 1, delay_ms = 20, drop = 0.2 }
[[camera]]
name = "side"
mount = { position = [-1, 0.15, 0], look_at = [0, 0.15, 0] }
lens = { fx = 80, fy = 80, cx = 31.5, cy = 23.5 }
sensor = { width = 64, height = 48, frame_rate = 25 }
[[task]]
kind = "move"
duration = 0.4
to = { bends_deg = [[120, 20]] }
)";

// All files: log with pictures and contacts, summary, report and figures.
TEST_F(DynamicArm, GivesTheSameBytesForAnyNumberOfThreads) {
  const auto files_by = [&](std::size_t threads) {
    Quiet quiet;
    const RunResult result = run_experiment(
        parse_experiment(filmed_touch, "x.toml"), make_new_folder(folder_.path() / "results"), quiet, nullptr,
        [&](const auto& setup) { return std::make_unique<Filming>(setup, threads); });
    EXPECT_EQ(result.outcome, RunOutcome::done);
    if (threads == 1) {
      const auto contacts = logged<ContactsMessage>(result, arm_contacts_topic);
      EXPECT_TRUE(std::ranges::any_of(contacts, [](const auto& at) { return !at.contacts.empty(); }));
    }
    return files_in(result.folder);
  };
  const auto one = files_by(1);
  for (const char* name : {"log.mcap", "summary.json", "report.html"})
    ASSERT_TRUE(one.contains(name)) << name;
  for (const std::size_t threads : {2U, 5U}) {
    const auto other = files_by(threads);
    ASSERT_EQ(other.size(), one.size());
    for (const auto& [name, bytes] : one) {
      if (name == "timing.json") continue;
      EXPECT_TRUE(other.at(name) == bytes) << name << ", " << threads;
    }
  }
}

constexpr const char* moving_rod = R"([arm]
kind = "spatial"
model = "dynamic"
[[arm.section]]
length = 0.3
radius = 0.02
[arm.section.material]
youngs_modulus = 1e6
density = 1000
damping_time = 0.01
[[arm.tendon]]
section = 1
radius = 0.01
[arm.contact]
friction = 0.4
[arm.drag]
density = 1000
[[arm.payload]]
section = 1
mass = 0.1
from = 1
until = 2
)";

std::string moving_with(const std::string& from, const std::string& to) {
  return replaced(moving_rod, from, to);
}

TEST(BadDynamicFiles, EachGetsALineWithPlaceValueAndExpectation) {
  EXPECT_EQ(error_of_file(moving_rod), "no error");
  EXPECT_THAT(error_of_file(moving_with("density = 1000\ndamping", "damping")),
              HasSubstr("arm.section[0].material: has no mass: expected density or mass_per_length"));
  EXPECT_EQ(error_of_file(moving_with("radius = 0.01\n", "radius = 0.01\nfriction = 0.1\n")), "no error");
  EXPECT_THAT(error_of_file(moving_with("\"dynamic\"", "\"static\"")),
              HasSubstr("arm.contact: is only for dynamic arms: expected model = \"dynamic\""));
  EXPECT_EQ(error_of_file(moving_with("radius = 0.02\n", "radius = 0.02\nstretch_limits = [1, 2]\n")),
            "no error");
  EXPECT_THAT(error_of_file(moving_with("until = 2", "until = 0.5")),
              HasSubstr("arm.payload[0].until: is not after `from`"));
  EXPECT_THAT(error_of_file(moving_with("section = 1\nmass", "section = 2\nmass")),
              HasSubstr("arm.payload[0].section: 2: expected a section of the arm, 1 to 1"));
  EXPECT_THAT(error_of_file(moving_with("friction = 0.4", "stiffness = 0")),
              HasSubstr("arm.contact.stiffness = 0"));
  // The paper's arcs are of an arm that does not sag.
  EXPECT_THAT(error_of_file(moving_rod + std::string("[[task]]\nkind = \"calibrate\"\nmethod = \"arcs\"\n")),
              HasSubstr("task[0].method: this method needs an arm model of arcs, but an elastic arm sags"));
  EXPECT_THAT(error_of_file(moving_with("model = \"dynamic\"", "model = \"dynamic\"\ntime_step = 0")),
              HasSubstr("arm.time_step"));
}

TEST(BadDynamicFiles, AnArmDoesNotStartInsideAnObstacle) {
  const auto with_ball = [](double x, const std::string& more = "") {
    return moving_rod + fmt::format(
                            "[[obstacle]]\nkind = \"plane\"\npoint = [0, -1, 0]\n"
                            "[[obstacle]]\nkind = \"sphere\"\nname = \"ball\"\n"
                            "center = [{}, 0.2, 0]\nradius = 0.05\n{}",
                            x, more);
  };
  // The arm stands upright, 20 mm thick: its surface and then its centerline are inside.
  EXPECT_EQ(error_of_file(with_ball(0.071)), "no error");
  EXPECT_EQ(error_of_file(with_ball(0.06)), "no error");
  const std::string refused = error_of_file(with_ball(0.04));
  EXPECT_THAT(refused, HasSubstr("obstacle[1]: at the start, the arm's centerline is inside ball (the "
                                 "arm is 30 mm deep at 0.2 m from its base)"));
  EXPECT_THAT(refused, HasSubstr(":26:"));
  EXPECT_EQ(std::ranges::count(refused, '\n'), 0);
  EXPECT_EQ(error_of_file(with_ball(0.04, "ignore_base = 0.3\n")), "no error");
  // A ball so small that it lies between the contact points.
  EXPECT_THAT(error_of_file(replaced(with_ball(0.0), "center = [0, 0.2, 0]\nradius = 0.05",
                                     "center = [0, 0.2063, 0]\nradius = 0.001")),
              HasSubstr("obstacle[1]: at the start, the arm's centerline is inside ball"));
  // The true arm decides.
  EXPECT_THAT(error_of_file(with_ball(0.06, "[truth.arm.base]\nposition = [0.02, 0, 0]\n")),
              HasSubstr("obstacle[1]: at the start"));
  // Without contact, the arm passes through it.
  EXPECT_EQ(error_of_file(replaced(with_ball(0.04), "[arm.contact]\nfriction = 0.4\n", "")), "no error");
}

}  // namespace
}  // namespace flexura

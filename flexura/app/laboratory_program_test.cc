// The commands with which a laboratory sets up its equipment.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "flexura/equipment/gstreamer_camera.h"
#include "flexura/equipment/visca_device.h"
#include "flexura/store/json.h"
#include "tests/support/laboratory.h"
#include "tests/support/program.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

using LaboratoryProgram = Program;

// A VISCA head at a port of this machine.
struct Head {
  Head() : Head(open_udp_place()) {}
  explicit Head(UdpPlace place)
      : link("udp:127.0.0.1:" + std::to_string(place.port)), server(std::move(place.device), device) {
    const auto lock = server.lock();
    device.add({});
  }
  ViscaCounts counts() {
    const auto lock = server.lock();
    return device.counts(0, DeviceServer::now());
  }
  ViscaDevice device{ViscaFraming::datagram};
  std::string link;
  DeviceServer server;
};

TEST_F(LaboratoryProgram, JogMovesOneMotorByWhatIsAsked) {
  Controller controller;
  std::ofstream(path("lab.toml")) << lab_file(controller.path, 1);
  const Ended ended = run("jog lab.toml motor.2 -150");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out, "motor.2: commanded from 0 to -150 microsteps; measured position -150\n");
  EXPECT_EQ(controller.positions(), (std::vector<double>{0, -150, 0}));
  const Ended again = run("jog lab.toml tendon.3 0.2mm --json");
  EXPECT_EQ(again.status, 0) << again.err;
  const Node answer = parse_json(again.out, "stdout");
  EXPECT_EQ(*answer.find("unit")->as<std::string>(), "mm");
  EXPECT_NEAR(*answer.find("reads")->as<double>(), 0.2, 0.03);
}

TEST_F(LaboratoryProgram, JogRefusesWhatWouldHarmAndMovesNothing) {
  Controller controller;
  std::ofstream(path("lab.toml")) << lab_file(controller.path, 1);
  const Ended ended = run("jog lab.toml tendon.1 50mm");
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, HasSubstr("refused: tendon 1 would pull"));
  EXPECT_THAT(ended.out, IsEmpty());
  EXPECT_EQ(controller.positions(), (std::vector<double>{0, 0, 0}));
  const Ended unknown = run("jog lab.toml motor.7 1");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, StartsWith("AXIS: \"motor.7\": expected one of motor.1, motor.2"));
  const Ended simulated = run("jog " + paper_file + " motor.1 1");
  EXPECT_EQ(simulated.status, 2);
  EXPECT_THAT(simulated.err, HasSubstr("expected a table [rig]"));
}

TEST_F(LaboratoryProgram, JogOfAMissingControllerSaysSo) {
  std::ofstream(path("lab.toml")) << lab_file("/dev/no-such-line", 1);
  const Ended ended = run("jog lab.toml motor.1 1");
  EXPECT_EQ(ended.status, 3);
  EXPECT_EQ(ended.err, "flexura: link lost: /dev/no-such-line: No such file or directory\n");
}

TEST_F(LaboratoryProgram, JogTurnsAHeadWithinItsLimits) {
  Head head;
  // No controller is there: the arm is not touched.
  std::ofstream(path("lab.toml")) << lab_file("/dev/no-such-line", 1,
                                              "visca.bus.link = \"" + head.link + "\"\n");
  const Ended ended = run("jog lab.toml front.pan 5deg");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(head.counts().pan, -72);  // 14.4 counts per degree to the right.
  const Ended far = run("jog lab.toml front.pan 400");
  EXPECT_EQ(far.status, 1);
  EXPECT_THAT(far.err, MatchesRegex("refused: front.pan would go to 40. deg, the limits of .*\n"));
  EXPECT_EQ(head.counts().pan, -72);
}

TEST_F(LaboratoryProgram, DevicesReportsWhatCanBeUsed) {
  if (!has_gstreamer()) GTEST_SKIP() << "built without GStreamer";
  Controller controller;
  Head head;
  std::ofstream(path("lab.toml")) << lab_file(controller.path, 1, "visca.bus.link = \"" + head.link + "\"\n");
  const Ended ended = run("devices lab.toml");
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
  for (const char* fact :
       {"motors 1 to 3: Grbl at", "axes           XYZ\n", "highest speed  10000 microsteps/s\n",
        "front: pictures: GStreamer at", "160 x 120 pixels", "front: head: VISCA at",
        "vendor 0020h, model 040Eh", "pan -170.0 to 170.0 deg", "devices: 3 of 3 devices can be used\n"})
    EXPECT_THAT(ended.out, HasSubstr(fact));
  EXPECT_EQ(controller.positions(), (std::vector<double>{0, 0, 0}));
}

TEST_F(LaboratoryProgram, DevicesSaysWhyADeviceCannotBeUsed) {
  Controller controller;
  std::ofstream(path("lab.toml")) << lab_file(controller.path, 1, "visca.bus.link = \"/dev/no-such-line\"\n");
  const Ended ended = run("devices lab.toml --json");
  EXPECT_EQ(ended.status, 3);
  const Node answer = parse_json(ended.out, "stdout");
  const auto& devices = *answer.find("devices")->as<Node::Array>();
  ASSERT_EQ(devices.size(), 3u);
  EXPECT_TRUE(*devices[0].find("usable")->as<bool>());
  EXPECT_FALSE(*devices[2].find("usable")->as<bool>());
  EXPECT_THAT(*devices[2].find("problem")->as<std::string>(), HasSubstr("No such file"));
  EXPECT_EQ(run("devices " + paper_file).status, 2) << "a simulated rig has no devices";
}

TEST_F(LaboratoryProgram, DevicesListsThisMachine) {
  const Ended ended = run("devices --json");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(parse_json(ended.out, "stdout").find("found"), nullptr);
  EXPECT_EQ(run("devices").status, 0);
  Controller controller;
  EXPECT_THAT(run("devices --probe " + controller.path).out, HasSubstr("Grbl 1.1"));
  EXPECT_EQ(run("devices --probe can:can0").status, 2);
  EXPECT_EQ(run("devices --probe nonsense").status, 2);
}

TEST_F(LaboratoryProgram, DryRunPrintsEveryCommandAndNeedsNoDevice) {
  std::ofstream(path("lab.toml")) << lab_file("/dev/no-such-line", 0.1,
                                              "visca.bus.link = \"/dev/none@9600\"\n");
  const Ended ended = run("run lab.toml --dry-run");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out,
              StartsWith("dry run: no command is sent to real devices; simulated devices answer\n"));
  EXPECT_THAT(ended.out, HasSubstr(" s  /dev/no-such-line  0x18 (reset)\n"));
  EXPECT_THAT(ended.out, HasSubstr("$J=G90G21G53X"));
  EXPECT_THAT(ended.out, HasSubstr("stop pan and tilt\n"));
  EXPECT_THAT(ended.out, ::testing::Not(HasSubstr("? (status)")));
  EXPECT_FALSE(std::filesystem::exists(path("results"))) << "nothing is written";
  EXPECT_EQ(run("run lab.toml --dry-run").out, ended.out) << "the same file gives the same bytes";
  EXPECT_THAT(run("run lab.toml --dry-run --queries").out, HasSubstr("? (status)"));
  const Ended json = run("run lab.toml --dry-run --json");
  EXPECT_GT(parse_json(json.out, "stdout").find("sent")->as<Node::Array>()->size(), 5u);
  EXPECT_EQ(run("run " + paper_file + " --dry-run").status, 2) << "a simulated rig sends nothing";
  EXPECT_EQ(run("run lab.toml --dry-run --out there").status, 2);
  EXPECT_EQ(run("run lab.toml --queries").status, 2);
}

// Cameras are calibrated, and a servo moves the arm: three controllers and two heads.
TEST_F(LaboratoryProgram, DryRunOfTheWholeExample) {
  std::string file = read_text_file(checkout_file("examples/17_rehearsal/experiment.toml"), 1 << 20);
  const std::size_t truth = file.find("# The simulated cameras"), tasks = file.find("[[task]]", truth);
  ASSERT_NE(tasks, std::string::npos);
  file.erase(truth, tasks - truth);
  file += "[rig]\n";
  for (const char* line : {"/dev/a", "/dev/b", "/dev/c"})
    file += fmt::format("[[rig.grbl]]\nlink = \"{}\"\n", line);
  for (const char* camera : {"front", "side"})
    file += fmt::format(
        "[[rig.camera]]\nname = \"{0}\"\ngstreamer.source = \"rtsp://none/{0}\"\n"
        "onvif = {{ link = \"tcp:{0}:80\", user = \"me\", password_file = \"/no/file\", "
        "zoom = {{ points = [0, 1], positions = [1, 10] }} }}\n",
        camera);
  std::ofstream(path("lab.toml")) << file;
  const Ended ended = run("run lab.toml --dry-run");
  EXPECT_EQ(ended.status, 0) << ended.err;
  for (const char* line :
       {"/dev/a  $J=", "/dev/c  $J=", "tcp:front:80  AbsoluteMove pan ", "tcp:side:80  Absolute"})
    EXPECT_THAT(ended.out, HasSubstr(line));
  EXPECT_THAT(ended.out, HasSubstr("bow: converged"));
}

TEST_F(LaboratoryProgram, DryRunOfAnUnsafeMotionSendsNoMotion) {
  std::string file = lab_file("/dev/no-such-line", 0.1);
  file.insert(file.find("[drive]"), "max_bend_deg = 5\n");
  std::ofstream(path("lab.toml")) << file;
  const Ended ended = run("run lab.toml --dry-run");
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.out, ::testing::Not(HasSubstr("$J=")));
  EXPECT_THAT(ended.err, HasSubstr("bend"));
}

TEST_F(LaboratoryProgram, DeviceThatIsUsedTwiceIsAnError) {
  std::string file = lab_file("/dev/ttyUSB0", 0.1, "visca.bus.link = \"/dev/ttyUSB0\"\n");
  std::ofstream(path("lab.toml")) << file;
  const Ended ended = run("devices lab.toml");
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, HasSubstr("\"/dev/ttyUSB0\" is used by rig.grbl[0].link: expected another device"));
}

}  // namespace
}  // namespace flexura

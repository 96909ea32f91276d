#include "flexura/log/export_csv.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "flexura/log/logged_message.h"
#include "flexura/log/messages.h"
#include "flexura/log/recorder.h"
#include "flexura/log/results.h"
#include "flexura/model/backbone.h"
#include "flexura/servo/servo_step.h"
#include "flexura/store/text_file.h"
#include "flexura/tasks/servo/servo_messages.h"
#include "flexura/tasks/task_kinds.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

// One row per command; before the first pictures, the arm's values are missing.
TEST(ExportCsv, HasTheErrorsOfAServoOverTime) {
  const TemporaryFolder folder;
  Arm arm;
  arm.sections = {{.length = 0.3}};
  {
    Recorder recorder(folder.path() / log_file_name, arm);
    recorder.state(0, ArmState::straight(1), Backbone(arm, ArmState::straight(1)));
    ServoStep step;
    step.desired = step.sent = {{{0.5, 0.0}}, {1.0}};
    step.lengths = {0.3};
    recorder.write({servo_steps_topic, step.time, step});
    step.time = 0.25, step.seen_at = 0.125, step.error = {0.5, 1.5, 1};
    step.truth = {{}, {}, {0.75, 2, 1.75}}, step.potential = 0.0625;
    step.limited = "section 1, a bend";
    recorder.write({servo_steps_topic, step.time, step});
    recorder.close();
  }
  const ExportResult exported = export_csv(folder.path(), task_tables());
  EXPECT_EQ(read_text_file(exported.folder / "servo.csv", 1 << 20),
            "time,seen_at,rms,most,tip,true_rms,true_most,true_tip,potential,limited\n"
            "0,,,,,,,,0,\n"
            "0.25,0.125,0.5,1.5,1,0.75,2,1.75,0.0625,\"section 1, a bend\"\n");
  EXPECT_FALSE(std::filesystem::exists(exported.folder / "dynamics.csv"));
}

// A row per contact; none while the arm touches nothing.
TEST(ExportCsv, HasTheContactsOfAnArmInMotion) {
  const TemporaryFolder folder;
  Arm arm;
  arm.sections = {{.length = 0.3}};
  {
    Recorder recorder(folder.path() / log_file_name, arm);
    recorder.state(0, ArmState::straight(1), Backbone(arm, ArmState::straight(1)));
    const ContactMessage post{.s = 0.25,
                              .with = "post, left",
                              .point = {1, 2, 3},
                              .force = {-4, 5, 6},
                              .depth = 0.125,
                              .normal_force = 8,
                              .sticks = true};
    const ContactMessage itself{.s = 0.1, .with = "the arm", .point = {}, .force = {}, .depth = 0.5};
    recorder.write({arm_contacts_topic, 0.5, ContactsMessage{.time = 0.5, .contacts = {post, itself}}});
    recorder.write({arm_contacts_topic, 0.75, ContactsMessage{.time = 0.75, .contacts = {}}});
    recorder.close();
  }
  const ExportResult exported = export_csv(folder.path(), task_tables());
  EXPECT_EQ(read_text_file(exported.folder / "contacts.csv", 1 << 20),
            "time,s,with,point_x,point_y,point_z,force_x,force_y,force_z,depth,normal_force,sticks\n"
            "0.5,0.25,\"post, left\",1,2,3,-4,5,6,0.125,8,1\n"
            "0.5,0.1,the arm,0,0,0,0,0,0,0.5,,\n");
}

}  // namespace
}  // namespace flexura

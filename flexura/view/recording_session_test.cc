#include "flexura/view/recording_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>

#include "flexura/experiment/run.h"
#include "flexura/experiment/schedule.h"
#include "flexura/log/recorder.h"
#include "flexura/log/results.h"
#include "flexura/model/backbone.h"
#include "flexura/picture/image_file.h"
#include "flexura/port/motion_ports.h"
#include "flexura/store/text_file.h"
#include "flexura/view/series.h"
#include "tests/support/experiment_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/view_fakes.h"

namespace flexura {
namespace {

using ::testing::HasSubstr;

class Quiet : public Progress {
 public:
  void update(double, std::string_view) override {}
};

// Runs an experiment and opens its results.
class RecordingSessionTest : public ::testing::Test {
 protected:
  void record(const std::string& text = viewed_text) {
    experiment_ = parse_experiment(text, "x.toml");
    Quiet quiet;
    (void)run_experiment(experiment_, folder_.path(), quiet);
  }
  void open() {
    session_.emplace(std::make_shared<const Recording>(folder_.path()), messenger_, background_);
    session_->opened(me);
  }
  ViewAnswer ask(const Ask& ask, ClientId client = me) {
    ViewAnswer got{{}, "no answer yet"};
    try {
      session_->take(client, ask, [&](const ViewAnswer& answer) { got = answer; });
    } catch (const std::exception& refusal) {
      return {{}, refusal.what()};
    }
    return got;
  }
  HttpAnswer get(const Document& document) {
    HttpAnswer got;
    session_->take(document, [&](const HttpAnswer& answer) { got = answer; });
    return got;
  }
  [[nodiscard]] std::string last_image(std::uint32_t stream) {
    return *messenger_.posts[{me, stream}].back();
  }

  TemporaryFolder folder_;
  Experiment experiment_;
  FakeMessenger messenger_;
  FakeBackground background_;
  std::optional<RecordingSession> session_;
};

TEST_F(RecordingSessionTest, ShowsTheLoggedStateAtOrBeforeATime) {
  record();
  open();
  EXPECT_EQ(messenger_.state(me).time, 0) << "at once";
  const Hello hello = session_->hello();
  EXPECT_EQ(hello.mode, "recording");
  EXPECT_EQ(hello.duration, 1);
  EXPECT_EQ(hello.interval, 0.02);
  EXPECT_TRUE(hello.report);
  const Schedule schedule(experiment_);
  for (const auto& [asked, shown] : std::vector<std::pair<double, double>>{
           {-1, 0}, {0, 0}, {0.019, 0}, {0.02, 0.02}, {0.5, 0.5}, {0.519, 0.5}, {1, 1}, {1e300, 1}}) {
    EXPECT_EQ(*ask(AtRequest{asked}).result.find("time")->as<double>(), shown) << asked;
    const StateMessage state = messenger_.state(me);
    EXPECT_TRUE(state.is_recording);
    EXPECT_EQ(state.time, shown);
    EXPECT_TRUE(
        state.arm.bends[1].isApprox(schedule.state_at(shown).bends[1].cast<float>().cast<double>(), 1e-6) ||
        shown == 0);
  }
}

TEST_F(RecordingSessionTest, LetsEveryClientBeAtATimeOfItsOwn) {
  record();
  open();
  session_->opened(other);
  ask(AtRequest{0.5});
  ask(AtRequest{0.8}, other);
  EXPECT_EQ(messenger_.state(me).time, 0.5);
  EXPECT_EQ(messenger_.state(other).time, 0.8);
  const Eigen::Vector3d tip = messenger_.state(me).samples.back().X_WS.position;
  const Node::Array at = *ask(PointRequest{1}).result.find("position")->as<Node::Array>();
  EXPECT_NEAR(*at[0].as<double>(), tip.x(), 1e-6);
}

TEST_F(RecordingSessionTest, MovesNothing) {
  record();
  open();
  ArmRequest arm;
  arm.bends = {{{0, 0}, {0, 0}}};
  for (const Ask& request : std::vector<Ask>{arm, TipRequest{}, HeadRequest{"front", 0.1, {}, {}},
                                             HaltRequest{}, ResetRequest{}, RunRequest{}})
    EXPECT_THAT(ask(request).error, HasSubstr("this is a recording"));
}

TEST_F(RecordingSessionTest, SaysInWhichConditionTheRunWas) {
  record();
  open();
  const auto condition = [&](double time) {
    ask(AtRequest{time});
    return *messenger_.last(me, "condition").find("condition")->as<std::string>();
  };
  for (const auto& [time, reported] : std::vector<std::pair<double, std::string>>{
           {0, "running"}, {0.5, "running"}, {1, "done"}, {0.9, "running"}})
    EXPECT_EQ(condition(time), reported) << time;
}

// Not the first one before it has come, which is of the future.
TEST_F(RecordingSessionTest, HasNoPictureBeforeTheFirstHasCome) {
  record(replaced(replaced(viewed_text, "bits = 12", "bits = 12, delay = 0.3"), "[arm]",
                  "[record]\ncameras = true\n[arm]"));
  open();
  EXPECT_EQ(ask(ImagesRequest{"side", 60, 80}).error, "");
  auto shown_at = [&, now = 10.0](double time) mutable {
    ask(AtRequest{time});
    session_->advance(++now);
    std::string message = last_image(2);
    std::uint32_t number = 0;
    std::memcpy(&number, message.data() + 4, sizeof(number));
    ask(AckRequest{"side", number});
    return message;
  };
  EXPECT_EQ(shown_at(0).size(), 16) << "a head, and no file";
  EXPECT_THAT(ask(PixelRequest{"side", 3, 2}).error, HasSubstr("has no picture at 0 s"));
  EXPECT_THROW(session_->take(ImageAsk{"side", 0.1}, [](const HttpAnswer&) {}), ViewRefusal);
  double before = -1;
  for (const double time : {0.4, 0.6, 1.0}) {
    const std::string message = shown_at(time);
    EXPECT_GT(message.size(), 100);
    double exposed = 0;
    std::memcpy(&exposed, message.data() + 8, sizeof(exposed));
    EXPECT_GT(exposed, before);
    EXPECT_LE(exposed, time - 0.3);
    before = exposed;
  }
  EXPECT_EQ(shown_at(0.2).size(), 16) << "and none again";
}

TEST_F(RecordingSessionTest, SendsTheImagesOfTheLogAsTheyAre) {
  record(replaced(viewed_text, "[arm]", "[record]\ncameras = true\n[arm]"));
  open();
  EXPECT_EQ(ask(ImagesRequest{"side", 60, 80}).error, "");
  session_->advance(10);
  ASSERT_EQ(messenger_.count(me, 2), 1);
  ask(AckRequest{"side", 0});
  session_->advance(11);
  EXPECT_EQ(messenger_.count(me, 2), 1) << "the same image is not sent again";
  ask(AtRequest{0.5});
  session_->advance(12);
  ASSERT_EQ(messenger_.count(me, 2), 2);
  const std::string message = last_image(2);
  EXPECT_EQ(message.substr(0, 4), std::string("\x02\x01\x01\0", 4)) << "an image of the second camera, PNG";
  const HttpAnswer file = get(ImageAsk{"side", 0.5});
  EXPECT_EQ(message.substr(16), file.body);
  const auto picture = std::get<Image<std::uint16_t>>(read_png(file.body));
  const ViewAnswer pixel = ask(PixelRequest{"side", 30, 20});
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_EQ(*pixel.result.find("value")
                   ->as<Node::Array>()
                   ->at(static_cast<std::size_t>(channel))
                   .as<std::int64_t>(),
              picture.at(30, 20, channel));
  EXPECT_THAT(ask(PixelRequest{"side", 64, 0}).error, HasSubstr("outside the image"));
  EXPECT_NE(get(ImageAsk{"side", {}}).body, file.body) << "without a time the newest";
}

TEST_F(RecordingSessionTest, ShowsTheCommandedArmWhereNothingWasFilmed) {
  record();
  open();
  ask(ImagesRequest{"front", 60, 80});
  session_->advance(10);
  ASSERT_EQ(messenger_.count(me, 1), 1);
  EXPECT_EQ(last_image(1).substr(16, 3), "\xff\xd8\xff");
  EXPECT_THAT(*ask(PixelRequest{"front", 31, 24}).result.find("label")->as<std::string>(),
              HasSubstr("section"));
  EXPECT_EQ(get(ImageAsk{"front", 0.2}).body.substr(1, 3), "PNG");
}

// Head and stage messages as logged by a calibration, in which heads and stages move.
TEST_F(RecordingSessionTest, ShowsCamerasWhereTheLogHasThem) {
  const std::string text =
      replaced(viewed_text, "position = [0, 0.5, 2], look_at = [0, 0.5, 0] }",
               "position = [0, 0.5, 2], look_at = [0, 0.5, 0], stage = { x = { limits = [-0.5, 0.5] } } }");
  experiment_ = parse_experiment(text, "x.toml");
  write_new_file(folder_.path() / experiment_file_name, text);
  {
    const Arm arm = experiment_.arm.arm();
    Recorder recorder(folder_.path() / log_file_name, arm);
    const ArmState straight = ArmState::straight(2);
    for (const double time : {0.0, 1.0, 2.0}) {
      recorder.state(time, straight, Backbone(arm, straight));
      recorder.reading("front", HeadReading{time, {0.1 * time, 0.05, 1}, false});
      recorder.reading("front", StageReading{time, {{0.2 * time, 0, 0}}, true});
    }
    recorder.close();
  }
  open();
  const StateMessage start = messenger_.state(me);
  EXPECT_NEAR(start.cameras[0].head.tilt, 0.05, 1e-6);
  const std::string before = get(ImageAsk{"front", 0.0}).body;
  ask(AtRequest{2});
  const StateMessage end = messenger_.state(me);
  EXPECT_NEAR(end.cameras[0].head.pan, 0.2, 1e-6);
  EXPECT_NEAR(end.cameras[0].stage.x(), 0.4, 1e-6);
  EXPECT_NEAR((end.cameras[0].X_WC.position - start.cameras[0].X_WC.position).norm(), 0.4, 1e-6);
  EXPECT_EQ(end.cameras[1].stage.norm(), 0) << "of which the log says nothing";
  EXPECT_NE(get(ImageAsk{"front", 2.0}).body, before) << "pictures are taken from there";
}

TEST_F(RecordingSessionTest, MeasuresThePicturesOfTheLog) {
  std::string text = viewed_text;
  for (const char* what :
       {"lens = { fx = 80, fy = 80, cx = 31.5, cy = 23.5 }\nsensor = { width = 64, height = 48, ",
        "lens = { fx = 80, fy = 80, cx = 31.5, cy = 23.5 }\nsensor = { width = 64, height = 48, "})
    text = replaced(text, what, "sensor = { ");
  record(text + "[record]\ncameras = true\nevery = 10\n");
  open();
  ask(AtRequest{1});
  const ViewAnswer answer = ask(MeasureRequest{"front", {{"axis"}}});
  ASSERT_EQ(answer.error, "");
  EXPECT_TRUE(*answer.result.find("found")->as<bool>()) << *answer.result.find("reason")->as<std::string>();
  EXPECT_EQ(*answer.result.find("number")->as<std::int64_t>(),
            *ask(PixelRequest{"front", 1, 1}).result.find("number")->as<std::int64_t>());
  const ViewAnswer shape = ask(ShapeRequest{});
  ASSERT_EQ(shape.error, "");
  ASSERT_TRUE(*shape.result.find("found")->as<bool>()) << *shape.result.find("reason")->as<std::string>();
  const Node::Array& tip = *shape.result.find("poses")->as<Node::Array>()->back().as<Node::Array>();
  const Eigen::Vector3d shown = messenger_.state(me).samples.back().X_WS.position;
  for (Eigen::Index i = 0; i < 3; ++i)
    EXPECT_NEAR(*tip[static_cast<std::size_t>(i)].as<double>(), shown[i], 0.03) << "but for the frame's age";
}

TEST_F(RecordingSessionTest, GivesSeriesThatKeepTheirExtremes) {
  record();
  open();
  const HttpAnswer answer = get(SeriesAsk{{"tip_x", "bend_y_2"}, 1000});
  ASSERT_EQ(answer.status, 200) << answer.body;
  const Node series = parse_json(answer.body, "series");
  EXPECT_EQ(series.find("time")->as<Node::Array>()->size(), 51);
  EXPECT_NEAR(*series.find("bend_y_2")->as<Node::Array>()->back().as<double>(), 0.7, 1e-12);
  const Node thin = parse_json(get(SeriesAsk{{"tip_x"}, 10}).body, "series");
  EXPECT_LE(thin.find("time")->as<Node::Array>()->size(), 10);
  EXPECT_EQ(get(SeriesAsk{{"nothing"}, 10}).status, 404);
}

TEST(Series, AreThinnedToTheirEndsAndExtremes) {
  std::vector<double> curve(1000, 0.0), wave(1000);
  curve[333] = 5, curve[777] = -5;
  for (std::size_t i = 0; i < wave.size(); ++i) wave[i] = static_cast<double>(i % 7);
  const std::vector<std::vector<double>> curves{curve, wave};
  const auto kept = thinned(curves, 42);
  EXPECT_LE(kept.size(), 42);
  for (const int place : {0, 333, 777, 999})
    EXPECT_THAT(kept, ::testing::Contains(static_cast<std::size_t>(place)));
  EXPECT_TRUE(std::ranges::is_sorted(kept));
  EXPECT_EQ(thinned(curves, 2), (std::vector<std::size_t>{0, 999}));
  EXPECT_EQ(thinned(curves, 1000).size(), 1000);
  EXPECT_TRUE(thinned(std::vector<std::vector<double>>{}, 10).empty());
}

TEST(Series, KeepWhereACurveBeginsAndEnds) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> curve(1000, nothing);
  for (std::size_t i = 301; i < 500; ++i) curve[i] = -static_cast<double>(i % 50);
  const auto kept = thinned(std::vector<std::vector<double>>{curve}, 20);
  for (const int place : {0, 300, 301, 499, 500, 999})
    EXPECT_THAT(kept, ::testing::Contains(static_cast<std::size_t>(place)));
  EXPECT_EQ(thinned(std::vector<std::vector<double>>{std::vector<double>(1000, nothing)}, 20).size(), 2);
}

TEST_F(RecordingSessionTest, MarksWhatHappenedAndHowLong) {
  record(replaced(viewed_text, "bends = [[0.8, 0.5]", "bends = [[2.5, 0.5]"));
  open();
  const std::vector<Mark> marks = session_->hello().marks;
  const auto unsafe = std::ranges::find_if(marks, [](const Mark& mark) {
    return mark.name == "unsafe" && mark.text.find("section 1: bend ") != std::string::npos;
  });
  ASSERT_NE(unsafe, marks.end());
  EXPECT_EQ(unsafe->level, "error");
  EXPECT_GT(unsafe->end, unsafe->time);
  ask(AtRequest{0});
  EXPECT_FALSE(messenger_.state(me).is_unsafe);
  ask(AtRequest{(unsafe->time + unsafe->end) / 2});
  EXPECT_TRUE(messenger_.state(me).is_unsafe);
}

TEST_F(RecordingSessionTest, GivesTheReportAsAStrangersPage) {
  record();
  open();
  const HttpAnswer report = get(ReportAsk{});
  EXPECT_EQ(report.body, read_text_file(folder_.path() / "report.html", 1 << 26));
  EXPECT_THAT(report.policy, HasSubstr("sandbox allow-scripts;"));
  EXPECT_THAT(report.policy, ::testing::Not(HasSubstr("allow-same-origin")));
  std::filesystem::remove(folder_.path() / "report.html");
  std::filesystem::create_symlink("/etc/hostname", folder_.path() / "report.html");
  EXPECT_EQ(get(ReportAsk{}).status, 404) << "a link out of the folder";
}

TEST_F(RecordingSessionTest, OpensNoFileThatALinkLeadsOutTo) {
  record();
  const TemporaryFolder elsewhere;
  for (const char* name : {log_file_name, experiment_file_name, summary_file_name}) {
    std::filesystem::rename(folder_.path() / name, elsewhere.path() / name);
    std::filesystem::create_symlink(elsewhere.path() / name, folder_.path() / name);
    try {
      open();
      ADD_FAILURE() << name;
    } catch (const InputError& refusal) {
      EXPECT_THAT(refusal.what(), HasSubstr(std::string(name) + "\" is outside"));
    }
    // A link to a file inside the folder counts as part of the folder.
    std::filesystem::remove(folder_.path() / name);
    std::filesystem::rename(elsewhere.path() / name, folder_.path() / "moved");
    std::filesystem::create_symlink("moved", folder_.path() / name);
    EXPECT_NO_THROW(open()) << name;
    std::filesystem::remove(folder_.path() / name);
    std::filesystem::rename(folder_.path() / "moved", folder_.path() / name);
  }
}

// For such a link the system reports neither existence nor absence.
TEST_F(RecordingSessionTest, SaysInOneLineThatAFileIsALinkToItself) {
  record();
  for (const char* name : {log_file_name, experiment_file_name, summary_file_name}) {
    const auto file = folder_.path() / name;
    std::filesystem::rename(file, folder_.path() / "moved");
    std::filesystem::create_symlink(name, file);
    try {
      open();
      ADD_FAILURE() << name;
    } catch (const InputError& refusal) {
      EXPECT_THAT(refusal.what(), HasSubstr("\"" + std::string(name) + "\": Too many levels"));
      EXPECT_THAT(refusal.what(), ::testing::Not(HasSubstr("\n")));
    }
    std::filesystem::rename(folder_.path() / "moved", file);
  }
}

TEST_F(RecordingSessionTest, HasNoReportWhereItIsALinkToItself) {
  record();
  std::filesystem::remove(folder_.path() / report_file_name);
  std::filesystem::create_symlink(report_file_name, folder_.path() / report_file_name);
  open();
  EXPECT_FALSE(session_->hello().report);
  EXPECT_EQ(get(ReportAsk{}).status, 404);
}

// The invalid state has the time of the first, so that clients would start there.
TEST_F(RecordingSessionTest, OpensNoLogWithAStateThatIsNoShape) {
  write_new_file(folder_.path() / experiment_file_name, viewed_text);
  const Arm arm = parse_experiment(viewed_text, "x.toml").arm.arm();
  const ArmState straight = ArmState::straight(2);
  ArmState flat = straight;
  flat.stretches[1] = 0;
  {
    Recorder recorder(folder_.path() / log_file_name, arm);
    for (const ArmState& state : {straight, flat, straight})
      recorder.state(0, state, Backbone(arm, straight));
    recorder.close();
  }
  try {
    open();
    ADD_FAILURE() << "opened";
  } catch (const InputError& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr("state at 0 s does not fit the log's arm"));
  }
}

TEST_F(RecordingSessionTest, OpensTheLogOfAKilledRun) {
  record(replaced(viewed_text, "duration = 1", "duration = 30"));
  const auto log = folder_.path() / log_file_name;
  std::filesystem::resize_file(log, std::filesystem::file_size(log) * 3 / 4);
  std::filesystem::remove(folder_.path() / summary_file_name);
  open();
  const Hello hello = session_->hello();
  EXPECT_LT(hello.duration, 30);
  EXPECT_GT(hello.duration, 1);
  EXPECT_EQ(hello.marks.back().name, "log");
  EXPECT_EQ(*ask(AtRequest{1e9}).result.find("time")->as<double>(), hello.duration);
}

// The summary was cut short by a full disk, or edited.
TEST_F(RecordingSessionTest, OpensTheLogBesideADamagedSummary) {
  record();
  const auto summary = folder_.path() / summary_file_name;
  std::filesystem::resize_file(summary, std::filesystem::file_size(summary) / 2);
  open();
  const Hello hello = session_->hello();
  EXPECT_EQ(hello.duration, 1);
  EXPECT_EQ(hello.marks.back().name, "summary");
  EXPECT_EQ(hello.marks.back().level, "warning");
  EXPECT_THAT(hello.marks.back().text, HasSubstr("summary.json:"));
  EXPECT_THAT(hello.marks.back().text, HasSubstr("not JSON"));
}

TEST_F(RecordingSessionTest, RefusesWhatIsNoRecording) {
  const auto error = [&] {
    try {
      const Recording recording(folder_.path());
    } catch (const InputError& bad) {
      return std::string(bad.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(error(), HasSubstr("has no experiment.toml"));
  std::ofstream(folder_.path() / experiment_file_name) << viewed_text;
  EXPECT_THAT(error(), HasSubstr("has no log.mcap"));
  std::ofstream(folder_.path() / log_file_name) << "";
  EXPECT_THAT(error(), HasSubstr("has no messages"));
  std::ofstream(folder_.path() / log_file_name) << "this is no log at all, is it";
  EXPECT_NE(error(), "no error");
}

}  // namespace
}  // namespace flexura

// Tests the input of `measure`: files, options, several pictures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "flexura/app/commands.h"
#include "flexura/app/measure.h"
#include "flexura/base/source.h"
#include "flexura/picture/image_file.h"
#include "flexura/store/text_file.h"
#include "flexura/vision/picture_file.h"
#include "tests/support/measured_pictures.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

using testing::HasSubstr;

TEST(Measure, RefusesWhatCountsForNothing) {
  MeasureArguments arguments;
  arguments.images = {"x.png"};
  const auto refusal = [&] {
    std::ostringstream out;
    try {
      (void)measure_command(arguments, out);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const char* what : {"circle", "etalon"}) {
    arguments.what = what;
    arguments.base = {1, 2};
    EXPECT_THAT(refusal(), HasSubstr("--base: has no effect with --what"));
    arguments.base.clear(), arguments.camera = "x.toml";
    EXPECT_THAT(refusal(), HasSubstr("--camera: has no effect with --what"));
    arguments.camera.clear();
  }
  arguments.what = "arm";
  for (const double aside : {1e6, -1e300, std::nan("")}) {
    arguments.base = {100, aside};
    EXPECT_THAT(refusal(), HasSubstr("--base: expected two numbers u,v within 100000 px"));
  }
  arguments.base.clear(), arguments.camera = "x.toml";
  for (const double radius : {0.0, -1.0, 1e-300, 1e300, std::nan("")}) {
    arguments.radius = radius;
    EXPECT_THAT(refusal(), HasSubstr("expected a number from 1e-06 to 1000")) << radius;
  }
}

TEST(Measure, CountsCamerasAndPicturesInGoodWords) {
  const TemporaryFolder folder;
  MeasureArguments arguments;
  arguments.images = {"x.png"};
  arguments.camera = (folder.path() / "two.toml").string();
  write_new_file(arguments.camera,
                 "[[camera]]\nfx = 1\ncx = 0\ncy = 0\n[[camera]]\nfx = 1\ncx = 0\ncy = 0\n");
  std::ostringstream out;
  try {
    (void)measure_command(arguments, out);
    ADD_FAILURE() << "measured";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("camera: 2 for 1 picture: expected one"));
  }
}

TEST(Measure, DoesNotDrawOverThePictureThatItMeasures) {
  const TemporaryFolder folder;
  MeasureArguments arguments;
  arguments.images = {(folder.path() / "tube.png").string()};
  write_new_file(arguments.images.front(), png(tube()));
  const std::string before = read_text_file(arguments.images.front(), most_picture_bytes);
  std::ostringstream out;
  arguments.overlay = (folder.path() / "." / "tube.png").string();
  EXPECT_THROW((void)measure_command(arguments, out), InputError);
  EXPECT_EQ(read_text_file(arguments.images.front(), most_picture_bytes), before);
  arguments.overlay = (folder.path() / "over.png").string();
  EXPECT_EQ(measure_command(arguments, out), exit_done);
}

TEST(Measure, RefusesWhatIsNoPictureInOneLine) {
  const std::string whole = png(tube());
  for (const std::string& file :
       {std::string(), std::string("GIF"), whole.substr(0, 60), std::string("P5\n100000 100000\n255\n"),
        std::string("P6\n30 30\n255\nabcdef"),
        // A JPEG file's header that claims 30000 x 30000 px.
        std::string("\xFF\xD8\xFF\xC0\x00\x0B\x08\x75\x30\x75\x30\x01\x01\x11\x00\xFF\xDA\x00\x08", 19)}) {
    try {
      (void)measured(file);
      FAIL() << file.size();
    } catch (const InputError& error) {
      EXPECT_THAT(std::string(error.what()), HasSubstr("test.png"));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

TEST(Measure, AnswersSeveralPicturesInLinesAndTellsTheWorstByItsStatus) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& name, const std::string& bytes) {
    write_new_file(folder.path() / name, bytes);
    return (folder.path() / name).string();
  };
  const std::string good = write("good.png", png(tube())), bad = write("bad.png", "no picture");
  const std::string blank = write("blank.png", png(Image<std::uint8_t>(30, 20, 1, 90)));
  const auto status = [](const std::vector<std::string>& images, std::string& text) {
    MeasureArguments arguments;
    arguments.images = images;
    std::ostringstream out;
    const int result = measure_command(arguments, out);
    text = out.str();
    return result;
  };
  std::string text;
  EXPECT_EQ(status({good, good}, text), exit_done);
  EXPECT_EQ(std::ranges::count(text, '\n'), 2);
  EXPECT_EQ(text.substr(0, text.find('\n')), text.substr(text.find('\n') + 1, text.size() / 2 - 1));
  EXPECT_EQ(status({good, blank}, text), exit_missed);
  EXPECT_EQ(status({bad, good, blank}, text), exit_bad_input);
  EXPECT_THAT(text, HasSubstr("\"error\":\"not a picture"));
  EXPECT_EQ(status({blank}, text), exit_missed);
  EXPECT_THROW((void)status({bad}, text), InputError);
}

TEST(Measure, ReadsAPlainKindOfFileAndNamesWhatItDoesNotRead) {
  const TemporaryFolder folder;
  const Image<std::uint8_t> image = tube();
  std::string pnm = (image.channels() == 1 ? "P5 " : "P6 ") + std::to_string(image.width()) + " " +
                    std::to_string(image.height()) + " 255\n";
  for (const std::uint8_t value : image.values()) pnm += static_cast<char>(value);
  const auto line_of = [&](const std::string& name, const std::string& bytes) {
    write_new_file(folder.path() / name, bytes);
    MeasureArguments arguments;
    arguments.images = {(folder.path() / name).string(), (folder.path() / name).string()};
    std::ostringstream out;
    (void)measure_command(arguments, out);
    const std::string line = out.str().substr(0, out.str().find('\n'));
    return line.substr(line.find(',') + 1);  // After the file's name.
  };
  EXPECT_EQ(line_of("tube.pnm", pnm), line_of("tube.png", png(image)));
  EXPECT_EQ(line_of("depth.pfm", "Pf\n1 1\n-1\n0000"),
            "\"error\":\"PFM files are not read: expected PNG, JPEG, TIFF or PNM\"}");
}

}  // namespace
}  // namespace flexura

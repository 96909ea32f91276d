#include "flexura/log/export_png.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/run.h"
#include "flexura/log/messages.h"
#include "flexura/log/results.h"
#include "flexura/log/results_log.h"
#include "flexura/picture/image_file.h"
#include "flexura/store/json.h"
#include "flexura/store/text_file.h"
#include "tests/support/quiet.h"
#include "tests/support/temporary_folder.h"

namespace flexura {
namespace {

constexpr const char* filmed_arm = R"(
[record]
cameras = true
report = false
[arm]
[[arm.section]]
length = 1
[[camera]]
name = "one"
mount = { position = [0, 0.5, 3], look_at = [0, 0.5, 0] }
sensor = { width = 40, height = 30, frame_rate = 7 }
[[task]]
kind = "move"
to = { archings = [0.5] }
duration = 1
[[task]]
kind = "hold"
duration = 70
)";

struct PngChunk {
  std::string type, data;
};

std::uint32_t number_at(const std::string& bytes, std::size_t at, std::size_t count = 4) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

// All chunks of a PNG file; expects that each has the right checksum and that nothing is left over.
std::vector<PngChunk> chunks_of(const std::string& png) {
  std::vector<PngChunk> chunks;
  std::size_t at = 8;
  while (at + 12 <= png.size()) {
    const std::size_t length = number_at(png, at);
    const std::string checked = png.substr(at + 4, 4 + length);
    const auto sum =
        crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
    EXPECT_EQ(number_at(png, at + 8 + length), sum) << checked.substr(0, 4);
    chunks.push_back({checked.substr(0, 4), checked.substr(4)});
    at += 12 + length;
  }
  EXPECT_EQ(at, png.size());
  return chunks;
}

// The compressed pixels of each picture, and its delay in ms. Expects sequence numbers without a gap.
struct FilmFrame {
  std::string pixels;
  std::uint32_t delay = 0;
};

std::vector<FilmFrame> frames_of(const std::vector<PngChunk>& chunks) {
  std::vector<FilmFrame> frames;
  std::uint32_t sequence = 0;
  for (const PngChunk& chunk : chunks) {
    if (chunk.type == "fcTL") {
      EXPECT_EQ(number_at(chunk.data, 0), sequence++);
      EXPECT_EQ(number_at(chunk.data, 22, 2), 1000U);
      frames.push_back({"", number_at(chunk.data, 20, 2)});
    } else if (chunk.type == "fdAT") {
      EXPECT_EQ(number_at(chunk.data, 0), sequence++);
      frames.back().pixels += chunk.data.substr(4);
    } else if (chunk.type == "IDAT") {
      frames.back().pixels += chunk.data;
    }
  }
  return frames;
}

class ExportPng : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(results());
    Quiet progress;
    (void)run_experiment(parse_experiment(filmed_arm, "x.toml"), results(), progress);
  }
  [[nodiscard]] std::string exported() const {
    const auto cameras = load_experiment(results() / experiment_file_name).true_rig().cameras;
    return read_text_file(export_png(results(), cameras).folder / "one.png", 1 << 24);
  }
  [[nodiscard]] std::filesystem::path results() const { return folder_.path() / "run"; }
  TemporaryFolder folder_;
};

TEST_F(ExportPng, HasEachImageOfTheLogForItsTime) {
  const std::vector<PngChunk> chunks = chunks_of(exported());
  ASSERT_GE(chunks.size(), 5U);
  EXPECT_EQ(chunks.front().type, "IHDR");
  EXPECT_EQ(number_at(chunks.front().data, 0), 40U);
  EXPECT_EQ(number_at(chunks.front().data, 4), 30U);
  ASSERT_EQ(chunks[1].type, "acTL");
  EXPECT_EQ(chunks.back().type, "IEND");
  const std::vector<FilmFrame> frames = frames_of(chunks);
  EXPECT_EQ(number_at(chunks[1].data, 0), frames.size());
  EXPECT_EQ(number_at(chunks[1].data, 4), 0U) << "repeats for ever";

  // What the camera saw, without repetitions.
  std::vector<std::string> images;
  const McapReader log = open_log(results());
  for (const McapMessage& message : log.messages()) {
    if (message.channel->topic != image_topic("one")) continue;
    const std::string png = read_as<ImageMessage>(parse_json(message.text(), "image")).data.data;
    std::string pixels;
    for (const PngChunk& chunk : chunks_of(png))
      if (chunk.type == "IDAT") pixels += chunk.data;
    if (images.empty() || images.back() != pixels) images.push_back(pixels);
  }
  EXPECT_GE(images.size(), 5U) << "the arm moves";
  std::uint32_t time = 0;
  std::size_t image = 0;
  for (const FilmFrame& frame : frames) {
    time += frame.delay;
    if (frame.pixels != images[image]) ++image;
    ASSERT_LT(image, images.size());
    EXPECT_EQ(frame.pixels, images[image]);
  }
  EXPECT_EQ(image + 1, images.size());
  // 71 s at 7 frames a second, the last one included. What lasts longer than 65.535 s has two parts.
  EXPECT_NEAR(time, 1000.0 * (71 * 7 + 1) / 7, 1);
  EXPECT_EQ(frames.size(), images.size() + 1);
}

TEST(FilmedLog, IsSmallerThanItsPictures) {
  std::string text = filmed_arm;
  text.replace(text.find("width = 40, height = 30, frame_rate = 7"), 39, "frame_rate = 20");
  text.replace(text.find("duration = 70"), 13, "duration = 1");
  const TemporaryFolder folder;
  Quiet progress;
  (void)run_experiment(parse_experiment(text, "x.toml"), folder.path(), progress);
  // 41 pictures of 640 x 480 pixels.
  EXPECT_LT(std::filesystem::file_size(folder.path() / log_file_name), 41U * 640 * 480 / 10);
}

TEST_F(ExportPng, IsTheSameEachTimeAndAPictureForAll) {
  const std::string film = exported();
  EXPECT_EQ(film, exported());
  const McapReader log = open_log(results());
  for (const McapMessage& message : log.messages()) {
    if (message.channel->topic != image_topic("one")) continue;
    const std::string png = read_as<ImageMessage>(parse_json(message.text(), "image")).data.data;
    EXPECT_EQ(read_png(film), read_png(png)) << "the first picture";
    break;
  }
}

}  // namespace
}  // namespace flexura

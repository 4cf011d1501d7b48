// SPDX-License-Identifier: MIT
// Damaged pictures, recorded settings and device profiles, and wild command lines: each is taken, or refused in one
// sentence.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "../tools/temporary_folder.h"
#include "device/device_impl.h"
#include "tools/image/image_reader.h"
#include "tools/record/recorded_settings.h"
#include "tools/sequence/resolve_task.h"
#include "wild.h"

namespace quincunx::testing {
namespace {

void write(const std::string& path, const std::string& bytes) {
  std::filesystem::remove(path);  // overwriting in place makes some file systems wait for the disk
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(FileFuzz, Pictures) {
  const TemporaryFolder folder;
  std::vector<float> rgba;
  for (int i = 0; i < 24 * 20 * 4; ++i)
    rgba.push_back(static_cast<float>(i * 7919 % 251) / 251);
  Random random(21);
  for (const tools::backend::Ending& ending : tools::backend::written_endings()) {
    const std::string path = folder.file("a" + std::string(ending.text));
    ASSERT_TRUE(tools::write_light(path, {24, 20}, rgba, tools::ChannelType::kHalf, {}, {}).ok());
    const std::string good = read_file(path);
    for (int round = 0; round < rounds() / 100; ++round) {
      SCOPED_TRACE(round);
      write(path, damaged(good, random));
      expect_sentence(tools::check_whole(path));
      const auto reader = tools::ImageReader::open(path);
      expect_sentence(reader.status());
      if (!reader.ok() || reader->header().parts.front().display.extent.area() > 1'000'000) continue;
      expect_sentence(tools::read_image(path).status());
    }
  }
}

TEST(FileFuzz, RecordedSettings) {
  const TemporaryFolder folder;
  const std::string path = folder.file(tools::kSettingsFile),
                    good = tools::to_json(tools::RecordedSettings{});
  std::string ended = good;  // a name in which a line ends
  write(path, ended.replace(ended.find("grain"), 5, "gr\\nain"));
  EXPECT_NE(tools::read_settings(folder.file("")).error().find("'filter.gr\\nain'"), std::string::npos);
  Random random(22);
  int taken = 0;
  for (int round = 0; round < rounds(); ++round) {
    SCOPED_TRACE(round);
    write(path, damaged(good, random));
    const auto read = tools::read_settings(folder.file(""));
    expect_sentence(read.status());
    taken += read.ok() ? 1 : 0;
  }
  EXPECT_LT(taken, rounds());
}

TEST(FileFuzz, Profiles) {
  const std::string good = profile_text({{"platform", "device", "cpu", "driver"}, {}});
  ASSERT_TRUE(parse_profile(good).ok());
  Random random(23);
  for (int round = 0; round < rounds(); ++round) {
    SCOPED_TRACE(round);
    expect_sentence(parse_profile(damaged(good, random)).status());
  }
}

TEST(FileFuzz, CommandLines) {
  const std::vector<std::string> words = {
      "f.%04d.exr", "--out",      "u.%04d.exr", "--output",         "128x72", "--frames",
      "1-10x2,20",  "--method",   "temporal",   "--noise",          "auto",   "--blur",
      "0.5",        "--velocity", "a.X,a.Y",    "--velocity-scale", "1,-1",   "--memory",
      "4GB",        "--cuts",     "25,80",      "--sharpen",        "-n",     "--json"};
  Random random(24);
  int taken = 0;
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  for (int round = 0; round < rounds(); ++round) {
    std::vector<std::string> line = {"quincunx-resolve", "--list-devices"};  // which writes nothing
    for (int i = 0, count = random.below(8); i < count; ++i) {
      const std::string& word = words[static_cast<std::size_t>(random.below(static_cast<int>(words.size())))];
      line.push_back(random.below(3) == 0 ? damaged(word, random) : word);
    }
    std::vector<const char*> arguments;
    for (const std::string& word : line)
      arguments.push_back(word.c_str());
    tools::ResolveOptions options;
    const auto code = command_line(options).parse(static_cast<int>(arguments.size()), arguments.data());
    EXPECT_TRUE(!code || *code == 0 || *code == 2) << round;
    taken += code ? 0 : 1;
  }
  ::testing::internal::GetCapturedStdout();
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_GT(taken, 0);
  EXPECT_LE(std::count(said.begin(), said.end(), '\n'), 2 * (rounds() - taken));
}

}  // namespace
}  // namespace quincunx::testing

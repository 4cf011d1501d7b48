// SPDX-License-Identifier: MIT
// Killed at any moment, a run leaves only whole files, and --resume makes the rest as if nothing had
// happened.
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "sequence_fixture.h"
#include "tools/sequence/sequence_output.h"

extern char** environ;

namespace quincunx {
namespace {

constexpr int kFrames = 14;

class Resume : public testing::SequenceTest {
 protected:
  // Large enough that a file takes longer to write than to notice.
  void write_large_frames() {
    for (int number = 1; number <= kFrames; ++number) {
      testing::FrameFile file = frame(number);
      file.extent = {320, 180};
      file.attributes[1] = {"quincunx:outputSize", Vec2{1280, 720}};
      write_frame(input(number), file);
    }
  }

  std::filesystem::path results() const { return folder_.file("r"); }

  // Files of the results by how their names end.
  int count(const std::string& ending) const {
    int found = 0;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(results(), error), end; !error && entry != end;
         entry.increment(error)) {
      found += entry->path().string().ends_with(ending) ? 1 : 0;
    }
    return found;
  }

  // Starts a run and kills it as soon as `now` says so. True: it was killed; false: it ended before.
  bool run_and_kill(int signal, const std::function<bool()>& now) {
    const std::string in = folder_.file("f.%04d.exr");
    const std::string out = (results() / "u.%04d.exr").string();
    const char* arguments[] = {QUINCUNX_PROGRAM, in.c_str(), "--out", out.c_str(), "--resume", "-q", nullptr};
    pid_t process = 0;
    EXPECT_EQ(
        ::posix_spawn(&process, QUINCUNX_PROGRAM, nullptr, nullptr, const_cast<char**>(arguments), environ),
        0);
    int status = 0;
    while (::waitpid(process, &status, WNOHANG) == 0) {
      if (now()) {
        ::kill(process, signal);
        ::waitpid(process, &status, 0);
        return WIFSIGNALED(status) || WEXITSTATUS(status) != 0;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }

  void expect_whole_files() {
    for (int number = 1; number <= kFrames; ++number) {
      const std::string path = (results() / fmt::format("u.{:04}.exr", number)).string();
      if (!std::filesystem::exists(path)) continue;
      EXPECT_EQ(testing::read_file(path), testing::read_file(output(number))) << path;
    }
  }
};

TEST_F(Resume, KilledAnywhereItGoesOnAsIfNothingHadHappened) {
  write_large_frames();
  resolve_to("u", "");
  for (const int done : {0, 1, 4, 8}) {
    // In the middle of writing a file, once so many are there.
    run_and_kill(SIGKILL, [&] { return count(".exr") >= done && count(".part") > 0; });
    expect_whole_files();
  }
  const int there = count(".exr");
  EXPECT_GT(there, 0);
  EXPECT_LT(there, kFrames) << "the run was never killed";
  const auto last = resolve("'{}/f.%04d.exr' --out '{}/r/u.%04d.exr' --resume --json");
  ASSERT_EQ(last.exit_code, 0) << last.err;
  EXPECT_EQ(count(".exr"), kFrames);
  EXPECT_EQ(count(".part"), 0) << "what the killed runs left behind";
  expect_whole_files();
}

TEST_F(Resume, StoppedBySignalItEndsCleanly) {
  write_large_frames();
  resolve_to("u", "");
  ASSERT_TRUE(run_and_kill(SIGTERM, [&] { return count(".exr") >= 2; }));
  EXPECT_EQ(count(".part"), 0);
  EXPECT_LT(count(".exr"), kFrames);
  expect_whole_files();
}

TEST_F(Resume, WhatIsThereIsLeftAlone) {
  write_frames(1, 6);
  resolve_to("u", "");
  for (const int number : {2, 5})
    std::filesystem::remove(output(number));
  const auto before = std::filesystem::last_write_time(output(3));
  const std::string third = testing::read_file(output(3));
  resolve_to("again", "");
  resolve_to("u", "--resume");
  for (int number = 1; number <= 6; ++number)
    EXPECT_EQ(testing::read_file(output(number)), testing::read_file(output(number, "again"))) << number;
  EXPECT_EQ(std::filesystem::last_write_time(output(3)), before);
  const auto nothing = resolve("'{}/f.%04d.exr' --out '{}/u.%04d.exr' --resume");
  EXPECT_EQ(nothing.exit_code, 0);
  EXPECT_NE(nothing.err.find("nothing to do"), std::string::npos) << nothing.err;
}

// A run without history at its start is continued as such.
TEST_F(Resume, ColdRunsStayCold) {
  write_frames(1, 6);
  resolve_to("u", "--frames 3-6 --warm-up 0");
  resolve_to("part", "--frames 3-6 --warm-up 0");
  for (const int number : {3, 5})
    std::filesystem::remove(output(number, "part"));
  resolve_to("part", "--frames 3-6 --warm-up 0 --resume");
  for (int number = 3; number <= 6; ++number)
    EXPECT_EQ(testing::read_file(output(number)), testing::read_file(output(number, "part"))) << number;
}

// But a run with history does not take over what was begun without.
TEST_F(Resume, ColdChunksAreMadeAgain) {
  write_frames(1, 4);
  resolve_to("u", "");
  resolve_to("mixed", "--frames 3-4 --warm-up 0");
  resolve_to("mixed", "--resume");
  for (int number = 1; number <= 4; ++number)
    EXPECT_EQ(testing::read_file(output(number)), testing::read_file(output(number, "mixed"))) << number;
}

TEST_F(Resume, WhatWasMadeOtherwiseIsMadeAgain) {
  write_frames(1, 4);
  resolve_to("u", "");
  resolve_to("mixed", "--method bilinear --frames 1-2");
  const auto result = resolve("'{}/f.%04d.exr' --out '{}/mixed.%04d.exr' --resume");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("2 frames are there, but not whole or made otherwise; they are made again: 1-2"),
            std::string::npos)
      << result.err;
  for (int number = 1; number <= 4; ++number)
    EXPECT_EQ(testing::read_file(output(number)), testing::read_file(output(number, "mixed"))) << number;
}

TEST_F(Resume, AnotherShutterIsAnotherPicture) {
  for (int number = 1; number <= 2; ++number) {
    testing::FrameFile file = frame(number);
    file.depth = true;
    write_frame(input(number), file);
  }
  resolve_to("u", "--blur 1");
  resolve_to("mixed", "--blur 0.5");
  const auto result = resolve("'{}/f.%04d.exr' --out '{}/mixed.%04d.exr' --resume --blur 1");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (int number = 1; number <= 2; ++number)
    EXPECT_EQ(testing::read_file(output(number)), testing::read_file(output(number, "mixed"))) << number;
}

// Cut anywhere, or filled up with zeros as a copy is that was broken off.
TEST_F(Resume, WhatIsNotWholeIsNotTakenForDone) {
  constexpr Extent kSize = {40, 36};
  std::vector<float> picture;
  for (int i = 0; i < kSize.area() * 4; ++i)
    picture.push_back(static_cast<float>(i / 16 % 13 + 1) / 16);
  for (const char* ending : {"exr", "png", "tif", "jpg", "hdr"}) {
    const std::string name = folder_.file(std::string("p.%04d.") + ending);
    if (!tools::format_of(name)) continue;  // a build that knows fewer formats
    const tools::SequenceOutput output = {
        .pattern = tools::FramePattern::parse(name, "output").value(), .extent = kSize, .settings = "some"};
    ASSERT_TRUE(output.write_linear(1, picture, 1, {}).ok()) << ending;
    EXPECT_EQ(output.made(1), tools::Made::kAsWanted) << ending;
    const std::string path = output.path(1), whole = testing::read_file(path);
    const std::size_t step = std::max<std::size_t>(whole.size() / 61, 1);
    for (std::size_t size = 0; size < whole.size(); size += step) {
      std::string bytes = whole.substr(0, size);
      std::ofstream(path, std::ios::binary) << bytes;
      EXPECT_EQ(output.made(1), tools::Made::kOtherwise) << ending << " of " << size;
      bytes.resize(whole.size());
      std::ofstream(path, std::ios::binary) << bytes;
      EXPECT_EQ(output.made(1), tools::Made::kOtherwise) << ending << " with zeros from " << size;
    }
  }
}

TEST_F(Resume, WhatIsBrokenIsMadeAgain) {
  write_frames(1, 3);
  for (const char* ending : {"exr", "png"}) {
    const auto run = [&](const char* more) {
      return resolve(fmt::format("'{{}}/f.%04d.exr' --out '{{}}/u.%04d.{}' {}", ending, more));
    };
    ASSERT_EQ(run("").exit_code, 0);
    std::vector<std::string> paths, good;
    for (int number = 1; number <= 3; ++number) {
      paths.push_back(folder_.file(fmt::format("u.{:04}.{}", number, ending)));
      good.push_back(testing::read_file(paths.back()));
    }
    std::filesystem::resize_file(paths[1], 0);
    std::filesystem::resize_file(paths[2], good[2].size() * 2 / 3);
    std::filesystem::resize_file(paths[2], good[2].size());
    const auto result = run("--resume");
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("not whole or made otherwise; they are made again: 2-3"), std::string::npos)
        << result.err;
    for (std::size_t i = 0; i < paths.size(); ++i)
      EXPECT_EQ(testing::read_file(paths[i]), good[i]) << paths[i];
  }
}

class LongHistory : public Resume {
 protected:
  static constexpr int kLast = 60;  // more than a chunk looks back

  void SetUp() override {
    for (int number = 1; number <= kLast; ++number) {
      testing::FrameFile file = frame(number);
      file.depth = true;
      file.sky = true;  // at rest: history counts for long
      write_frame(input(number), file);
    }
  }

  // The warning of a run that is asked for with --json.
  std::string warnings(const std::string& arguments) {
    const auto result = resolve("'{}/f.%04d.exr' --method temporal:fast --json " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out)["warnings"].dump();
  }
};

// What it advises gives the pixels of a run in one go.
TEST_F(LongHistory, AChunkSaysWhatItKnowsLess) {
  EXPECT_EQ(warnings("--out '{}/u.%04d.exr'").find("history of"), std::string::npos);
  const std::string chunk = "--frames 58-60 --out '{}/c.%04d.exr' ";
  EXPECT_NE(warnings(chunk).find("frame 58 has a history of 48 frames, and in a run in one go of 57"),
            std::string::npos);
  EXPECT_NE(testing::read_file(output(58)), testing::read_file(output(58, "c")));
  EXPECT_EQ(warnings(chunk + "--warm-up 57").find("history of"), std::string::npos);
  for (int number = 58; number <= kLast; ++number)
    EXPECT_EQ(testing::read_file(output(number)), testing::read_file(output(number, "c"))) << number;
  // And the rest of a run, between frames that are there.
  for (const int number : {3, 59})
    std::filesystem::remove(output(number));
  const std::string resume = "--out '{}/u.%04d.exr' --resume ";
  EXPECT_NE(warnings(resume + "-n").find("frame 59 has a history of 48 frames"), std::string::npos);
  EXPECT_EQ(warnings(resume + "--warm-up 58").find("history of"), std::string::npos);
  EXPECT_EQ(testing::read_file(output(59)), testing::read_file(output(59, "c")));
}

TEST_F(LongHistory, ChunksAgreeOnTheirNoise) {
  const std::string chunk =
      "'{}/f.%04d.exr' --out '{}/u.%04d.exr' --method temporal:fast --noise auto --frames 30-31";
  EXPECT_EQ(resolve(chunk).exit_code, 0);
  std::filesystem::remove(output(30));
  std::filesystem::remove(output(31));
  std::filesystem::rename(input(33), folder_.file("not yet"));  // it is still being rendered
  expect_refused(chunk, 1, "--noise auto with --frames needs the first 33 files of the sequence");
  std::ofstream(input(33)) << testing::read_file(folder_.file("not yet")).substr(0, 1000);
  expect_refused(chunk, 1, "or say --noise SPP");
}

TEST_F(LongHistory, ASeamBesideAnotherChunkIsNamed) {
  resolve_to("u", "--method temporal:fast --frames 1-4 --noise 4");
  const std::string next = "--out '{}/u.%04d.exr' -n --frames 5-8 ";
  EXPECT_NE(
      warnings(next).find("u.0004.exr', beside the frames of this run, was made otherwise: 'denoised 0.25' "
                          "there, 'nothing' here"),
      std::string::npos)
      << warnings(next);
  EXPECT_EQ(warnings(next + "--noise 4").find("beside"), std::string::npos);
}

TEST_F(Resume, LeftoversOfLivingProcessesStay) {
  write_frames(1, 2);
  const std::string mine = folder_.file(fmt::format(".u.0001.exr.{}-0.part", ::getpid()));
  const std::string other = folder_.file(".u.0009.exr.999999999-0.part");  // not of this run
  const std::string dead = folder_.file(".u.0002.exr.999999999-0.part");
  for (const std::string& path : {mine, other, dead})
    std::ofstream(path) << "part";
  const int lock = ::open(mine.c_str(), O_WRONLY | O_CLOEXEC);  // as one who writes it has
  ASSERT_EQ(::flock(lock, LOCK_EX | LOCK_NB), 0);
  resolve_to("u", "");
  ::close(lock);
  EXPECT_TRUE(std::filesystem::exists(mine));
  EXPECT_TRUE(std::filesystem::exists(other));
  EXPECT_FALSE(std::filesystem::exists(dead));
}

}  // namespace
}  // namespace quincunx

// SPDX-License-Identifier: MIT
// Errors of a sequence or a command line: one clear sentence, an exit code, nothing half-written.
#include <sys/stat.h>

#include <fstream>

#include "sequence_fixture.h"
#include "skip.h"
#include "tools/exr_files.h"

namespace quincunx {
namespace {

const std::string kRun = "'{}/f.%04d.exr' --out '{}/o/u.%04d.exr' ";

// Bytes of a file whose header is good and whose pixels are not.
std::string with_bad_pixels(std::string bytes) {
  return bytes.replace(bytes.size() * 2 / 3, 64, 64, '\x55');
}

class Refusal : public testing::SequenceTest {
 protected:
  static void write_bytes(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
  }
};

TEST_F(Refusal, HelpVersionAndDevices) {
  const auto help = resolve("--help-all");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* part : {"Examples:",        "--out",      "--output",
                           "--method",         "--velocity", "--velocity-convention",
                           "--velocity-scale", "--depth",    "--depth-kind",
                           "--reactive",       "--jitter",   "--frames",
                           "--warm-up",        "--resume",   "--skip-bad-frames",
                           "--dry-run",        "--threads",  "--device",
                           "--list-devices",   "--tone-map", "--exposure",
                           "--json",           "--report",   "--quiet",
                           "--verbose",        "--truth",    "--explain"}) {
    EXPECT_NE(help.out.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(resolve("--version").out.rfind("quincunx-resolve ", 0), 0u);
  EXPECT_NE(resolve("--list-devices").out.find("OpenCL 0"), std::string::npos);
}

TEST_F(Refusal, WrongUsage) {
  write_frames(1, 2);
  expect_refused("", 2, "INPUT");
  expect_refused("'{}/f.%04d.exr'", 2, "--out");
  expect_refused(kRun + "--no-such-option", 2, "--no-such-option");
  expect_refused(kRun + "--output 640", 2, "WIDTHxHEIGHT");
  expect_refused(kRun + "--output 32769x1", 2, "--output: '32769x1' is too large; both sides must lie in");
  expect_refused(kRun + "--method magic", 2, "'magic' is none of");
  for (const char* amount : {"-0.1", "1.1", "nan", "much"})
    expect_refused(kRun + "--sharpen " + amount, 2, "--sharpen");
  expect_refused(kRun + "--frames 5-1", 2, "'5-1'");
  expect_refused(kRun + "--frames 1-x", 2, "'1-x'");
  expect_refused(kRun + "--velocity u", 2, "'u'");
  expect_refused(kRun + "--velocity u,v,w", 2, "'u,v,w'");
  expect_refused(kRun + "--velocity u,v", 2, "--velocity-convention");
  expect_refused(kRun + "--velocity-convention maya", 2, "'maya' is none of blender, fsr2, ndc, nuke");
  expect_refused(kRun + "--velocity-scale 1", 2, "--velocity-scale");
  expect_refused(kRun + "--velocity-scale 1,a", 2, "'a' is no number");
  expect_refused(kRun + "--velocity-scale 1,1 --velocity-convention nuke", 2, "--velocity-");
  expect_refused(kRun + "--velocity-scale 0,0", 2, "leaves no motion");
  expect_refused(kRun + "--velocity none --velocity-convention nuke", 2, "it does nothing here");
  expect_refused(kRun + "--depth none --near 1", 2, "it does nothing here");
  expect_refused(kRun + "--exposure 1e7", 2, "--exposure: '1e7' is no number");
  expect_refused(kRun + "--near 1e38", 2, "--near: '1e38' is no number from");
  expect_refused(kRun + "--noise auto --method bilinear", 2, "it goes with --method temporal");
  expect_refused(kRun + "--cuts 900", 2, "--cuts: there is no frame 900; the frames are 1 to 2");
  expect_refused(kRun + "--jitter haltom", 2, "did you mean 'halton'?");
  expect_refused(kRun + "--depth-kind z", 2, "'z' is none of device, device-reversed, linear");
  expect_refused(kRun + "--warm-up -1", 2, "--warm-up");
  expect_refused(kRun + "--threads 0", 2, "--threads");
  expect_refused(kRun + "--jitter zigzag", 2, "'zigzag' is neither");
  expect_refused(kRun + "--store double", 2, "'double' is none of");
  expect_refused(kRun + "--device none-such", 2, "none-such");
}

// Later frames of the shot may not be rendered yet.
TEST_F(Refusal, AChunkMayNameCutsBeyondIt) {
  write_frames(1, 2);
  const auto run = resolve(kRun + "--frames 1-2 --cuts 900 --method bilinear");
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

TEST_F(Refusal, PatternsThatCannotWork) {
  write_frames(1, 2);
  expect_refused("'{}/f.exr' --out '{}/u.%04d.exr'", 2, "has no frame number");
  expect_refused("'{}/f.%04d.png' --out '{}/u.%04d.exr'", 1, "no file is named");
  expect_refused("'{}/f.%s.exr' --out '{}/u.%04d.exr'", 2, "input pattern");
  expect_refused("'{}/f.%04d.exr' --out '{}/u.exr'", 2, "has no frame number");
  expect_refused("'{}/f.%04d.exr' --out '{}/u.%04d.gif'", 2, "'.gif'; it must end in .exr");
  expect_refused(kRun + "--truth '{}/t.exr'", 2, "truth pattern");
}

TEST_F(Refusal, InputsAreNeverOverwritten) {
  write_frames(1, 2);
  const std::string before = testing::read_file(input(1));
  expect_refused("'{}/f.%04d.exr' --out '{}/f.%04d.exr'", 2, "would overwrite an input");
  expect_refused("'{}/f.%04d.exr' --out '{}/./f.####.exr'", 2, "would overwrite an input");
  expect_refused("'{}/f.%04d.exr' --out '{}/f.%04d.exr' -n", 2, "would overwrite an input");
  std::filesystem::create_symlink(input(1), folder_.file("link.0001.exr"));
  expect_refused("'{}/f.%04d.exr' --out '{}/link.%04d.exr'", 2, "would overwrite an input");
  // Frame 1 of the output is frame 2 of the input.
  std::filesystem::create_hard_link(input(2), folder_.file("hard.0001.exr"));
  expect_refused("'{}/f.%04d.exr' --out '{}/hard.%04d.exr'", 2, "would overwrite an input");
  expect_refused("'{}/f.%04d.exr' --out '{}/t.%04d.exr' --truth '{}/t.%04d.exr'", 2,
                 "would overwrite an input");
  EXPECT_EQ(testing::read_file(input(1)), before);
}

TEST_F(Refusal, PathsAreTriedBeforeTheWork) {
  write_frames(1, 2);
  expect_refused(kRun + "--report /proc/none/r", 1, "--report: '/proc/none/r.json' cannot be written");
  expect_refused(kRun + "--report '{}/'", 1, "/' cannot be written: the path names no file");
  expect_refused("'{}/f.%04d.exr' --out '{}/f.0001.exr/u.%04d.exr'", 1, "--out: '");
}

TEST_F(Refusal, APipeIsNoFrame) {
  ASSERT_EQ(::mkfifo(input(1).c_str(), 0600), 0);
  expect_refused(kRun, 1, "cannot be read: it is a pipe or a device; save it to a file first");
}

TEST_F(Refusal, MissingFrames) {
  expect_refused(kRun, 1, "no file is named");
  write_frames(1, 3);
  write_frames(5, 6);
  expect_refused(kRun, 1, "frame 4 is missing: there is no '" + input(4) + "'");
  expect_refused(kRun + "--frames 3-8", 1, "frame 4 is missing");
  expect_refused(kRun + "--frames 9", 1, "frame 9 is missing");
  expect_refused(kRun + "--frames 5-6", 1, "frame 4 is missing, the history of the one after it");
  resolve_to("warm", "--frames 5-6 --warm-up 0");
  resolve_to("single", "--frames 5-6 --method bilinear");
}

TEST_F(Refusal, MissingChannelsAndSizes) {
  write_frames(1, 4);
  testing::FrameFile odd = frame(3);
  odd.velocity = false;
  write_frame(input(3), odd);
  expect_refused(kRun, 1, "f.0003.exr' has no channel 'backward.u'; it has R, G, B, A");
  resolve_to("single", "--method bilinear");  // which does not read it
  expect_refused(kRun + "--colour Beauty", 1, "has no channel 'Beauty.R'");
  expect_refused(kRun + "--velocity a.x,a.y --velocity-convention nuke", 1, "has no channel 'a.x'");
  expect_refused(kRun + "--reactive mask", 1, "has no channel 'mask'");

  odd = frame(3);
  odd.attributes.push_back({"quincunx:renderSize", Vec2{100, 50}});
  write_frame(input(3), odd);
  expect_refused(kRun, 1, "f.0003.exr' is 24x14 pixels, but its attribute 'quincunx:renderSize' says 100x50");
  odd = frame(3);
  odd.attributes[0] = {"quincunx:jitter", Vec2{3, 0}};
  write_frame(input(3), odd);
  expect_refused(kRun, 1, "f.0003.exr' has a jitter of 3, 0");
  odd.attributes.erase(odd.attributes.begin());
  write_frame(input(3), odd);
  expect_refused(kRun, 1, "f.0003.exr' has no attribute 'quincunx:jitter'");
}

TEST_F(Refusal, TheOutputSizeMustBeKnown) {
  testing::FrameFile file = frame(1);
  file.attributes.clear();
  write_frame(input(1), file);
  expect_refused(kRun, 2, "--output is missing");
  resolve_to("u", "--output 20x20");
}

TEST_F(Refusal, BlurNeedsDepth) {
  write_frames(1, 2);
  expect_refused(kRun + "--blur 0.5 --method bilinear", 1, "motion blur reads depth here");
}

TEST_F(Refusal, FarMotionNeedsMatricesAndDepth) {
  testing::FrameFile file = frame(1);
  file.depth = true;
  write_frame(input(1), file);
  expect_refused(kRun + "--sky-motion camera", 1,
                 "has no attribute 'worldToNDC', which --sky-motion camera needs");
  expect_refused(kRun + "--sky-motion camera --method bilinear", 2, "it does nothing here");
  file.attributes.push_back({"worldToNDC", tools::Matrix{}});
  file.depth = false;
  write_frame(input(1), file);
  expect_refused(kRun + "--sky-motion camera", 1, "--sky-motion camera reads depth here");
}

TEST_F(Refusal, ADilatedVelocityNeedsDepth) {
  write_frames(1, 2);
  const std::string dilated = kRun + "--drawn-velocity dilated ";
  expect_refused(dilated + "--method quincunx", 1, "--drawn-velocity dilated reads depth here");
  resolve_to("u", "--drawn-velocity dilated --method bilinear");
  expect_refused(kRun + "--drawn-velocity spread", 2, "'spread' is none of dilated, own");
}

TEST_F(Refusal, CameraMotionNeedsItsMatrices) {
  testing::FrameFile file = frame(1);
  file.depth = true;
  write_frame(input(1), file);
  expect_refused(kRun + "--velocity camera", 1, "has no attribute 'worldToNDC'");
  file.attributes.push_back({"worldToNDC", tools::Matrix{}});
  file.depth = false;
  write_frame(input(1), file);
  expect_refused(kRun + "--velocity camera", 1, "reads depth");
}

TEST_F(Refusal, DamagedFiles) {
  write_frames(1, 4);
  const std::string whole = testing::read_file(input(3));
  write_bytes(input(3), "no picture");
  expect_refused(kRun, 1, "f.0003.exr' cannot be read");
  write_bytes(input(3), "");
  expect_refused(kRun, 1, "f.0003.exr' cannot be read");
  testing::write_deep_exr(input(3), {24, 14});
  expect_refused(kRun, 1, "f.0003.exr' holds deep pixels in channel 'R'");
  write_bytes(input(3), whole.substr(0, whole.size() * 2 / 3));
  expect_refused(kRun, 1, "f.0003.exr' is cut short: 1 of its 1 blocks of pixels is missing");
  const auto listing = resolve(kRun + "-n");
  EXPECT_EQ(listing.exit_code, 1);
  EXPECT_NE(listing.out.find("Missing   1 frame: 3\n  '" + input(3) + "' is cut short"), std::string::npos)
      << listing.out;
  // Bad pixels in a whole file show only when they are read: what was done by then stays, whole.
  write_bytes(input(3), with_bad_pixels(whole));
  const auto result = resolve("'{}/f.%04d.exr' --out '{}/u.%04d.exr' -q");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("f.0003.exr' cannot be read"), std::string::npos) << result.err;
  for (int number = 1; number <= 2; ++number)
    EXPECT_EQ(image(output(number)).extent, kOutput);
  EXPECT_EQ(files(), 4 + 2);
}

TEST_F(Refusal, BadFramesMayBeSkipped) {
  write_frames(1, 7);
  const std::string whole = testing::read_file(input(5));
  std::filesystem::remove(input(2));
  write_bytes(input(5), with_bad_pixels(whole));
  const auto result = resolve("'{}/f.%04d.exr' --out '{}/u.%04d.exr' --skip-bad-frames");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("frame 2 is missing"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("f.0005.exr' cannot be read"), std::string::npos) << result.err;
  // A frame after a gap has no history.
  write_bytes(input(5), whole);
  resolve_to("cold", "--frames 3,6 --warm-up 0");
  resolve_to("warm", "--frames 4,7");
  for (const int number : {3, 6})
    EXPECT_EQ(image(output(number)).pixels, image(output(number, "cold")).pixels) << number;
  for (const int number : {4, 7})
    EXPECT_EQ(testing::read_file(output(number)), testing::read_file(output(number, "warm"))) << number;
  for (const int number : {2, 5})
    EXPECT_FALSE(std::filesystem::exists(output(number))) << number;
}

#if !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)  // which take more addresses than any limit leaves
// Whatever gives up first: the driver's own start, its memory for pictures, or ours.
TEST_F(Refusal, TooLittleMemory) {
  write_frames(1, 1);
  for (const int megabytes : {700, 1200, 2000}) {
    const std::string program = fmt::format("ulimit -v {}; {}", megabytes * 1000, QUINCUNX_PROGRAM);
    const auto result = run_program(folder_, kRun + "--output 15360x8640 -q", program.c_str());
    EXPECT_EQ(result.exit_code, 1) << megabytes;
    EXPECT_EQ(result.err.rfind("error: ", 0), 0u) << megabytes << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
}
#endif

TEST_F(Refusal, AHomeThatCannotBeWrittenIsNamed) {
  write_frames(1, 1);
  const auto result = run_program(folder_, kRun + "-q",
                                  "env -u POCL_CACHE_DIR -u XDG_CACHE_HOME HOME=/dev/null " QUINCUNX_PROGRAM);
  if (result.exit_code == 0) QUINCUNX_SKIP("a driver needs no folder");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.err.find("cannot write below '/dev/null'"), std::string::npos) << result.err;
}

TEST_F(Refusal, FoldersThatCannotBeWritten) {
  write_frames(1, 2);
  expect_refused("'{}/f.%04d.exr' --out /proc/none/u.%04d.exr", 1, "/proc/none");
  std::ofstream(folder_.file("file")) << "a file, not a folder";
  expect_refused("'{}/f.%04d.exr' --out '{}/file/u.%04d.exr'", 1, "file");
  std::filesystem::create_directories(folder_.file("u.0001.exr"));
  expect_refused("'{}/f.%04d.exr' --out '{}/u.%04d.exr'", 1, "it is a folder");
}

TEST_F(Refusal, Truth) {
  write_frames(1, 2);
  expect_refused(kRun + "--truth '{}/t.%04d.exr'", 1, "belongs to a frame of this run");
  write_frame(folder_.file("t.0002.exr"), frame(9));
  const auto result = resolve(kRun + "--truth '{}/t.%04d.exr' -q");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("t.0002.exr' is 24x14 pixels; the output is 34x20"), std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace quincunx

// SPDX-License-Identifier: MIT
// A user's command lines: help, lists, and one clear sentence for each mistake.
#include <gtest/gtest.h>

#include <algorithm>

#include "program_run.h"

namespace quincunx {
namespace {

using testing::ProgramResult;
using testing::run_program;

class CommandLine : public ::testing::Test {
 protected:
  ProgramResult run(const std::string& arguments) { return run_program(folder_, arguments); }

  // Fails with `code` and one line on stderr that holds `part`; nothing on stdout; no file but the two
  // captures.
  void expect_refused(const std::string& arguments, int code, const std::string& part) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, code) << arguments << "\n" << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << arguments << "\n" << result.err;
    EXPECT_LE(std::count(result.err.begin(), result.err.end(), '\n'), 2) << result.err;
    EXPECT_EQ(folder_.entries(), 2) << arguments;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(CommandLine, HelpHasExamples) {
  const ProgramResult result = run("--help-all");
  EXPECT_EQ(result.exit_code, 0);
  for (const char* part : {"Examples:", "--scene", "--scale-path", "--truth", "--explain", "--interop"}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part;
  }
}

TEST_F(CommandLine, VersionAndLists) {
  EXPECT_EQ(run("--version").out.rfind("quincunx-render ", 0), 0u);
  const ProgramResult scenes = run("--list-scenes");
  EXPECT_EQ(scenes.exit_code, 0);
  for (const char* name : {"chart", "pan", "wires", "wheel", "occluders"}) {
    EXPECT_NE(scenes.out.find(name), std::string::npos) << name;
  }
  const ProgramResult devices = run("--list-devices");
  EXPECT_EQ(devices.exit_code, 0);
  EXPECT_NE(devices.out.find("OpenCL 0"), std::string::npos);
  EXPECT_NE(devices.out.find("OpenGL"), std::string::npos);
}

TEST_F(CommandLine, ExplainPlansWithoutRendering) {
  const ProgramResult moving = run("--explain --scene wheel --method quincunx");
  EXPECT_EQ(moving.exit_code, 0) << moving.err;
  EXPECT_NE(moving.out.find("WEIGHT=1"), std::string::npos) << moving.out;
  EXPECT_NE(moving.out.find("Profile        "), std::string::npos) << moving.out;
  const auto crossing = moving.out.find("Frames         ");
  ASSERT_NE(crossing, std::string::npos) << moving.out;
  const std::string line = moving.out.substr(crossing, moving.out.find('\n', crossing) - crossing);
  EXPECT_NE(line.find(" ms and 3.7 MB back ("), std::string::npos) << line;
  const ProgramResult none_there = run("--explain --scene wheel --device nowhere");
  EXPECT_EQ(none_there.exit_code, 0) << none_there.err;
  EXPECT_NE(none_there.out.find("Device         none: no OpenCL device matches 'nowhere'"), std::string::npos)
      << none_there.out;
  const ProgramResult camera = run("--explain --scene pan");
  EXPECT_NE(camera.out.find("velocity_from_depth"), std::string::npos) << camera.out;
  EXPECT_NE(camera.out.find("velocity target"), std::string::npos);
  const ProgramResult still = run("--explain --scene chart --method quincunx");
  EXPECT_NE(still.out.find("WEIGHT=0"), std::string::npos) << still.out;
  const ProgramResult mean = run("--explain --scene wheel --method quincunx:mean");
  EXPECT_NE(mean.out.find("WEIGHT=0"), std::string::npos) << mean.out;
  const ProgramResult coarse = run("--explain --scene wheel --shadow-scale 0.25");
  EXPECT_NE(coarse.out.find("Shadow map     512x512 of 2048x2048"), std::string::npos) << coarse.out;
  const ProgramResult apart = run("--explain --scene particles --particle-scale 0.5");
  EXPECT_NE(apart.out.find("overlay_particles"), std::string::npos) << apart.out;
  EXPECT_NE(apart.out.find("its own"), std::string::npos) << apart.out;
  const ProgramResult none = run("--explain --scene wheel --particle-scale 0.5");
  EXPECT_NE(none.out.find("Particles      none in this scene"), std::string::npos) << none.out;
  EXPECT_EQ(none.out.find("overlay_particles"), std::string::npos) << none.out;
  const ProgramResult focused = run("--explain --scene wheel --focus tyre");
  EXPECT_NE(focused.out.find("The focus's region"), std::string::npos) << focused.out;
  const ProgramResult placed = run("--explain --scene wheel --targets placed");
  EXPECT_NE(placed.out.find("Targets        placed"), std::string::npos) << placed.out;
  const ProgramResult dual = run("--explain --scene wheel --output 640x360 --dual auto");
  EXPECT_NE(dual.out.find("Output         dynamic: 320x200 to 640x360"), std::string::npos) << dual.out;
}

TEST_F(CommandLine, WrongUsageIsExitTwoAndOneSentence) {
  expect_refused("--colour rgb8", 2, "--colour: 'rgb8' is none of rgba16f, rgba8");
  expect_refused("--truth 2 --colour rgba8 --out x.png", 2, "--colour: --truth excludes it");
  expect_refused("--no-such-option", 2, "--no-such-option");
  expect_refused("--outpt 64x36", 2, "unknown option '--outpt'; did you mean '--output'?");
  expect_refused("--method biliner", 2, "did you mean 'bilinear'?");
  expect_refused("--scene weel", 2, "did you mean 'wheel'?");
  expect_refused("--scale-path sweeep", 2, "did you mean 'sweep'?");
  expect_refused("--grain 0.5", 2, "--grain: it does nothing here; it goes with --method noise");
  expect_refused("--contact-sheet '{}/x.exr'", 2, "must end in .tif, .png, .jpg or .dpx");
  expect_refused("--output 1280", 2, "WIDTHxHEIGHT");
  expect_refused("--output 0x720", 2, "WIDTHxHEIGHT");
  expect_refused("--scale abc --out '{}/a.png'", 2, "abc");
  expect_refused("--scale 0 --out '{}/a.png'", 2, "scale");
  expect_refused("--scale 3 --out '{}/a.png'", 2, "scale");
  expect_refused("--scale-path zigzag --out '{}/a.png'", 2, "zigzag");
  expect_refused("--scale 0.5 --scale-path sweep", 2, "--scale");
  expect_refused("--method magic", 2, "magic");
  expect_refused("--method quincunx:median", 2, "quincunx:mean");
  for (const char* amount : {"-0.1", "1.1", "nan", "much"})
    expect_refused(std::string("--scene chart --sharpen ") + amount, 2, "--sharpen");
  expect_refused("--velocity-weight -1", 2, "--velocity-weight");
  for (const char* output : {"fast", "0.05", "1.5", "nan", "0.5x"})
    expect_refused(std::string("--dual ") + output, 2,
                   "is no resolution of the output; write auto, random, or");
  expect_refused("--targets large", 2, "'large' is none of placed, viewport");
  expect_refused("--scene chart --targets placed --interop gl", 2, "exclude each other");
  for (const char* scale : {"0", "0.06", "1.5", "nan", "automatic"})
    expect_refused(std::string("--shadow-scale ") + scale, 2, "--shadow-scale");
  for (const char* scale : {"0", "0.06", "1.5", "nan", "automatic"})
    expect_refused(std::string("--particle-scale ") + scale, 2, "--particle-scale");
  expect_refused("--particle-budget 2", 2, "--particle-scale");
  expect_refused("--particle-scale 0.5 --particle-budget 2", 2, "nothing holds it");
  expect_refused("--scene particles --particle-scale 0.5 --colour rgba8", 2, "exclude each other");
  expect_refused("--shadow-budget 2", 2, "--shadow-scale");
  expect_refused("--shadow-scale 0.5 --shadow-budget 2", 2, "nothing holds it");
  expect_refused("--shadow-scale auto --shadow-budget 0", 2, "--shadow-budget");
  expect_refused("--scene wheel --focus 1270,0,20,20", 2, "is no rectangle within the picture of 1280x720");
  expect_refused("--scene wheel --focus hat", 2, "the scene 'wheel' has no object 'hat'; it has band, brick");
  expect_refused("--scene wheel --focus pointer", 2, "give it with --window");
  expect_refused("--scene wheel --focus tyre --focus-scale 3", 2, "--focus-scale");
  expect_refused("--frames 0", 2, "--frames");
  expect_refused("--fps -3", 2, "--fps");
  expect_refused("--shutter 0.5", 2, "--truth");
  expect_refused("--score 0", 2, "--score");
  expect_refused("--score 2 --truth 2 --out x.png", 2, "--truth");
  expect_refused("--score 2 --output 640x10", 2,
                 "--score needs an output of at least 11x11 pixels; this is 640x10");
  expect_refused("--frames 2 --out '{}/same.png'", 2, "same.png");
  expect_refused("--out '{}/frame.gif'", 2, ".gif");
  expect_refused("--scene nowhere", 2, "nowhere");
  expect_refused("--scene chart --device none-such", 2, "none-such");
  expect_refused("--exr-frame 5 --frames 2 --out '{}/f.%d.png'", 2, "--exr-frame");
}

TEST_F(CommandLine, WrongPacingIsExitTwoAndOneSentence) {
  for (const char* rate : {"0", "-1", "nan", "inf", "fast"}) {
    expect_refused(std::string("--target-fps ") + rate, 2, "--target-fps");
  }
  expect_refused("--target-fps 1e-9", 2, "frames a second");
  expect_refused("--target-fps 30 --min-scale 0.9 --max-scale 0.5", 2, "--min-scale 0.9");
  expect_refused("--target-fps 30 --min-scale 0", 2, "--min-scale");
  expect_refused("--target-fps 30 --max-scale 2.5", 2, "--max-scale");
  expect_refused("--target-fps 30 --controller magic", 2, "minimum-of-n");
  expect_refused("--target-fps 30 --ladder rope", 2, "horizontal-first");
  expect_refused("--target-fps 30 --buffers 1", 2, "--buffers");
  expect_refused("--target-fps 30 --headroom 0.6", 2, "--headroom");
  expect_refused("--target-fps 30 --scale 0.5", 2, "--controller fixed");
  expect_refused("--target-fps 30 --scale-path sweep", 2, "--controller fixed");
  expect_refused("--target-fps 30 --truth 4", 2, "--truth");
  expect_refused("--target-fps 30 --compare-fixed 1,0", 2, "--compare-fixed");
  expect_refused("--compare-fixed 1", 2, "--target-fps");
  expect_refused("--target-fps 30 --calibrate '{}/c.json'", 2, "--calibrate");
  expect_refused("--target-fps 30 --calibration /dev/null", 1,
                 "/dev/null' cannot be read: it is a pipe or a device");
  expect_refused("--target-fps 30 --calibration '{}/missing.json'", 1, "missing.json");
  expect_refused("--calibrate /proc/none/c.json", 1, "/proc/none");
  expect_refused("--calibrate '{}/c.json' --min-scale 0.9 --max-scale 0.5", 2, "--min-scale 0.9");
  expect_refused("--target-fps 30 --controller fixed --min-scale 0.5", 2, "--min-scale");
  expect_refused("--target-fps 30 --blur-aware", 2, "--blur");
  expect_refused("--target-fps 30 --controller proportional --follow-cpu", 2, "--follow-cpu");
  const std::string quality = "--target-fps 30 --controller quality ";
  expect_refused(quality + "--method bilinear", 2, "--method");
  expect_refused(quality + "--jitter halton", 2, "the method is chosen for you");
  expect_refused(quality + "--dual auto", 2, "--dual");
  expect_refused(quality + "--scene wheel --focus tyre", 2, "--focus");
  expect_refused(quality + "--compare-fixed 1", 2, "have one method");
  for (const char* alone : {"--controller predictive", "--min-scale 0.5", "--ladder both", "--buffers 2",
                            "--calibration c.json", "--follow-cpu", "--detail-follows"}) {
    expect_refused(alone, 2, "--target-fps");
  }
}

TEST_F(CommandLine, BadSceneFilesAreExitOneAndOneSentence) {
  expect_refused("--scene '{}/missing.gltf'", 1, "missing.gltf");
  expect_refused("--scene /dev/null.glb", 1, "/dev/null.glb");
}

TEST_F(CommandLine, PathsAreTriedBeforeTheWork) {
  for (const char* option : {"--report", "--contact-sheet", "--out"})
    expect_refused(std::string("--scene chart ") + option + " /proc/none/a.png", 1,
                   std::string(option) + ": '/proc/none");
  expect_refused("--target-fps 30 --calibration '{}/'", 1, "it is a folder");
}

TEST_F(CommandLine, StandardOutputThatIsFullIsAnError) {
  const ProgramResult result =
      testing::run_program(folder_, "-c '\"$0\" --list-scenes >/dev/full' " QUINCUNX_PROGRAM, "sh");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "error: standard output cannot be written: No space left on device\n");
}

TEST_F(CommandLine, AFolderThatCannotBeWrittenIsAnError) {
  const ProgramResult result = run("-q --output 32x32 --scene chart --out /proc/none/a.png");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("/proc/none"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace quincunx

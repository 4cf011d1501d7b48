// SPDX-License-Identifier: MIT
// The window's pictures and files; every setting can be changed while it runs.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <random>

#include "display.h"
#include "tools/image/image_io.h"
#include "window/key_bindings.h"

namespace quincunx::testing {
namespace {

class Window : public OnDisplay {
 protected:
  tools::LoadedImage image(const std::string& name) const {
    auto loaded = tools::read_image(path(name));
    EXPECT_TRUE(loaded.ok()) << loaded.status().message();
    return loaded.ok() ? loaded.value() : tools::LoadedImage();
  }

  void render_headless(const std::string& arguments) {
    const ProgramResult result = run_program(folder_, "-q --output 160x90 " + arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
};

TEST_F(Window, ShowsTheBitsOfARunWithoutOne) {
  write_script("5 key s\n");
  const std::vector<std::string> settings = {
      "--scene wires --scale 0.71", "--scene wheel --scale 0.5,0.5 --method catmull-rom --blur 0.5",
      "--scene particles --scale 1.5 --method quincunx:reprojected --tone-map reinhard"};
  for (const std::string& arguments : settings) {
    std::filesystem::remove_all(path("captures"));
    render_headless(arguments + " --frames 6 --out '{}/headless.%04d.png'");
    ASSERT_EQ(run_window(arguments + " --frames 6 --hide-ui -q"), 0) << said();
    const tools::LoadedImage shown = image("captures/screenshot.0005.png");
    EXPECT_EQ(shown.extent, (Extent{160, 90}));
    EXPECT_EQ(shown.pixels, image("headless.0005.png").pixels) << arguments;
  }
}

TEST_F(Window, AFocusShowsTheSameBits) {
  write_script("5 key s\n");
  const std::string plain = "--scene wheel --scale 0.5 --method temporal ";
  const std::string focused = plain + "--focus 40,20,60,40 ";
  render_headless(plain + "--frames 6 --out '{}/plain.%04d.png'");
  render_headless(focused + "--frames 6 --out '{}/focused.%04d.png'");
  EXPECT_NE(image("plain.0005.png").pixels, image("focused.0005.png").pixels);
  ASSERT_EQ(run_window(focused + "--frames 6 --hide-ui -q"), 0) << said();
  EXPECT_EQ(image("captures/screenshot.0005.png").pixels, image("focused.0005.png").pixels);

  // The pointer's place from frame 1 to 2; this method needs nothing of the frames before.
  std::filesystem::remove_all(path("captures"));
  write_script("1 key g\n3 key g\n5 key s\n");
  const std::string single = "--scene wheel --scale 0.5 --method mitchell ";
  render_headless(single + "--frames 6 --out '{}/single.%04d.png'");
  ASSERT_EQ(run_window(single + "--frames 6 --hide-ui -q"), 0) << said();
  EXPECT_EQ(image("captures/screenshot.0005.png").pixels, image("single.0005.png").pixels);
}

TEST_F(Window, PlacedTargetsShowTheSameBits) {
  write_script("5 key s\n");
  const std::string arguments = "--scene wheel --scale 0.71 --method temporal ";
  render_headless(arguments + "--frames 6 --out '{}/headless.%04d.png'");
  ASSERT_EQ(run_window(arguments + "--targets placed --frames 6 --hide-ui -q"), 0) << said();
  EXPECT_EQ(image("captures/screenshot.0005.png").pixels, image("headless.0005.png").pixels);

  // The other kind from frame 2 on; this method needs nothing of the frames before.
  std::filesystem::remove_all(path("captures"));
  write_script("2 key a\n5 key s\n");
  const std::string single = "--scene wheel --scale 0.71 --method mitchell ";
  render_headless(single + "--frames 6 --out '{}/single.%04d.png'");
  ASSERT_EQ(run_window(single + "--frames 6 --hide-ui -q"), 0) << said();
  EXPECT_EQ(image("captures/screenshot.0005.png").pixels, image("single.0005.png").pixels);
}

TEST_F(Window, ADynamicOutputShowsTheSameBits) {
  write_script("5 key s\n");
  const std::string arguments = "--scene wheel --scale 0.5 --method temporal --dual random --seed 3 ";
  render_headless(arguments + "--frames 6 --out '{}/headless.%04d.png'");
  ASSERT_EQ(run_window(arguments + "--frames 6 --hide-ui -q"), 0) << said();
  EXPECT_EQ(image("captures/screenshot.0005.png").pixels, image("headless.0005.png").pixels);

  // Switched on by its key in frame 2; this method needs nothing of the frames before.
  std::filesystem::remove_all(path("captures"));
  write_script("2 key u\n5 key s\n");
  const std::string single = "--scene wheel --scale 0.5 --method mitchell ";
  render_headless(single + "--dual auto --frames 6 --out '{}/single.%04d.png'");
  ASSERT_EQ(run_window(single + "--frames 6 --hide-ui -q"), 0) << said();
  EXPECT_EQ(image("captures/screenshot.0005.png").pixels, image("single.0005.png").pixels);
}

TEST_F(Window, DumpsWhatARunWithoutOneDumps) {
  write_script("4 key d\n");
  const std::string arguments = "--scene wheel --scale 0.71 ";
  render_headless(arguments + "--frames 5 --exr-frame 4 --out '{}/headless.%04d.png'");
  ASSERT_EQ(run_window(arguments + "--frames 5 -q"), 0) << said();
  for (const std::string part : {"targets", "resolved"}) {
    const tools::LoadedImage dumped = image("captures/dump.0004_" + part + ".exr");
    const tools::LoadedImage expected = image("frame_0004_" + part + ".exr");
    EXPECT_EQ(dumped.channels, expected.channels) << part;
    EXPECT_EQ(dumped.pixels, expected.pixels) << part;
  }
}

// A frozen frame by other settings is that frame of a run with those settings; one on and one back as well. F goes
// on from bilinear to b-spline; R begins with the first resolve, quincunx:mean.
TEST_F(Window, FrozenFramesAreMadeAgain) {
  write_script(
      "6 key space\n7 key f\n9 key s\n10 key shift+r\n11 key period\n13 key s\n15 key comma\n17 key s\n");
  ASSERT_EQ(
      run_window("--scene wires --scale 0.71 --method bilinear --jitter quincunx --frames 20 --hide-ui -q"),
      0)
      << said();
  const std::string headless = "--scene wires --scale 0.71 --jitter quincunx --frames 8 --method ";
  render_headless(headless + "b-spline --out '{}/filter.%04d.png'");
  EXPECT_EQ(image("captures/screenshot.0005.png").pixels, image("filter.0005.png").pixels);
  render_headless(headless + "quincunx:mean --out '{}/resolve.%04d.png'");
  EXPECT_EQ(image("captures/screenshot.0006.png").pixels, image("resolve.0006.png").pixels);
  EXPECT_EQ(image("captures/screenshot.0005-2.png").pixels, image("resolve.0005.png").pixels);
}

TEST_F(Window, SplitShowsBothMethodsAndZoomRepeatsPixels) {
  write_script(
      "3 key space\n4 key s\n5 key v\n6 key v\n7 key v\n8 key s\n9 key shift+v\n10 key shift+v\n11 key "
      "shift+v\n"
      "12 key z\n13 key z\n14 key s\n");
  ASSERT_EQ(run_window("--scene wires --scale 0.5 --method point --frames 20 --hide-ui -q"), 0) << said();
  const tools::LoadedImage whole = image("captures/screenshot.0002.png");
  const tools::LoadedImage split = image("captures/screenshot.0002-2.png");
  const tools::LoadedImage zoomed = image("captures/screenshot.0002-3.png");
  int different = 0;
  for (int y = 0; y < 90; ++y) {
    for (int x = 0; x < 160; ++x) {
      for (int c = 0; c < 3; ++c) {
        const bool same = split.at(x, y, c) == whole.at(x, y, c);
        ASSERT_TRUE(same || x >= 80) << x << ", " << y;
        different += same ? 0 : 1;
        // Four times, about the middle: its corner is 160/2 - 40/2 and 90/2 - 22/2.
        ASSERT_EQ(zoomed.at(x, y, c), whole.at(60 + x / 4, 34 + y / 4, c)) << x << ", " << y;
      }
    }
  }
  EXPECT_GT(different, 1000) << "the other method must look different";
}

TEST_F(Window, ResizingMakesThePictureInTheNewSize) {
  write_script("5 resize 240x130\n25 key s\n26 resize 61x33\n45 key s\n");
  ASSERT_EQ(run_window("--scene chart --scale 0.6 --frames 50 -q"), 0) << said();
  EXPECT_EQ(image("captures/screenshot.0025.png").extent, (Extent{240, 130}));
  EXPECT_EQ(image("captures/screenshot.0045.png").extent, (Extent{61, 33}));
}

TEST_F(Window, DrawsNothingWhileMinimised) {
  open_window_manager();
  write_script("10 minimise\n150 restore\n200 key s\n210 key escape\n");
  ASSERT_EQ(run_window("--scene chart --hide-ui -q"), 0) << said();
  const std::filesystem::directory_iterator captures(path("captures"));
  const std::string name = captures->path().filename().string();
  int frame = 0;
  ASSERT_EQ(std::sscanf(name.c_str(), "screenshot.%d.png", &frame), 1) << name;
  EXPECT_LT(frame, 150) << "turns while it was minimised must not draw";
  EXPECT_GT(frame, 20) << "and it must go on afterwards";
}

TEST_F(Window, DrawsItsInterfaceInEverySecondFrameIfWanted) {
  for (const bool every_second : {false, true}) {
    write_script(every_second ? "0 key o\n" : "");
    ASSERT_EQ(run_window("--scene chart --frames 40 -v"), 0) << said();
    const std::string text = said();
    const std::size_t at = text.find("pictures of");
    ASSERT_NE(at, std::string::npos) << text;
    int drawn = 0;
    ASSERT_EQ(std::sscanf(text.c_str() + at, "pictures of 40 frames, the interface drawn %d times", &drawn),
              1)
        << text;
    EXPECT_EQ(drawn, every_second ? 20 : 40);
  }
}

// Keys of a real keyboard, and the screen itself: what stands there is the picture.
TEST_F(Window, ListensToTheKeyboardAndStandsOnTheScreen) {
  const auto window = start_window("--scene wires --scale 0.71 --hide-ui -q");
  ASSERT_EQ(tool("mousemove 80 45"), 0);
  ASSERT_TRUE(wait_until([&] {
    tool("key s");
    return std::filesystem::exists(path("captures")) || !window->runs();
  }));
  ASSERT_EQ(tool("key space"), 0);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  std::filesystem::remove_all(path("captures"));
  ASSERT_EQ(tool("key s"), 0);
  ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(path("captures")) || !window->runs(); }))
      << said();
  const std::string screen = read_file(path("screen/Xvfb_screen0"));
  ASSERT_EQ(tool("key Escape"), 0);
  EXPECT_EQ(window->wait(), 0) << said();
  std::string name;
  for (const auto& entry : std::filesystem::directory_iterator(path("captures")))
    name = "captures/" + entry.path().filename().string();
  const tools::LoadedImage shot = image(name);
  // The X window dump format: 32-bit numbers, most significant byte first; then a table of colours; then rows
  // of blue, green, red, nothing.
  const auto number = [&](std::size_t index) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = value << 8U | static_cast<unsigned char>(screen.at(4 * index + i));
    return static_cast<std::size_t>(value);
  };
  const std::size_t pixels = number(0) + number(19) * 12;
  const std::size_t row = number(12);
  for (int y = 0; y < 90; ++y) {
    for (int x = 0; x < 160; ++x) {
      for (int c = 0; c < 3; ++c) {
        const auto at = pixels + row * static_cast<std::size_t>(y) + 4 * static_cast<std::size_t>(x) + 2 -
                        static_cast<std::size_t>(c);
        const int code = static_cast<unsigned char>(screen.at(at));
        ASSERT_EQ(code, std::lround(shot.at(x, y, c) * 255)) << x << ", " << y << ", " << c;
      }
    }
  }
}

// Every key with and without Shift, in an order by chance: nothing breaks, and it ends as it should.
TEST_F(Window, WithstandsAnyKeys) {
  std::mt19937 random(2026);
  std::string script;
  int turn = 0;
  for (int i = 0; i < 90; ++i) {
    const auto keys = scenes::key_bindings();
    const std::string name = keys[random() % keys.size()].name;
    if (name == "escape") continue;
    script += fmt::format("{} key {}{}\n", turn++, random() % 4 == 0 ? "shift+" : "", name);
  }
  for (const scenes::KeyBinding& binding : scenes::key_bindings()) {
    if (std::string(binding.name) != "escape") script += fmt::format("{} key {}\n", turn++, binding.name);
  }
  write_script(script + fmt::format("{} key escape\n", turn + 5));
  EXPECT_EQ(run_window("--scene chart --scale 0.5 -q"), 0) << said() << script;
  EXPECT_EQ(said(), "") << "quiet means quiet";
}

TEST_F(Window, FollowsAController) {
  write_script("30 key c\n60 key c\n90 key p\n");
  EXPECT_EQ(run_window("--scene wheel --target-fps 120 --frames 120 -q"), 0) << said();
  EXPECT_EQ(said(), "");
}

// Frozen, one frame on, beside truth and another method, with a focus, of which no front knows, and without it again.
TEST_F(Window, FollowsAControllerThatChoosesTheMethod) {
  write_script(
      "10 key space\n14 key period\n18 key space\n22 key v\n26 key v\n30 key shift+v\n32 key shift+v\n"
      "36 key g\n42 key g\n46 key c\n50 key shift+c\n");
  EXPECT_EQ(run_window("--scene wheel --target-fps 60 --controller quality --frames 60 -q"), 0) << said();
  EXPECT_EQ(said(), "");
}

}  // namespace
}  // namespace quincunx::testing

// SPDX-License-Identifier: MIT
// From scene to file: invariants of whole frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "program_run.h"
#include "skip.h"
#include "tools/image/image_io.h"
#include "tools/own_cache.h"

namespace quincunx {
namespace {

using testing::ProgramResult;
using testing::read_file;
using testing::run_program;

class EndToEnd : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.file(name); }

  void render(const std::string& arguments) {
    const ProgramResult result = run_program(folder_, "-q --output 160x90 " + arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "") << "quiet means quiet";
  }

  tools::LoadedImage image(const std::string& name) const {
    auto loaded = tools::read_image(path(name));
    EXPECT_TRUE(loaded.ok()) << loaded.status().message();
    return loaded.value();
  }

  testing::TemporaryFolder folder_;
};

TEST_F(EndToEnd, AStillSceneIsBitStableFromFrameThree) {
  render("--scene chart --scale 0.71 --frames 7 --method quincunx --out '{}/f.%04d.exr'");
  const auto third = image("f.0002.exr").pixels;
  for (int index = 3; index < 7; ++index) {
    EXPECT_EQ(image("f.000" + std::to_string(index) + ".exr").pixels, third) << "frame " << index;
  }
  EXPECT_NE(image("f.0000.exr").pixels, third) << "the second frame must add something";
}

TEST_F(EndToEnd, ScaleOneWithoutJitterIsTheIdentity) {
  for (const std::string method : {"point", "bilinear", "quincunx", "point --colour rgba8"}) {
    render("--scene chart --scale 1 --jitter none --frames 3 --exr-frame 2 --method " + method +
           " --out '{}/f.%04d.png'");
    const auto drawn = image("frame_0002_targets.exr");
    const auto resolved = image("frame_0002_resolved.exr");
    ASSERT_EQ(drawn.extent, resolved.extent);
    for (const char* name : {"R", "G", "B", "A"}) {
      const int from = drawn.channel(name);
      const int to = resolved.channel(name);
      ASSERT_GE(from, 0);
      ASSERT_GE(to, 0);
      for (int y = 0; y < drawn.extent.height; ++y) {
        for (int x = 0; x < drawn.extent.width; ++x)
          ASSERT_EQ(drawn.at(x, y, from), resolved.at(x, y, to)) << method;
      }
    }
  }
}

// Where Vulkan's loader cannot be loaded, its drivers can.
TEST_F(EndToEnd, ExternalMemoryNeedsNoLoader) {
  const std::string scene = "-q --output 160x90 --scene wheel --scale 0.71 --frames 3 ";
  const ProgramResult usual = run_program(folder_, scene + "--interop external --out '{}/usual.%d.png'");
  if (usual.exit_code != 0) QUINCUNX_SKIP(usual.err);
  std::filesystem::create_directory(path("lib"));
  std::ofstream(path("lib/libvulkan.so.1")) << "no library";
  const std::string without =
      fmt::format("LD_LIBRARY_PATH='{}':$LD_LIBRARY_PATH {}", path("lib"), QUINCUNX_PROGRAM);
  const ProgramResult hidden =
      run_program(folder_, scene + "--interop external --json --out '{}/hidden.%d.png'", without.c_str());
  ASSERT_EQ(hidden.exit_code, 0) << hidden.err;
  EXPECT_EQ(nlohmann::json::parse(hidden.out)["interop"], "external");
  EXPECT_EQ(image("hidden.2.png").pixels, image("usual.2.png").pixels);
}

TEST_F(EndToEnd, TwoRunsAgreeBitForBit) {
  const std::string arguments = "--scene particles --scale-path random --seed 7 --frames 6 --out ";
  render(arguments + "'{}/a.%04d.png'");
  render(arguments + "'{}/b.%04d.png'");
  render(arguments + "'{}/c.%04d.png' --no-overlap");
  for (int index = 0; index < 6; ++index) {
    const std::string number = ".000" + std::to_string(index) + ".png";
    EXPECT_EQ(image("a" + number).pixels, image("b" + number).pixels) << index;
    EXPECT_EQ(image("a" + number).pixels, image("c" + number).pixels)
        << index << ": overlap must not change a pixel";
  }
}

// With parts at a scale of their own nothing of another frame's is seen, either, and targets of any kind give the same.
TEST_F(EndToEnd, PartsAtTheirOwnScaleAgreeBitForBitToo) {
  for (const std::string method : {"bilinear", "temporal", "temporal --shading checkerboard"}) {
    const std::string arguments =
        "--scene particles --scale-path random:0.2,1.2 --seed 7 --frames 5 "
        "--shadow-scale 0.3 --particle-scale 0.37 --method " +
        method + " --out ";
    render(arguments + "'{}/a.%04d.png'");
    render(arguments + "'{}/b.%04d.png' --no-overlap");
    render(arguments + "'{}/c.%04d.png' --targets placed");
    for (int index = 0; index < 5; ++index) {
      const std::string number = ".000" + std::to_string(index) + ".png";
      EXPECT_EQ(image("a" + number).pixels, image("b" + number).pixels) << method << index;
      EXPECT_EQ(image("a" + number).pixels, image("c" + number).pixels) << method << index;
    }
  }
}

TEST_F(EndToEnd, PartsUnderControllersAreReported) {
  render(
      "--scene particles --frames 12 --shadow-scale auto --shadow-budget 0.05 --particle-scale auto "
      "--particle-budget 0.05 --report '{}/run'");
  const auto report = nlohmann::json::parse(read_file(path("run.json")));
  const std::string parts = report["settings"]["parts"];
  EXPECT_NE(parts.find("particles "), std::string::npos) << parts;
  EXPECT_NE(parts.find("held at 0.05 ms"), std::string::npos) << parts;
  EXPECT_NE(parts.find(" to 1, mean 0."), std::string::npos) << parts << ": a budget that nothing fits in";
}

// Placed targets change no bit of any picture, whatever the resolution does, for frames of their own and for history.
TEST_F(EndToEnd, PlacedTargetsGiveTheSamePictures) {
  for (const std::string method :
       {"bilinear", "quincunx", "quincunx:reprojected", "temporal:fast", "temporal"}) {
    const std::string arguments =
        "--scene wheel --scale-path random:0.2,1.4 --seed 5 --frames 6 --method " + method + " --out ";
    render(arguments + "'{}/viewport.%04d.png'");
    render(arguments + "'{}/placed.%04d.png' --targets placed");
    render(arguments + "'{}/finished.%04d.png' --targets placed --no-overlap");
    for (int index = 0; index < 6; ++index) {
      const std::string number = ".000" + std::to_string(index) + ".png";
      EXPECT_EQ(image("placed" + number).pixels, image("viewport" + number).pixels) << method << index;
      EXPECT_EQ(image("finished" + number).pixels, image("viewport" + number).pixels) << method << index;
    }
  }
}

// An output that always has its largest size changes no bit. One that changes in every frame gives pictures of that
// size, the same in every run.
TEST_F(EndToEnd, TheOutputMayBeDynamic) {
  for (const std::string method : {"quincunx", "temporal --blur 0.5", "bilinear --focus 10,8,40,30"}) {
    const std::string arguments =
        "--scene wheel --scale-path random:0.3,1.2 --seed 5 --frames 6 --method " + method + " --out ";
    render(arguments + "'{}/fixed.%04d.png'");
    render(arguments + "'{}/largest.%04d.png' --dual 1");
    render(arguments + "'{}/random.%04d.png' --dual random");
    render(arguments + "'{}/again.%04d.png' --dual random --no-overlap");
    render(arguments + "'{}/auto.%04d.exr' --dual auto");
    for (int index = 0; index < 6; ++index) {
      const std::string number = ".000" + std::to_string(index);
      const auto fixed = image("fixed" + number + ".png");
      EXPECT_EQ(image("largest" + number + ".png").pixels, fixed.pixels) << method << index;
      EXPECT_EQ(image("random" + number + ".png").extent, fixed.extent) << method << index;
      EXPECT_NE(image("random" + number + ".png").pixels, fixed.pixels) << method << index;
      EXPECT_EQ(image("again" + number + ".png").pixels, image("random" + number + ".png").pixels) << index;
      EXPECT_EQ(image("auto" + number + ".exr").extent, fixed.extent) << method << index;
    }
  }
}

TEST_F(EndToEnd, TheTargetFileHoldsEveryChannel) {
  render("--scene occluders --scale 0.5 --frames 2 --method quincunx --exr-frame 1 --out '{}/f.%04d.png'");
  const auto targets = image("frame_0001_targets.exr");
  EXPECT_EQ(targets.extent, (Extent{80, 44}));  // the ladder has 90 - 2k, and 45 lies between two rungs
  for (const char* name : {"R", "G", "B", "A", "Z", "backward.u", "backward.v"}) {
    EXPECT_GE(targets.channel(name), 0) << name;
  }
  for (const float value : targets.pixels)
    ASSERT_TRUE(std::isfinite(value));
  for (const char* name : {"quincunx:jitter", "quincunx:renderSize", "quincunx:outputSize", "quincunx:near",
                           "quincunx:frameIndex", "worldToCamera", "worldToNDC"}) {
    EXPECT_NE(targets.attribute(name), nullptr) << name;
  }
  EXPECT_EQ(std::get<Vec2>(targets.attribute("quincunx:jitter")->value), (Vec2{0.25f, 0.25f}));
}

// The two-frame resolve must come closer to supersampled truth than one bilinear frame on a still scene.
TEST_F(EndToEnd, QuincunxIsCloserToTruthThanBilinear) {
  render("--scene chart --scale 0.71 --frames 4 --method quincunx --out '{}/q.%04d.exr'");
  render("--scene chart --scale 0.71 --frames 1 --method bilinear --out '{}/b.exr'");
  render("--scene chart --truth 6 --out '{}/t.exr'");
  const auto truth = image("t.exr").pixels;
  const auto error = [&](const std::vector<float>& pixels) {
    double sum = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double difference = std::clamp(pixels[i], 0.0f, 1.0f) - std::clamp(truth[i], 0.0f, 1.0f);
      sum += difference * difference;
    }
    return sum / static_cast<double>(pixels.size());
  };
  const double quincunx = error(image("q.0003.exr").pixels);
  const double bilinear = error(image("b.exr").pixels);
  EXPECT_LT(quincunx, bilinear);
  RecordProperty("quincunx_mse", std::to_string(quincunx));
  RecordProperty("bilinear_mse", std::to_string(bilinear));
}

TEST_F(EndToEnd, TheReportSaysWhatWasDone) {
  render("--scene wheel --scale-path ramp:0.4,1.2 --frames 9 --method quincunx --report '{}/report'");
  const std::string text = read_file(path("report.txt"));
  for (const char* part : {"resolve_quincunx", "present", "llvmpipe", "copy", "wheel", "ramp:0.4,1.2"}) {
    if (std::string(part) == "llvmpipe") continue;  // another renderer is as good
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
  const auto json = nlohmann::json::parse(read_file(path("report.json")));
  ASSERT_EQ(json.at("frames").size(), 9u);
  EXPECT_EQ(json.at("seed"), 0);
  const std::string dumped = json.dump();
  EXPECT_NE(dumped.find("192"), std::string::npos) << "the last viewport is 192 wide";
}

TEST_F(EndToEnd, TheReportSaysWhichWayVelocityPointsIfAsked) {
  const ProgramResult result = run_program(
      folder_,
      "-q --scene occluders --output 640x360 --scale 0.5 --frames 14 --check-motion --report '{}/r'");
  ASSERT_EQ(result.exit_code, 0) << result.out;
  const std::string said = nlohmann::json::parse(read_file(path("r.json")))["settings"]["motion check"];
  EXPECT_TRUE(said.starts_with("velocity.x points the right way: ")) << said;
}

TEST_F(EndToEnd, ScoresAreOfThisRunAndChangeNoPixel) {
  const std::string run =
      "--scene pan --frames 8 --method temporal --scale-path random:0.4,0.8 --exposure 1 ";
  render(run + "--out '{}/without.%04d.exr'");
  render(run + "--out '{}/with.%04d.exr' --score 2 --report '{}/r'");
  for (int index = 0; index < 8; ++index) {
    const std::string name = fmt::format(".{:04}.exr", index);
    EXPECT_EQ(image("with" + name).pixels, image("without" + name).pixels) << index;
  }
  render("--scene pan --frames 8 --truth 2 --out '{}/truth.%04d.exr'");
  const auto report = nlohmann::json::parse(read_file(path("r.json")));
  const auto& frames = report["scores"]["frames"];
  ASSERT_EQ(frames.size(), 8u);
  const auto drawn = image("with.0005.exr").pixels, truth = image("truth.0005.exr").pixels;
  double squares = 0;
  for (std::size_t i = 0; i < drawn.size(); ++i)
    squares += i % 4 < 3 ? std::pow(std::clamp(drawn[i], 0.f, 1.f) - std::clamp(truth[i], 0.f, 1.f), 2) : 0;
  // The files are stored as half, which moves no value by more than 2^-11 of it.
  EXPECT_NEAR(frames[5]["psnr_linear"], -10 * std::log10(squares / (static_cast<double>(drawn.size()) * .75)),
              .01);
  EXPECT_TRUE(frames[0]["flicker"].is_null());
  EXPECT_GT(frames[1]["flicker"], 0);
  const std::string page = read_file(path("r.html"));
  EXPECT_NE(page.find("{\"name\":\"ghosts\",\"map\":true}"), std::string::npos);
}

TEST_F(EndToEnd, APacedRunReportsEveryFrame) {
  const std::string common = "--scene pan --target-fps 50 --frames 12 --report '{}/r' ";
  for (const std::string more :
       {"--min-scale 0.25 --max-scale 1.5", "--controller proportional --ladder both",
        "--controller minimum-of-n --buffers 2 --headroom 0.1", "--frame-cost device", "--frame-cost span"}) {
    render(common + more);
    const auto json = nlohmann::json::parse(read_file(path("r.json")));
    ASSERT_EQ(json.at("pacing").size(), 1u) << more;
    const auto& run = json.at("pacing")[0];
    EXPECT_EQ(run.at("target_fps"), 50);
    EXPECT_GT(run.at("summary").at("achieved_fps"), 0);
    EXPECT_NE(run.at("measured_by"), "");
    ASSERT_EQ(run.at("frames").size(), 12u);
    int missed = 0;
    for (std::size_t i = 0; i < 12; ++i) {
      const auto& frame = run.at("frames")[i];
      EXPECT_EQ(frame.at("index"), i);
      EXPECT_EQ(frame.at("render"), json.at("frames")[i].at("render")) << "what was drawn is what was chosen";
      EXPECT_GT(frame.at("busy_ms"), 0);
      EXPECT_GE(frame.at("shown_ms"), frame.at("finished_ms"));
      missed += frame.at("missed").get<int>();
    }
    EXPECT_EQ(run.at("summary").at("dropped"), missed);
    const std::string text = read_file(path("r.txt"));
    for (const char* part : {"Pacing: target 50.00", "dropped", "Scale over the frames"})
      EXPECT_NE(text.find(part), std::string::npos) << part;
  }
}

TEST_F(EndToEnd, AControllerOfQualityReportsTheMethodOfEveryFrame) {
  const testing::OwnCache cache(path("cache"));
  render("--scene wires --target-fps 50 --controller quality --frames 12 --score 1 --report '{}/r'");
  const auto json = nlohmann::json::parse(read_file(path("r.json")));
  const auto& run = json.at("pacing")[0];
  EXPECT_EQ(run.at("controller"), "quality");
  EXPECT_NE(run.at("reasons").get<std::string>().find("Chosen"), std::string::npos);
  EXPECT_EQ(json.at("scores").at("frames").size(), 12u) << "a paced run can be scored";
  std::string method;
  std::size_t changes = 0;
  for (const auto& frame : run.at("frames")) {
    EXPECT_EQ(frame.at("render"), json.at("frames")[frame.at("index").get<std::size_t>()].at("render"));
    EXPECT_EQ(frame.at("fading_from").is_null(), frame.at("weight") == 1);
    const std::string now = frame.at("method");
    if (!method.empty() && now != method) {
      ASSERT_LT(changes, run.at("method_changes").size());
      const auto& change = run.at("method_changes")[changes++];
      EXPECT_EQ(change.at("frame"), frame.at("index"));
      EXPECT_EQ(change.at("from"), method);
      EXPECT_EQ(change.at("to"), now);
      EXPECT_NE(change.at("why").get<std::string>().find(now), std::string::npos);
    }
    method = now;
  }
  EXPECT_EQ(changes, run.at("method_changes").size());
  EXPECT_NE(read_file(path("r.txt")).find("Methods: frames shown of each"), std::string::npos);
}

TEST_F(EndToEnd, AControllerStartsAtItsTopAndAFixedOneStaysAtTheScale) {
  render("--scene pan --target-fps 50 --max-scale 1.5 --frames 2 --report '{}/r'");
  auto json = nlohmann::json::parse(read_file(path("r.json")));
  EXPECT_EQ(json.at("target"), nlohmann::json::parse("[240, 135]"));
  EXPECT_EQ(json.at("frames")[0].at("render"), nlohmann::json::parse("[240, 134]"));
  render("--scene pan --target-fps 50 --controller fixed --scale 0.5 --frames 8 --report '{}/r'");
  json = nlohmann::json::parse(read_file(path("r.json")));
  EXPECT_EQ(json.at("pacing")[0].at("controller"), "fixed 0.5");
  for (const auto& frame : json.at("frames"))
    EXPECT_EQ(frame.at("render"), nlohmann::json::parse("[80, 44]"));
}

TEST_F(EndToEnd, TheSameFramesAtFixedScalesBesideTheControllers) {
  render(
      "--scene pan --target-fps 50 --frames 6 --compare-fixed 1,0.5 --out '{}/f.%02d.png' --report '{}/r'");
  const auto pacing = nlohmann::json::parse(read_file(path("r.json"))).at("pacing");
  ASSERT_EQ(pacing.size(), 3u);
  EXPECT_EQ(pacing[0].at("controller"), "predictive");
  EXPECT_EQ(pacing[1].at("controller"), "fixed 1");
  EXPECT_EQ(pacing[2].at("controller"), "fixed 0.5");
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(pacing[1].at("frames")[i].at("render"), nlohmann::json::parse("[160, 90]"));
    EXPECT_EQ(pacing[2].at("frames")[i].at("render"), nlohmann::json::parse("[80, 44]"));
  }
  const std::string text = read_file(path("r.txt"));
  EXPECT_NE(text.find("fixed 0.5"), std::string::npos) << text;
  EXPECT_NE(text.find("speed-up"), std::string::npos) << text;
}

TEST_F(EndToEnd, DetailAndStreaksAreReported) {
  render(
      "--scene particles --target-fps 5 --min-scale 0.3 --max-scale 0.3 --frames 9 --detail-follows "
      "--blur 0.5 --blur-aware --report '{}/r'");
  const auto frames = nlohmann::json::parse(read_file(path("r.json"))).at("pacing")[0].at("frames");
  EXPECT_GT(frames[8].at("detail"), 0) << "at a tenth of the pixels";
  EXPECT_GT(frames[8].at("blur_px"), 0) << "the camera moves";
}

TEST_F(EndToEnd, ACalibrationIsReadBack) {
  const testing::OwnCache cache(path("cache"));
  render("--scene pan --calibrate '{}/costs.json' --truth-seconds 0");
  const auto table = nlohmann::json::parse(read_file(path("costs.json")));
  EXPECT_EQ(table.at("quincunx_cost_table"), 1);
  EXPECT_GE(table.at("entries").size(), 5u) << "nine test points, as far as the ladder has them";
  render("--scene pan --target-fps 50 --frames 4 --calibration '{}/costs.json' --follow-cpu --report '{}/r'");
  EXPECT_NE(read_file(path("r.txt")).find("Pacing"), std::string::npos);

  std::ofstream(path("broken.json")) << R"({"quincunx_cost_table": 2, "entries": []})";
  const ProgramResult broken = run_program(folder_, "-q --target-fps 50 --calibration '{}/broken.json'");
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_NE(broken.err.find("broken.json"), std::string::npos) << broken.err;
  EXPECT_NE(broken.err.find("version"), std::string::npos) << broken.err;
}

TEST_F(EndToEnd, ContactSheetAndJson) {
  const ProgramResult result = run_program(
      folder_, "--output 160x90 --scene pan --frames 5 --json --contact-sheet '{}/sheet.png' 2>/dev/null");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out).at("frames").size(), 5u) << "stdout is JSON and nothing else";
  EXPECT_GT(image("sheet.png").extent.width, 160);
}

TEST_F(EndToEnd, ShutterBlursWhatMoves) {
  render("--scene occluders --truth 4 --out '{}/sharp.exr'");
  render("--scene occluders --truth 4 --shutter 1 --out '{}/blurred.exr'");
  render("--scene chart --truth 4 --out '{}/still.exr'");
  render("--scene chart --truth 4 --shutter 1 --out '{}/still_blurred.exr'");
  EXPECT_NE(image("sharp.exr").pixels, image("blurred.exr").pixels);
  EXPECT_EQ(image("still.exr").pixels, image("still_blurred.exr").pixels) << "nothing moves on the chart";
}

}  // namespace
}  // namespace quincunx

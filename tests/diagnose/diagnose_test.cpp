// SPDX-License-Identifier: MIT
// diagnose(): a stage broken in every way.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "diagnose_stage.h"
#include "tools/record/recorded_frame.h"
#include "tools/record/recorded_settings.h"

namespace quincunx {
namespace {

using testing::DiagnosedFrame;
using testing::DiagnosedInput;
using testing::DiagnoseProgram;
using testing::Diagnosis;
using testing::diagnosis_of;
using testing::Fault;
using testing::Finding;
using testing::finding;
using testing::Frames;
using testing::is_open;
using testing::kInput;
using testing::kNear;
using testing::kOutput;
using testing::kRender;
using testing::Stage;
using testing::Verdict;

TEST(Diagnose, FindsNothingWrongWithWholeFrames) {
  for (const std::uint32_t seed : {1u, 2u}) {
    for (const tools::Jitter jitter :
         {tools::Jitter::kHalton, tools::Jitter::kQuincunx, tools::Jitter::kNone}) {
      for (const float noise : {0.0f, .06f}) {
        const Diagnosis diagnosis =
            diagnosis_of(Stage({.seed = seed, .jitter = jitter, .noise = noise}).frames());
        EXPECT_EQ(testing::named(diagnosis), "none") << seed << " " << tools::name_of(jitter);
        for (const char* subject : {"velocity", "jitter", "depth", "camera", "dilation", "exposure", "cuts"})
          EXPECT_EQ(finding(diagnosis, subject).verdict, Verdict::kRight) << subject << " " << seed;
      }
    }
  }
}

TEST(Diagnose, NamesEveryFault) {
  const Frames textured = Stage({}).frames(), coloured = Stage({.plate = true}).frames();
  EXPECT_EQ(testing::named(diagnosis_of(coloured)), "none");
  for (const char* subject : {"objects", "colour", "picture"})
    EXPECT_EQ(finding(diagnosis_of(coloured), subject).verdict, Verdict::kRight) << subject;
  for (const Fault& fault : testing::faults(kNear)) {
    if (fault.name == "sky: at rest") continue;  // this stage has none
    const bool pixels = fault.name.starts_with("objects") || fault.name.starts_with("colour") ||
                        fault.name.starts_with("picture");
    Frames frames = pixels ? coloured : textured;
    fault.apply(frames);
    DiagnosedInput input = kInput;
    fault.say(input);
    const Diagnosis diagnosis = tools::diagnose(frames, input);
    EXPECT_EQ(testing::named(diagnosis), fault.name);
    EXPECT_TRUE(diagnosis.wrong()) << fault.name;
  }
}

TEST(Diagnose, FindsThinThingsAtRest) {
  const Frames whole = Stage({.plate = true, .rods = true}).frames();
  EXPECT_EQ(testing::named(diagnosis_of(whole)), "none");
  for (const bool zero : {false, true}) {
    Frames frames = whole;
    testing::stop_objects(frames, kNear, zero);
    EXPECT_EQ(testing::named(diagnosis_of(frames)), "objects: at rest") << zero;
  }
}

TEST(Diagnose, NamesFaultsOfMotionByTheCamera) {
  const Frames whole =
      Stage({.textured = false, .noise = .6f}).frames();  // nothing follows from the last frame
  EXPECT_EQ(testing::named(diagnosis_of(whole)), "none");
  EXPECT_EQ(finding(diagnosis_of(whole), "velocity").verdict, Verdict::kRight);
  for (const Fault& fault : testing::faults(kNear)) {
    if (!fault.name.starts_with("velocity: ") || fault.name.ends_with("in it")) continue;
    Frames frames = whole;
    fault.apply(frames);
    EXPECT_EQ(testing::named(diagnosis_of(frames)), fault.name);
  }
}

TEST(Diagnose, NamesFaultsOfMotionByShapes) {
  Frames whole = Stage({.textured = false, .plate = true, .rods = true}).frames();
  for (DiagnosedFrame& frame : whole) {
    std::fill(frame.luminance.begin(), frame.luminance.end(), .3f);  // no light tells of motion
    frame.world_to_ndc.reset();
  }
  EXPECT_EQ(testing::named(diagnosis_of(whole)), "none");
  EXPECT_EQ(finding(diagnosis_of(whole), "velocity").verdict, Verdict::kRight);
  for (const Fault& fault : testing::faults(kNear)) {
    if (fault.name != "velocity: sign of x" && fault.name != "velocity: axes") continue;
    Frames frames = whole;
    fault.apply(frames);
    EXPECT_EQ(testing::named(diagnosis_of(frames)), fault.name);
  }
}

TEST(Diagnose, NamesFaultsOfMotionAndJitterTogether) {
  const Frames whole = Stage({.seed = 2}).frames();
  std::vector<Fault> motions = testing::faults(kNear), jitters = motions;
  std::erase_if(motions, [](const Fault& fault) {
    return !fault.name.starts_with("velocity: ") || fault.name.ends_with("frame") ||
           fault.name.ends_with("in it");
  });
  std::erase_if(jitters, [](const Fault& fault) { return !fault.name.starts_with("jitter: "); });
  ASSERT_EQ(motions.size(), 7u);
  ASSERT_EQ(jitters.size(), 8u);
  for (std::size_t i = 0; i < jitters.size(); ++i) {
    Frames frames = whole;
    const Fault& motion = motions[i % motions.size()];
    motion.apply(frames);
    jitters[i].apply(frames);
    EXPECT_EQ(testing::named(diagnosis_of(frames)), motion.name + " + " + jitters[i].name);
  }
}

TEST(Diagnose, KnowsCamerasAndDepthByTheirFormWhereNothingMoves) {
  Frames whole = Stage({.moves = false}).frames();
  for (DiagnosedFrame& frame : whole)  // a floor, nearer than 1: so may be any kind
    for (std::size_t i = 0; i < frame.depth.size(); ++i)
      frame.depth[i] = 1 / (1.5f + .03f * static_cast<float>(i / kRender.width));
  EXPECT_EQ(testing::named(diagnosis_of(whole)), "none");
  EXPECT_EQ(finding(diagnosis_of(whole), "depth").verdict, Verdict::kRight);
  for (const Fault& fault : testing::faults(kNear)) {
    if (fault.name != "camera: transposed" && fault.name != "depth: kind") continue;
    Frames frames = whole;
    fault.apply(frames);
    EXPECT_EQ(testing::named(diagnosis_of(frames)), fault.name);
  }
}

TEST(Diagnose, SaysWhatItCannotTell) {
  Diagnosis still = diagnosis_of(Stage({.moves = false}).frames());
  EXPECT_EQ(finding(still, "velocity").verdict, Verdict::kUnknown);
  EXPECT_EQ(finding(still, "jitter").verdict, Verdict::kRight);
  EXPECT_EQ(finding(still, "camera").verdict, Verdict::kUnknown);

  const Diagnosis across = diagnosis_of(Stage({.only_across = true}).frames());
  EXPECT_EQ(finding(across, "velocity").verdict, Verdict::kRight);
  EXPECT_TRUE(is_open(finding(across, "velocity"), "sign of y"));
  EXPECT_FALSE(is_open(finding(across, "velocity"), "sign of x"));

  Frames plain = Stage({.textured = false}).frames();
  for (DiagnosedFrame& frame : plain)
    frame.depth.clear();  // whose rims would tell
  const Diagnosis blank = diagnosis_of(plain);
  EXPECT_FALSE(blank.wrong());
  for (const char* subject : {"velocity", "jitter", "exposure", "cuts"})
    EXPECT_EQ(finding(blank, subject).verdict, Verdict::kUnknown) << subject;

  Frames few = Stage({.frames = 1}).frames();
  EXPECT_FALSE(diagnosis_of(few).wrong());
  EXPECT_EQ(finding(diagnosis_of(few), "velocity").verdict, Verdict::kUnknown);
  EXPECT_TRUE(diagnosis_of({}).findings.empty());
  for (DiagnosedFrame& frame : few)
    frame.velocity.clear(), frame.depth.clear(), frame.world_to_ndc.reset();
  EXPECT_FALSE(diagnosis_of(few).wrong());
}

TEST(Diagnose, PassesOverValuesThatAreNotFinite) {
  Frames frames = Stage({}).frames();
  for (DiagnosedFrame& frame : frames) {
    for (std::size_t i = 0; i < frame.luminance.size(); i += 97) {
      frame.luminance[i] = i % 2 == 0 ? NAN : INFINITY;
      frame.velocity[i + 1] = {NAN, -INFINITY};
      frame.depth[i + 2] = i % 2 == 0 ? NAN : INFINITY;
    }
  }
  const Diagnosis diagnosis = diagnosis_of(frames);
  EXPECT_EQ(testing::named(diagnosis), "none");
  EXPECT_EQ(finding(diagnosis, "velocity").verdict, Verdict::kRight);
  EXPECT_EQ(finding(diagnosis, "jitter").verdict, Verdict::kRight);
}

TEST(Diagnose, GivesTheJitterThatFits) {
  const Frames whole = Stage({}).frames();
  Frames frames = whole;
  for (DiagnosedFrame& frame : frames)
    frame.jitter = {-frame.jitter.x, frame.jitter.y};
  const Diagnosis diagnosis = diagnosis_of(frames);
  EXPECT_EQ(diagnosis.jitter.later, 0);
  for (std::size_t i = 0; i < whole.size(); ++i)
    EXPECT_EQ(diagnosis.jitter.of(frames[i].jitter), whole[i].jitter) << i;
}

class DiagnoseRecording : public testing::DiagnoseProgram {
 protected:
  // As an engine gives them that has velocity as nuke does, and linear depth.
  void record(const Frames& frames, const InputConventions& conventions) {
    ResolveSettings settings = {.output_extent = kOutput, .target_extent = kRender};
    settings.method = Method::kTemporal;
    settings.colour = PixelFormat::kRGBA32F;
    settings.velocity = PixelFormat::kRG32F;
    settings.conventions = conventions;
    const auto plan = plan_for({}, settings);
    ASSERT_TRUE(plan.ok()) << plan.status().message();
    const auto image = [](PixelFormat format, const auto& values) {
      const auto bytes = std::as_bytes(std::span(values));
      return tools::RecordedImage{format, {bytes.begin(), bytes.end()}};
    };
    for (const DiagnosedFrame& frame : frames) {
      std::vector<std::array<float, 4>> colour;
      for (const float light : frame.luminance)
        colour.push_back({light, light, light, 1});
      tools::RecordedFrame recorded;
      recorded.inputs.render_extent = kRender;
      recorded.inputs.jitter = frame.jitter;
      recorded.inputs.near_plane = kNear;
      recorded.inputs.frame_index = static_cast<std::uint64_t>(frame.index);
      tools::RecordedPart& part = recorded[tools::FramePart::kPicture];
      part.extent = kRender;
      part.images = {image(PixelFormat::kRGBA32F, colour), image(PixelFormat::kRG32F, frame.velocity),
                     image(PixelFormat::kR32F, frame.depth)};
      if (plan->reads_reactive)
        part.images.push_back(image(PixelFormat::kR8, std::vector<std::uint8_t>(frame.depth.size())));
      const Status status = tools::write_frame(folder_.file("seen"), frame.number, plan.value(), recorded);
      ASSERT_TRUE(status.ok()) << status.message();
    }
    std::ofstream(folder_.file("seen/sequence.json"))
        << tools::to_json({.device = "none", .needs = {}, .settings = settings});
  }
};

TEST_F(DiagnoseProgram, NamesTheOptionThatMends) {
  write(Stage({.frames = 8}).frames());
  EXPECT_EQ(diagnose("").exit_code, 0);
  const std::string channels = "--velocity backward.u,backward.v ";
  auto result = diagnose(channels + "--velocity-convention fsr2");
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_NE(result.out.find("mends it: --velocity-convention nuke"), std::string::npos) << result.out;
  EXPECT_EQ(diagnose(channels + "--velocity-convention nuke").exit_code, 0);

  result = diagnose("--depth-kind device-reversed --method bilinear");
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_NE(result.out.find("mends it: --depth-kind linear"), std::string::npos) << result.out;

  result = diagnose("--drawn-velocity dilated");
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_NE(result.out.find("mends it: --drawn-velocity own"), std::string::npos) << result.out;
}

TEST_F(DiagnoseProgram, JitterInMotionIsMended) {
  Frames frames = Stage({.frames = 9}).frames();
  testing::jitter_into_velocity(frames);
  write(frames);
  auto result = diagnose("");
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_NE(result.out.find("mends it: --velocity-jittered\n"), std::string::npos) << result.out;
  result = diagnose("--velocity-jittered");
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_NE(result.out.find("velocity         right"), std::string::npos) << result.out;

  write(Stage({.frames = 9}).frames());
  result = diagnose("--velocity-jittered");
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_NE(result.out.find("mends it: no --velocity-jittered\n"), std::string::npos) << result.out;
}

TEST_F(DiagnoseRecording, LooksAtRecordings) {
  InputConventions conventions = {.depth = DepthConvention::kLinear,
                                  .velocity_unit = VelocityUnit::kPixels,
                                  .velocity_backward = true,
                                  .velocity_up = true};
  record(Stage({.frames = 7}).frames(), conventions);
  auto result = resolve("'{}/seen' --diagnose");
  EXPECT_EQ(result.exit_code, 0) << result.err << result.out;
  EXPECT_NE(result.out.find("velocity         right"), std::string::npos) << result.out;
  conventions.velocity_up = false;
  record(Stage({.frames = 7}).frames(), conventions);
  result = resolve("'{}/seen' --diagnose");
  EXPECT_EQ(result.exit_code, 3) << result.err << result.out;
  EXPECT_NE(result.out.find("fits: y the other way"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("mends it: conventions.velocity"), std::string::npos) << result.out;
}

TEST_F(DiagnoseProgram, AListingHasALineOfIt) {
  write(Stage({.frames = 8}).frames());
  const std::string listing = "'{}/f.%04d.exr' --out '{}/u.%04d.exr' -n ";
  EXPECT_NE(resolve(listing).out.find("Diagnosis nothing wrong in frames 1 to 5\n"), std::string::npos);
  const auto result = resolve(listing + "--velocity backward.u,backward.v --velocity-convention fsr2");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("Diagnosis velocity sign of y (--velocity-convention nuke)"), std::string::npos)
      << result.out;
  const auto json = nlohmann::json::parse(resolve(listing + "--json").out);
  EXPECT_EQ(json["diagnosis"], "nothing wrong in frames 1 to 5");
}

TEST_F(DiagnoseProgram, ARunSaysWhichWayMotionPointsIfAsked) {
  write(Stage({.frames = 14}).frames());
  const std::string run =
      "'{}/f.%04d.exr' --out '{}/u.%04d.exr' --output 320x180 --velocity backward.u,backward.v ";
  const auto right = resolve(run + "--velocity-convention nuke --check-motion");
  EXPECT_NE(right.out.find("motion check velocity points the right way"), std::string::npos) << right.out;
  const auto turned = resolve(run + "--velocity-convention fsr2 --check-motion");
  EXPECT_NE(turned.out.find("motion check velocity.y seems to point the other way: "), std::string::npos)
      << turned.out;
  EXPECT_EQ(resolve(run + "--velocity-convention fsr2").out.find("motion check"), std::string::npos);
}

TEST_F(DiagnoseProgram, AReportShowsWhere) {
  write(Stage({.frames = 6}).frames());
  const std::string arguments = "--report '{}/seen' --velocity backward.u,backward.v --velocity-convention ";
  EXPECT_EQ(diagnose(arguments + "fsr2").exit_code, 3);
  EXPECT_NE(testing::read_file(folder_.file("seen.txt")).find("fits: y the other way"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(testing::read_file(folder_.file("seen.json")))["wrong"], true);
  const std::string page = testing::read_file(folder_.file("seen.html"));
  const std::string open = "id=\"data\">";
  const std::size_t from = page.find(open) + open.size();
  const auto data = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  EXPECT_EQ(data["diagnosis"]["findings"][0]["fits"], "y the other way");
  ASSERT_EQ(data["pictures"]["frames"].size(), 3u);
  const double worst = data["pictures"]["frames"][0]["mean"];
  EXPECT_GE(worst, data["pictures"]["frames"][2]["mean"].get<double>());
  // The same frames, understood rightly, fail less.
  EXPECT_EQ(diagnose(arguments + "nuke").exit_code, 0);
  const std::string right = testing::read_file(folder_.file("seen.html"));
  const std::size_t begin = right.find(open) + open.size();
  const auto less = nlohmann::json::parse(right.substr(begin, right.find("</script>", begin) - begin));
  EXPECT_LT(less["pictures"]["frames"][0]["mean"].get<double>(), worst / 2);
}

TEST(FailureMaps, LieWhereMotionIsMissing) {
  Frames frames = Stage({.frames = 4, .plate = true}).frames();
  const auto mean_of_wall = [&](const std::vector<tools::FailureMap>& maps) {
    double sum = 0, count = 0;
    for (const tools::FailureMap& map : maps) {
      const DiagnosedFrame& frame = frames[static_cast<std::size_t>(map.number - 1)];
      for (std::size_t i = 0; i < map.error.size(); ++i)
        if (frame.depth[i] == 10) sum += map.error[i], count += 1;
    }
    return sum / count;
  };
  EXPECT_EQ(tools::failure_maps(frames, kInput, 2).size(), 2u);
  EXPECT_TRUE(tools::failure_maps({}, kInput).empty());
  const double whole = mean_of_wall(tools::failure_maps(frames, kInput));
  for (DiagnosedFrame& frame : frames)
    for (std::size_t i = 0; i < frame.velocity.size(); ++i)
      if (frame.depth[i] == 10) frame.velocity[i] = {};
  EXPECT_GT(mean_of_wall(tools::failure_maps(frames, kInput)), 2 * whole);
}

TEST_F(DiagnoseProgram, ItsJsonIsAFileOfJitter) {
  Frames frames = Stage({.frames = 18}).frames();
  for (DiagnosedFrame& frame : frames)
    frame.jitter = {frame.jitter.x, -frame.jitter.y};
  write(frames);
  const auto result = diagnose("--json");  // of 18 frames, it looks at 16
  EXPECT_EQ(result.exit_code, 3) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["wrong"], true);
  EXPECT_EQ(json["findings"][1]["subject"], "jitter");
  EXPECT_EQ(json["findings"][1]["faults"], nlohmann::json({"sign of y"}));
  std::ofstream(folder_.file("mended.json")) << result.out;
  const auto mended = diagnose("--jitter '{}/mended.json'");
  EXPECT_EQ(mended.exit_code, 0) << mended.out;
}

}  // namespace
}  // namespace quincunx

// SPDX-License-Identifier: MIT
// diagnose(): columns before a wall, both textured, under a camera that slides, drawn by one ray a pixel; broken in
// every way.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "diagnose_faults.h"
#include "sequence/sequence_fixture.h"
#include "tools/program/jitter.h"
#include "tools/record/recorded_frame.h"
#include "tools/record/recorded_settings.h"

namespace quincunx {
namespace {

using testing::Fault;
using testing::Frames;
using tools::DiagnosedFrame;
using tools::DiagnosedInput;
using tools::Diagnosis;
using tools::Finding;
using tools::Verdict;

constexpr Extent kRender = {160, 90};
constexpr Extent kOutput = {320, 180};
constexpr float kNear = .1f;

struct Shot {
  int frames = 10;
  std::uint32_t seed = 1;
  bool moves = true;
  bool textured = true;
  bool only_across = false;
  tools::Jitter jitter = tools::Jitter::kHalton;
  float noise = 0;
  bool plate = false;  // coloured; the columns are plain, and so is a plate that moves by itself before them
  bool rods = false;   // in place of the plate, three of little more than a pixel
};

// A smooth pattern with waves from some four pixels on.
float texture(std::uint32_t seed, double x, double y, double finest) {
  double sum = 0;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const double angle = 6.2832 * testing::noise(seed, 1, i), phase = 6.2832 * testing::noise(seed, 2, i);
    const double wave = finest * (1 + 3 * testing::noise(seed, 3, i));
    sum += std::sin(6.2832 / wave * (x * std::cos(angle) + y * std::sin(angle)) + phase);
  }
  return static_cast<float>(.4 + .12 * sum);
}

class Stage {
 public:
  explicit Stage(const Shot& shot) : shot_(shot) {}

  Frames frames() const {
    Frames frames;
    for (int n = 0; n < shot_.frames; ++n)
      frames.push_back(frame(n));
    return frames;
  }

 private:
  static constexpr double kFocal = 1.4;  // half the picture's width, at distance 1
  static constexpr double kWall = 10, kColumns = 5, kPlate = 3;
  static constexpr double kPlateMoves = .2;  // a frame

  // Slides, slower and faster.
  Vec2 camera(int n) const {
    if (!shot_.moves) return {};
    const auto t = static_cast<float>(n);
    return {.11f * t + .06f * std::sin(1.1f * t),
            shot_.only_across ? 0 : .07f * t - .05f * std::cos(.9f * t)};
  }

  // From pixels to places at distance 1, y down, and back.
  static double across(double pixel) { return (pixel - kRender.width / 2.0) / (kFocal * kRender.width / 2); }
  static double down(double pixel) { return (pixel - kRender.height / 2.0) / (kFocal * kRender.width / 2); }
  static double pixels(double distance) { return distance * kFocal * kRender.width / 2; }

  DiagnosedFrame frame(int n) const {
    DiagnosedFrame frame = {.number = n + 1, .index = n, .render = kRender};
    frame.jitter = tools::jitter_of(shot_.jitter, n, kRender, kOutput);
    const Vec2 now = camera(n), before = camera(n - 1);
    for (int y = 0; y < kRender.height; ++y) {
      for (int x = 0; x < kRender.width; ++x) {
        const double u = across(x + .5 + frame.jitter.x), v = down(y + .5 + frame.jitter.y);
        const bool column = std::sin(2.2 * (u * kColumns + now.x)) > .3;
        const double plate_x = u * kPlate + now.x - kPlateMoves * n + 1.5;
        const bool within = shot_.rods ? plate_x < 2.1 && std::fmod(plate_x, .7) < .032 : plate_x < 1.2;
        const bool plate = shot_.plate && plate_x > 0 && within && std::abs(v) < .3;
        const double z = plate ? kPlate : column ? kColumns : kWall;
        const double size = z / pixels(1);  // of a pixel there
        float light = .3f;
        if (shot_.plate && (plate || column)) {
          light = plate ? .9f : .05f;
        } else if (shot_.textured)
          light = texture(shot_.seed + (column ? 7 : 0), u * z + now.x, v * z + now.y, 4 * size);
        light += shot_.noise * (testing::noise(static_cast<std::uint32_t>(n), 5,
                                               static_cast<std::uint32_t>(y * kRender.width + x)) -
                                .5f);
        frame.luminance.push_back(std::max(light, 0.0f));
        if (shot_.plate) {
          const float blue = std::clamp(light, 0.0f, 1.0f);
          frame.colour.push_back({.9f - .8f * blue, blue, blue});
          frame.luminance.back() = .2126f * (.9f - .8f * blue) + .7874f * blue;
        }
        frame.depth.push_back(static_cast<float>(z));
        // Things move against the camera. As nuke has it: previous - this place, v up.
        const double own = plate ? kPlateMoves : 0;
        frame.velocity.push_back({static_cast<float>(pixels((now.x - before.x - own) / z)),
                                  static_cast<float>(-pixels((now.y - before.y) / z))});
      }
    }
    const auto focal = static_cast<float>(kFocal);
    const float tall = focal * kRender.width / kRender.height;
    frame.world_to_ndc =
        tools::Matrix{focal, 0, 0, 0, 0, -tall, 0, 0, 0, 0, 0, 1, -focal * now.x, tall * now.y, kNear, 0};
    return frame;
  }

  Shot shot_;
};

const DiagnosedInput kInput = {.near_plane = kNear, .output = kOutput};

Diagnosis diagnosis_of(const Frames& frames) {
  return tools::diagnose(frames, kInput);
}

const Finding& finding(const Diagnosis& diagnosis, const std::string& subject) {
  static const Finding kMissing;
  for (const Finding& one : diagnosis.findings)
    if (one.subject == subject) return one;
  ADD_FAILURE() << "no finding about " << subject;
  return kMissing;
}

bool is_open(const Finding& one, const std::string& fault) {
  return std::find(one.open.begin(), one.open.end(), fault) != one.open.end();
}

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

class DiagnoseProgram : public testing::SequenceTest {
 protected:
  void write(const Frames& frames) {
    for (const DiagnosedFrame& frame : frames) {
      std::vector<tools::Channel> channels;
      const auto add = [&](const char* name, const float* data, std::size_t stride) {
        channels.push_back({.name = name,
                            .type = tools::ChannelType::kFloat,
                            .data = data,
                            .pixel_stride = stride,
                            .row_stride = stride * kRender.width,
                            .stored = tools::ChannelType::kFloat});
      };
      for (const char* name : {"R", "G", "B"})
        add(name, frame.luminance.data(), sizeof(float));
      add("backward.u", &frame.velocity[0].x, sizeof(Vec2));
      add("backward.v", &frame.velocity[0].y, sizeof(Vec2));
      add("Z", frame.depth.data(), sizeof(float));
      const std::vector<tools::Attribute> attributes = {
          {"quincunx:jitter", frame.jitter},
          {"quincunx:outputSize",
           Vec2{static_cast<float>(kOutput.width), static_cast<float>(kOutput.height)}},
          {"quincunx:near", kNear},
          {"worldToNDC", *frame.world_to_ndc}};
      const Status status =
          tools::write_exr(input(static_cast<int>(frame.number)), kRender, channels, attributes);
      ASSERT_TRUE(status.ok()) << status.message();
    }
  }

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

  testing::ProgramResult diagnose(const std::string& arguments) {
    return resolve("'{}/f.%04d.exr' --diagnose " + arguments);
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

TEST_F(DiagnoseProgram, LooksAtRecordings) {
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

// SPDX-License-Identifier: MIT
// Whole runs: what goes in at one end comes out at the other, however the work is split.
#include <cmath>
#include <nlohmann/json.hpp>

#include "quincunx/resolve_service.h"
#include "sequence_fixture.h"

namespace quincunx {
namespace {

class Run : public testing::SequenceTest {
 protected:
  // Frames first to last of `a` and `b` are the same files, byte for byte.
  void expect_same(const std::string& a, const std::string& b, int first, int last) {
    for (int number = first; number <= last; ++number) {
      const std::string bytes = testing::read_file(output(number, a));
      ASSERT_FALSE(bytes.empty()) << a << number;
      EXPECT_TRUE(bytes == testing::read_file(output(number, b))) << a << " " << b << " " << number;
    }
  }

  // All that moves is the camera, which stands at `place` on the x axis.
  static testing::FrameFile frame_of_camera(int number, float place) {
    testing::FrameFile file = frame(number);
    file.velocity = false;
    file.depth = true;
    tools::Matrix matrix = {};
    matrix[0] = matrix[5] = matrix[10] = 1;
    matrix[11] = -1;
    matrix[12] = place;
    file.attributes.push_back({"worldToNDC", matrix});
    return file;
  }

  std::vector<float> channel(const std::string& path, const std::string& name) const {
    const tools::LoadedImage picture = image(path);
    std::vector<float> values;
    for (int y = 0; y < picture.extent.height; ++y) {
      for (int x = 0; x < picture.extent.width; ++x)
        values.push_back(picture.at(x, y, picture.channel(name)));
    }
    return values;
  }
};

// Bilinear at scale 1 without jitter is the identity, so a file must pass through.
TEST_F(Run, HalfColourComesThroughBitForBit) {
  testing::FrameFile file = frame(1);
  file.extent = {37, 21};
  file.attributes.clear();
  write_frame(input(1), file);
  for (const char* store : {"half", "float"}) {
    resolve_to("u", fmt::format("--output 37x21 --method bilinear --store {}", store));
    const tools::LoadedImage got = image(output(1));
    EXPECT_EQ(got.stored[0],
              std::string(store) == "half" ? tools::ChannelType::kHalf : tools::ChannelType::kFloat);
    for (const char* name : {"R", "G", "B", "A"})
      EXPECT_EQ(channel(output(1), name), channel(input(1), name)) << name << " " << store;
  }
}

// The program against the library, fed by hand: two frames of different sizes, motion as Nuke has it,
// reactive values and jitter.
TEST_F(Run, TheProgramGivesWhatTheServiceGives) {
  testing::FrameFile files[2];
  for (int i = 0; i < 2; ++i) {
    files[i] = frame(i + 1);
    files[i].extent = {24 + 3 * i, 14 - i};
    files[i].reactive = true;
    write_frame(input(i + 1), files[i]);
  }
  resolve_to("u", "--store float");

  const Device device = Device::open().value();
  ResolveSettings settings;
  settings.method = Method::kQuincunx;
  settings.output_extent = kOutput;
  settings.target_extent = {27, 14};
  settings.velocity = PixelFormat::kRG32F;
  settings.colour = PixelFormat::kRGBA32F;
  settings.output.present = false;
  auto service = ResolveService::create(device, plan_for({.camera_motion = false}, settings).value());
  ASSERT_TRUE(service.ok()) << service.status().message();
  const Image resolved = std::move(device.allocate(kOutput, settings.output.linear)).value();
  std::vector<Image> images;
  for (int i = 0; i < 2; ++i) {
    const tools::LoadedImage file = image(input(i + 1));
    std::vector<float> colour;
    std::vector<float> velocity;
    std::vector<std::uint8_t> reactive;
    for (int y = 0; y < file.extent.height; ++y) {
      for (int x = 0; x < file.extent.width; ++x) {
        for (const char* name : {"R", "G", "B", "A"})
          colour.push_back(file.at(x, y, file.channel(name)));
        velocity.push_back(-file.at(x, y, file.channel("backward.u")) /
                           static_cast<float>(file.extent.width));
        velocity.push_back(file.at(x, y, file.channel("backward.v")) /
                           static_cast<float>(file.extent.height));
        reactive.push_back(
            static_cast<std::uint8_t>(std::lround(file.at(x, y, file.channel("reactive.mask")) * 255)));
      }
    }
    FrameInputs inputs;
    const auto upload = [&](PixelFormat format, const void* texels) {
      images.push_back(std::move(device.allocate(file.extent, format)).value());
      EXPECT_TRUE(device.upload(images.back().view(), file.extent, texels).ok());
      return images.back().view();
    };
    inputs.colour = upload(PixelFormat::kRGBA32F, colour.data());
    inputs.velocity = upload(PixelFormat::kRG32F, velocity.data());
    inputs.reactive = upload(PixelFormat::kR8, reactive.data());
    inputs.render_extent = file.extent;
    inputs.jitter = testing::quincunx_jitter(i + 1);
    const FrameReport report = service->dispatch(inputs, {.linear = resolved.view()});
    ASSERT_TRUE(report.ok()) << report.status.message();
    EXPECT_EQ(report.used_previous, i == 1);
    std::vector<float> pixels(kOutput.area() * 4);
    ASSERT_TRUE(device.download(resolved.view(), kOutput, pixels.data()).ok());
    const std::vector<float> red = channel(output(i + 1), "R");
    for (std::size_t p = 0; p < red.size(); ++p)
      ASSERT_EQ(red[p], pixels[4 * p]) << "frame " << i + 1 << " pixel " << p;
  }
}

// Powers of two, so that every convention's numbers are exact.
TEST_F(Run, ConventionsOfMotionAgreeBitForBit) {
  const Extent extent{16, 8};
  const struct {
    const char* name;
    const char* options;
    float x, y;  // what turns nuke's numbers into this convention's
  } cases[] = {{"nuke", "--velocity m.u,m.v --velocity-convention nuke", 1, 1},
               {"blender", "--velocity m.u,m.v --velocity-convention blender", 1, 1},
               {"fsr2", "--velocity m.u,m.v --velocity-convention fsr2", 1, -1},
               {"ndc", "--velocity m.u,m.v --velocity-convention ndc", -2.0f / 16, -2.0f / 8},
               {"scale", "--velocity m.u,m.v --velocity-scale=-0.0625,0.125", 1, 1}};
  for (const auto& one : cases) {
    for (int number = 1; number <= 3; ++number) {
      std::vector<std::vector<float>> planes;
      std::vector<tools::Channel> channels;
      testing::FrameFile file;
      file.extent = extent;
      file.seed = static_cast<std::uint32_t>(number);
      for (std::uint32_t c = 0; c < 5; ++c) {
        planes.push_back(plane(file, c, 4, -2));
        for (float& value : planes.back())
          value = std::round(value * 64) / 64 * (c == 3 ? one.x : c == 4 ? one.y : 1);
        const char* names[] = {"R", "G", "B", "m.u", "m.v"};
        channels.push_back(
            {.name = names[c], .type = tools::ChannelType::kFloat, .stored = tools::ChannelType::kFloat});
      }
      for (std::size_t c = 0; c < 5; ++c)
        channels[c].data = planes[c].data();
      ASSERT_TRUE(tools::write_exr(input(number), extent, channels).ok());
    }
    resolve_to(one.name, fmt::format("--output 20x10 --jitter quincunx --store float {}", one.options));
  }
  for (const auto& one : cases) {
    for (int number = 1; number <= 3; ++number) {
      for (const char* name : {"R", "G", "B"})
        EXPECT_EQ(channel(output(number, one.name), name), channel(output(number, "nuke"), name)) << one.name;
    }
  }
  // And motion matters at all.
  resolve_to("none", "--output 20x10 --jitter quincunx --store float --velocity none --method quincunx");
  EXPECT_NE(channel(output(3, "none"), "R"), channel(output(3, "nuke"), "R"));
}

TEST_F(Run, TheSameRunMakesTheSameBytes) {
  write_frames(1, 4);
  resolve_to("a", "");
  resolve_to("b", "--threads 1");
  resolve_to("c", "--threads 7");
  expect_same("a", "b", 1, 4);
  expect_same("a", "c", 1, 4);
}

// A render farm's chunks, with resolutions that change from frame to frame and a cut within.
TEST_F(Run, ChunksAreTheWhole) {
  for (int number = 1; number <= 12; ++number) {
    testing::FrameFile file = frame(number);
    file.extent = {20 + number * 7 % 11, 12 + number * 5 % 7};
    if (number == 8) file.attributes.push_back({"quincunx:reset", 1});
    write_frame(input(number), file);
  }
  resolve_to("whole", "");
  for (const char* range : {"1-4", "5-8", "9-12"})
    resolve_to("chunk", fmt::format("--frames {}", range));
  expect_same("whole", "chunk", 1, 12);
  for (const char* range : {"1-5", "6-7", "8-12"})
    resolve_to("warm", fmt::format("--frames {} --warm-up 32", range));
  expect_same("whole", "warm", 1, 12);
  resolve_to("odd", "--frames 1-12x2");
  for (int number = 1; number <= 12; number += 2)
    expect_same("whole", "odd", number, number);
  EXPECT_FALSE(std::filesystem::exists(output(2, "odd")));
}

// Without history a chunk's first frame is another, so the tests above can fail.
TEST_F(Run, ColdChunksAndCutsHaveNoHistory) {
  write_frames(1, 4);
  resolve_to("whole", "");
  resolve_to("cold", "--frames 3-4 --warm-up 0");
  EXPECT_NE(channel(output(3, "whole"), "G"), channel(output(3, "cold"), "G"));
  EXPECT_EQ(channel(output(4, "whole"), "G"), channel(output(4, "cold"), "G"));
  testing::FrameFile cut = frame(3);
  cut.attributes.push_back({"quincunx:reset", 1});
  resolve_to("said", "--cuts 3");  // of frames that do not say so themselves
  write_frame(input(3), cut);
  resolve_to("cut", "");
  for (int number = 3; number <= 4; ++number) {
    EXPECT_EQ(channel(output(number, "cut"), "G"), channel(output(number, "cold"), "G")) << number;
    EXPECT_EQ(channel(output(number, "said"), "G"), channel(output(number, "cold"), "G")) << number;
  }
}

TEST_F(Run, JitterOfAFileIsThatOfAttributes) {
  write_frames(1, 4);
  std::ofstream(folder_.file("jitter.txt")) << "1 .25 .25\n2 -.25 -.25\n3 .25 .25\n4 -.25 -.25\n";
  resolve_to("attribute", "--jitter attribute");
  resolve_to("pattern", "--jitter quincunx");
  resolve_to("file", fmt::format("--jitter '{}'", folder_.file("jitter.txt")));
  resolve_to("none", "--jitter none --method quincunx");
  for (int number = 1; number <= 4; ++number) {
    EXPECT_EQ(channel(output(number, "attribute"), "G"), channel(output(number, "pattern"), "G"));
    EXPECT_EQ(channel(output(number, "attribute"), "G"), channel(output(number, "file"), "G"));
    EXPECT_NE(channel(output(number, "attribute"), "G"), channel(output(number, "none"), "G"));
  }
}

// With a sky alone, all motion is that which the camera gives to points infinitely far away.
TEST_F(Run, FarMotionFromTheCameraMovesASky) {
  for (int number = 1; number <= 3; ++number) {
    testing::FrameFile file = frame_of_camera(number, 0);
    std::get<tools::Matrix>(file.attributes.back().value)[8] =
        static_cast<float>(number * number) * .01f;  // a pan
    file.velocity = file.sky = true;
    write_frame(input(number), file);
  }
  for (const char* method : {"quincunx", "quincunx:reprojected", "temporal"}) {
    resolve_to("camera", fmt::format("--method {} --velocity camera --two-way 0", method));
    resolve_to("far", fmt::format("--method {} --sky-motion camera", method));
    resolve_to("drawn", fmt::format("--method {}", method));
    for (int number = 1; number <= 3; ++number)
      EXPECT_EQ(channel(output(number, "camera"), "R"), channel(output(number, "far"), "R"))
          << method << number;
    EXPECT_NE(channel(output(3, "far"), "R"), channel(output(3, "drawn"), "R")) << method;
  }
}

// Still cameras say the same as no motion; a moving one takes the other frame away.
TEST_F(Run, CameraMotionComesFromDepthAndMatrices) {
  for (const auto& [number, place] : {std::pair{1, 0.0f}, {2, 0.0f}, {3, 2.0f}})
    write_frame(input(number), frame_of_camera(number, place));
  resolve_to("camera", "--velocity camera --method quincunx");
  resolve_to("still", "--velocity none --method quincunx");
  EXPECT_EQ(channel(output(2, "camera"), "R"), channel(output(2, "still"), "R"));
  EXPECT_NE(channel(output(3, "camera"), "R"), channel(output(3, "still"), "R"));
}

// The camera's motion is that since the frame before, so even a method of one frame has a history here.
TEST_F(Run, BlurOfAMovingCameraIsTheSameInChunks) {
  for (const auto& [number, place] : {std::pair{1, 0.0f}, {2, 2.0f}, {3, 5.0f}, {4, 9.0f}})
    write_frame(input(number), frame_of_camera(number, place));
  const std::string blur = "--velocity camera --method bilinear --blur 1";
  resolve_to("whole", blur);
  for (const char* range : {"1-2", "3", "4"})
    resolve_to("chunk", fmt::format("{} --frames {}", blur, range));
  expect_same("whole", "chunk", 1, 4);
  resolve_to("sharp", "--velocity camera --method bilinear");
  EXPECT_EQ(channel(output(1, "whole"), "R"), channel(output(1, "sharp"), "R")) << "no frame is before it";
  EXPECT_NE(channel(output(3, "whole"), "R"), channel(output(3, "sharp"), "R"));

  testing::FrameFile cut = frame_of_camera(3, 5);
  cut.attributes.push_back({"quincunx:reset", 1});
  write_frame(input(3), cut);
  resolve_to("cut", blur);
  EXPECT_EQ(channel(output(3, "cut"), "R"), channel(output(3, "sharp"), "R"))
      << "the camera did not fly there";
}

TEST_F(Run, BlurIsOfTheLinearPicture) {
  for (int number = 1; number <= 2; ++number) {
    testing::FrameFile file = frame(number);
    file.depth = true;
    write_frame(input(number), file);
  }
  resolve_to("sharp", "");
  resolve_to("blurred", "--blur 2 --blur-samples 16");
  EXPECT_NE(channel(output(2, "blurred"), "R"), channel(output(2, "sharp"), "R"));
  const auto result = resolve("'{}/f.%04d.exr' --out '{}/n.%04d.exr' --velocity none --blur 1");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("nothing is blurred"), std::string::npos) << result.err;
}

TEST_F(Run, SharpeningIsOfTheLinearPictureAndNamedInIt) {
  write_frames(1, 2);
  resolve_to("plain", "");
  resolve_to("off", "--sharpen 0");
  resolve_to("sharp", "--sharpen 0.5");
  EXPECT_EQ(channel(output(2, "off"), "R"), channel(output(2, "plain"), "R"));
  EXPECT_NE(channel(output(2, "sharp"), "R"), channel(output(2, "plain"), "R"));
  const std::string how =
      std::get<std::string>(image(output(2, "sharp")).attribute("quincunx:resolve")->value);
  EXPECT_NE(how.find("sharpness 0.5"), std::string::npos) << how;
}

TEST_F(Run, AttributesOfTheResultSayWhatItIs) {
  testing::FrameFile file = frame(7);
  file.attributes.push_back({"framesPerSecond", tools::Rational{24, 1}});
  write_frame(input(7), file);
  resolve_to("u", "");
  const tools::LoadedImage made = image(output(7));
  EXPECT_EQ(made.extent, kOutput);
  EXPECT_EQ(std::get<int>(made.attribute("quincunx:frameIndex")->value), 7);
  EXPECT_TRUE(made.attribute("framesPerSecond")->value == tools::AttributeValue(tools::Rational{24, 1}));
  const std::string how = std::get<std::string>(made.attribute("quincunx:resolve")->value);
  EXPECT_NE(how.find("output 34x20"), std::string::npos) << how;
  EXPECT_NE(how.find("velocity backward.u,backward.v nuke"), std::string::npos) << how;
  EXPECT_EQ(made.attribute("quincunx:jitter"), nullptr);
}

TEST_F(Run, PngIsPresented) {
  write_frames(1, 2);
  const auto result = resolve("'{}/f.%04d.exr' --out '{}/u.%04d.png' --tone-map clamp --exposure 0.5 -q");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const tools::LoadedImage picture = image(folder_.file("u.0002.png"));
  EXPECT_EQ(picture.extent, kOutput);
  EXPECT_EQ(picture.channels.size(), 3u);
  EXPECT_FALSE(std::filesystem::exists(output(2)));
}

TEST_F(Run, ScoresAgainstTruth) {
  write_frames(1, 5);
  resolve_to("t", "--store float");
  std::filesystem::remove(output(2, "t"));
  const auto result = resolve("'{}/f.%04d.exr' --truth '{}/t.%04d.exr' --json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  const auto& frames = json["scores"]["frames"];
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_TRUE(frames[0]["psnr_linear"].is_null());  // infinite: the truth is the result
  EXPECT_EQ(frames[0]["ssim"], 1.0);
  EXPECT_EQ(frames[0]["flip"], 0.0);
  EXPECT_TRUE(frames[1]["flicker"].is_null());  // frame 3: 2 has no truth
  EXPECT_EQ(frames[2]["flicker"], 0.0);
  EXPECT_EQ(files(), 5 + 4);
  const auto other = resolve("'{}/f.%04d.exr' --truth '{}/t.%04d.exr' --method point");
  EXPECT_NE(other.out.find("PSNR-tm"), std::string::npos);
  EXPECT_NE(other.out.find("mean"), std::string::npos);
}

TEST_F(Run, ADryRunSaysAllAndDoesNothing) {
  write_frames(1, 4);
  write_frames(6, 8);
  const auto result = resolve("'{}/f.%04d.exr' --out '{}/o/u.%04d.exr' --frames 3-8 -n");
  EXPECT_EQ(result.exit_code, 1);
  for (const char* part : {"Make      6 frames: 3-8", "7 frames: 2-8", "1 frame: 2 (only as history)",
                           "frame 5 is missing", "34x20", "quincunx:velocity"}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << "\n" << result.out;
  }
  EXPECT_EQ(files(), 7);
  const auto good = resolve("'{}/f.%04d.exr' --out '{}/o/u.%04d.exr' --frames 6-8 --warm-up 0 -n --json");
  EXPECT_EQ(good.exit_code, 0) << good.err;
  const auto json = nlohmann::json::parse(good.out);
  EXPECT_EQ(json["make"], nlohmann::json({6, 7, 8}));
  EXPECT_EQ(json["problems"], nlohmann::json::array());
  const auto verbose = resolve("'{}/f.%04d.exr' --out '{}/o/u.%04d.exr' --frames 7 -n -v");
  EXPECT_NE(verbose.out.find(input(7) + " 24x14 -> "), std::string::npos) << verbose.out;
}

TEST_F(Run, ExplainPrintsThePlan) {
  write_frames(1, 2);
  const auto two = resolve("'{}/f.%04d.exr' --explain");
  EXPECT_EQ(two.exit_code, 0) << two.err;
  EXPECT_NE(two.out.find("resolve_quincunx"), std::string::npos);
  EXPECT_NE(two.out.find("transparents no"), std::string::npos) << two.out;
  EXPECT_NE(two.out.find("Profile        "), std::string::npos) << two.out;
  const auto one = resolve("'{}/f.%04d.exr' --explain --method bilinear");
  EXPECT_EQ(one.out.find("resolve_quincunx"), std::string::npos);
}

TEST_F(Run, TheReportSaysWhatItCost) {
  write_frames(1, 3);
  const auto result = resolve("'{}/f.%04d.exr' --out '{}/u.%04d.exr' --json --report '{}/r/run'");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["method"], "quincunx:velocity");
  EXPECT_EQ(json["frames"].size(), 3u);
  EXPECT_EQ(json["frames"][0]["used_previous"], false);
  EXPECT_EQ(json["frames"][2]["used_previous"], true);
  for (const char* what : {"reading", "resolving", "writing"})
    EXPECT_GT(json["busy_seconds"][what], 0.0) << what;
  EXPECT_EQ(nlohmann::json::parse(testing::read_file(folder_.file("r/run.json"))), json);
  EXPECT_NE(testing::read_file(folder_.file("r/run.txt")).find("Overlap"), std::string::npos);
  EXPECT_NE(testing::read_file(folder_.file("r/run.html")).find("\"pictures\":null"), std::string::npos);
}

// From seven frames with a truth the page keeps six at most, each with its maps; the maps of ghosts where motion is
// read.
TEST_F(Run, ThePageHasFramesBesideTheirTruth) {
  write_frames(1, 7);
  resolve_to("t", "--method bilinear --store float");
  const auto pictures = [&](const std::string& method) {
    const auto result =
        resolve("'{}/f.%04d.exr' --truth '{}/t.%04d.exr' -q --report '{}/r' --method " + method);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::string page = testing::read_file(folder_.file("r.html"));
    const std::size_t begin = page.find("{\"run\":");
    return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin))["pictures"];
  };
  const auto two_frames = pictures("quincunx");
  EXPECT_EQ(two_frames["kinds"].size(), 5u);
  ASSERT_EQ(two_frames["frames"].size(), 6u);
  EXPECT_EQ(two_frames["frames"][5]["index"], 7);
  EXPECT_EQ(two_frames["frames"][5]["pngs"].size(), 5u);
  EXPECT_EQ(two_frames["width"], kOutput.width);
  EXPECT_EQ(pictures("bilinear")["kinds"].size(), 4u);
}

// A frame's smallest large buffer is its half colour; a run that kept one of any kind for each frame would
// grow by that much. Half of it leaves room for what the allocator does with the same buffers in another
// order.
TEST_F(Run, MemoryDoesNotGrowWithTheLength) {
  constexpr int kShort = 12;
  constexpr int kLong = 72;
  constexpr Extent kExtent = {320, 180};
  testing::FrameFile first = frame(1);
  first.extent = kExtent;
  write_frame(input(1), first);
  for (int number = 2; number <= kLong; ++number)
    std::filesystem::create_hard_link(input(1), input(number));
  const auto peak = [&](int count) {
    const auto result =
        resolve(fmt::format("'{}' --out '{}' --output 640x360 --method quincunx --frames 1-{} --json",
                            folder_.file("f.%04d.exr"), folder_.file("u.%04d.exr"), count));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out)["peak_memory_bytes"].get<double>();
  };
  const double growth = peak(kLong) - peak(kShort);
  constexpr double kPerFrame = kExtent.width * kExtent.height * 8;
  EXPECT_LT(growth, (kLong - kShort) * kPerFrame / 2);
}

}  // namespace
}  // namespace quincunx

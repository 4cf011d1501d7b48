// SPDX-License-Identifier: MIT
// What other programs' files say of motion, depth, camera, numbers and shape: a frame is the same however it is said.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>

#include <cmath>
#include <functional>

#include "parsed_options.h"
#include "sequence_fixture.h"
#include "tools/program/jitter.h"
#include "tools/sequence/resolve_task.h"
#include "tools/sequence/sequence_output.h"
#include "tools/sequence/sequence_reader.h"

namespace quincunx {
namespace {

using tools::CameraSense;
using tools::Matrix;
using tools::SequenceFormat;
using tools::SequenceFrame;
using Attributes = std::vector<tools::Attribute>;
using Planes = std::vector<std::vector<float>>;  // R, G, B, u, v, Z

constexpr Extent kRender = {24, 14};

class Conventions : public testing::SequenceTest {
 protected:
  using Change = std::function<void(Planes&, Attributes&)>;

  // Motion of -2 to 2 pixels at distances of 1 to 9.
  void write(const std::string& path, const Change& change) {
    Planes planes(6);
    for (std::uint32_t p = 0; p < 6; ++p)
      for (int i = 0; i < kRender.width * kRender.height; ++i) {
        const float value = testing::noise(1, p, static_cast<std::uint32_t>(i));
        planes[p].push_back(p < 3 ? value : p < 5 ? 4 * value - 2 : 1 + 8 * value);
      }
    Attributes attributes;
    change(planes, attributes);
    std::vector<tools::Channel> channels;
    for (const char* name : {"R", "G", "B", "backward.u", "backward.v", "Z"})
      channels.push_back({.name = name,
                          .type = tools::ChannelType::kFloat,
                          .data = planes[channels.size()].data(),
                          .stored = tools::ChannelType::kFloat});
    const Status status = tools::write_exr(path, kRender, channels, attributes);
    ASSERT_TRUE(status.ok()) << status.message();
  }

  // Frame 1 under these options.
  SequenceFrame read(const std::string& words = "") {
    tools::ResolveOptions options = testing::parsed_options("--output 34x20 " + words);
    options.sequence.jitter = tools::JitterSource::parse(options.jitter).value();
    const auto reader = tools::ImageReader::open(input(1));
    EXPECT_TRUE(reader.ok());
    const auto attributes = tools::frame_attributes(input(1), reader->header());
    EXPECT_TRUE(attributes.ok()) << attributes.status().message();
    auto format = tools::settle(options.sequence, input(1), reader->header(), attributes.value());
    EXPECT_TRUE(format.ok()) << format.status().message();
    format_ = std::move(format).value();
    SequenceFrame frame;
    const float aspect = reader->header().parts[0].pixel_aspect;
    const Status status =
        tools::read_frame(input(1), format_, {.number = 1, .render = kRender, .pixel_aspect = aspect},
                          PixelFormat::kRGBA32F, frame);
    EXPECT_TRUE(status.ok()) << status.message();
    return frame;
  }

  SequenceFrame read_of(const Change& change, const std::string& words = "") {
    write(input(1), change);
    return read(words);
  }

  static void unchanged(Planes&, Attributes&) {}

  SequenceFormat format_;  // of the last frame that was read
};

template <typename Value>
void expect_near(std::span<const Value> a, std::span<const Value> b) {
  const auto *x = reinterpret_cast<const float*>(a.data()), *y = reinterpret_cast<const float*>(b.data());
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size_bytes() / sizeof(float); ++i)
    ASSERT_NEAR(x[i], y[i], 1e-6f * std::max(std::abs(y[i]), 1.f)) << i;  // some roundings
}

std::span<const Vec2> velocity(const SequenceFrame& frame) {
  return frame.velocity();
}
std::span<const float> depth(const SequenceFrame& frame) {
  return frame.depth();
}

TEST_F(Conventions, MotionAboutTheMiddle) {
  const SequenceFrame wanted = read_of(unchanged);
  write(input(1), [](Planes& planes, Attributes&) {
    for (const std::size_t p : {3, 4})
      for (float& v : planes[p])
        v = .5f + v / 32;
  });
  const std::string scale = fmt::format("--velocity-scale {:.9g},{:.9g} ", -32.f / 24, 32.f / 14);
  for (const char* offset : {"--velocity-offset .5", "--velocity-offset .5,.5"})
    expect_near(velocity(read(scale + offset)), velocity(wanted));
  EXPECT_NE(tools::summary_of(format_).find("about 0.5,0.5"), std::string::npos);
  expect_refused("'{}/f.%04d.exr' -n --velocity-offset 1,a", 2, "'a' is no number");
  expect_refused("'{}/f.%04d.exr' -n --velocity none --velocity-offset 1", 2, "does nothing here");
}

TEST_F(Conventions, DepthOfAnotherSignUnitAndRange) {
  const SequenceFrame linear = read_of(unchanged), device = read("--near 1 --depth-kind linear");
  const auto read_as = [&](float (*change)(float), const std::string& words) {
    return read_of(
        [change](Planes& planes, Attributes&) {
          for (float& z : planes[5])
            z = change(z);
        },
        words);
  };
  const SequenceFrame negative = read_as([](float z) { return -z; }, "");
  EXPECT_TRUE(negative.negative_depth);
  tools::SequenceWatch watch(ResolvePlan{}, 1);
  EXPECT_NE(watch.see(negative, true).at(0).find("depth is negative in most pixels of frame 1"),
            std::string::npos);
  EXPECT_TRUE(watch.see(negative, true).empty());  // once
  const SequenceFrame mended = read("--depth-range 0,-1");
  EXPECT_FALSE(mended.negative_depth);
  expect_near(depth(mended), depth(linear));
  expect_near(depth(read_as([](float z) { return 1 - z / 16; }, "--depth-range 16,0")), depth(linear));
  expect_near(depth(read_as([](float z) { return z * 1000; }, "--depth-range 0,.001")), depth(linear));
  expect_near(
      depth(read_as([](float z) { return -1 / z; }, "--depth-range 0,-1 --depth-kind device-reversed")),
      depth(device));
  expect_near(depth(read_as([](float z) { return 1 - 2 / z; }, "--depth-range .5,1 --depth-kind device")),
              depth(device));
  expect_refused("'{}/f.%04d.exr' -n --depth-range 1,1", 2, "leaves no depth");
}

// For row vectors, to -1 to 1, +y up.
Matrix with_lens(float place) {
  return {1.5f, 0, 0, 0, 0, 2.5f, 0, 0, 0, 0, 1, -1, place, 0, 0, 0};
}
Matrix orthographic(float place, float turn) {
  return {.5f, 0, 0, 0, 0, .75f, 0, 0, turn, 0, -.1f, 0, -place, .25f, 0, 1};
}

TEST_F(Conventions, CamerasOfEverySense) {
  const Matrix screen = with_lens(.25f);
  const auto with_matrix = [](const Matrix& m) {
    return [m](Planes&, Attributes& attributes) { attributes.push_back({"worldToNDC", m}); };
  };
  for (const char* name : {"screen", "openexr", "screen,flipped", "openexr,flipped", "openexr,transposed"}) {
    const CameraSense sense = tools::camera_sense_named(name).value();
    EXPECT_EQ(tools::text_of(sense), name);
    Matrix m = screen;
    for (std::size_t row = 0; row < 16; row += 4) {
      if (sense.flipped) m[row + 1] = -m[row + 1];
      if (sense.unit) m[row] = (m[row] + m[row + 3]) / 2, m[row + 1] = (m[row + 3] - m[row + 1]) / 2;
    }
    if (sense.transposed) m = tools::transposed(m);
    EXPECT_EQ(read_of(with_matrix(m), std::string("--world-to-ndc ") + name).world_to_ndc, screen) << name;
    // A matrix shows all but which way is up.
    EXPECT_EQ(read("").world_to_ndc == screen, !sense.flipped) << name;
  }
  EXPECT_NE(tools::summary_of(format_).find("worldToNDC openexr,transposed"), std::string::npos);
  expect_refused("'{}/f.%04d.exr' -n --world-to-ndc ndc", 2, "write screen or openexr");
}

TEST_F(Conventions, MatricesOfDoubles) {
  const Matrix m = with_lens(.25f);
  Imf::Header header(1, 1);
  Imath::M44d matrix;
  std::copy(m.begin(), m.end(), matrix.getValue());
  header.insert("worldToNDC", Imf::M44dAttribute(matrix));
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  float value = 1;
  Imf::FrameBuffer buffer;
  buffer.insert("R", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&value), 4, 4));
  {
    Imf::OutputFile file(input(1).c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(1);
  }
  const auto attributes = tools::frame_attributes(input(1), tools::ImageReader::open(input(1))->header());
  ASSERT_TRUE(attributes.ok());
  EXPECT_EQ(attributes->world_to_ndc, m);
}

TEST_F(Conventions, OrthographicCamerasMayMoveButNotTurn) {
  const auto motion = tools::camera_motion(orthographic(.25f, 0), orthographic(.125f, 0), 1);
  ASSERT_TRUE(motion);
  const auto& m = motion->clip_to_previous_clip;
  for (const float d : {0.f, .25f, 1.f}) {  // at any distance
    EXPECT_FLOAT_EQ(m[0] * .5f + m[4] * .25f + m[8] * d + m[12], .625f);
    EXPECT_FLOAT_EQ(m[1] * .5f + m[5] * .25f + m[9] * d + m[13], .25f);
    EXPECT_FLOAT_EQ(m[3] * .5f + m[7] * .25f + m[11] * d + m[15], 1);
  }
  EXPECT_FALSE(tools::camera_motion(orthographic(0, 0), orthographic(0, .05f), 1));
  for (int number = 1; number <= 3; ++number)
    write(input(number), [&](Planes&, Attributes& attributes) {
      const auto n = static_cast<float>(number);
      attributes.push_back({"worldToNDC", orthographic(.1f * n, number < 3 ? 0 : .1f)});
    });
  read("");
  format_.needs_camera = true;
  const std::int64_t numbers[] = {1, 2, 3};
  const auto pattern = tools::FramePattern::parse(folder_.file("f.%04d.exr")).value();
  const tools::SequenceScan scan = tools::scan_sequence(pattern, format_, numbers, numbers, 1);
  EXPECT_EQ(scan.bad(), (std::vector<std::int64_t>{3}));
  EXPECT_NE(scan.problem().message().find("of an orthographic camera that turns"), std::string::npos);
}

TEST_F(Conventions, AttributesOfOtherProgramsAreIgnored) {
  const auto with = [](const char* name, const tools::AttributeValue& value) {
    return [=](Planes&, Attributes& attributes) { attributes.push_back({name, value}); };
  };
  for (const tools::AttributeValue& value : {tools::AttributeValue(7), {std::string("on")}, {Vec2{8, 4}}}) {
    read_of(with("jitter", value));
    EXPECT_EQ(format_.ignored, (std::vector<std::string>{"jitter"}));
    EXPECT_EQ(format_.jitter.text(), "none");
    read("--jitter none");
    EXPECT_TRUE(format_.ignored.empty());
  }
  expect_refused("'{}/f.%04d.exr' --out '{}/o.%04d.exr' --output 34x20 --jitter attribute", 1,
                 "has an attribute 'jitter' that is not two numbers");
  const auto listing = resolve("'{}/f.%04d.exr' -n --output 34x20");
  EXPECT_NE(listing.out.find("the frames' attribute 'jitter' does not hold what it would here"),
            std::string::npos);
  const auto reset_of = [&](const tools::AttributeValue& value) {
    write(input(1), with("reset", value));
    return tools::frame_attributes(input(1), tools::ImageReader::open(input(1))->header()).value();
  };
  for (const tools::AttributeValue& value :
       {tools::AttributeValue(1), {std::string("True")}, {std::string("1")}})
    EXPECT_EQ(reset_of(value).reset, true);
  for (const tools::AttributeValue& value : {tools::AttributeValue(0), {std::string("false")}})
    EXPECT_EQ(reset_of(value).reset, false);
  for (const tools::AttributeValue& value : {tools::AttributeValue(7), {std::string("none")}}) {
    EXPECT_FALSE(reset_of(value).reset);
    EXPECT_EQ(reset_of(value).foreign, (std::vector<std::string>{"reset"}));
  }
}

TEST_F(Conventions, NumbersBelowZeroAndBeyondInt) {
  for (const char* name : {"f.-002.exr", "f.-001.exr", "f.0000.exr", "f.0001.exr"})
    write(folder_.file(name), unchanged);
  const auto listing =
      resolve("'{}/f.%04d.exr' -n --output 34x20 --jitter halton --method temporal --frames -1-0");
  EXPECT_NE(listing.out.find("Make      2 frames: -1-0\n"), std::string::npos) << listing.out << listing.err;
  EXPECT_NE(listing.out.find("Read      3 frames: -2-0\n"), std::string::npos) << listing.out;
  std::ofstream(folder_.file("h.9223372036854775807.exr")) << "far";
  expect_refused("'{}/h.%d.exr' -n --output 34x20", 2, "more than 18 digits");

  const tools::SequenceOutput made = {.pattern = tools::FramePattern::parse(folder_.file("u.%d.exr")).value(),
                                      .extent = {1, 1}};
  const float texel[] = {1, 1, 1, 1};
  ASSERT_TRUE(made.write_linear(3'000'000'001, texel, 1, {}).ok());
  const std::string path = folder_.file("u.3000000001.exr");
  EXPECT_EQ(tools::frame_attributes(path, tools::ImageReader::open(path)->header())->index, 3'000'000'001);
}

TEST(NumbersBelowZero, WindowsAndJitterGoOn) {
  for (const auto& [number, window] : {std::pair(-25, -2), {-24, -1}, {-1, -1}, {0, 0}, {23, 0}, {24, 1}})
    EXPECT_EQ(tools::window_of(number), window) << number;
  const int places = jitter_phases({24, 14}, {34, 20});
  for (const tools::Jitter pattern : {tools::Jitter::kHalton, tools::Jitter::kQuincunx})
    for (const int number : {-1, -2, -100})
      EXPECT_EQ(tools::jitter_of(pattern, number, {24, 14}, {34, 20}),
                tools::jitter_of(pattern, number + 100 * places * 2, {24, 14}, {34, 20}));
}

TEST_F(Conventions, TheAspectOfPixelsFollowsTheShape) {
  const auto aspect_of = [](const SequenceFrame& frame) {
    for (const tools::Attribute& kept : frame.kept)
      if (kept.name == "pixelAspectRatio") return std::get<float>(kept.value);
    return 0.f;
  };
  write(input(1), [](Planes&, Attributes& attributes) { attributes.push_back({"pixelAspectRatio", 2.f}); });
  for (const auto& [output, aspect] :
       {std::pair(Extent{48, 28}, 2.f), {{96, 28}, 1.f}, {{49, 28}, 2.f}, {{48, 48}, 2 * 24.f / 14}}) {
    EXPECT_FLOAT_EQ(tools::output_aspect(2, kRender, output), aspect) << output.width;
  }
  EXPECT_FLOAT_EQ(aspect_of(read("")), 2);
  format_.output = {96, 28};
  SequenceFrame frame;
  ASSERT_TRUE(tools::read_frame(input(1), format_, {.number = 1, .render = kRender, .pixel_aspect = 2},
                                PixelFormat::kRGBA32F, frame)
                  .ok());
  EXPECT_FLOAT_EQ(aspect_of(frame), 1);
  const auto listing = resolve("'{}/f.%04d.exr' -n --output 48x48 --method point");
  EXPECT_NE(listing.out.find(
                "of aspect 2 and the output 48x48: the picture is stretched; 48x28 would keep its shape, "
                "48x14 with square pixels"),
            std::string::npos)
      << listing.out;
}

}  // namespace
}  // namespace quincunx

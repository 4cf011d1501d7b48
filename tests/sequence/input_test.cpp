// SPDX-License-Identifier: MIT
// The settings that a command line and the first frame come to: channels, attributes, jitter.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "sequence_fixture.h"
#include "tools/exr_files.h"
#include "tools/sequence/sequence_input.h"
#include "tools/sequence/sequence_scan.h"

namespace quincunx::tools {
namespace {

using testing::FrameFile;

class Input : public testing::SequenceTest {
 protected:
  ImageHeader header_of(const FrameFile& file) {
    write_frame(input(1), file);
    return ImageReader::open(input(1))->header();
  }

  static FrameAttributes attributes_of(const ImageHeader& header) {
    auto attributes = frame_attributes("f", header);
    EXPECT_TRUE(attributes.ok()) << attributes.status().message();
    return attributes.value();
  }

  Result<SequenceFormat> settled(const SequenceInput& sequence, const FrameFile& file) {
    const ImageHeader header = header_of(file);
    return settle(sequence, "f.exr", header, attributes_of(header));
  }
};

TEST_F(Input, TheExchangeFormatNeedsNoWords) {
  FrameFile file = frame(1);
  file.depth = file.reactive = true;
  file.attributes.push_back({"quincunx:depthKind", "device-reversed"});
  file.attributes.push_back({"quincunx:near", 0.25f});
  const auto format = settled({}, file);
  ASSERT_TRUE(format.ok()) << format.status().message();
  EXPECT_EQ(format->motion, MotionSource::kChannels);
  EXPECT_EQ(format->channels[InputPlane::kVelocity], kBackwardChannels);
  EXPECT_EQ(format->units.convention, VelocityConvention::kNuke);
  EXPECT_EQ(format->channels[InputPlane::kDepth].front(), "Z");
  EXPECT_EQ(format->depth_kind, DepthKind::kDeviceReversed);
  EXPECT_EQ(format->near_plane, 0.25f);
  EXPECT_EQ(format->channels[InputPlane::kReactive].front(), "reactive.mask");
  EXPECT_EQ(format->jitter.text(), "attribute");
  EXPECT_EQ(format->output, kOutput);
  const SceneNeeds needs = needs_of(format.value());
  EXPECT_TRUE(needs.moving_objects);
  EXPECT_TRUE(needs.transparents);
}

TEST_F(Input, WhatIsNotThereIsNotNeeded) {
  FrameFile file = frame(1);
  file.velocity = false;
  file.attributes = {{"quincunx:outputSize", Vec2{64, 32}}};
  const auto format = settled({}, file);
  ASSERT_TRUE(format.ok());
  EXPECT_EQ(format->motion, MotionSource::kNone);
  EXPECT_FALSE(format->channels.has(InputPlane::kDepth));
  EXPECT_EQ(format->jitter.text(), "none");
  const SceneNeeds needs = needs_of(format.value());
  EXPECT_FALSE(needs.moving_objects);
  EXPECT_FALSE(needs.camera_motion);
  EXPECT_FALSE(needs.transparents);
}

TEST_F(Input, WhatThePlanDoesNotReadIsForgotten) {
  FrameFile file = frame(1);
  file.depth = file.reactive = true;
  SequenceFormat format = settled({}, file).value();
  ResolveSettings settings;
  settings.method = Method::kBilinear;
  settings.output_extent = settings.target_extent = kOutput;
  ASSERT_TRUE(keep_what_is_read(format, plan_for(needs_of(format), settings).value()).ok());
  EXPECT_FALSE(format.channels.has(InputPlane::kVelocity));
  EXPECT_FALSE(format.channels.has(InputPlane::kDepth));
  EXPECT_FALSE(format.channels.has(InputPlane::kReactive));
}

TEST_F(Input, MotionOfOtherNamesNeedsItsMeaning) {
  FrameFile file = frame(1);
  file.velocity_names = {"Vector.X", "Vector.Y"};
  SequenceInput sequence;
  sequence.motion = MotionSource::kChannels;
  sequence.velocity = {"Vector.X", "Vector.Y"};
  const Status status = settled(sequence, file).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_NE(status.message().find("--velocity-convention"), std::string::npos) << status.message();
  sequence.units = VelocityUnits{VelocityConvention::kBlender, {}};
  EXPECT_TRUE(settled(sequence, file).ok());
}

TEST_F(Input, ChannelsAreNamedInMessages) {
  const ImageHeader header = header_of(frame(1));
  ChannelNames names;
  names[InputPlane::kColour] = choose_picture("f", header, {.layer = "ViewLayer.Combined"})->channels;
  const auto places = find_channels("f.0001.exr", header, names);
  ASSERT_FALSE(places.ok());
  EXPECT_EQ(places.status().message(),
            "'f.0001.exr' has no channel 'ViewLayer.Combined.R'; it has R, G, B, A, backward.u, backward.v");
}

TEST_F(Input, ChannelsThatCannotBeUsedAreRefused) {
  ChannelNames names;
  names[InputPlane::kDepth] = {"Z"};
  const auto message_of = [&](const std::vector<testing::ExrPart>& parts) {
    testing::write_exr_parts(input(1), parts);
    return find_channels("f.exr", ImageReader::open(input(1))->header(), names).status().message();
  };
  testing::ExrPart whole = testing::simple_part({2, 2}, {"R", "G", "B", "Z"}, std::vector<float>(16));
  EXPECT_EQ(message_of({whole}), "");
  whole.types[3] = Imf::UINT;
  EXPECT_EQ(message_of({whole}), "'f.exr' holds integers in channel 'Z'; half or float is needed");
  testing::write_deep_exr(input(1), {2, 2});
  names[InputPlane::kDepth].clear();
  EXPECT_EQ(find_channels("f.exr", ImageReader::open(input(1))->header(), names).status().message(),
            "'f.exr' holds deep pixels in channel 'R'; flat ones are needed");
}

TEST_F(Input, AttributesMayBeTextAndHaveShortNames) {
  FrameFile file;
  file.attributes = {{"jitter", std::string("0.25, -0.5")},
                     {"reset", std::string("1")},
                     {"quincunx:near", std::string("0.1")},
                     {"quincunx:frameIndex", 77}};
  const FrameAttributes attributes = attributes_of(header_of(file));
  EXPECT_EQ(attributes.jitter, (Vec2{0.25f, -0.5f}));
  EXPECT_EQ(attributes.reset, true);
  EXPECT_EQ(attributes.near_plane, 0.1f);
  EXPECT_EQ(attributes.index, 77);
}

TEST_F(Input, AttributesThatMeanNothingAreRefused) {
  const auto refused = [&](const Attribute& attribute, const std::string& part) {
    FrameFile file;
    file.attributes = {attribute};
    const auto attributes = frame_attributes("f.exr", header_of(file));
    ASSERT_FALSE(attributes.ok()) << attribute.name;
    const std::string message = attributes.status().message();
    EXPECT_EQ(message.rfind("'f.exr' has an attribute '" + attribute.name + "'", 0), 0u) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  refused({"quincunx:jitter", std::string("1 2 3")}, "two numbers");
  refused({"quincunx:jitter", Vec2{NAN, 0}}, "two numbers");
  refused({"quincunx:outputSize", Vec2{0, 20}}, "a width and a height from 1 to 32768");
  refused({"quincunx:outputSize", Vec2{32769, 20}}, "a width and a height from 1 to 32768");
  refused({"quincunx:exposure", -1.0f}, "a number from 0 to 1000000");
  refused({"quincunx:exposure", 2e6f}, "a number from 0 to 1000000");
  refused({"quincunx:reset", std::string("yes")}, "0 or 1");
  refused({"quincunx:near", -1.0f}, "a positive number");
  refused({"quincunx:depthKind", std::string("Linear")}, "linear, device or device-reversed");
}

class Jitters : public testing::SequenceTest {
 protected:
  std::string jitter_file(const std::string& text) const {
    std::ofstream(folder_.file("jitter")) << text;
    return folder_.file("jitter");
  }

  static Result<Vec2> at(const std::string& text, std::int64_t number,
                         const FrameAttributes& attributes = {}) {
    auto source = JitterSource::parse(text);
    if (!source.ok()) return source.status();
    source->settle(attributes);
    return source->at("f.exr", number, attributes, {1, 1}, {2, 2});
  }
};

TEST_F(Jitters, PatternsCountByFrameIndexOrNumber) {
  EXPECT_EQ(at("none", 3).value(), (Vec2{0, 0}));
  EXPECT_EQ(at("quincunx", 3).value(), (Vec2{0.25f, 0.25f}));
  EXPECT_EQ(at("quincunx-half", 4).value(), (Vec2{0, 0}));
  EXPECT_EQ(at("halton", 9).value(), jitter_of(Jitter::kHalton, 9, {1, 1}, {2, 2}));
  FrameAttributes shifted;
  shifted.index = 4;
  EXPECT_EQ(at("quincunx", 3, shifted).value(), (Vec2{-0.25f, -0.25f}));
}

TEST_F(Jitters, WithoutWordsTheAttributeCountsWhereThereIsOne) {
  EXPECT_EQ(at("", 3).value(), (Vec2{0, 0}));
  FrameAttributes attributes;
  attributes.jitter = Vec2{0.5f, -1};
  EXPECT_EQ(at("", 3, attributes).value(), (Vec2{0.5f, -1}));
  EXPECT_EQ(at("none", 3, attributes).value(), (Vec2{0, 0}));
  auto source = JitterSource::parse("").value();
  source.settle(attributes);
  const Status missing = source.at("f.exr", 4, {}, {1, 1}, {1, 1}).status();
  EXPECT_NE(missing.message().find("'f.exr' has no attribute 'quincunx:jitter'"), std::string::npos);
}

TEST_F(Jitters, Files) {
  const std::string lines = jitter_file("# frame x y\n1 0.25 -0.25\n\n2, -0.5, 1  # more\n");
  EXPECT_EQ(at(lines, 1).value(), (Vec2{0.25f, -0.25f}));
  EXPECT_EQ(at(lines, 2).value(), (Vec2{-0.5f, 1}));
  EXPECT_EQ(at(lines, 3).status().code(), StatusCode::kIoFailure);
  const std::string json = jitter_file(R"({"per_frame": [{"frame": 7, "jitter": [0.125, 0], "reset": 0}]})");
  EXPECT_EQ(at(json, 7).value(), (Vec2{0.125f, 0}));
}

TEST_F(Jitters, BadSourcesAreOneSentence) {
  EXPECT_EQ(at("quincux", 1).status().code(), StatusCode::kInvalidArgument);
  for (const char* text :
       {"", "1 2", "a b c", "1 0 0 0", "{", "{\"per_frame\": [{\"frame\": 1}]}", "1 7 0"}) {
    const Status status = at(jitter_file(text), 1).status();
    EXPECT_EQ(status.code(), StatusCode::kIoFailure) << text;
    EXPECT_EQ(status.message().find('\n'), std::string::npos) << text;
  }
}

}  // namespace

// Which frames a run reads, and what it finds out about them beforehand.

namespace {

using Frames = std::vector<std::int64_t>;

TEST(History, ReachesBackBeforeEveryWantedFrame) {
  EXPECT_EQ(with_history(Frames{5, 6, 7}, 0, 1), (Frames{5, 6, 7}));
  EXPECT_EQ(with_history(Frames{5, 6, 7}, 2, 1), (Frames{3, 4, 5, 6, 7}));
  EXPECT_EQ(with_history(Frames{5, 9, 20}, 1, 1), (Frames{4, 5, 8, 9, 19, 20}));
  EXPECT_EQ(with_history(Frames{5, 7}, 3, 1), (Frames{2, 3, 4, 5, 6, 7}));
}

TEST(History, EndsWhereTheSequenceBegins) {
  EXPECT_EQ(with_history(Frames{3, 4}, 32, 1), (Frames{1, 2, 3, 4}));
  EXPECT_EQ(with_history(Frames{3}, 2, 3), (Frames{3}));
}

class Scan : public testing::SequenceTest {
 protected:
  FramePattern pattern() const { return FramePattern::parse(folder_.file("f.%04d.exr")).value(); }

  static SequenceFormat format() {
    SequenceFormat format;
    format.output = kOutput;
    return format;
  }
};

TEST_F(Scan, AllFramesReachFromTheFirstFileToTheLast) {
  EXPECT_FALSE(all_frames(pattern()).ok());
  write_frames(3, 4);
  write_frames(6, 6);
  EXPECT_EQ(all_frames(pattern()).value(), (Frames{3, 4, 5, 6}));
}

TEST_F(Scan, TheSequenceBeginsWithItsFirstFile) {
  write_frames(3, 6);
  EXPECT_EQ(first_in_reach(pattern(), 6, 32), 3);
  EXPECT_EQ(first_in_reach(pattern(), 6, 1), 5);
  EXPECT_EQ(first_in_reach(pattern(), 3, 5), 3);
  EXPECT_EQ(first_in_reach(pattern(), 2, 5), 2);
}

TEST_F(Scan, SizesTypesAndJitterOfEachFrame) {
  for (int number = 1; number <= 3; ++number) {
    testing::FrameFile file = frame(number);
    file.extent = {20 + number, 30 - number};
    if (number == 2) file.colour = ChannelType::kFloat;
    write_frame(input(number), file);
  }
  SequenceFormat all = format();
  all.jitter = JitterSource::parse("attribute").value();
  const SequenceScan scan = scan_sequence(pattern(), all, Frames{1, 2, 3}, Frames{2, 3}, 3);
  ASSERT_TRUE(scan.problem().ok()) << scan.problem().message();
  EXPECT_EQ(scan.target(), (Extent{23, 29}));
  EXPECT_FALSE(scan.half_colour());
  EXPECT_TRUE(scan.frames[0].half_colour);
  EXPECT_EQ(scan.wanted(), (Frames{2, 3}));
  EXPECT_EQ(scan.history(), (Frames{1}));
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(scan.frames[i].render, (Extent{21 + i, 29 - i}));
    EXPECT_EQ(scan.frames[i].jitter, testing::quincunx_jitter(i + 1));
    EXPECT_EQ(scan.frames[i].reset, i == 0);
  }
}

TEST_F(Scan, WhatFollowsNothingIsReset) {
  write_frames(1, 8);
  testing::FrameFile cut = frame(3);
  cut.attributes.push_back({"quincunx:reset", 1});
  write_frame(input(3), cut);
  std::filesystem::remove(input(7));
  const SequenceScan scan =
      scan_sequence(pattern(), format(), Frames{1, 2, 3, 4, 6, 7, 8}, Frames{1, 2, 3, 4, 6, 7, 8}, 2);
  const std::vector<bool> wanted = {true, false, true, false, true, false, true};
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_EQ(scan.frames[i].reset, wanted[i]) << scan.frames[i].number;
  EXPECT_EQ(scan.bad(), (Frames{7}));
}

TEST_F(Scan, ProblemsAreCounted) {
  write_frames(1, 5);
  std::filesystem::remove(input(2));
  std::filesystem::remove(input(4));
  const Frames all = {1, 2, 3, 4, 5};
  const std::string message = scan_sequence(pattern(), format(), all, all, 1).problem().message();
  EXPECT_NE(message.find("frame 2 is missing"), std::string::npos) << message;
  EXPECT_NE(message.find("1 more"), std::string::npos) << message;
}

}  // namespace

}  // namespace quincunx::tools

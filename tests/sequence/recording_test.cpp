// SPDX-License-Identifier: MIT
// What is recorded of a service's frames makes the same pictures again, bit for bit.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "quincunx_record/record.h"
#include "sequence_fixture.h"
#include "service/service_fixture.h"
#include "tools/program/atomic_file.h"
#include "tools/record/recorded_frame.h"
#include "tools/record/recorded_settings.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::random_frame;
using testing::ServiceRig;

constexpr Extent kOutput{48, 27};
constexpr Extent kTarget{96, 54};
constexpr int kBefore = 3, kFrames = 7;
constexpr SceneNeeds kCameraOnly = {.moving_objects = false};

// The picture's top row first.
template <typename Element>
std::vector<Element> upright(std::vector<Element> picture, Extent extent, Origin origin) {
  const auto row = static_cast<std::ptrdiff_t>(picture.size()) / extent.height;
  for (int y = 0; y < extent.height / 2 && origin == Origin::kBottom; ++y)
    std::swap_ranges(picture.begin() + y * row, picture.begin() + (y + 1) * row,
                     picture.end() - (y + 1) * row);
  return picture;
}

// Frames of noise with all that the settings ask for: particles, a focus and its mask, a picture to fade from.
class Player {
 public:
  Player(const SceneNeeds& needs, const ResolveSettings& settings)
      : settings_(settings),
        rig_(needs, settings, kOutput, kTarget),
        region_(rig_.device(), needs, settings,
                settings.focus.extent == Extent{} ? kOutput : settings.focus.extent, kTarget) {}

  ServiceRig& rig() { return rig_; }

  FrameReport dispatch(int index) {
    HostFrame frame = random_frame(random_, kTarget);
    frame.reset = index == kBefore + 4;
    if (settings_.targets.shading == Shading::kCheckerboard && frame.render != Extent{1, 1})
      frame.parity = index % 2;
    if (settings_.output.min_extent != Extent{} && index % 3 != 0)
      frame.output = random_frame(random_, kOutput).render;
    frame.camera.clip_to_previous_clip[8] = static_cast<float>(index) / 512;
    FrameInputs inputs = rig_.upload(frame);
    inputs.frame_index = 5'000'000'000u + static_cast<unsigned>(index);
    inputs.velocity_scale = {.5f, 1.25f};
    inputs.near_plane = .125f;
    inputs.far_plane = 1000.1f;
    inputs.exposure = .7f + static_cast<float>(index) / 3;
    if (index % 2 == 0) inputs.exposure_image = constant(PixelFormat::kR32F, {1, 1}, 1.3f);
    const Extent own = settings_.targets.particle_extent;
    if (own != Extent{}) {
      const HostFrame particles = random_frame(random_, own);
      const Extent extent = inputs.particle_render_extent = particles.render;
      inputs.particle_colour =
          image(extent, PixelFormat::kRGBA32F, settings_.targets.storage, particles.colour);
      inputs.particle_depth = image(extent, PixelFormat::kR32F, settings_.targets.storage, particles.depth);
      inputs.particle_reactive =
          image(extent, PixelFormat::kR8, settings_.targets.storage, particles.reactive);
    }
    if (settings_.control.fades && index % 3 != 1) {
      inputs.fading_from = image(kOutput, PixelFormat::kRGBA32F, Storage::kBuffer, frame.colour);
      inputs.fade_weight = .3f;
    }
    const FrameOutputs outputs = {rig_.resolved_view(), rig_.presented_view()};
    const Extent region = settings_.focus.extent;
    if (region == Extent{} || index % 4 == 3) return rig_.service().dispatch(inputs, outputs);
    FocusInputs focus = {.x = index,
                         .y = index % 7,
                         .rectangles = {{{index + 2, index % 7 + 1, 14, 9}, {index, index % 7, 3, 3}}},
                         .rectangle_count = 2,
                         .feather = 2.5f};
    HostFrame close = random_frame(random_, kTarget);
    focus.frame = region_.upload(close);
    focus.frame.near_plane = inputs.near_plane;
    focus.frame.far_plane = inputs.far_plane;
    focus.mask = image(region, PixelFormat::kR8, Storage::kBuffer, close.reactive);
    return rig_.service().dispatch(inputs, focus, outputs);
  }

 private:
  template <typename Value>
  ImageView image(Extent extent, PixelFormat format, Storage storage,
                  const std::function<Value(int, int)>& value) {
    std::vector<Value> texels;
    for (int y = 0; y < extent.height; ++y) {
      for (int x = 0; x < extent.width; ++x)
        texels.push_back(value(x, y));
    }
    kept_.push_back(rig_.device().allocate(extent, format, storage).value());
    EXPECT_TRUE(rig_.device().upload(kept_.back().view(), extent, texels.data()).ok());
    return kept_.back().view();
  }

  ImageView constant(PixelFormat format, Extent extent, float value) {
    return image<float>(extent, format, Storage::kBuffer, [value](int, int) { return value; });
  }

  ResolveSettings settings_;
  ServiceRig rig_;
  ServiceRig region_;
  std::mt19937 random_{31};
  std::vector<Image> kept_;
};

float value_of_half(std::uint16_t half) {
  const int exponent = half >> 10 & 31, digits = half & 1023;
  const float value = exponent == 0 ? std::ldexp(static_cast<float>(digits), -24)
                                    : std::ldexp(static_cast<float>(1024 + digits), exponent - 25);
  return half & 0x8000 ? -value : value;
}

// The linear picture where it has halves, of which download() fills the first bytes.
std::vector<Pixel> from_halves(const std::vector<Pixel>& bytes) {
  std::vector<std::uint16_t> halves(bytes.size() * 4);
  std::memcpy(halves.data(), bytes.data(), halves.size() * sizeof(std::uint16_t));
  std::vector<Pixel> pixels(bytes.size());
  for (std::size_t i = 0; i < halves.size(); ++i)
    pixels[i / 4][i % 4] = value_of_half(halves[i]);
  return pixels;
}

struct Run {
  const char* name;
  ResolveSettings settings;
  SceneNeeds needs = {};
};

class Replay : public ::testing::TestWithParam<Run> {
 protected:
  testing::ProgramResult resolve(const std::string& arguments) {
    return testing::run_program(folder_, arguments);
  }

  testing::TemporaryFolder folder_;
};

TEST_P(Replay, MakesTheSamePictures) {
  const Origin origin = GetParam().settings.conventions.origin;
  const bool halves = GetParam().settings.output.linear == PixelFormat::kRGBA16F;
  Player player(GetParam().needs, GetParam().settings);
  for (int i = 0; i < kBefore; ++i)
    ASSERT_TRUE(player.dispatch(i).ok());
  auto recording = record_frames(player.rig().service(), folder_.file("seen"), {.frames = kFrames});
  ASSERT_TRUE(recording.ok()) << recording.error();
  std::vector<std::vector<Pixel>> linear;
  std::vector<std::vector<std::uint8_t>> presented;
  for (int i = kBefore; !recording->done(); ++i) {
    const FrameReport report = player.dispatch(i);
    ASSERT_TRUE(report.ok()) << report.status.message();
    const std::vector<Pixel> resolved = player.rig().resolved();
    linear.push_back(upright(halves ? from_halves(resolved) : resolved, kOutput, origin));
    presented.push_back(upright(player.rig().presented(), kOutput, origin));
  }
  ASSERT_TRUE(recording->status().ok()) << recording->status().message();
  EXPECT_EQ(recording->frames(), kFrames);
  ASSERT_EQ(linear.size(), std::size_t{kFrames});
  ASSERT_TRUE(player.dispatch(kBefore + kFrames).ok());  // which nobody records

  for (const char* out : {"'{}/again.%04d.exr'", "'{}/again.%04d.png'"}) {
    const auto result = resolve(fmt::format("'{{}}/seen' -q --out {}", out));
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const auto exr = tools::read_image(folder_.file(fmt::format("again.{:04}.exr", i)));
    ASSERT_TRUE(exr.ok()) << exr.error();
    ASSERT_EQ(exr->stored[0], halves ? tools::ChannelType::kHalf : tools::ChannelType::kFloat);
    ASSERT_EQ(exr->pixels.size(), linear[i].size() * 4);
    EXPECT_EQ(std::memcmp(exr->pixels.data(), linear[i].data(), linear[i].size() * sizeof(Pixel)), 0) << i;
    const auto png = tools::read_image(folder_.file(fmt::format("again.{:04}.png", i)));
    ASSERT_TRUE(png.ok()) << png.error();
    ASSERT_EQ(png->channels.size(), 3u);
    for (std::size_t k = 0; k < linear[i].size(); ++k) {
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_EQ(std::lround(png->pixels[3 * k + c] * 255), presented[i][4 * k + c]) << i << " " << k;
    }
  }
}

const Run kRuns[] = {
    {.name = "temporal_particles",
     .settings = {.method = Method::kTemporal,
                  .targets = {.particle_extent = kTarget},
                  .blur = {.shutter = .5f}}},
    {.name = "checkerboard",
     .settings = {.method = Method::kQuincunx, .targets = {.shading = Shading::kCheckerboard}}},
    {.name = "rgba8_temporal", .settings = {.method = Method::kTemporal, .colour = PixelFormat::kRGBA8}},
    {.name = "noise_in_halves",
     .settings = {.method = Method::kNoise, .output = {.linear = PixelFormat::kRGBA16F}}},
    {.name = "opengl_engine",
     .settings = {.method = Method::kTemporal,
                  .conventions = {.depth = DepthConvention::kForward,
                                  .clip_space = ClipSpace::kOpenGl,
                                  .velocity_unit = VelocityUnit::kNdc,
                                  .velocity_backward = true,
                                  .velocity_up = true,
                                  .velocity_jittered = true,
                                  .origin = Origin::kBottom}}},
    {.name = "linear_depth_from_the_bottom_in_images",
     .settings = {.method = Method::kQuincunx,
                  .conventions = {.depth = DepthConvention::kLinear, .origin = Origin::kBottom},
                  .targets = {.storage = Storage::kImage},
                  .quincunx = {.form = TwoFrameForm::kReprojected, .residual_weight = 1}}},
    {.name = "dual", .settings = {.method = Method::kTemporal, .output = {.min_extent = {1, 1}}}},
    {.name = "camera_placed",
     .settings = {.method = Method::kTemporal, .sharpness = .5f, .targets = {.placement = Targets::kPlaced}},
     .needs = kCameraOnly},
    {.name = "sky_fades",
     .settings = {.method = Method::kTemporal,
                  .conventions = {.sky_motion = SkyMotion::kEvidence},
                  .control = {.fades = true}}},
    {.name = "focus",
     .settings = {.method = Method::kTemporal,
                  .focus = {.extent = {21, 12}, .target_extent = kTarget, .mask = true}}},
};
INSTANTIATE_TEST_SUITE_P(All, Replay, ::testing::ValuesIn(kRuns),
                         [](const auto& instance) { return std::string(instance.param.name); });

// Texels of every format, at an offset and a pitch of theirs or in images, keep every bit.
TEST(RecordedFrame, KeepsEveryBit) {
  const testing::TemporaryFolder folder;
  const Device device = Device::open().value();
  constexpr Extent kRender{19, 11};
  std::mt19937 random(5);
  for (const PixelFormat colour : {PixelFormat::kRGBA8, PixelFormat::kRGBA16F, PixelFormat::kRGBA32F}) {
    for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
      ResolveSettings settings{.output_extent = {38, 22},
                               .target_extent = {30, 20},
                               .colour = colour,
                               .targets = {.storage = storage}};
      settings.velocity = colour == PixelFormat::kRGBA32F ? PixelFormat::kRG32F : PixelFormat::kRG16F;
      const ResolvePlan plan = plan_for({}, settings).value();
      std::vector<Image> memory;
      std::vector<std::vector<std::byte>> texels;
      const auto fill = [&](PixelFormat format) {
        const std::size_t texel = bytes_per_pixel(format);
        ImageView view = {.storage = storage, .format = format, .extent = kRender};
        if (storage == Storage::kBuffer) {
          memory.push_back(device.allocate({1 << 14, 1}, PixelFormat::kR8).value());
          view.memory = memory.back().view().memory;
          view.offset = 48;
          view.pitch = 25 * texel;
        } else {
          memory.push_back(device.allocate(settings.target_extent, format, storage).value());
          view = memory.back().view();
        }
        texels.emplace_back(static_cast<std::size_t>(kRender.area()) * texel);
        for (std::byte& byte : texels.back())
          byte = static_cast<std::byte>(random());
        EXPECT_TRUE(device.upload(view, kRender, texels.back().data()).ok());
        return view;
      };
      FrameInputs inputs;
      inputs.colour = fill(colour);
      inputs.velocity = fill(settings.velocity);
      inputs.depth = fill(PixelFormat::kR32F);
      inputs.reactive = fill(PixelFormat::kR8);
      inputs.render_extent = kRender;
      inputs.jitter = {.1f, -.3f};
      const auto frame = tools::download(device, plan, inputs, nullptr);
      ASSERT_TRUE(frame.ok()) << frame.error();
      ASSERT_TRUE(tools::write_frame(folder.file("f"), 3, plan, *frame).ok());
      const auto read = tools::read_recorded_frame(folder.file("f"), 3, plan);
      ASSERT_TRUE(read.ok()) << read.error();
      const tools::RecordedPart& picture = (*read)[tools::FramePart::kPicture];
      ASSERT_EQ(picture.images.size(), texels.size());
      EXPECT_EQ(picture.extent, kRender);
      EXPECT_EQ(read->inputs.jitter, inputs.jitter);
      for (std::size_t i = 0; i < texels.size(); ++i)
        EXPECT_TRUE(picture.images[i].texels == texels[i]) << name_of(colour) << " " << i;
    }
  }
}

class RecordingFolder : public ::testing::Test {
 protected:
  // Records so many frames of a bilinear service into "seen".
  Result<Recording> record(int frames, bool overwrite = false) {
    return record_frames(player_.rig().service(), seen(), {.frames = frames, .overwrite = overwrite});
  }

  void dispatch(int frames) {
    for (int i = 0; i < frames; ++i)
      ASSERT_TRUE(player_.dispatch(i).ok());
  }

  void record_all(int frames) {
    const auto recording = record(frames);
    ASSERT_TRUE(recording.ok()) << recording.error();
    dispatch(frames);
    ASSERT_TRUE(recording->done() && recording->status().ok()) << recording->status().message();
  }

  // One line on stderr that holds `part`.
  void expect_refused(const std::string& arguments, int code, const std::string& part) {
    const auto result = testing::run_program(folder_, arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
    EXPECT_LE(std::count(result.err.begin(), result.err.end(), '\n'), 2) << result.err;
  }

  // Replaces a part of sequence.json.
  void edit(const std::string& from, const std::string& to) {
    std::string text = testing::read_file(file(tools::kSettingsFile));
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << text;
    text.replace(at, from.size(), to);
    ASSERT_TRUE(tools::write_text(file(tools::kSettingsFile), text).ok());
  }

  std::string seen() const { return folder_.file("seen"); }
  std::string file(const std::string& name) const { return seen() + "/" + name; }
  bool there(const std::string& name) const { return std::filesystem::exists(file(name)); }

  testing::TemporaryFolder folder_;
  Player player_{{}, {.method = Method::kBilinear, .targets = {.particle_extent = kTarget}}};
};

TEST_F(RecordingFolder, WhatCannotBeRecordedIsSaid) {
  EXPECT_EQ(record(0).error(), "frames is 0; at least 1 must be recorded");
  EXPECT_EQ(record_frames(player_.rig().service(), "").error(), "folder is empty; name one to record into");
  ASSERT_TRUE(tools::write_text(folder_.file("text"), "x").ok());
  const std::string error = record_frames(player_.rig().service(), folder_.file("text")).error();
  EXPECT_EQ(error, fmt::format("'{}' cannot be listed: Not a directory", folder_.file("text")));
}

TEST_F(RecordingFolder, AnotherRecordingIsKeptUnlessToldOtherwise) {
  record_all(3);
  const std::string before = testing::read_file(file("frame.0000.exr"));
  EXPECT_NE(record(1).error().find("of another recording; give another folder, or set overwrite"),
            std::string::npos)
      << record(1).error();
  dispatch(1);
  EXPECT_TRUE(testing::read_file(file("frame.0000.exr")) == before);
  ASSERT_TRUE(tools::write_text(file("notes.txt"), "kept").ok());
  const auto again = record(1, true);
  ASSERT_TRUE(again.ok()) << again.error();
  EXPECT_FALSE(there("frame.0000.exr"));
  dispatch(2);
  EXPECT_TRUE(there("frame.0000.exr") && there("particles.0000.exr") && there("notes.txt"));
  EXPECT_FALSE(there("frame.0001.exr") || there("particles.0002.exr"));
}

TEST_F(RecordingFolder, AFailureEndsItAndLeavesWholeFrames) {
  const auto recording = record(4);
  ASSERT_TRUE(recording.ok()) << recording.error();
  dispatch(1);
  std::filesystem::create_directory(file("frame.0001.exr"));
  dispatch(2);  // which goes on
  EXPECT_TRUE(recording->done());
  EXPECT_EQ(recording->frames(), 1);
  EXPECT_EQ(recording->status().message(),
            fmt::format("'{}' cannot be written: it is a folder", file("frame.0001.exr")));
  EXPECT_FALSE(there("particles.0001.exr"));
  std::filesystem::remove(file("frame.0001.exr"));
  const auto result = testing::run_program(folder_, "'{}/seen' --out '{}/u.%04d.exr' -q");
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(RecordingFolder, EndsWithItsObject) {
  { const auto recording = record(4); }
  dispatch(1);
  EXPECT_FALSE(there("frame.0000.exr"));
}

TEST_F(RecordingFolder, WhatCannotBeReplayedIsSaid) {
  const std::string replay = "'{}/seen' --out '{}/u.%04d.exr'";
  std::filesystem::create_directory(seen());
  expect_refused(replay, 1, "sequence.json' is not there or says nothing of a recording");
  record_all(2);
  expect_refused(replay + " --velocity none", 2, "--velocity: it is what the recording in");
  expect_refused(replay + " --output 30x20", 2, "--output: it is what the recording in");
  expect_refused(replay + " --method temporal", 1, "has no channel");
  expect_refused(replay + " --frames 1-3", 1, "frame 2 is missing");
  edit("\"grain\"", "\"grian\"");
  expect_refused(replay, 1, "has a 'filter.grian' that this version does not know");
  edit("\"grian\"", "\"grain\"");
  edit("\"bilinear\"", "\"bylinear\"");
  expect_refused(replay, 1, "has a 'method' that cannot be meant");
  edit("\"bylinear\"", "\"bilinear\"");
  std::filesystem::remove(file("particles.0001.exr"));
  expect_refused(replay, 1, "particles.0001.exr");
}

TEST_F(RecordingFolder, OptionsCountAndAreSaid) {
  record_all(3);
  const auto result =
      testing::run_program(folder_, "'{}/seen' --out '{}/u.%04d.exr' --method lanczos3 --store half");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("not as it was recorded: method is lanczos3 in place of bilinear"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(tools::read_image(folder_.file("u.0002.exr"))->stored[0], tools::ChannelType::kHalf);
  const auto resumed = testing::run_program(folder_, "'{}/seen' --out '{}/u.%04d.exr' --resume --frames 2");
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_NE(resumed.err.find("1 frames are there, but not whole or made otherwise"), std::string::npos)
      << resumed.err;
}

TEST_F(RecordingFolder, IsNamedWhereItsFilesAreReadAsOthers) {
  record_all(1);
  const auto result = testing::run_program(folder_, "'{}/seen/frame.%04d.exr' -n");
  EXPECT_NE(result.out.find("holds a recording: give the folder alone"), std::string::npos)
      << result.out << result.err;
  const auto listed = testing::run_program(folder_, "'{}/seen' -n");
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_NE(listed.out.find("a recording, by its settings"), std::string::npos) << listed.out;
  EXPECT_EQ(listed.out.find("Warning"), std::string::npos) << listed.out;
}

// Every field that sequence.json has, each with another value than by itself.
TEST(RecordedSettings, ComeBack) {
  const testing::TemporaryFolder folder;
  const tools::RecordedSettings recorded = {
      .device = "a \"device\"",
      .needs = {.moving_objects = false, .camera_motion = false, .transparents = false, .background = false},
      .settings = {.method = Method::kLanczos3,
                   .output_extent = {1, 2},
                   .target_extent = {5, 6},
                   .colour = PixelFormat::kRGBA8,
                   .velocity = PixelFormat::kRG32F,
                   .conventions = {.depth = DepthConvention::kForward,
                                   .clip_space = ClipSpace::kVulkan,
                                   .velocity_unit = VelocityUnit::kNdc,
                                   .velocity_backward = true,
                                   .velocity_up = true,
                                   .velocity_jittered = true,
                                   .origin = Origin::kBottom,
                                   .drawn_velocity = DrawnVelocity::kDilated,
                                   .sky_motion = SkyMotion::kEvidence},
                   .sharpness = .9f,
                   .targets = {.storage = Storage::kImage,
                               .placement = Targets::kPlaced,
                               .shading = Shading::kCheckerboard,
                               .particle_extent = {7, 8},
                               .clear = true},
                   .output = {.min_extent = {3, 4},
                              .linear = PixelFormat::kRGBA16F,
                              .present = false,
                              .tone_map = ToneMap::kReinhard,
                              .dither = false},
                   .filter = {.clamp_ringing = false, .grain = .1f, .noise_moves = false},
                   .quincunx = {TwoFrameForm::kReprojected, Sampling::kPoint, .3f, 1e-30f},
                   .temporal = {TemporalPreset::kQuality, TemporalView::kFar, PixelFormat::kRGBA32F},
                   .blur = {.7f, 64},
                   .focus = {{9, 10}, {11, 12}, true},
                   .control = {.measures_content = true, .fades = true}}};
  ASSERT_TRUE(tools::write_text(folder.file(tools::kSettingsFile), tools::to_json(recorded)).ok());
  const auto read = tools::read_settings(folder.file(""));
  ASSERT_TRUE(read.ok()) << read.error();
  EXPECT_TRUE(*read == recorded) << tools::to_json(*read);
}

TEST(RecordedSettings, NumbersOfMoreThan32BitsAreNotCut) {
  const testing::TemporaryFolder folder;
  const std::string text = tools::to_json({.settings = {.output_extent = {1111, 22}}}), number = "1111";
  for (const char* other : {"4294968407", "-4294966185", "18446744073709552727"}) {  // 1111 in 32 or 64 bits
    std::string wide = text;
    wide.replace(wide.find(number), number.size(), other);
    ASSERT_TRUE(tools::write_text(folder.file(tools::kSettingsFile), wide).ok());
    const std::string why = tools::read_settings(folder.file("")).error();
    EXPECT_NE(why.find("has a 'output_extent' that cannot be meant"), std::string::npos)
        << other << ": " << why;
  }
}

}  // namespace
}  // namespace quincunx

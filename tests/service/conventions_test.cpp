// SPDX-License-Identifier: MIT
// The same scene in the conventions of other engines makes the same pictures, bit for bit: all numbers of these scenes
// are such that converting them rounds nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

#include "service_fixture.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::random_frame;
using testing::ServiceRig;

constexpr Extent kOutput{48, 27};
constexpr Extent kTarget{96, 54};
constexpr SceneNeeds kOpaque = {.transparents = false};
constexpr SceneNeeds kCameraOnly = {.moving_objects = false};

struct Run {
  const char* name;
  ResolveSettings settings;
  SceneNeeds needs = {};
};

std::string name_of_run(const ::testing::TestParamInfo<Run>& instance) {
  return instance.param.name;
}

template <typename Element>
void turn_rows(std::vector<Element>& picture, Extent extent) {
  const auto row = static_cast<std::ptrdiff_t>(picture.size()) / extent.height;
  for (int y = 0; y < extent.height / 2; ++y)
    std::swap_ranges(picture.begin() + y * row, picture.begin() + (y + 1) * row,
                     picture.end() - (y + 1) * row);
}

template <typename Value>
void turn(std::function<Value(int, int)>& image, int height) {
  image = [image, height](int x, int y) { return image(x, height - 1 - y); };
}

// The frame, from the lowest row on.
HostFrame turned(HostFrame frame) {
  const int height = frame.render.height;
  turn(frame.colour, height);
  turn(frame.velocity, height);
  turn(frame.depth, height);
  turn(frame.reactive, height);
  frame.jitter.y = -frame.jitter.y;
  if (height % 2 == 0) frame.parity = 1 - frame.parity;
  return frame;
}

// ---- Origin.

class FromTheBottom : public ::testing::TestWithParam<Run> {};

// Particles, a focus and its mask are there where the settings ask for them.
TEST_P(FromTheBottom, TheSamePicturesTurned) {
  ResolveSettings settings = GetParam().settings;
  const Storage storage = settings.targets.storage;
  ServiceRig top(GetParam().needs, settings, kOutput, kTarget);
  settings.conventions.origin = Origin::kBottom;
  ServiceRig bottom(top.device(), GetParam().needs, settings, kOutput, kTarget);
  const Extent region = settings.focus.extent;
  ServiceRig region_inputs(top.device(), {}, settings, region == Extent{} ? kOutput : region, kTarget);

  std::vector<Image> kept;
  const auto image = [&]<typename Value>(Extent extent, PixelFormat format, Storage stored,
                                         std::function<Value(int, int)> value, bool turns) {
    if (turns) turn(value, extent.height);
    std::vector<Value> texels;
    for (int y = 0; y < extent.height; ++y) {
      for (int x = 0; x < extent.width; ++x)
        texels.push_back(value(x, y));
    }
    kept.push_back(top.device().allocate(extent, format, stored).value());
    EXPECT_TRUE(top.device().upload(kept.back().view(), extent, texels.data()).ok());
    return kept.back().view();
  };

  std::mt19937 random(27);
  for (int i = 0; i < 12; ++i) {
    HostFrame frame = random_frame(random, kTarget);
    frame.reset = i == 8;
    if (settings.targets.shading == Shading::kCheckerboard && frame.render != Extent{1, 1})
      frame.parity = i % 2;
    if (settings.output.min_extent != Extent{} && i % 3 != 0)
      frame.output = random_frame(random, kOutput).render;
    frame.camera.clip_to_previous_clip[8] = static_cast<float>(i) / 512;
    HostFrame close = random_frame(random, kTarget);
    close.reset = frame.reset;
    const HostFrame particles = random_frame(
        random, settings.targets.particle_extent == Extent{} ? kTarget : settings.targets.particle_extent);

    const auto dispatch = [&](ServiceRig& rig, bool turns) {
      FrameInputs inputs = rig.upload(turns ? turned(frame) : frame);
      if (settings.targets.particle_extent != Extent{}) {
        const Extent extent = inputs.particle_render_extent = particles.render;
        inputs.particle_colour = image(extent, PixelFormat::kRGBA32F, storage, particles.colour, turns);
        inputs.particle_depth = image(extent, PixelFormat::kR32F, storage, particles.depth, turns);
        inputs.particle_reactive = image(extent, PixelFormat::kR8, storage, particles.reactive, turns);
      }
      if (region == Extent{}) return rig.dispatch(inputs);
      const auto row = [&](int y, int height) { return turns ? kOutput.height - y - height : y; };
      const int y = i % 7;
      FocusInputs focus{.frame = region_inputs.upload(turns ? turned(close) : close),
                        .x = i,
                        .y = row(y, region.height),
                        .rectangles = {{{i + 2, row(y + 1, 9), 14, 9}}},
                        .rectangle_count = 1,
                        .feather = 3};
      focus.mask = image(region, PixelFormat::kR8, Storage::kBuffer, close.reactive, turns);
      return rig.service().dispatch(inputs, focus, {rig.resolved_view(), rig.presented_view()});
    };
    ASSERT_TRUE(dispatch(top, false).ok());
    const FrameReport report = dispatch(bottom, true);
    ASSERT_TRUE(report.ok()) << report.status.message();

    std::vector<Pixel> actual = bottom.resolved();
    turn_rows(actual, kOutput);
    const std::vector<Pixel> expected = top.resolved();
    ASSERT_EQ(std::memcmp(expected.data(), actual.data(), expected.size() * sizeof(Pixel)), 0)
        << "frame " << i << ", " << frame.render.width << "x" << frame.render.height;
    std::vector<std::uint8_t> codes = bottom.presented();
    turn_rows(codes, kOutput);
    ASSERT_EQ(top.presented(), codes) << "frame " << i;
  }
}

const Run kOrigins[] = {
    {.name = "lanczos3", .settings = {.method = Method::kLanczos3}},
    {.name = "noise_offset", .settings = {.method = Method::kNoiseOffset}},
    {.name = "quincunx_rgba8", .settings = {.method = Method::kQuincunx, .colour = PixelFormat::kRGBA8}},
    {.name = "reprojected",
     .settings = {.method = Method::kQuincunx,
                  .sharpness = .5f,
                  .quincunx = {.form = TwoFrameForm::kReprojected, .residual_weight = 1}}},
    {.name = "temporal", .settings = {.method = Method::kTemporal}, .needs = kOpaque},
    {.name = "temporal_camera", .settings = {.method = Method::kTemporal}, .needs = kCameraOnly},
    {.name = "temporal_dual", .settings = {.method = Method::kTemporal, .output = {.min_extent = {1, 1}}}},
    {.name = "temporal_placed",
     .settings = {.method = Method::kTemporal, .targets = {.placement = Targets::kPlaced}},
     .needs = kOpaque},
    {.name = "temporal_images",
     .settings = {.method = Method::kTemporal, .targets = {.storage = Storage::kImage}},
     .needs = kOpaque},
    {.name = "placed_images",
     .settings = {.method = Method::kQuincunx,
                  .targets = {.storage = Storage::kImage, .placement = Targets::kPlaced}}},
    {.name = "far_evidence",
     .settings = {.method = Method::kTemporal, .conventions = {.sky_motion = SkyMotion::kEvidence}}},
    {.name = "checkerboard",
     .settings = {.method = Method::kTemporal,
                  .targets = {.shading = Shading::kCheckerboard, .particle_extent = {40, 20}}}},
    {.name = "checkerboard_images",
     .settings = {.method = Method::kQuincunx,
                  .conventions = {.drawn_velocity = DrawnVelocity::kDilated},
                  .targets = {.storage = Storage::kImage, .shading = Shading::kCheckerboard}}},
    {.name = "focus",
     .settings = {.method = Method::kQuincunx,
                  .focus = {.extent = {20, 12}, .target_extent = kTarget, .mask = true}}},
    {.name = "focus_images",
     .settings = {.method = Method::kCatmullRom,
                  .targets = {.storage = Storage::kImage, .particle_extent = {40, 20}},
                  .focus = {.extent = {20, 12}, .target_extent = kTarget, .mask = true}}},
};

INSTANTIATE_TEST_SUITE_P(Methods, FromTheBottom, ::testing::ValuesIn(kOrigins), name_of_run);

// ---- All else.

// Conventions, with the planes' distances, and depths of three surfaces to which they are exact.
struct Given {
  const char* name = "native";
  InputConventions conventions = {};
  float near_plane = 0, far_plane = 0;
  std::array<float, 3> depths = {1, .5f, .25f};
};

using enum DepthConvention;
constexpr float kFarPlane = 2;
constexpr std::array<float, 3> kBeforeFarPlane = {1, .75f, .625f};

const Given kGiven[] = {
    {"pixels", {.velocity_unit = VelocityUnit::kPixels, .velocity_backward = true}},
    {"ndc", {.depth = kInfinite, .velocity_unit = VelocityUnit::kNdc, .velocity_up = true}},
    {"jittered", {.velocity_jittered = true}},
    {"reversed", {.depth = kReversed}, 1, kFarPlane, kBeforeFarPlane},
    {"linear", {.depth = kLinear, .clip_space = ClipSpace::kOpenGl}, .5f},
    {"opengl",
     {.depth = kForward,
      .clip_space = ClipSpace::kOpenGl,
      .velocity_unit = VelocityUnit::kNdc,
      .velocity_up = true,
      .origin = Origin::kBottom},
     .25f,
     .5f,
     kBeforeFarPlane},
    {"everything",
     {.depth = kReversed,
      .clip_space = ClipSpace::kVulkan,
      .velocity_unit = VelocityUnit::kPixels,
      .velocity_backward = true,
      .velocity_up = true,
      .velocity_jittered = true,
      .origin = Origin::kBottom},
     1,
     kFarPlane,
     kBeforeFarPlane},
};

// Returns the value for a reversed infinite depth; of 0 as though it were a surface's.
float given_depth(const Given& given, float depth) {
  const float share = given.far_plane > 0 ? given.near_plane / given.far_plane : 0;
  const float reversed = (depth - share) / (1 - share);
  switch (given.conventions.depth) {
    case kReversedInfinite:
    case kReversed:
      return reversed;
    case kInfinite:
    case kForward:
      return 1 - reversed;
    case kLinear:
      return given.near_plane / depth;
  }
  return 0;
}

float given_sky(const Given& given) {
  const DepthConvention depth = given.conventions.depth;
  return depth == kLinear                                   ? std::numeric_limits<float>::infinity()
         : depth == kReversed || depth == kReversedInfinite ? 0.f
                                                            : 1.f;
}

CameraMotion given_camera(const Given& given, CameraMotion camera) {
  auto& m = camera.clip_to_previous_clip;
  const InputConventions& is = given.conventions;
  if (is.clip_space == ClipSpace::kVulkan) {
    for (const std::size_t i : {1, 4, 6, 7, 9, 13})
      m[i] = -m[i];
  }
  if (is.depth == kLinear) return camera;
  const auto in_clip = [&](float depth) {
    const float value = given_depth(given, depth);
    return is.clip_space == ClipSpace::kOpenGl ? 2 * value - 1 : value;
  };
  const float slope = in_clip(1) - in_clip(0);
  for (std::size_t row = 0; row < 4; ++row) {
    m[8 + row] /= slope;
    m[12 + row] -= m[8 + row] * in_clip(0);
  }
  return camera;
}

// Returns a frame as it is given, where `previous` was the last one.
HostFrame as_given(const Given& given, const HostFrame& frame, const HostFrame& previous) {
  HostFrame made = frame;
  const InputConventions& is = given.conventions;
  made.depth = [=](int x, int y) {
    const float depth = frame.depth(x, y);
    return depth == 0 ? given_sky(given) : given_depth(given, depth);
  };
  const auto width = static_cast<float>(frame.render.width), height = static_cast<float>(frame.render.height);
  const Vec2 step = {
      frame.jitter.x / width - previous.jitter.x / static_cast<float>(previous.render.width),
      frame.jitter.y / height - previous.jitter.y / static_cast<float>(previous.render.height)};
  made.velocity = [=](int x, int y) {
    Vec2 v = frame.velocity(x, y);
    if (is.velocity_jittered && frame.depth(x, y) != 0) v = {v.x - step.x, v.y - step.y};
    if (is.velocity_unit == VelocityUnit::kPixels) v = {v.x * width, v.y * height};
    if (is.velocity_unit == VelocityUnit::kNdc) v = {2 * v.x, 2 * v.y};
    if (is.velocity_backward) v = {-v.x, -v.y};
    if (is.velocity_up) v.y = -v.y;
    return v;
  };
  made.camera = given_camera(given, frame.camera);
  return is.origin == Origin::kBottom ? turned(made) : made;
}

// Surfaces of three depths that move apart, before a sky without velocity; numbers with few digits.
HostFrame scene_frame(int i, const std::array<float, 3>& depths) {
  constexpr Extent kRenders[] = {{64, 32}, {32, 32}, {64, 16}};
  HostFrame frame;
  const Extent render = frame.render = kRenders[i / 2 % 3];
  frame.jitter = {static_cast<float>(i * 5 % 16 - 8) / 16, static_cast<float>(i * 7 % 16 - 8) / 16};
  const auto surface = [render, i](int x, int y) {
    const int u = x * 64 / render.width + 2 * i, v = y * 64 / render.height;
    return v < 12 ? 3 : (u / 11 + v / 9) % 3;
  };
  frame.depth = [=](int x, int y) {
    const int s = surface(x, y);
    return s == 3 ? 0 : depths[static_cast<std::size_t>(s)];
  };
  frame.velocity = [=](int x, int y) {
    constexpr Vec2 kVelocities[] = {{17.f / 4096, -9.f / 4096}, {-33.f / 4096, 5.f / 4096}, {}, {}};
    return kVelocities[surface(x, y)];
  };
  frame.colour = [=](int x, int y) {
    const auto hash = static_cast<unsigned>(x * 7919 + y * 104729 + i) * 2654435761u >> 24;
    return Pixel{static_cast<float>(hash) / 256, static_cast<float>(surface(x, y)) / 4, .5f, 1};
  };
  auto& m = frame.camera.clip_to_previous_clip;
  m[4] = 1.f / 256, m[8] = 1.f / 32, m[9] = -1.f / 64, m[11] = 1.f / 64, m[12] = 1.f / 128, m[13] = 1.f / 512;
  frame.reset = i == 4;
  frame.parity = i % 2;
  return frame;
}

class Conventions : public ::testing::TestWithParam<Run> {};

// Frames of the scene, given or native. With motion blur the pictures are the blurred ones.
std::vector<std::vector<Pixel>> pictures_of(const Device& device, const Run& run, const Given& given) {
  ResolveSettings settings = run.settings;
  const auto [drawn, sky] = std::pair(settings.conventions.drawn_velocity, settings.conventions.sky_motion);
  settings.conventions = given.conventions;
  settings.conventions.drawn_velocity = drawn;
  settings.conventions.sky_motion = sky;
  ServiceRig rig(device, run.needs, settings, kOutput, kTarget);
  const Image finished = device.allocate(kOutput, settings.output.linear).value();
  std::vector<std::vector<Pixel>> pictures;
  HostFrame previous = scene_frame(0, given.depths);
  for (int i = 0; i < 7; ++i) {
    const HostFrame frame = scene_frame(i, given.depths);
    FrameInputs inputs = rig.upload(as_given(given, frame, previous));
    inputs.near_plane = given.near_plane;
    inputs.far_plane = given.far_plane;
    const FrameReport report = rig.service().dispatch(inputs, {.linear = finished.view()});
    EXPECT_TRUE(report.ok()) << report.status.message();
    pictures.emplace_back(static_cast<std::size_t>(kOutput.area()));
    EXPECT_TRUE(device.download(finished.view(), kOutput, pictures.back().data()).ok());
    if (given.conventions.origin == Origin::kBottom) turn_rows(pictures.back(), kOutput);
    previous = frame;
  }
  return pictures;
}

TEST_P(Conventions, MakeTheSamePictures) {
  const Device device = Device::open().value();
  const auto expected = pictures_of(device, GetParam(), {});
  const auto before_far_plane = pictures_of(device, GetParam(), {.depths = kBeforeFarPlane});
  for (const Given& given : kGiven) {
    EXPECT_EQ(given.depths == kBeforeFarPlane ? before_far_plane : expected,
              pictures_of(device, GetParam(), given))
        << given.name;
  }
}

const Run kMethods[] = {
    {.name = "temporal", .settings = {.method = Method::kTemporal}, .needs = kOpaque},
    {.name = "temporal_images",
     .settings = {.method = Method::kTemporal, .targets = {.storage = Storage::kImage}},
     .needs = kOpaque},
    {.name = "temporal_dilated_far",
     .settings = {.method = Method::kTemporal,
                  .conventions = {.drawn_velocity = DrawnVelocity::kDilated,
                                  .sky_motion = SkyMotion::kCamera}}},
    {.name = "velocity", .settings = {.method = Method::kQuincunx}},
    {.name = "reprojected_blurred",
     .settings = {.method = Method::kQuincunx,
                  .quincunx = {.form = TwoFrameForm::kReprojected, .residual_weight = 1},
                  .blur = {.shutter = 2}}},
    {.name = "camera",
     .settings = {.method = Method::kQuincunx, .quincunx = {.form = TwoFrameForm::kReprojected}},
     .needs = kCameraOnly},
    {.name = "checkerboard",
     .settings = {.method = Method::kTemporal, .targets = {.shading = Shading::kCheckerboard}},
     .needs = kOpaque},
};

INSTANTIATE_TEST_SUITE_P(Methods, Conventions, ::testing::ValuesIn(kMethods), name_of_run);

// ---- Plans.

ResolvePlan plan_with(const InputConventions& conventions, Storage storage = Storage::kBuffer) {
  return plan_for({}, {.method = Method::kTemporal,
                       .output_extent = kOutput,
                       .target_extent = kTarget,
                       .conventions = conventions,
                       .targets = {.storage = storage}})
      .value();
}

std::vector<std::string> conversions(const ResolvePlan& plan) {
  std::vector<std::string> reasons;
  for (const PlannedPass& pass : plan.passes) {
    if (pass.kernel == "convert_inputs") reasons.push_back(pass.reason);
  }
  return reasons;
}

TEST(ConventionsPlan, UnitsSignsAndRowsOfBuffersTakeNoPass) {
  const ResolvePlan native = plan_with({});
  const ResolvePlan given = plan_with({.clip_space = ClipSpace::kOpenGl,
                                       .velocity_unit = VelocityUnit::kNdc,
                                       .velocity_backward = true,
                                       .velocity_up = true,
                                       .origin = Origin::kBottom});
  EXPECT_EQ(given.passes, native.passes);
  EXPECT_EQ(given.buffers, native.buffers);
  EXPECT_TRUE(given.keeps_previous_frame());
  EXPECT_EQ(native.explain().find("Conventions"), std::string::npos);
  EXPECT_NE(
      given.explain().find("Conventions    depth reversed infinite; velocity in ndc, previous - this, +y up; "
                           "bottom row first; clip space of OpenGL\n"),
      std::string::npos)
      << given.explain();
}

TEST(ConventionsPlan, OnlyWhatHasToBeIsConverted) {
  EXPECT_EQ(conversions(plan_with({.depth = kForward})), (std::vector<std::string>{"depth is forward"}));
  EXPECT_EQ(conversions(plan_with({.velocity_jittered = true})),
            (std::vector<std::string>{"velocity has the jitter in it"}));
  const ResolvePlan images = plan_with({.depth = kLinear, .origin = Origin::kBottom}, Storage::kImage);
  EXPECT_EQ(
      conversions(images),
      (std::vector<std::string>{"colour is an image that begins with the lowest row",
                                "velocity is an image that begins with the lowest row", "depth is linear",
                                "reactive is an image that begins with the lowest row"}));
  EXPECT_FALSE(images.keeps_previous_frame());
  const ResolvePlan one_frame = plan_for({}, {.method = Method::kBilinear,
                                              .output_extent = kOutput,
                                              .target_extent = kTarget,
                                              .conventions = {.depth = kForward, .velocity_jittered = true}})
                                    .value();
  EXPECT_TRUE(conversions(one_frame).empty());
}

}  // namespace
}  // namespace quincunx

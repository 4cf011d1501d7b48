// SPDX-License-Identifier: MIT
// The C interface: the pictures of the C++ one, bad input, and settings of programs of any age.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "c_fixture.h"
#include "service_fixture.h"

namespace quincunx::testing {
namespace {

// Version 2; a field that is appended raises the left side alone.
static_assert(sizeof(void*) != 8 ||
              (sizeof(quincunx_settings) == 232 && sizeof(quincunx_needs) == 48 &&
               sizeof(quincunx_image) == 48 && sizeof(quincunx_inputs) == 208 &&
               sizeof(quincunx_outputs) == 24 && sizeof(quincunx_report) == 112 &&
               sizeof(quincunx_particles) == 40 && sizeof(quincunx_focus) == 48 &&
               sizeof(quincunx_fade) == 24 && sizeof(quincunx_sync) == 56 && sizeof(quincunx_content) == 64 &&
               sizeof(quincunx_external_memory) == 48));

// ServiceRig's twin behind the C interface, all of whose images lie in host memory.
class CRig {
 public:
  CRig(const SceneNeeds& needs, ResolveSettings settings, Extent output, Extent target)
      : settings_(settings) {
    settings_.output_extent = output;
    settings_.target_extent = target;
    settings_.colour = PixelFormat::kRGBA32F;
    settings_.velocity = PixelFormat::kRG32F;
    settings_.output.dither = false;
    plan_ = c_plan(needs, settings_);
    device_ = c_device(nullptr);
    service_ = c_service(device_, plan_);
    resolved_ = std::make_unique<HostPicture>(output, settings_.output.linear);
    presented_ = std::make_unique<HostPicture>(output, PixelFormat::kRGBA8);
    outputs_ = {sizeof(outputs_), resolved_->image(), presented_->image()};
  }

  // The frame's images are gone when it returns.
  quincunx_status resolve(const HostFrame& frame, quincunx_report* report = nullptr) {
    const Extent size =
        settings_.targets.placement == Targets::kPlaced ? frame.render : settings_.target_extent;
    HostPicture colour(size, settings_.colour), velocity(size, settings_.velocity);
    HostPicture depth(size, PixelFormat::kR32F), reactive(size, PixelFormat::kR8);
    colour.fill<Pixel>(frame.render, frame.colour);
    velocity.fill<Vec2>(frame.render, frame.velocity);
    depth.fill<float>(frame.render, frame.depth);
    reactive.fill<std::uint8_t>(frame.render, frame.reactive);
    auto inputs = sized<quincunx_inputs>();
    inputs.colour = colour.image();
    inputs.depth = depth.image();
    inputs.velocity = velocity.image();
    inputs.reactive = reactive.image();
    inputs.render_width = frame.render.width;
    inputs.render_height = frame.render.height;
    inputs.jitter_x = frame.jitter.x;
    inputs.jitter_y = frame.jitter.y;
    std::memcpy(inputs.clip_to_previous_clip, frame.camera.clip_to_previous_clip.data(),
                sizeof(inputs.clip_to_previous_clip));
    inputs.reset = frame.reset;
    inputs.parity = frame.parity;
    inputs.frame_index = count_++;
    return quincunx_dispatch(service_.get(), &inputs, &outputs_, report);
  }

  quincunx_service* service() { return service_.get(); }
  quincunx_plan* plan() { return plan_.get(); }
  HostPicture& resolved() { return *resolved_; }
  HostPicture& presented() { return *presented_; }
  void leave_device() { device_.reset(); }

 private:
  ResolveSettings settings_;
  COwner<quincunx_plan> plan_;
  COwner<quincunx_device> device_;
  COwner<quincunx_service> service_;
  std::unique_ptr<HostPicture> resolved_, presented_;
  quincunx_outputs outputs_ = {};
  std::uint64_t count_ = 0;
};

}  // namespace

}  // namespace quincunx::testing

namespace quincunx {
namespace {

using testing::c_inputs;
using testing::c_plan;
using testing::c_service;
using testing::c_settings;
using testing::COwner;
using testing::CRig;
using testing::HostFrame;
using testing::Pixel;
using testing::sized;

constexpr Extent kOutput{48, 27};
constexpr Extent kTarget{64, 36};

bool tells(const char* words) {
  return std::string(quincunx_last_error()).find(words) != std::string::npos;
}

// The C interface makes the same pictures as the C++ one, from memory objects and from host memory.
struct CRun {
  const char* name;
  ResolveSettings settings;
  SceneNeeds needs = {};
};

class CPictures : public ::testing::TestWithParam<CRun> {};

// Any resolution each frame; what host memory holds between rows never counts and never changes.
TEST_P(CPictures, FromHostMemoryAreTheSame) {
  const CRun& run = GetParam();
  testing::ServiceRig expected(run.needs, run.settings, kOutput, kTarget);
  CRig rig(run.needs, run.settings, kOutput, kTarget);
  rig.leave_device();  // the service keeps what it needs of it
  std::mt19937 random(99);
  for (int i = 0; i < 30; ++i) {
    HostFrame frame = testing::random_frame(random, kTarget);
    frame.camera.clip_to_previous_clip[8] = static_cast<float>(random() % 64) / 512;
    const std::vector<Pixel> resolved = expected.resolve(frame);
    ASSERT_EQ(rig.resolve(frame), QUINCUNX_OK) << quincunx_last_error();
    const auto texels = rig.resolved().texels();
    ASSERT_EQ(texels.size(), resolved.size() * sizeof(Pixel));
    ASSERT_EQ(std::memcmp(texels.data(), resolved.data(), texels.size()), 0) << "frame " << i;
    ASSERT_EQ(rig.presented().texels(), expected.presented()) << "frame " << i;
    ASSERT_TRUE(rig.resolved().gaps_are_whole() && rig.presented().gaps_are_whole()) << "frame " << i;
  }
}

const CRun kRuns[] = {
    {.name = "bilinear", .settings = {.method = Method::kBilinear}},
    {.name = "quincunx", .settings = {.method = Method::kQuincunx}},
    {.name = "reprojected", .settings = {.quincunx = {.form = TwoFrameForm::kReprojected}}},
    {.name = "temporal", .settings = {.method = Method::kTemporal}},
    {.name = "camera", .settings = {.method = Method::kTemporal}, .needs = {.moving_objects = false}},
    {.name = "placed", .settings = {.method = Method::kTemporal, .targets = {.placement = Targets::kPlaced}}},
    {.name = "images", .settings = {.method = Method::kTemporal, .targets = {.storage = Storage::kImage}}},
};
INSTANTIATE_TEST_SUITE_P(Methods, CPictures, ::testing::ValuesIn(kRuns),
                         [](const auto& instance) { return instance.param.name; });

// The caller's own context, queue and memory objects, half precision, and the report of each frame.
TEST(CInterface, BorrowsDeviceAndMemoryObjects) {
  Device own = Device::open().value();
  quincunx_device* raw = nullptr;
  ASSERT_EQ(quincunx_device_borrow(own.context(), own.id(), own.queue(), &raw), QUINCUNX_OK);
  COwner<quincunx_device> device(raw);
  EXPECT_EQ(quincunx_device_queue(raw), own.queue());
  EXPECT_STREQ(quincunx_device_name(raw), own.info().name.c_str());
  const auto plan = c_plan({.background = false}, {.method = Method::kBilinear,
                                                   .output_extent = kOutput,
                                                   .target_extent = kTarget,
                                                   .targets = {.clear = true},
                                                   .output = {.present = false}});
  const auto service = c_service(device, plan);
  const Image colour = own.allocate(kTarget, PixelFormat::kRGBA16F).value();
  const Image resolved = own.allocate(kOutput, PixelFormat::kRGBA32F).value();
  const auto image = [](const Image& of, int format) {
    return quincunx_image{sizeof(quincunx_image),
                          QUINCUNX_BUFFER,
                          format,
                          of.view().extent.width,
                          of.view().extent.height,
                          0,
                          0,
                          of.view().memory};
  };
  const quincunx_image in = image(colour, QUINCUNX_RGBA16F), out = image(resolved, QUINCUNX_RGBA32F);
  const float value[4] = {0.25f, 0.5f, 2, 1};
  ASSERT_EQ(quincunx_clear(service.get(), &in, 20, 10, value), QUINCUNX_OK) << quincunx_last_error();

  quincunx_inputs inputs = c_inputs(&in, {20, 10});
  inputs.frame_index = 77;
  const quincunx_outputs outputs = {sizeof(outputs), &out, nullptr};
  quincunx_pass_report passes[20];
  auto report = sized<quincunx_report>();
  ASSERT_EQ(quincunx_dispatch(service.get(), &inputs, &outputs, &report), QUINCUNX_OK)
      << quincunx_last_error();
  EXPECT_EQ(report.frame_index, 77u);
  EXPECT_FLOAT_EQ(report.ratio_x, 20.f / 48);
  EXPECT_EQ(report.non_finite_pixels, -1);
  ASSERT_EQ(quincunx_finish(service.get()), QUINCUNX_OK);
  std::vector<Pixel> pixels(static_cast<std::size_t>(kOutput.area()));
  ASSERT_TRUE(own.download(resolved.view(), kOutput, pixels.data()).ok());
  for (const Pixel& pixel : pixels)
    ASSERT_EQ(pixel, (Pixel{0.25f, 0.5f, 2, 1}));

  report.passes = passes;
  report.pass_capacity = 20;
  ASSERT_EQ(quincunx_next_report(service.get(), &report), QUINCUNX_OK);
  EXPECT_EQ(report.frame_index, 77u);
  EXPECT_EQ(report.non_finite_pixels, 0);
  ASSERT_EQ(report.pass_count, 1);
  EXPECT_STREQ(passes[0].kernel, "scale_bilinear");
  EXPECT_GT(passes[0].bytes, 0u);
  EXPECT_EQ(quincunx_next_report(service.get(), &report), QUINCUNX_NOT_READY);
}

// A refused frame leaves outputs and history as they were.
TEST(CInterface, ABadFrameIsRefusedWhole) {
  testing::ServiceRig expected({}, Method::kTemporal, kOutput, kTarget);
  CRig rig({}, {.method = Method::kTemporal}, kOutput, kTarget);
  std::mt19937 random(5);
  for (int i = 0; i < 6; ++i) {
    const HostFrame frame = testing::random_frame(random, kTarget);
    HostFrame bad = testing::random_frame(random, kTarget);
    bad.jitter.y = 2;
    const auto before = rig.resolved().texels();
    ASSERT_EQ(rig.resolve(bad), QUINCUNX_INVALID_ARGUMENT);
    EXPECT_TRUE(tells("jitter_y is 2; it must lie in [-1, 1]")) << quincunx_last_error();
    ASSERT_EQ(rig.resolved().texels(), before);
    const std::vector<Pixel> resolved = expected.resolve(frame);
    ASSERT_EQ(rig.resolve(frame), QUINCUNX_OK) << quincunx_last_error();
    const auto texels = rig.resolved().texels();
    ASSERT_EQ(std::memcmp(texels.data(), resolved.data(), texels.size()), 0) << "frame " << i;
  }
}

// The C interface answers bad input with a code and a sentence.

TEST(CErrors, ValidateNamesTheField) {
  const auto plan =
      c_plan({}, {.method = Method::kBilinear, .output_extent = kOutput, .target_extent = kTarget});
  float texels[4] = {};
  quincunx_image colour = {sizeof(colour), QUINCUNX_HOST, QUINCUNX_RGBA16F, 64, 36, 0, 0, texels};
  quincunx_image picture = {sizeof(picture), QUINCUNX_HOST, QUINCUNX_RGBA32F, 48, 27, 0, 0, texels};
  quincunx_inputs inputs = c_inputs(&colour, {64, 36});
  quincunx_outputs outputs = {sizeof(outputs), &picture, nullptr};
  const auto check = [&] { return quincunx_validate(plan.get(), &inputs, &outputs); };
  ASSERT_EQ(check(), QUINCUNX_OK) << quincunx_last_error();  // and no texel was read
  const auto refuses = [&](const char* words) {
    return check() == QUINCUNX_INVALID_ARGUMENT && tells(words);
  };
  colour.pitch = 511;
  EXPECT_TRUE(refuses("colour.pitch is 511; a row of 64 texels of RGBA16F takes 512"))
      << quincunx_last_error();
  colour.pitch = 0;
  colour.offset = 16;
  EXPECT_TRUE(refuses("colour.offset is 16; in host memory it must be 0")) << quincunx_last_error();
  colour.offset = 0;
  colour.place = 3;
  EXPECT_TRUE(refuses("colour.place is 3; it must lie in [0, 2]")) << quincunx_last_error();
  colour.place = QUINCUNX_HOST;
  colour.format = QUINCUNX_RGBA8;
  EXPECT_TRUE(refuses("colour.format is RGBA8; the plan has RGBA16F")) << quincunx_last_error();
  colour.format = 0;
  EXPECT_TRUE(refuses("colour.format is 0; it must lie in [1, 7]")) << quincunx_last_error();
  colour.format = QUINCUNX_RGBA16F;
  colour.memory = nullptr;
  EXPECT_TRUE(refuses("colour.memory is NULL")) << quincunx_last_error();
  inputs.colour = nullptr;
  EXPECT_TRUE(refuses("colour is missing; the plan needs it as RGBA16F")) << quincunx_last_error();
}

TEST(CErrors, NullPointersAreErrors) {
  EXPECT_EQ(quincunx_settings_init(nullptr), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_TRUE(tells("settings is NULL")) << quincunx_last_error();
  EXPECT_EQ(quincunx_plan_create(nullptr, nullptr), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_EQ(quincunx_device_open("", nullptr), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_EQ(quincunx_dispatch(nullptr, nullptr, nullptr, nullptr), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_TRUE(tells("service is NULL")) << quincunx_last_error();
  quincunx_service* service = reinterpret_cast<quincunx_service*>(16);
  EXPECT_EQ(quincunx_service_create(nullptr, nullptr, &service), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_EQ(service, nullptr);
  quincunx_service_destroy(nullptr);
  quincunx_plan_destroy(nullptr);
  quincunx_device_destroy(nullptr);
  EXPECT_EQ(quincunx_plan_text(nullptr), nullptr);
}

TEST(CErrors, ADeviceThatIsNotThereIsNamed) {
  quincunx_device* device = nullptr;
  EXPECT_EQ(quincunx_device_open("no such device", &device), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_EQ(device, nullptr);
  EXPECT_TRUE(tells("no OpenCL device matches 'no such device'")) << quincunx_last_error();
}

TEST(CErrors, EachThreadHasItsOwnSentence) {
  EXPECT_EQ(quincunx_finish(nullptr), QUINCUNX_INVALID_ARGUMENT);
  std::string other = "not asked";
  std::thread([&other] { other = quincunx_last_error(); }).join();
  EXPECT_EQ(other, "");
  EXPECT_TRUE(tells("service is NULL"));
}

// Settings pass through the C interface whole, and programs and libraries of different age understand each other.

// Does not compile once a struct has a field more: c/settings.h then wants it at its end, too, and here.
SceneNeeds other_needs() {
  SceneNeeds needs;
  auto& [moving_objects, camera_motion, transparents, background] = needs;
  moving_objects = camera_motion = transparents = background = false;
  return needs;
}

ResolveSettings other_settings() {
  ResolveSettings settings;
  auto& [method, output_extent, target_extent, colour, velocity, conventions, sharpness, targets, output,
         filter, quincunx, temporal, blur, focus, control, checks_motion] = settings;
  method = Method::kTemporal;
  output_extent = {3, 4};
  target_extent = {5, 6};
  colour = PixelFormat::kRGBA8;
  velocity = PixelFormat::kRG32F;
  auto& [depth, clip_space, velocity_unit, velocity_backward, velocity_up, velocity_jittered, origin,
         drawn_velocity, sky_motion] = conventions;
  depth = DepthConvention::kLinear;
  clip_space = ClipSpace::kVulkan;
  velocity_unit = VelocityUnit::kNdc;
  velocity_backward = velocity_up = velocity_jittered = true;
  origin = Origin::kBottom;
  drawn_velocity = DrawnVelocity::kDilated;
  sky_motion = SkyMotion::kEvidence;
  sharpness = 0.75f;
  auto& [storage, placement, shading, particle_extent, clear] = targets;
  storage = Storage::kImage;
  placement = Targets::kPlaced;
  shading = Shading::kCheckerboard;
  particle_extent = {7, 8};
  clear = true;
  auto& [min_extent, linear, present, tone_map, dither] = output;
  min_extent = {1, 2};
  linear = PixelFormat::kRGBA16F;
  tone_map = ToneMap::kReinhard;
  auto& [clamp_ringing, grain, noise_moves] = filter;
  grain = 0.125f;
  present = dither = clamp_ringing = noise_moves = false;
  auto& [form, sampling, velocity_weight, residual_weight] = quincunx;
  form = TwoFrameForm::kReprojected;
  sampling = Sampling::kPoint;
  velocity_weight = 2;
  residual_weight = 3;
  auto& [preset, view, history, noise] = temporal;
  preset = TemporalPreset::kQuality;
  view = TemporalView::kFar;
  history = PixelFormat::kRGBA32F;
  noise = 0.25f;
  auto& [shutter, samples] = blur;
  shutter = 1.5f;
  samples = 64;
  focus = {.extent = {9, 10}, .target_extent = {11, 12}, .mask = true};
  auto& [measures_content, fades] = control;
  measures_content = fades = checks_motion = true;
  return settings;
}

TEST(CSettings, EveryFieldArrives) {
  const quincunx_settings settings = c_settings({other_needs(), other_settings()});
  const auto back = c::from_c(&settings);
  ASSERT_TRUE(back.ok()) << back.status().message();
  EXPECT_EQ(back->needs, other_needs());
  EXPECT_EQ(back->resolve, other_settings());
}

TEST(CSettings, DefaultsAreThoseOfTheLibrary) {
  quincunx_settings settings;
  std::memset(&settings, 0xff, sizeof(settings));
  settings.struct_size = sizeof(settings);
  ASSERT_EQ(quincunx_settings_init(&settings), QUINCUNX_OK) << quincunx_last_error();
  const auto read = c::from_c(&settings);
  ASSERT_TRUE(read.ok()) << read.status().message();
  EXPECT_EQ(read->needs, SceneNeeds());
  EXPECT_EQ(read->resolve, ResolveSettings());
}

TEST(CSettings, ANumberThatNamesNothingIsRefused) {
  quincunx_settings settings = c_settings({});
  settings.method = 99;
  const auto read = c::from_c(&settings);
  ASSERT_FALSE(read.ok());
  EXPECT_EQ(read.status().message(), "settings.method is 99; it must lie in [0, 10]");
  settings.method = 0;
  settings.colour_format = 0;
  EXPECT_EQ(c::from_c(&settings).status().message(), "settings.colour_format is 0; it must lie in [1, 7]");
}

TEST(CSettings, MethodsAreKnownByName) {
  EXPECT_STREQ(quincunx_method_name(QUINCUNX_TWO_FRAMES), "quincunx");
  EXPECT_STREQ(quincunx_method_name(QUINCUNX_TEMPORAL), "temporal");
  EXPECT_EQ(quincunx_method_name(-1), nullptr);
  EXPECT_EQ(quincunx_method_name(static_cast<int>(methods().size())), nullptr);
}

// A program of a later version, whose struct has fields that this library does not know.
struct LaterSettings {
  quincunx_settings settings;
  std::int64_t later;
};

TEST(CSettings, AProgramThatIsNewerIsUnderstoodUntilItUsesWhatIsNew) {
  LaterSettings later = {c::to_c({{}, {.output_extent = {64, 36}, .target_extent = {64, 36}}}), 0};
  later.settings.struct_size = sizeof(later);
  quincunx_plan* plan = nullptr;
  ASSERT_EQ(quincunx_plan_create(&later.settings, &plan), QUINCUNX_OK) << quincunx_last_error();
  COwner<quincunx_plan> owner(plan);
  later.later = 1;
  EXPECT_EQ(quincunx_plan_create(&later.settings, &plan), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_EQ(plan, nullptr);
  EXPECT_NE(std::string(quincunx_last_error()).find("a field beyond the 232 bytes that this library knows"),
            std::string::npos)
      << quincunx_last_error();
  later.later = 12345;
  ASSERT_EQ(quincunx_settings_init(&later.settings), QUINCUNX_OK);
  EXPECT_EQ(later.later, 12345);
  EXPECT_EQ(later.settings.struct_size, sizeof(later));
}

TEST(CSettings, AStructWithoutItsSizeIsRefused) {
  quincunx_settings settings = {};
  EXPECT_EQ(quincunx_settings_init(&settings), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_STREQ(quincunx_last_error(),
               "settings.struct_size is 0; it must be the sizeof of the struct, in [144, 4096]");
}

TEST(CSettings, NeedsAreThoseOfThePlan) {
  const auto plan = testing::c_plan({.moving_objects = false}, {.method = Method::kTemporal,
                                                                .output_extent = {64, 36},
                                                                .target_extent = {64, 36},
                                                                .blur = {.shutter = 0.5f}});
  auto needs = sized<quincunx_needs>();
  ASSERT_EQ(quincunx_plan_needs(plan.get(), &needs), QUINCUNX_OK) << quincunx_last_error();
  EXPECT_EQ(needs.reads_depth, 1);
  EXPECT_EQ(needs.reads_velocity, 0);
  EXPECT_EQ(needs.reads_reactive, 1);
  EXPECT_EQ(needs.reads_camera, 1);
  EXPECT_EQ(needs.keeps_previous_frame, 1);
  EXPECT_EQ(needs.accumulates, 1);
  EXPECT_GT(needs.frame_bytes, 64u * 36 * 12);
  EXPECT_NE(std::string(quincunx_plan_text(plan.get())).find("velocity_from_depth"), std::string::npos);
}

TEST(CSettings, VersionsAreTold) {
  EXPECT_EQ(quincunx_api_version(), QUINCUNX_API_VERSION);
  EXPECT_NE(std::string(quincunx_version()).find('.'), std::string::npos);
}

}  // namespace

}  // namespace quincunx

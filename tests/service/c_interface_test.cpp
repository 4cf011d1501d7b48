// SPDX-License-Identifier: MIT
// The C interface makes the same pictures as the C++ one, from memory objects and from host memory.
#include "quincunx/quincunx.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "c_interface_fixture.h"
#include "random_frame.h"

namespace quincunx {
namespace {

using testing::c_plan;
using testing::COwner;
using testing::CRig;
using testing::HostFrame;
using testing::Pixel;

constexpr Extent kOutput{48, 27};
constexpr Extent kTarget{64, 36};

bool tells(const char* words) {
  return std::string(quincunx_last_error()).find(words) != std::string::npos;
}

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
    {.name = "placed", .settings = {.method = Method::kTemporal, .targets = Targets::kPlaced}},
    {.name = "images", .settings = {.method = Method::kTemporal, .storage = Storage::kImage}},
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
  const auto plan = c_plan(
      {.background = false},
      {.method = Method::kBilinear, .output = kOutput, .target = kTarget, .present = false, .clear = true});
  quincunx_service* made = nullptr;
  ASSERT_EQ(quincunx_service_create(raw, plan.get(), &made), QUINCUNX_OK) << quincunx_last_error();
  COwner<quincunx_service> service(made);
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
  ASSERT_EQ(quincunx_clear(made, &in, 20, 10, value), QUINCUNX_OK) << quincunx_last_error();

  quincunx_inputs inputs = {};
  inputs.struct_size = sizeof(inputs);
  inputs.colour = &in;
  inputs.render_width = 20;
  inputs.render_height = 10;
  inputs.frame_index = 77;
  const quincunx_outputs outputs = {sizeof(outputs), &out, nullptr, nullptr};
  quincunx_pass_report passes[20];
  quincunx_report report = {};
  report.struct_size = sizeof(report);
  ASSERT_EQ(quincunx_dispatch(made, &inputs, &outputs, &report), QUINCUNX_OK) << quincunx_last_error();
  EXPECT_EQ(report.frame_index, 77u);
  EXPECT_FLOAT_EQ(report.ratio_x, 20.f / 48);
  EXPECT_EQ(report.non_finite_pixels, -1);
  ASSERT_EQ(quincunx_finish(made), QUINCUNX_OK);
  std::vector<Pixel> pixels(static_cast<std::size_t>(kOutput.area()));
  ASSERT_TRUE(own.download(resolved.view(), kOutput, pixels.data()).ok());
  for (const Pixel& pixel : pixels)
    ASSERT_EQ(pixel, (Pixel{0.25f, 0.5f, 2, 1}));

  report.passes = passes;
  report.pass_capacity = 20;
  ASSERT_EQ(quincunx_next_report(made, &report), QUINCUNX_OK);
  EXPECT_EQ(report.frame_index, 77u);
  EXPECT_EQ(report.non_finite_pixels, 0);
  ASSERT_EQ(report.pass_count, 1);
  EXPECT_STREQ(passes[0].kernel, "scale_bilinear");
  EXPECT_GT(passes[0].bytes, 0u);
  EXPECT_EQ(quincunx_next_report(made, &report), QUINCUNX_NOT_READY);
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
    EXPECT_TRUE(tells("jitter.y is 2; it must lie in [-1, 1]")) << quincunx_last_error();
    ASSERT_EQ(rig.resolved().texels(), before);
    const std::vector<Pixel> resolved = expected.resolve(frame);
    ASSERT_EQ(rig.resolve(frame), QUINCUNX_OK) << quincunx_last_error();
    const auto texels = rig.resolved().texels();
    ASSERT_EQ(std::memcmp(texels.data(), resolved.data(), texels.size()), 0) << "frame " << i;
  }
}

}  // namespace
}  // namespace quincunx

// SPDX-License-Identifier: MIT
// validate() needs no device: views here hold a made-up handle that is never dereferenced.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "quincunx/resolve_service.h"

namespace quincunx {
namespace {

const cl_mem kMadeUp = reinterpret_cast<cl_mem>(0x10);

ImageView view(PixelFormat format, Extent extent = {1280, 720}) {
  return {.memory = kMadeUp, .format = format, .extent = extent};
}

class Validate : public ::testing::Test {
 protected:
  Validate() {
    settings_.method = Method::kQuincunx;
    settings_.output_extent = {1280, 720};
    settings_.target_extent = {1280, 720};
    inputs_.colour = view(PixelFormat::kRGBA16F);
    inputs_.velocity = view(PixelFormat::kRG16F);
    inputs_.reactive = view(PixelFormat::kR8);
    inputs_.depth = view(PixelFormat::kR32F);
    inputs_.render_extent = {908, 512};
    inputs_.jitter = {0.25f, -0.25f};
    outputs_.linear = view(PixelFormat::kRGBA32F);
    outputs_.presented = view(PixelFormat::kRGBA8);
  }

  Status check(const SceneNeeds& needs = {}) const {
    return validate(plan_for(needs, settings_).value(), inputs_, outputs_);
  }

  ResolveSettings settings_;
  FrameInputs inputs_;
  FrameOutputs outputs_;
};

TEST_F(Validate, AGoodFramePasses) {
  EXPECT_TRUE(check().ok()) << check().message();
  outputs_.linear = {};
  EXPECT_TRUE(check().ok());
}

// Kernels count the channels of texels in 32 bits, from the start of the buffer.
TEST_F(Validate, AnImageEndsWhereKernelsCanCountTo) {
  constexpr std::size_t kTwoGiB = std::size_t{1} << 31;
  const auto refused = [&](const char* field) {
    const std::string message = check().message();
    return message.starts_with(std::string(field) + ".offset is ") &&
           message.find("must end within the first") != std::string::npos;
  };
  inputs_.reactive.offset = kTwoGiB - 1280 * 720;
  EXPECT_TRUE(check().ok()) << check().message();
  inputs_.reactive.offset += 16;
  EXPECT_TRUE(refused("reactive")) << check().message();
  inputs_.reactive.offset = 0;
  inputs_.colour.offset = 2 * kTwoGiB - 1280 * 720 * 8;
  EXPECT_TRUE(check().ok()) << "halves take two bytes: " << check().message();
  inputs_.colour.offset += 16;
  EXPECT_TRUE(refused("colour")) << check().message();
  inputs_.colour.offset = std::numeric_limits<std::size_t>::max() - 15;
  EXPECT_TRUE(refused("colour")) << check().message();
  inputs_.colour.offset = 0;
  inputs_.colour.pitch = std::size_t{1} << 40;
  EXPECT_TRUE(refused("colour")) << check().message();
  inputs_.colour.pitch = std::numeric_limits<std::size_t>::max() - 7;
  EXPECT_TRUE(refused("colour")) << check().message();
  inputs_.colour.pitch = 0;
  outputs_.linear.offset = 4 * kTwoGiB;
  EXPECT_TRUE(refused("linear")) << check().message();
}

TEST_F(Validate, ACheckerboardHasAShadedPixel) {
  inputs_.parity = 2;
  EXPECT_TRUE(check().ok()) << "all pixels are shaded";
  settings_.targets.shading = Shading::kCheckerboard;
  EXPECT_NE(check().message().find("parity is 2; it must be 0 or 1"), std::string::npos) << check().message();
  inputs_.parity = 1;
  EXPECT_TRUE(check().ok()) << check().message();
  inputs_.render_extent = {1, 1};
  EXPECT_NE(check().message().find("it must be 0 where the viewport is a single pixel"), std::string::npos);
  inputs_.render_extent = {1, 2};
  EXPECT_TRUE(check().ok()) << check().message();
  inputs_.depth = {};
  EXPECT_FALSE(check().ok()) << "surfaces are told by depth";
}

TEST_F(Validate, WhatThePlanDoesNotReadMayBeMissing) {
  inputs_.depth = {};
  EXPECT_TRUE(check().ok());
  inputs_.velocity = {};
  EXPECT_FALSE(check().ok());
  inputs_.depth = view(PixelFormat::kR32F);
  EXPECT_TRUE(check({.moving_objects = false}).ok());
  inputs_.reactive = {};
  EXPECT_TRUE(check({.moving_objects = false, .transparents = false}).ok());
}

// The service makes each sample's own velocity from the caller's, which it needs all the same.
TEST_F(Validate, DilatedVelocityIsNeededAsOwnVelocityIs) {
  settings_.conventions.drawn_velocity = DrawnVelocity::kDilated;
  for (const Method method : {Method::kQuincunx, Method::kTemporal}) {
    for (const SkyMotion far : {SkyMotion::kAsDrawn, SkyMotion::kCamera, SkyMotion::kEvidence}) {
      settings_.method = method;
      settings_.conventions.sky_motion = far;
      inputs_.velocity = view(PixelFormat::kRG16F);
      EXPECT_TRUE(check().ok()) << check().message();
      inputs_.velocity.extent = {907, 512};
      EXPECT_EQ(check().message(), "velocity.extent is 907x512; it must hold the viewport of 908x512");
      inputs_.velocity = {};
      EXPECT_EQ(check().message(),
                "velocity is missing; the plan needs it as RG16F, or plan with moving_objects = false");
    }
  }
}

TEST_F(Validate, EachBadFieldIsNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  struct Case {
    std::string field;
    std::function<void(FrameInputs&, FrameOutputs&)> spoil;
  };
  const std::vector<Case> cases = {
      {"colour is missing", [](auto& in, auto&) { in.colour = {}; }},
      {"colour.format", [](auto& in, auto&) { in.colour.format = PixelFormat::kRGBA32F; }},
      {"colour.storage", [](auto& in, auto&) { in.colour.storage = Storage::kImage; }},
      {"colour.extent",
       [](auto& in, auto&) {
         in.colour.extent = {900, 512};
       }},
      {"colour.pitch", [](auto& in, auto&) { in.colour.pitch = 1280 * 8 - 8; }},
      {"colour.pitch", [](auto& in, auto&) { in.colour.pitch = 1280 * 8 + 3; }},
      {"colour.offset", [](auto& in, auto&) { in.colour.offset = 8; }},
      {"velocity is missing", [](auto& in, auto&) { in.velocity = {}; }},
      {"velocity_scale.x", [nan](auto& in, auto&) { in.velocity_scale.x = nan; }},
      {"reactive is missing; the plan needs it as R8, or plan with transparents = false",
       [](auto& in, auto&) { in.reactive = {}; }},
      {"render_extent is 0x512", [](auto& in, auto&) { in.render_extent.width = 0; }},
      {"render_extent is 1281x512", [](auto& in, auto&) { in.render_extent.width = 1281; }},
      {"jitter.x", [nan](auto& in, auto&) { in.jitter.x = nan; }},
      {"jitter.y", [](auto& in, auto&) { in.jitter.y = 1.5f; }},
      {"exposure", [](auto& in, auto&) { in.exposure = -1; }},
      {"outputs", [](auto&, auto& out) { out = {}; }},
      {"linear.extent",
       [](auto&, auto& out) {
         out.linear.extent = {1280, 721};
       }},
      {"linear.format", [](auto&, auto& out) { out.linear.format = PixelFormat::kRGBA16F; }},
      {"presented.format", [](auto&, auto& out) { out.presented.format = PixelFormat::kRGBA16F; }},
      {"presented.extent",
       [](auto&, auto& out) {
         out.presented.extent = {640, 360};
       }},
  };
  for (const Case& bad : cases) {
    FrameInputs inputs = inputs_;
    FrameOutputs outputs = outputs_;
    bad.spoil(inputs, outputs);
    const Status status = validate(plan_for({}, settings_).value(), inputs, outputs);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument) << bad.field;
    EXPECT_NE(status.message().find(bad.field), std::string::npos)
        << bad.field << " not in: " << status.message();
  }
}

TEST_F(Validate, OneMessageNamesAllBadFields) {
  inputs_.colour = {};
  inputs_.jitter.x = 7;
  outputs_.presented.extent = {1, 1};
  const std::string message = check().message();
  for (const char* field : {"colour", "jitter.x", "presented.extent"}) {
    EXPECT_NE(message.find(field), std::string::npos) << field;
  }
}

TEST_F(Validate, ACameraThatIsNotFiniteIsRefusedWhereItIsRead) {
  inputs_.camera.clip_to_previous_clip[5] = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(check().ok());
  const Status status = check({.moving_objects = false});
  EXPECT_NE(status.message().find("camera"), std::string::npos);
  settings_.quincunx.form = TwoFrameForm::kReprojected;
  EXPECT_NE(check().message().find("camera"), std::string::npos);
}

TEST_F(Validate, PlanesAreAskedForWhereDepthLiesBetweenThem) {
  settings_.method = Method::kTemporal;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto message = [&](DepthConvention depth, float near_plane, float far_plane) {
    settings_.conventions.depth = depth;
    inputs_.near_plane = near_plane;
    inputs_.far_plane = far_plane;
    return check().message();
  };
  EXPECT_EQ(message(DepthConvention::kReversedInfinite, nan, -1), "");
  EXPECT_EQ(message(DepthConvention::kInfinite, nan, -1), "");
  EXPECT_EQ(message(DepthConvention::kLinear, .1f, -1), "");
  EXPECT_EQ(message(DepthConvention::kLinear, 0, 0),
            "near_plane is 0; where depth is linear it must be above 0 and finite");
  EXPECT_EQ(message(DepthConvention::kForward, nan, 1),
            "near_plane is nan; where depth is forward it must be above 0 and finite");
  EXPECT_EQ(message(DepthConvention::kForward, 2, 2),
            "far_plane is 2; it must be beyond the near plane at 2 and finite");
  EXPECT_EQ(message(DepthConvention::kReversed, 2, std::numeric_limits<float>::infinity()),
            "far_plane is inf; it must be beyond the near plane at 2 and finite");
  EXPECT_EQ(message(DepthConvention::kReversed, 2, 100), "");
  settings_.method = Method::kBilinear;
  EXPECT_EQ(message(DepthConvention::kLinear, 0, 0), "") << "nobody reads depth";
}

TEST_F(Validate, APresentedPictureNeedsAPresentPass) {
  settings_.output.present = false;
  EXPECT_NE(check().message().find("presented"), std::string::npos);
  outputs_.presented = {};
  EXPECT_TRUE(check().ok());
}

}  // namespace
}  // namespace quincunx

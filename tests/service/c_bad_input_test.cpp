// SPDX-License-Identifier: MIT
// Bad input over C: each wrong field is named in one sentence.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "c_fixture.h"
#include "device/opencl.h"

namespace quincunx {
namespace {

using testing::c_device;
using testing::c_service;
using testing::COwner;
using testing::Everything;
using testing::good_settings;
using testing::sized;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
COwner<quincunx_plan> plan_of(const quincunx_settings& settings) {
  quincunx_plan* plan = nullptr;
  EXPECT_EQ(quincunx_plan_create(&settings, &plan), QUINCUNX_OK) << quincunx_last_error();
  return COwner<quincunx_plan>(plan);
}

bool names(const char* word) {
  return std::string(quincunx_last_error()).find(word) != std::string::npos;
}

template <typename Struct>
struct Wrong {
  const char* word;  // that the sentence has
  std::function<void(Struct&)> set;
};

TEST(CBadInput, EachWrongSettingIsNamed) {
  using S = quincunx_settings;
  const Wrong<S> table[] = {
      {"settings.struct_size is 143", [](S& s) { s.struct_size = 143; }},
      {"settings.struct_size is 18446744073709551608", [](S& s) { s.struct_size = ~std::size_t{7}; }},
      {"settings.method is 11", [](S& s) { s.method = 11; }},
      {"settings.output_width x output_height is -1x18", [](S& s) { s.output_width = -1; }},
      {"settings.output_width x output_height is 24x2147483647", [](S& s) { s.output_height = 2147483647; }},
      {"settings.target_width x target_height is 0x18", [](S& s) { s.target_width = 0; }},
      {"settings.target_width x target_height is 24x-5", [](S& s) { s.target_height = -5; }},
      {"settings.colour_format is 8", [](S& s) { s.colour_format = 8; }},
      {"settings.colour_format is R8", [](S& s) { s.colour_format = QUINCUNX_R8; }},
      {"settings.velocity_format is RGBA8", [](S& s) { s.velocity_format = QUINCUNX_RGBA8; }},
      {"settings.linear_format is R32F", [](S& s) { s.linear_format = QUINCUNX_R32F; }},
      {"settings.storage is 2", [](S& s) { s.storage = QUINCUNX_HOST; }},
      {"settings.targets is -1", [](S& s) { s.targets = -1; }},
      {"settings.shading is 2", [](S& s) { s.shading = 2; }},
      {"settings.tone_map is 3", [](S& s) { s.tone_map = 3; }},
      {"settings.sky_motion is 3", [](S& s) { s.sky_motion = 3; }},
      {"settings.two_frame_form is 3", [](S& s) { s.two_frame_form = 3; }},
      {"settings.sampling is 2", [](S& s) { s.sampling = 2; }},
      {"settings.temporal_preset is 3", [](S& s) { s.temporal_preset = 3; }},
      {"settings.temporal_view is 8", [](S& s) { s.temporal_view = 8; }},
      {"settings.history_format is RG16F", [](S& s) { s.history_format = QUINCUNX_RG16F; }},
      {"settings.blur_samples is 7", [](S& s) { s.blur_samples = 7; }},
      {"settings.shutter is nan", [](S& s) { s.shutter = kNaN; }},
      {"settings.sharpness is 2", [](S& s) { s.sharpness = 2; }},
      {"settings.grain is -1", [](S& s) { s.grain = -1; }},
      {"settings.velocity_weight is inf", [](S& s) { s.velocity_weight = HUGE_VALF; }},
      {"settings.residual_weight is nan", [](S& s) { s.residual_weight = kNaN; }},
      {"settings.drawn_velocity is 2", [](S& s) { s.drawn_velocity = 2; }},
      {"settings.depth_convention is 5", [](S& s) { s.depth_convention = 5; }},
      {"settings.clip_space is 3", [](S& s) { s.clip_space = 3; }},
      {"settings.velocity_unit is 3", [](S& s) { s.velocity_unit = 3; }},
      {"settings.origin is -7", [](S& s) { s.origin = -7; }},
      {"settings.min_output_width x min_output_height is 30x1",
       [](S& s) { s.min_output_width = 30, s.min_output_height = 1; }},
      {"settings.particle_target_width x particle_target_height is 99x9",
       [](S& s) { s.particle_target_width = 99, s.particle_target_height = 9; }},
      {"settings.focus_width x focus_height is 25x2", [](S& s) { s.focus_width = 25, s.focus_height = 2; }},
      {"settings.focus_target_width x focus_target_height is -1x4",
       [](S& s) {
         s.focus_width = s.focus_height = 8;
         s.focus_target_width = -1, s.focus_target_height = 4;
       }},
  };
  for (const Wrong<S>& wrong : table) {
    S settings = good_settings();
    wrong.set(settings);
    auto* plan = reinterpret_cast<quincunx_plan*>(&settings);
    EXPECT_EQ(quincunx_plan_create(&settings, &plan), QUINCUNX_INVALID_ARGUMENT) << wrong.word;
    EXPECT_EQ(plan, nullptr) << wrong.word;
    EXPECT_TRUE(names(wrong.word)) << wrong.word << ": " << quincunx_last_error();
  }
}

TEST(CBadInput, EachWrongInputIsNamed) {
  using E = Everything;
  const Wrong<E> table[] = {
      {"inputs.struct_size is 151", [](E& e) { e.frame.struct_size = 151; }},
      {"inputs.struct_size is 170", [](E& e) { e.frame.struct_size = 170; }},
      {"outputs.struct_size is 0", [](E& e) { e.outputs.struct_size = 0; }},
      {"colour.struct_size is 4", [](E& e) { e.colour.image()->struct_size = 4; }},
      {"colour.pitch is 18446744073709551208", [](E& e) { e.colour.image()->pitch = ~std::size_t{407}; }},
      {"particles.struct_size is 39", [](E& e) { e.particles.struct_size = 39; }},
      {"focus.struct_size is 1", [](E& e) { e.focus.struct_size = 1; }},
      {"focus.frame.struct_size is 0", [](E& e) { e.region.struct_size = 0; }},
      {"fade.struct_size is 0", [](E& e) { e.fade.struct_size = 0; }},
      {"sync.struct_size is 31", [](E& e) { e.sync.struct_size = 31; }},
      {"colour is missing", [](E& e) { e.frame.colour = nullptr; }},
      {"depth is missing", [](E& e) { e.frame.depth = nullptr; }},
      {"particles.colour is missing", [](E& e) { e.frame.particles = nullptr; }},
      {"particles.depth is missing", [](E& e) { e.particles.depth = nullptr; }},
      {"exposure_image.width x height is 24x18", [](E& e) { e.frame.exposure_image = e.depth.image(); }},
      {"render_width x render_height is 25x18", [](E& e) { e.frame.render_width = 25; }},
      {"output_width x output_height is 7x18", [](E& e) { e.frame.output_width = 7; }},
      {"particles.render_width x render_height is 0x18", [](E& e) { e.particles.render_width = 0; }},
      {"jitter_x is nan", [](E& e) { e.frame.jitter_x = kNaN; }},
      {"jitter_y is -2", [](E& e) { e.frame.jitter_y = -2; }},
      {"velocity_scale_x is inf", [](E& e) { e.frame.velocity_scale_x = HUGE_VALF; }},
      {"velocity_scale_y is nan", [](E& e) { e.frame.velocity_scale_y = kNaN; }},
      {"clip_to_previous_clip holds", [](E& e) { e.frame.clip_to_previous_clip[7] = kNaN; }},
      {"near_plane is nan", [](E& e) { e.frame.near_plane = kNaN; }},
      {"far_plane is 0.5", [](E& e) { e.frame.far_plane = 0.5f; }},
      {"exposure is -1", [](E& e) { e.frame.exposure = -1; }},
      {"fade.weight is nan", [](E& e) { e.fade.weight = kNaN; }},
      {"fade.from is NULL", [](E& e) { e.fade.from = nullptr; }},
      {"focus.frame is NULL", [](E& e) { e.focus.frame = nullptr; }},
      {"focus.frame.focus is given", [](E& e) { e.region.focus = &e.focus; }},
      {"focus.frame.sync is given", [](E& e) { e.region.sync = &e.sync; }},
      {"of focus.frame: depth is missing", [](E& e) { e.region.depth = nullptr; }},
      {"region of 12x8 at -1, 2 leaves", [](E& e) { e.focus.x = -1; }},
      {"leaves the output's", [](E& e) { e.focus.y = 2147483647; }},
      {"focus.rectangle_count is 5", [](E& e) { e.focus.rectangle_count = 5; }},
      {"focus.rectangle_count is -1", [](E& e) { e.focus.rectangle_count = -1; }},
      {"focus.rectangles is NULL", [](E& e) { e.focus.rectangles = nullptr; }},
      {"focus.rectangles[1]", [](E& e) { e.rectangles[1].width = 2147483647; }},
      {"focus.feather is nan", [](E& e) { e.focus.feather = kNaN; }},
      {"focus.mask is missing", [](E& e) { e.focus.mask = nullptr; }},
      {"outputs are both missing; give linear",
       [](E& e) { e.outputs.linear = e.outputs.presented = nullptr; }},
      {"linear.format is RGBA8", [](E& e) { e.outputs.linear = e.presented.image(); }},
  };
  const auto plan = plan_of(Everything::settings());
  for (const Wrong<E>& wrong : table) {
    Everything all;
    ASSERT_EQ(quincunx_validate(plan.get(), &all.frame, &all.outputs), QUINCUNX_OK) << quincunx_last_error();
    wrong.set(all);
    EXPECT_EQ(quincunx_validate(plan.get(), &all.frame, &all.outputs), QUINCUNX_INVALID_ARGUMENT)
        << wrong.word;
    EXPECT_TRUE(names(wrong.word)) << wrong.word << ": " << quincunx_last_error();
  }
  Everything all;
  const auto plain = plan_of(good_settings());
  EXPECT_EQ(quincunx_validate(plain.get(), &all.frame, &all.outputs), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_TRUE(names("set settings.focus_width")) << quincunx_last_error();
  all.frame.focus = nullptr;
  EXPECT_EQ(quincunx_validate(plain.get(), &all.frame, &all.outputs), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_TRUE(names("set settings.fades")) << quincunx_last_error();
}

TEST(CBadInput, ReportsAreChecked) {
  const auto plan = plan_of(good_settings());
  const auto device = c_device();
  const auto service = c_service(device, plan);
  quincunx_content content = {};
  int in_focus[1] = {};
  const Wrong<quincunx_report> table[] = {
      {"report.struct_size is 63", [](auto& r) { r.struct_size = 63; }},
      {"report.pass_capacity is -1", [&](auto& r) { r.in_focus = in_focus, r.pass_capacity = -1; }},
      {"report.content.struct_size is 0", [&](auto& r) { r.content = &content; }},
  };
  for (const auto& wrong : table) {
    auto report = sized<quincunx_report>();
    wrong.set(report);
    EXPECT_EQ(quincunx_next_report(service.get(), &report), QUINCUNX_INVALID_ARGUMENT) << wrong.word;
    EXPECT_TRUE(names(wrong.word)) << wrong.word << ": " << quincunx_last_error();
  }
  EXPECT_EQ(quincunx_settings_set_method(nullptr, "temporal"), QUINCUNX_INVALID_ARGUMENT);
  quincunx_settings settings = good_settings();
  EXPECT_EQ(quincunx_settings_set_method(&settings, nullptr), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_EQ(quincunx_settings_set_method(&settings, "best"), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_TRUE(names("temporal:quality")) << quincunx_last_error();
  EXPECT_EQ(quincunx_settings_set_method(&settings, "be\nst"), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_TRUE(names("there is no method 'be?st'")) << quincunx_last_error();
  ASSERT_EQ(quincunx_settings_set_method(&settings, "quincunx:reprojected"), QUINCUNX_OK);
  EXPECT_EQ(settings.method, QUINCUNX_TWO_FRAMES);
  EXPECT_EQ(settings.two_frame_form, QUINCUNX_REPROJECTED);
  settings.method = 99;
  ASSERT_EQ(quincunx_settings_set_method(&settings, "temporal:fast"), QUINCUNX_OK) << quincunx_last_error();
  EXPECT_EQ(settings.method, QUINCUNX_TEMPORAL);
  EXPECT_EQ(settings.temporal_preset, QUINCUNX_FAST);
  EXPECT_EQ(settings.two_frame_form, QUINCUNX_REPROJECTED);
  settings.tone_map = 99;
  EXPECT_EQ(quincunx_settings_set_method(&settings, "point"), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_TRUE(names("settings.tone_map is 99")) << quincunx_last_error();
  EXPECT_EQ(settings.method, QUINCUNX_TEMPORAL);
  EXPECT_EQ(quincunx_variant_name(-1), nullptr);
  EXPECT_EQ(quincunx_variant_name(9999), nullptr);
  quincunx_plan* region = nullptr;
  EXPECT_EQ(quincunx_plan_focus(plan.get(), &region), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_TRUE(names("the plan has no focus")) << quincunx_last_error();
  EXPECT_EQ(quincunx_plan_focus(nullptr, nullptr), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_EQ(quincunx_plan_reads_history(nullptr, 1, 1, 0, 0), 0);
  EXPECT_EQ(quincunx_plan_reads_history(plan.get(), 12, 9, 0, 0), 1);
  EXPECT_EQ(quincunx_plan_reads_history(plan.get(), -1, 9, 0, 0), 0);
  EXPECT_EQ(quincunx_allow_timing_waits(nullptr, 1), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_EQ(quincunx_allow_timing_waits(service.get(), 1), QUINCUNX_OK);
  EXPECT_EQ(quincunx_device_profile(nullptr), nullptr);
  EXPECT_EQ(quincunx_device_pass_timer(nullptr), nullptr);
  EXPECT_NE(std::string(quincunx_device_profile(device.get())), "");
}

// An image2d is one, as large as it is said to be.
TEST(CBadInput, ImagesAreAskedForTheirSize) {
  quincunx_settings settings = good_settings();
  settings.method = QUINCUNX_BILINEAR;
  const auto device = c_device();
  const auto service = c_service(device, plan_of(settings));
  Everything all;
  all.frame.particles = nullptr;
  all.frame.focus = nullptr;
  all.frame.fade = nullptr;
  all.exposure.image()->place = QUINCUNX_IMAGE2D;
  all.exposure.image()->pitch = 0;
  const auto error_with = [&](const cl::Memory& memory) {
    all.exposure.image()->memory = memory();
    EXPECT_EQ(quincunx_dispatch(service.get(), &all.frame, &all.outputs, nullptr), QUINCUNX_INVALID_ARGUMENT);
    return std::string(quincunx_last_error());
  };
  const cl::Context context(static_cast<cl_context>(quincunx_device_context(device.get())), true);
  EXPECT_EQ(error_with(cl::Buffer(context, CL_MEM_READ_WRITE, 64)),
            "exposure_image.memory is no OpenCL image2d, and exposure_image.place says that it is one");
  EXPECT_EQ(error_with(cl::Image2D(context, CL_MEM_READ_WRITE, cl::ImageFormat(CL_RGBA, CL_FLOAT), 2, 3)),
            "exposure_image.memory has 2x3 texels of 16 bytes; exposure_image.width x height 1x1 and "
            "exposure_image.format R32F need 1x1 of 4");
}

// What the plan does not read may be anything: it is not looked at.
TEST(CBadInput, ImagesThatAreNotReadAreNotCopied) {
  quincunx_settings settings = good_settings();
  settings.method = QUINCUNX_BILINEAR;
  const auto plan = plan_of(settings);
  const auto device = c_device();
  const auto service = c_service(device, plan);
  Everything all;
  quincunx_image nothing = *all.depth.image();
  nothing.memory = reinterpret_cast<void*>(16);  // no address of this program's
  all.frame.depth = all.frame.velocity = &nothing;
  all.frame.particles = nullptr;
  all.frame.focus = nullptr;
  all.frame.fade = nullptr;
  EXPECT_EQ(quincunx_dispatch(service.get(), &all.frame, &all.outputs, nullptr), QUINCUNX_OK)
      << quincunx_last_error();
}

}  // namespace
}  // namespace quincunx

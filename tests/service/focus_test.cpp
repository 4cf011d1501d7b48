// SPDX-License-Identifier: MIT
// A focus within the service: what it shows, and that nothing else changes by it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include "service_fixture.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::random_frame;
using testing::ServiceRig;

constexpr Extent kOutput{64, 48};
constexpr Extent kTarget{96, 72};
constexpr Extent kRegion{32, 24};
constexpr Extent kRegionTarget{48, 36};

ResolveSettings focused(ResolveSettings settings) {
  settings.focus = {.extent = kRegion, .target_extent = kRegionTarget};
  return settings;
}

// The inputs of a region's frames: a service's own rig keeps them. Its service is never called.
ServiceRig region_rig(const Device& device, const ResolveSettings& picture) {
  ResolveSettings settings = picture;
  settings.targets.shading = Shading::kFull;
  settings.output.present = true;
  settings.output.min_extent = {};
  return ServiceRig(device, {}, settings, kRegion, kRegionTarget);
}

struct Case {
  const char* name;
  ResolveSettings settings;
};

class FocusMethods : public ::testing::TestWithParam<Case> {};

bool is_inside(const Rectangle& where, int x, int y) {
  return x >= where.x && y >= where.y && x < where.x + where.width && y < where.y + where.height;
}

// Frames of any size, jitter and picture, with a focus that wanders and is now and then not there. Where the output is
// dynamic, it is often the largest one.
TEST_P(FocusMethods, OutsideOfItsRectangleNoBitChanges) {
  const ResolveSettings& settings = GetParam().settings;
  const bool is_dual = settings.output.min_extent != Extent{};
  ServiceRig plain({}, settings, kOutput, kTarget);
  ServiceRig with(plain.device(), {}, focused(settings), kOutput, kTarget);
  ServiceRig region = region_rig(plain.device(), settings);
  std::mt19937 random(7);
  int changed = 0;
  for (int i = 0; i < 60; ++i) {
    HostFrame frame = random_frame(random, kTarget);
    if (settings.targets.shading == Shading::kCheckerboard && frame.render.area() > 1) frame.parity = i % 2;
    if (is_dual && i % 3 != 0) frame.output = random_frame(random, kOutput).render;
    HostFrame close = random_frame(random, kRegionTarget);
    close.reset = false;
    const Rectangle shown = {static_cast<int>(random() % 30) + 2, static_cast<int>(random() % 20) + 1, 26,
                             18};
    FocusInputs focus{.frame = region.upload(close),
                      .x = shown.x - 2,
                      .y = shown.y - 1,
                      .rectangles = {{shown}},
                      .rectangle_count = 1};
    const std::vector<Pixel> expected = plain.resolve(frame);
    const FrameInputs inputs = with.upload(frame);
    const FrameReport report =
        i % 7 == 5 ? with.dispatch(inputs)
                   : with.service().dispatch(inputs, focus, {with.resolved_view(), with.presented_view()});
    ASSERT_TRUE(report.ok()) << report.status.message();
    EXPECT_EQ(report.focused, i % 7 != 5);
    const std::vector<Pixel> actual = with.resolved();
    const std::vector<std::uint8_t> codes = plain.presented();
    const std::vector<std::uint8_t> focused_codes = with.presented();
    for (int y = 0; y < kOutput.height; ++y) {
      for (int x = 0; x < kOutput.width; ++x) {
        const auto at = static_cast<std::size_t>(y * kOutput.width + x);
        const bool same = std::memcmp(&expected[at], &actual[at], sizeof(Pixel)) == 0;
        if (report.focused && is_inside(shown, x, y)) {
          changed += same ? 0 : 1;
          for (const float value : actual[at])
            ASSERT_TRUE(std::isfinite(value)) << "frame " << i;
          continue;
        }
        ASSERT_TRUE(same) << "frame " << i << " at " << x << ", " << y;
        ASSERT_EQ(std::memcmp(&codes[4 * at], &focused_codes[4 * at], 4), 0) << "frame " << i;
      }
    }
  }
  EXPECT_GT(changed, 50 * 26 * 18 / 2);
}

const Case kCases[] = {
    {"point", {.method = Method::kPoint}},
    {"lanczos3", {.method = Method::kLanczos3, .sharpness = .5f}},
    {"velocity", {.method = Method::kQuincunx}},
    {"reprojected_blurred",
     {.method = Method::kQuincunx,
      .quincunx = {.form = TwoFrameForm::kReprojected},
      .blur = {.shutter = .5f}}},
    {"temporal", {.method = Method::kTemporal}},
    {"temporal_rgba8", {.method = Method::kTemporal, .colour = PixelFormat::kRGBA8}},
    {"temporal_fast_half",
     {.method = Method::kTemporal,
      .output = {.linear = PixelFormat::kRGBA32F},
      .temporal = {.preset = TemporalPreset::kFast}}},
    {"temporal_placed", {.method = Method::kTemporal, .targets = {.placement = Targets::kPlaced}}},
    {"temporal_checkerboard", {.method = Method::kTemporal, .targets = {.shading = Shading::kCheckerboard}}},
    {"dual_lanczos3",
     {.method = Method::kLanczos3, .output = {.min_extent = {1, 1}}, .blur = {.shutter = .5f}}},
    {"dual_temporal", {.method = Method::kTemporal, .sharpness = .5f, .output = {.min_extent = {1, 1}}}},
};

INSTANTIATE_TEST_SUITE_P(Methods, FocusMethods, ::testing::ValuesIn(kCases),
                         [](const auto& instance) { return instance.param.name; });

// The region is resolved as a picture of its own: what shows in its middle is what a service of that size gives,
// over many frames and wherever the region lies.
TEST(Focus, TheMiddleIsThePictureOfTheRegion) {
  const ResolveSettings settings = {.method = Method::kTemporal};
  ServiceRig with({}, focused(settings), kOutput, kTarget);
  ServiceRig region = region_rig(with.device(), settings);
  ServiceRig alone = region_rig(with.device(), settings);
  std::mt19937 random(3);
  for (int i = 0; i < 20; ++i) {
    const HostFrame frame = random_frame(random, kTarget);
    HostFrame close = random_frame(random, kRegionTarget);
    close.reset = frame.reset;
    const FocusInputs focus{.frame = region.upload(close), .x = i, .y = i, .feather = 1};
    ASSERT_TRUE(with.service().dispatch(with.upload(frame), focus, {with.resolved_view()}).ok());
    const std::vector<Pixel> picture = with.resolved();
    const std::vector<Pixel> expected = alone.resolve(close);
    for (int y = 1; y + 1 < kRegion.height; ++y) {
      for (int x = 1; x + 1 < kRegion.width; ++x) {
        const Pixel& actual = picture[static_cast<std::size_t>((y + i) * kOutput.width + x + i)];
        ASSERT_EQ(actual, expected[static_cast<std::size_t>(y * kRegion.width + x)])
            << i << ": " << x << ", " << y;
      }
    }
  }
}

// A bright focus over a dark picture, the harshest seam there is: along every row and column the step from one pixel to
// the next is at most what the feather's steepest slope, 1.5 over its width, makes of their difference.
TEST(Focus, TheSeamIsNoEdge) {
  const ResolveSettings settings = {.method = Method::kBilinear};
  ServiceRig with({}, focused(settings), kOutput, kTarget);
  ServiceRig region = region_rig(with.device(), settings);
  const HostFrame dark{.render = kOutput, .colour = [](int, int) { return Pixel{0, 0, 0, 1}; }};
  const HostFrame bright{.render = kRegion, .colour = [](int, int) { return Pixel{1, 1, 1, 1}; }};
  for (const Rectangle& shown :
       {Rectangle{10, 12, 32, 24}, Rectangle{0, 12, 32, 24}, Rectangle{32, 24, 32, 24}}) {
    const FocusInputs focus{.frame = region.upload(bright), .x = shown.x, .y = shown.y, .feather = 6};
    ASSERT_TRUE(with.service().dispatch(with.upload(dark), focus, {with.resolved_view()}).ok());
    const std::vector<Pixel> picture = with.resolved();
    const auto at = [&](int x, int y) { return picture[static_cast<std::size_t>(y * kOutput.width + x)][0]; };
    float largest = 0;
    for (int y = 0; y < kOutput.height; ++y) {
      for (int x = 0; x < kOutput.width; ++x) {
        if (x > 0) largest = std::max(largest, std::abs(at(x, y) - at(x - 1, y)));
        if (y > 0) largest = std::max(largest, std::abs(at(x, y) - at(x, y - 1)));
      }
    }
    EXPECT_LE(largest, 1.5f / 6 + 1e-6f);
    EXPECT_GT(largest, .2f);  // it is there
    EXPECT_EQ(at(shown.x + 16, shown.y + 12), 1);
    // A side that is the picture's own has no seam.
    if (shown.x == 0) {
      EXPECT_EQ(at(0, 24), 1);
    }
    if (shown.x + shown.width == kOutput.width) {
      EXPECT_EQ(at(63, 47), 1);
    }
  }
}

TEST(Focus, AMaskMultipliesTheWeight) {
  ResolveSettings settings = focused({.method = Method::kPoint});
  settings.focus.mask = true;
  ServiceRig with({}, settings, kOutput, kTarget);
  ServiceRig region = region_rig(with.device(), {.method = Method::kPoint});
  const Image mask = with.device().allocate(kRegion, PixelFormat::kR8).value();
  std::vector<std::uint8_t> codes(static_cast<std::size_t>(kRegion.area()));
  for (std::size_t i = 0; i < codes.size(); ++i)
    codes[i] = static_cast<std::uint8_t>(i % 32 < 16 ? 0 : 255);
  ASSERT_TRUE(with.device().upload(mask.view(), kRegion, codes.data()).ok());
  const HostFrame dark{.render = kOutput, .colour = [](int, int) { return Pixel{.25f, 0, 0, 1}; }};
  const HostFrame bright{.render = kRegion, .colour = [](int, int) { return Pixel{1, 1, 1, 1}; }};
  const FocusInputs focus{.frame = region.upload(bright), .x = 8, .y = 8, .feather = 1, .mask = mask.view()};
  ASSERT_TRUE(with.service().dispatch(with.upload(dark), focus, {with.resolved_view()}).ok());
  const std::vector<Pixel> picture = with.resolved();
  EXPECT_EQ(picture[20 * 64 + 8 + 15], (Pixel{.25f, 0, 0, 1}));
  EXPECT_EQ(picture[20 * 64 + 8 + 16], (Pixel{1, 1, 1, 1}));
}

TEST(Focus, AFrameWithoutOneEndsItsHistory) {
  const ResolveSettings settings = {.method = Method::kTemporal};
  ServiceRig with({}, focused(settings), kOutput, kTarget);
  ServiceRig region = region_rig(with.device(), settings);
  const HostFrame frame{.render = kOutput};
  const auto grey = [](float value) {
    return HostFrame{.render = {16, 12}, .colour = [value](int, int) {
                       return Pixel{value, value, value, 1};
                     }};
  };
  const auto middle = [&](const HostFrame& close) {
    const FocusInputs focus{.frame = region.upload(close), .x = 8, .y = 8};
    EXPECT_TRUE(with.service().dispatch(with.upload(frame), focus, {with.resolved_view()}).ok());
    return with.resolved()[20 * 64 + 24][0];
  };
  middle(grey(0));
  EXPECT_LT(middle(grey(.01f)), .009f);  // half of it is history
  with.resolve(frame);
  EXPECT_NEAR(middle(grey(.01f)), .01f, 1e-5f);
}

TEST(Focus, ThePlanTellsOfIt) {
  ResolveSettings settings = focused({.method = Method::kTemporal,
                                      .output_extent = kOutput,
                                      .target_extent = kTarget,
                                      .targets = {.shading = Shading::kCheckerboard}});
  const ResolvePlan plan = plan_for({}, settings).value();
  EXPECT_TRUE(plan.has_focus());
  const std::string text = plan.explain();
  EXPECT_NE(text.find("Focus          32x24 pixels of the picture"), std::string::npos) << text;
  EXPECT_NE(text.find("lay_focus"), std::string::npos);
  const ResolvePlan region = plan.focus_plan().value();
  EXPECT_EQ(region.settings.output_extent, kRegion);
  EXPECT_EQ(region.settings.target_extent, kRegionTarget);
  EXPECT_EQ(region.settings.targets.shading, Shading::kFull);
  EXPECT_FALSE(region.has_focus());
  // Both at their most: the region's picture is read, and of the picture as much is read and written.
  const auto lay = std::find_if(plan.passes.begin(), plan.passes.end(),
                                [](const auto& pass) { return pass.kernel == "lay_focus"; });
  ASSERT_NE(lay, plan.passes.end());
  EXPECT_EQ(lay->bytes, 32u * 24 * 16 * 3);

  settings.focus = {};
  const ResolvePlan without = plan_for({}, settings).value();
  EXPECT_FALSE(without.focus_plan().has_value());
  EXPECT_EQ(without.explain().find("Focus  "), std::string::npos);
  EXPECT_NE(without.explain().find("no part is in focus"), std::string::npos);
}

TEST(Focus, TheReportNamesThePassesOfBoth) {
  ServiceRig with({}, focused({.method = Method::kBilinear}), kOutput, kTarget);
  ServiceRig region = region_rig(with.device(), {.method = Method::kBilinear});
  const HostFrame spoilt{.render = kRegion, .colour = [](int x, int y) {
                           return x == 5 && y == 5 ? Pixel{NAN, 0, 0, 1} : Pixel{1, 1, 1, 1};
                         }};
  const FocusInputs focus{.frame = region.upload(spoilt), .x = 8, .y = 8};
  const FrameReport report = with.service().dispatch(with.upload({.render = kOutput}), focus,
                                                     {with.resolved_view(), with.presented_view()});
  ASSERT_TRUE(report.ok()) << report.status.message();
  ASSERT_EQ(report.passes.size(), 4u);
  const std::pair<const char*, bool> expected[] = {
      {"scale_bilinear", true}, {"scale_bilinear", false}, {"lay_focus", false}, {"present", false}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_STREQ(report.passes[i].kernel, expected[i].first);
    EXPECT_EQ(report.passes[i].in_focus, expected[i].second);
  }
  ASSERT_TRUE(with.service().finish().ok());
  const auto finished = with.service().next_completed();
  ASSERT_TRUE(finished.has_value());
  EXPECT_EQ(finished->non_finite_pixels, 1);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_GT(finished->passes[i].ms, 0) << i;
}

TEST(Focus, BadSettingsAreRefused) {
  const auto refused = [](FocusSettings focus) {
    const auto plan = plan_for({}, {.output_extent = kOutput, .target_extent = kTarget, .focus = focus});
    return plan.ok() ? std::string() : std::string(plan.status().message());
  };
  EXPECT_EQ(refused({.extent = {65, 20}}),
            "settings.focus.extent is 65x20; it must lie within 1x1 and the output's 64x48, or be 0x0 for no "
            "focus");
  EXPECT_EQ(
      refused({.extent = {0, 20}}),
      "settings.focus.extent is 0x20; it must lie within 1x1 and the output's 64x48, or be 0x0 for no focus");
  EXPECT_EQ(refused({.extent = {6, 6}, .target_extent = {-1, 3}}),
            "settings.focus.target_extent is -1x3; both sides must lie in [1, 32768]");
  EXPECT_EQ(refused({.extent = {64, 48}}), "");
}

TEST(Focus, BadFramesAreRefusedWhole) {
  ServiceRig with({}, focused({.method = Method::kTemporal}), kOutput, kTarget);
  ServiceRig without({}, Method::kTemporal, kOutput, kTarget);
  ServiceRig region = region_rig(with.device(), {.method = Method::kTemporal});
  const FrameInputs close = region.upload({.render = kRegion});
  const auto refused = [&](const FocusInputs& focus) {
    const FrameReport report =
        with.service().dispatch(with.upload({.render = kOutput}), focus, {with.resolved_view()});
    return std::string(report.status.message());
  };
  EXPECT_EQ(refused({.frame = close, .x = 33, .y = 0}),
            "the focus's region of 32x24 at 33, 0 leaves the output's 64x48");
  EXPECT_EQ(refused({.frame = close, .x = 0, .y = -1}),
            "the focus's region of 32x24 at 0, -1 leaves the output's 64x48");
  EXPECT_EQ(refused({.frame = close, .x = 4, .y = 4, .rectangles = {{{3, 4, 9, 9}}}, .rectangle_count = 1}),
            "focus.rectangles[0] is 9x9 at 3, 4; it must lie within the region of 32x24 at 4, 4");
  EXPECT_EQ(
      refused(
          {.frame = close, .x = 4, .y = 4, .rectangles = {{{5, 5, 2147483647, 9}}}, .rectangle_count = 1}),
      "focus.rectangles[0] is 2147483647x9 at 5, 5; it must lie within the region of 32x24 at 4, 4");
  EXPECT_EQ(refused({.frame = close, .rectangle_count = 5}),
            "focus.rectangle_count is 5; it must lie in [0, 4]");
  EXPECT_EQ(refused({.frame = close, .feather = NAN}), "focus.feather is nan; it must lie in [0, 32768]");
  FrameInputs large = close;
  large.render_extent = {49, 36};
  EXPECT_NE(
      refused({.frame = large})
          .find("of focus.frame: render_extent is 49x36; it must lie within 1x1 and the target's 48x36"),
      std::string::npos);
  EXPECT_EQ(refused({.frame = close}), "");
  EXPECT_NE(refused({.frame = close}).find("of focus.frame: depth is the memory of the previous frame"),
            std::string::npos);
  const FrameReport report = without.service().dispatch(without.upload({.render = kOutput}), {.frame = close},
                                                        {without.resolved_view()});
  EXPECT_EQ(report.status.message(), "focus is given, but the plan has none; set settings.focus.extent");
}

}  // namespace
}  // namespace quincunx

// SPDX-License-Identifier: MIT
// Frames whose method changes on the way: what a viewer sees of it.
#include "frames/method_resolves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frames/picture_options.h"
#include "tools/image/image_metrics.h"

namespace quincunx::scenes {
namespace {

constexpr Extent kOutput = {160, 90};
constexpr int kBefore = 20;  // frames of the old method
constexpr int kFade = 6;
constexpr int kFrames = 36;

const MethodVariant kOld = {.method = Method::kTemporal};
const MethodVariant kNew = {.method = Method::kBilinear};

struct Played {
  std::vector<double> steps;  // FLIP between a frame and the one before, of frames 1 ...
  std::vector<FrameReport> reports;
};

QualityChoice choice_at(int frame, const MethodVariant& from, const MethodVariant& to, bool fades) {
  QualityChoice choice = {.render_extent = {100, 56}, .method = frame < kBefore ? from : to};
  const int faded = frame - kBefore + 1;
  if (!fades || faded < 1 || faded > kFade) return choice;
  choice.fading_from = from;
  choice.weight = faded / (kFade + 1.0);
  return choice;
}

// Returns red, green and blue of the presented picture, as FLIP takes it.
std::vector<float> shown(Device device, const Image& picture) {
  std::vector<std::uint8_t> codes(static_cast<std::size_t>(kOutput.area()) * 4);
  EXPECT_TRUE(device.download(picture.view(), kOutput, codes.data()).ok());
  std::vector<float> rgb;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (i % 4 < 3) rgb.push_back(static_cast<float>(codes[i]) / 255);
  }
  return rgb;
}

// By default the scene `still`, so that nothing but the method changes the picture.
Played play(const MethodVariant& from, const MethodVariant& to, bool fades, const char* scene = "still") {
  PictureOptions options;
  options.scene = scene;
  options.output = kOutput;
  options.frames = kFrames;
  options.interop = gl::Interop::kCopy;
  Played run;
  const auto source = FrameSource::create(source_settings_for(options).value());
  EXPECT_TRUE(source.ok()) << source.status().message();
  FrameSource& frames = *source.value();
  auto resolves = MethodResolves::create(frames, options.resolve, {from, to});
  EXPECT_TRUE(resolves.ok()) << resolves.status().message();
  const Image picture =
      frames.device().allocate(kOutput, PixelFormat::kRGBA8, resolves->plan().presented_storage()).value();
  std::vector<float> before;
  for (int index = 0; index < kFrames; ++index) {
    const QualityChoice choice = choice_at(index, from, to, fades);
    const MethodSampling sampling = sampling_for(choice);
    frames.sequence().set_sampling(sampling.jitter, sampling.detail);
    EXPECT_TRUE(frames.draw(index, frames.sequence().at(index, choice.render_extent)).ok());
    const auto inputs = frames.acquire();
    EXPECT_TRUE(inputs.ok()) << inputs.status().message();
    const FrameReport report =
        resolves->dispatch(inputs.value(), frames.focus(), {.presented = picture.view()}, choice);
    EXPECT_TRUE(report.ok()) << report.status.message();
    std::vector<float> now = shown(frames.device(), picture);
    if (index > 0) run.steps.push_back(tools::flip_mean(tools::flip_map(kOutput, now, before)));
    before = std::move(now);
    frames.release();
    while (auto completed = resolves->next_completed())
      run.reports.push_back(*completed);
  }
  return run;
}

double largest(const Played& run, int first, int last) {  // steps to these frames
  return *std::max_element(run.steps.begin() + first - 1, run.steps.begin() + last);
}

// A change at once is one step; a fade spreads it over its frames, and each is a small part of it.
TEST(MethodResolves, AFadeHasNoStepThatIsSeen) {
  for (const auto& [from, to] : {std::pair{kOld, kNew}, {kNew, kOld}}) {
    const Played at_once = play(from, to, false);
    const Played faded = play(from, to, true);
    const double pop = largest(at_once, kBefore, kBefore);
    const double fade = largest(faded, kBefore, kBefore + kFade);
    RecordProperty((to == kNew ? "temporal_to_bilinear" : "bilinear_to_temporal"),
                   std::to_string(pop) + " " + std::to_string(fade));
    EXPECT_GT(pop, .01) << "a change at once is seen, or the test shows nothing";
    EXPECT_LT(fade, pop / 2) << name_of(from) << " to " << name_of(to);
    for (int frame = 1; frame < kBefore; ++frame)
      EXPECT_EQ(faded.steps[static_cast<std::size_t>(frame - 1)],
                at_once.steps[static_cast<std::size_t>(frame - 1)]);
  }
}

TEST(MethodResolves, AReportHasThePassesOfBothAndTheContent) {
  const Played run = play(kOld, kNew, true);
  ASSERT_EQ(run.reports.size(), static_cast<std::size_t>(kFrames));
  const auto has = [](const FrameReport& report, std::string_view kernel) {
    return std::any_of(report.passes.begin(), report.passes.end(),
                       [&](const PassReport& pass) { return pass.kernel == kernel; });
  };
  for (int index = 0; index < kFrames; ++index) {
    const FrameReport& report = run.reports[static_cast<std::size_t>(index)];
    const bool fading = index >= kBefore && index < kBefore + kFade;
    EXPECT_EQ(report.frame_index, static_cast<std::uint64_t>(index));
    EXPECT_EQ(has(report, "resolve_temporal"), index < kBefore + kFade) << index;
    EXPECT_EQ(has(report, "scale_bilinear"), index >= kBefore) << index;
    EXPECT_EQ(has(report, "cross_fade"), fading) << index;
    ASSERT_TRUE(report.content.has_value());
    EXPECT_EQ(report.content->cut, index == 0);
    EXPECT_EQ(report.content->moving, 0);
  }
}

// Shadows have neither velocity nor reactive values. The judge of history sees them, and nothing where all else moves.
TEST(MethodResolves, ShadowsThatMoveCountAsLight) {
  const auto mean_light = [](const char* scene) {
    const Played run = play(kOld, kOld, false, scene);
    double sum = 0;
    for (int index = kFrames / 3; index < kFrames; ++index)
      sum += run.reports[static_cast<std::size_t>(index)].content->light;
    return sum / (kFrames - kFrames / 3);
  };
  const double shadows = mean_light("shadows"), pan = mean_light("pan");
  RecordProperty("light_of_shadows_and_pan", std::to_string(shadows) + " " + std::to_string(pan));
  EXPECT_GT(shadows, .2);
  EXPECT_LT(pan, .05);
  EXPECT_EQ(mean_light("still"), 0);
}

// A method that has rested finds no history of its own.
TEST(MethodResolves, AMethodThatBeginsIsReset) {
  const Played run = play(kNew, kOld, true);
  EXPECT_FALSE(run.reports[kBefore].used_previous);
  EXPECT_TRUE(run.reports[kBefore + 1].used_previous);
}

}  // namespace
}  // namespace quincunx::scenes

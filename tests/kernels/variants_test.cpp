// SPDX-License-Identifier: MIT
// Every row of variants.txt builds on the device; the option strings that the host makes are those rows.
#include <gtest/gtest.h>

#include <algorithm>
#include <compare>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "embedded_kernels.h"
#include "kernel_fixture.h"
#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx {
namespace {

struct Row {
  std::string kernel;
  std::string options;

  friend auto operator<=>(const Row&, const Row&) = default;
};

std::vector<Row> rows() {
  std::ifstream file(QUINCUNX_VARIANTS);
  std::vector<Row> found;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    const std::size_t space = line.find(' ');
    found.push_back({line.substr(0, space), space == std::string::npos ? "" : line.substr(space + 1)});
  }
  return found;
}

class KernelVariants : public ::testing::TestWithParam<std::string> {};

TEST_P(KernelVariants, EveryRowBuilds) {
  int built = 0;
  for (const Row& row : rows()) {
    if (row.kernel != GetParam()) continue;
    try {
      build_kernel(testing::impl(), row.kernel, row.options);
      ++built;
    } catch (const std::exception& error) {
      ADD_FAILURE() << row.kernel << " " << row.options << ": " << error.what();
    }
  }
  EXPECT_GT(built, 0);
}

INSTANTIATE_TEST_SUITE_P(Kernels, KernelVariants,
                         ::testing::Values("clear_region", "scale_point", "scale_bilinear", "scale_filter",
                                           "scale_noise", "scale_noise_offset", "resolve_quincunx",
                                           "reproject", "resolve_reprojected", "temporal_tiles",
                                           "temporal_light", "resolve_temporal", "temporal_display",
                                           "motion_tiles", "motion_neighbours", "motion_blur", "sharpen",
                                           "present", "velocity_from_depth"),
                         [](const auto& instance) { return instance.param; });

TEST(Variants, EveryEmbeddedKernelHasRows) {
  const std::vector<Row> all = rows();
  for (const EmbeddedFile& file : embedded_kernel_files()) {
    if (!file.name.ends_with(".cl")) continue;
    const std::size_t folder = file.name.rfind('/') + 1;  // 0 where there is none
    const std::string kernel(file.name.substr(folder, file.name.size() - folder - 3));
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Row& row) { return row.kernel == kernel; }))
        << kernel;
  }
}

TEST(Variants, TheHostAsksForEveryRowAndNoOther) {
  using enum PixelFormat;
  const std::vector<Row> listed = rows();
  const std::set<Row> all(listed.begin(), listed.end());
  std::set<Row> asked;
  std::set<std::string> kernels;
  const auto expect_row = [&](const std::string& kernel, const std::string& options) {
    if (asked.insert({kernel, options}).second) {
      EXPECT_TRUE(all.contains({kernel, options})) << kernel << " " << options;
    }
    kernels.insert(kernel);
  };
  for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
    for (const PixelFormat format : {kR8, kR32F, kRG16F, kRG32F, kRGBA8, kRGBA16F, kRGBA32F}) {
      expect_row("clear_region", clear_options(storage, format));
    }
    for (const PixelFormat velocity : {kRG16F, kRG32F})
      expect_row("velocity_from_depth", velocity_options({.velocity = velocity, .storage = storage}));
    for (const PixelFormat colour : {kRGBA16F, kRGBA32F}) {
      for (const PixelFormat resolved : {kRGBA16F, kRGBA32F}) {
        ResolvePlan plan;
        plan.settings = {.colour = colour, .resolved = resolved, .storage = storage};
        expect_row("scale_point", scale_options(plan.settings));
        expect_row("scale_bilinear", scale_options(plan.settings));
        expect_row("sharpen", sharpen_options(plan.settings));
        for (const ToneMap tone_map : {ToneMap::kClamp, ToneMap::kReinhard, ToneMap::kAces}) {
          plan.settings.tone_map = tone_map;
          for (const bool dither : {false, true}) {
            plan.settings.dither = dither;
            expect_row("present", present_options(plan.settings));
          }
        }
        for (const VelocitySource velocity :
             {VelocitySource::kNone, VelocitySource::kTarget, VelocitySource::kCamera}) {
          plan.velocity = velocity;
          for (const PixelFormat velocity_format : {kRG16F, kRG32F}) {
            plan.settings.velocity = velocity_format;
            for (const bool reactive : {false, true}) {
              plan.reads_reactive = reactive;
              for (const Sampling sampling : {Sampling::kPoint, Sampling::kBilinear}) {
                plan.settings.quincunx = {.sampling = sampling};
                expect_row("resolve_quincunx", quincunx_options(plan));
              }
              plan.settings.quincunx = {.form = TwoFrameForm::kReprojected};
              expect_row("resolve_reprojected", reprojected_options(plan));
              for (const float weight : {0.0f, 1.0f}) {
                plan.settings.quincunx.residual_weight = weight;
                expect_row("reproject", reproject_options(plan));
              }
              plan.settings.method = Method::kTemporal;
              for (const TemporalPreset preset :
                   {TemporalPreset::kFast, TemporalPreset::kBalanced, TemporalPreset::kQuality}) {
                for (const PixelFormat history : {kRGBA16F, kRGBA32F}) {
                  plan.settings.temporal = {.preset = preset, .history = history};
                  if (velocity != VelocitySource::kNone) expect_row("reproject", reproject_options(plan));
                  expect_row("temporal_tiles", temporal_tiles_options(plan));
                  expect_row("resolve_temporal", temporal_options(plan));
                  // Formats mean nothing to views, which are listed with one of each.
                  if (storage == Storage::kBuffer && colour == kRGBA16F && history == kRGBA16F &&
                      resolved == kRGBA32F) {
                    for (const TemporalView view :
                         {TemporalView::kConfidence, TemporalView::kRejection, TemporalView::kPhase}) {
                      plan.settings.temporal.view = view;
                      expect_row("resolve_temporal", temporal_options(plan));
                    }
                    plan.settings.temporal.view = TemporalView::kPicture;
                  }
                  for (const bool background : {false, true}) {
                    plan.needs.background = background;
                    expect_row("temporal_display", temporal_display_options(plan));
                  }
                }
              }
              plan.settings.method = Method::kQuincunx;
            }
          }
        }
      }
    }
  }
  for (const Row& row : listed) {
    if (kernels.contains(row.kernel)) {
      EXPECT_TRUE(asked.contains(row)) << "no plan asks for " << row.kernel << " " << row.options;
    }
  }
}

}  // namespace
}  // namespace quincunx

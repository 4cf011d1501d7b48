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
#include "pass_spec.h"
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
  if (!file) file.open("kernels/variants.txt");  // built elsewhere, run from the root of a copy
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

INSTANTIATE_TEST_SUITE_P(
    Kernels, KernelVariants,
    ::testing::Values("clear_region", "scale_point", "scale_bilinear", "scale_filter", "scale_noise",
                      "scale_noise_offset", "resolve_quincunx", "reproject", "resolve_reprojected",
                      "layer_records", "turn_records", "advect_records", "layer_split", "temporal_tiles",
                      "temporal_light", "resolve_temporal", "resolve_layers", "temporal_display",
                      "display_layers", "temporal_refine", "motion_tiles", "motion_neighbours", "motion_blur",
                      "sharpen", "lay_focus", "present", "resolve_checkerboard", "overlay_particles",
                      "velocity_from_depth", "undilate_velocity", "far_velocity", "far_surroundings",
                      "far_fit", "far_match", "resize_history", "resize_tiles", "resize_layers",
                      "resize_records", "measure_content", "cross_fade"),
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

// Every combination of what a plan's options depend on.
std::vector<PlanFacts> all_facts() {
  using enum PixelFormat;
  std::vector<PlanFacts> all;
  const auto add_needs = [&all](const ResolveSettings& settings) {
    for (const bool moves : {false, true}) {
      for (const bool transparents : {false, true}) {
        for (const bool background : {false, true}) {
          all.push_back({{.moving_objects = moves,
                          .camera_motion = moves,
                          .transparents = transparents,
                          .background = background},
                         settings});
          if (moves) {
            all.push_back({{.moving_objects = false, .transparents = transparents, .background = background},
                           settings});
          }
        }
      }
    }
  };
  const auto add_methods = [&](ResolveSettings settings) {
    for (const MethodInfo& method : methods()) {
      settings.method = method.method;
      add_needs(settings);
    }
    settings.method = Method::kQuincunx;
    for (const FarMotion far : {FarMotion::kCamera, FarMotion::kEvidence}) {
      settings.far = far;
      add_needs(settings);
    }
    settings.far = FarMotion::kAsDrawn;
    settings.drawn_velocity = DrawnVelocity::kDilated;
    add_needs(settings);
    settings.drawn_velocity = DrawnVelocity::kOwn;
    for (const TwoFrameForm form :
         {TwoFrameForm::kMean, TwoFrameForm::kVelocity, TwoFrameForm::kReprojected}) {
      for (const Sampling sampling : {Sampling::kPoint, Sampling::kBilinear}) {
        for (const float residual : {0.0f, 1.0f}) {
          settings.quincunx = {.form = form, .sampling = sampling, .residual_weight = residual};
          add_needs(settings);
        }
      }
    }
    settings.method = Method::kTemporal;
    for (const TemporalPreset preset :
         {TemporalPreset::kFast, TemporalPreset::kBalanced, TemporalPreset::kQuality}) {
      for (const PixelFormat history : {kRGBA16F, kRGBA32F}) {
        settings.temporal = {.preset = preset, .history = history};
        add_needs(settings);
        // Formats mean nothing to views, which are listed with one of each.
        if (settings.storage != Storage::kBuffer || settings.colour != kRGBA16F || history != kRGBA16F ||
            settings.resolved != kRGBA32F) {
          continue;
        }
        for (const TemporalView view :
             {TemporalView::kConfidence, TemporalView::kRejection, TemporalView::kPhase,
              TemporalView::kLayers, TemporalView::kCoverage, TemporalView::kNear, TemporalView::kFar}) {
          settings.temporal.view = view;
          add_needs(settings);
        }
      }
    }
  };
  const Extent output{64, 64};
  for (const Storage storage : {Storage::kBuffer, Storage::kImage}) {
    for (const PixelFormat colour : {kRGBA16F, kRGBA32F, kRGBA8}) {
      for (const PixelFormat velocity : {kRG16F, kRG32F}) {
        for (const PixelFormat resolved : {kRGBA16F, kRGBA32F}) {
          ResolveSettings settings{.output = output,
                                   .target = {2 * output.width, 2 * output.height},
                                   .colour = colour,
                                   .velocity = velocity,
                                   .resolved = resolved,
                                   .storage = storage,
                                   .clear = true};
          settings.blur.shutter = .5f;
          settings.sharpness = .5f;
          for (const bool clamp_ringing : {false, true}) {
            settings.clamp_ringing = clamp_ringing;
            add_methods(settings);
          }
          settings.method = Method::kBilinear;
          settings.shading = Shading::kCheckerboard;
          for (const float shutter : {0.0f, .5f}) {
            settings.blur.shutter = shutter;
            add_needs(settings);
          }
          settings.shading = Shading::kFull;
          settings.measures_content = settings.fades = true;
          for (const Method method : {Method::kBilinear, Method::kTemporal}) {
            settings.method = method;
            add_needs(settings);
          }
          settings.measures_content = settings.fades = false;
          settings.method = Method::kBilinear;
          if (colour != kRGBA8) {
            settings.particle_target = output;
            for (const Method method : {Method::kBilinear, Method::kQuincunx, Method::kTemporal}) {
              settings.method = method;
              for (const Shading shading : {Shading::kFull, Shading::kCheckerboard}) {
                settings.shading = shading;
                add_needs(settings);
              }
            }
            settings.shading = Shading::kFull;
            settings.particle_target = {};
          }
          settings.focus.extent = {32, 32};
          for (const bool mask : {false, true}) {
            settings.focus.mask = mask;
            all.push_back({{}, settings});
          }
          settings.focus = {};
          settings.least_output = {1, 1};
          for (const PixelFormat history : {kRGBA16F, kRGBA32F}) {
            settings.method = Method::kTemporal;
            settings.temporal = {.history = history};
            add_needs(settings);
          }
          settings.least_output = {};
          for (const ToneMap tone_map : {ToneMap::kClamp, ToneMap::kReinhard, ToneMap::kAces}) {
            for (const bool dither : {false, true}) {
              settings.tone_map = tone_map;
              settings.dither = dither;
              all.push_back({{}, settings});
            }
          }
        }
      }
    }
  }
  return all;
}

TEST(Variants, PlansAskForEveryRowAndNoOther) {
  const std::vector<Row> listed = rows();
  const std::set<Row> all(listed.begin(), listed.end());
  std::set<Row> asked;
  for (const PlanFacts& facts : all_facts()) {
    for (const PassSpec& spec : list_passes(facts).passes)
      asked.insert({spec.kernel, spec.options});
  }
  for (const Row& row : asked)
    EXPECT_TRUE(all.contains(row)) << "variants.txt lacks " << row.kernel << " " << row.options;
  for (const Row& row : listed)
    EXPECT_TRUE(asked.contains(row)) << "no plan asks for " << row.kernel << " " << row.options;
}

// A frame's report has a fixed number of places.
TEST(Variants, NoPlanHasMorePassesThanAReport) {
  std::size_t most = 0;
  for (const PlanFacts& facts : all_facts())
    most = std::max(most, list_passes(facts).passes.size());
  // And as many of the focus's region.
  EXPECT_LE(2 * most, static_cast<std::size_t>(FrameReport::kMaxPasses));
  EXPECT_GE(most, 11u) << "the temporal upscaler with all that goes with it";
}

}  // namespace
}  // namespace quincunx

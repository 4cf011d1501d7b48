// SPDX-License-Identifier: MIT
// resize_history, resize_tiles, resize_layers and resize_records against their references.
#include "../reference/resize_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "expected.h"
#include "layer_fixture.h"
#include "layers/layer.h"

namespace quincunx {
namespace {

using reference::OutputSize;
using testing::expect_near;
using testing::from_device;
using testing::LayerStageInputs;
using testing::LayerStages;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::StageSpec;
using testing::StageVariant;
using testing::TemporalStages;
using testing::to_device;
using testing::view_of;

constexpr unsigned char kPoison = 0x7f;

// Ratios of the output to the history's size: one that is copied, larger ones, smaller ones, and some that are so small
// that several places are read.
constexpr double kRatios[][2] = {{1, 1},   {1.25, 1.25}, {1.7, 1.3}, {3.3, 2},
                                 {.8, .8}, {.66, 1.4},   {.5, .45},  {.2, .9}};

Extent resized_extent(Extent from, const double* ratio) {
  return {std::max(1, static_cast<int>(std::lround(from.width * ratio[0]))),
          std::max(1, static_cast<int>(std::lround(from.height * ratio[1])))};
}

class Resize : public ::testing::TestWithParam<StageVariant> {
 protected:
  Resize() : stages_(GetParam()) {
    for (const char* kernel : {"resize_history", "resize_tiles", "resize_layers", "resize_records"})
      rigs_.push_back(rig_of(kernel));
  }

  struct Made {
    std::vector<unsigned char> history, alpha, near, states;
    std::vector<TileReprojection> tiles;
    std::vector<TileLight> light;
    std::vector<LayerTile> layers;

    std::vector<unsigned char> bytes() const {
      std::vector<unsigned char> all = history;
      for (const auto& more : {alpha, near, states, testing::bytes_of(tiles), testing::bytes_of(light),
                               testing::bytes_of(layers)})
        all.insert(all.end(), more.begin(), more.end());
      return all;
    }
  };

  // Bytes were 0x7f before.
  Made run(const LayerStageInputs& in, Extent output) {
    const reference::LayerHistory& past = in.reference.past;
    const Extent before{past.width, past.height};
    const PixelFormat format = GetParam().history;
    const auto texels = static_cast<std::size_t>(output.area());
    const OutputSize size{output.width, output.height};
    const auto tile_count = static_cast<std::size_t>(size.tiles_x() * size.tiles_y());
    const cl::Buffer history = to_device(testing::encode(format, past.far));
    const cl::Buffer near = to_device(testing::encode(format, past.near));
    const cl::Buffer states = testing::states_to_device(past.states);
    const cl::Buffer tiles = to_device(testing::reprojections_of(past.tiles));
    const cl::Buffer light = to_device(testing::lights_of(past.tiles));
    const cl::Buffer layers = to_device(testing::to_kernel(past.layers));
    const std::size_t bytes = texels * bytes_per_pixel(format);
    const std::size_t alpha_bytes = (texels + 3) / 4 * bytes_per_pixel(format);
    const std::size_t state_bytes = texels * bytes_per_pixel(PixelFormat::kRGBA16F);
    const cl::Buffer alpha = GetParam().alpha
                                 ? to_device(testing::encode_plane(format, in.stage.reference.history_alpha))
                                 : history;
    const auto poisoned = [](std::size_t count) {
      return to_device(std::vector<unsigned char>(count, kPoison));
    };
    const cl::Buffer new_history = poisoned(bytes), new_near = poisoned(bytes);
    const cl::Buffer new_alpha = poisoned(alpha_bytes), new_states = poisoned(state_bytes);
    const cl::Buffer new_tiles = poisoned(tile_count * sizeof(TileReprojection));
    const cl::Buffer new_light = poisoned(tile_count * sizeof(TileLight));
    const cl::Buffer new_layers = poisoned(tile_count * sizeof(LayerTile));
    for (const std::size_t pass : {0, 1, 2}) {
      rigs_[pass].run(in.stage.frame, in.previous, output, {},
                      {{Resource::kPreviousTileReprojection, view_of(tiles)},
                       {Resource::kPreviousTileLight, view_of(light)},
                       {Resource::kPreviousLayerTiles, view_of(layers)},
                       {Resource::kPreviousHistory, view_of(history)},
                       {Resource::kPreviousHistoryAlpha, view_of(alpha)},
                       {Resource::kPreviousNearHistory, view_of(near)},
                       {Resource::kPreviousLayerStates, view_of(states)},
                       {Resource::kTileReprojection, view_of(new_tiles)},
                       {Resource::kTileLight, view_of(new_light)},
                       {Resource::kLayerTiles, view_of(new_layers)},
                       {Resource::kHistory, view_of(new_history)},
                       {Resource::kHistoryAlpha, view_of(new_alpha)},
                       {Resource::kNearHistory, view_of(new_near)},
                       {Resource::kLayerStates, view_of(new_states)}},
                      before);
    }
    return {
        from_device<unsigned char>(new_history, bytes),
        GetParam().alpha ? from_device<unsigned char>(new_alpha, alpha_bytes) : std::vector<unsigned char>(),
        from_device<unsigned char>(new_near, bytes),
        from_device<unsigned char>(new_states, state_bytes),
        from_device<TileReprojection>(new_tiles, tile_count),
        from_device<TileLight>(new_light, tile_count),
        from_device<LayerTile>(new_layers, tile_count)};
  }

  void compare(const LayerStageInputs& in, Extent output, const Made& made, const std::string& what) {
    compare_tiles(in, output, made, what);
    if (!HasFatalFailure()) compare_history(in, output, made, what);
    if (!HasFatalFailure()) compare_layers(in, output, made, what);
  }

  // Exact.
  static void compare_tiles(const LayerStageInputs& in, Extent output, const Made& made,
                            const std::string& what) {
    const OutputSize size{output.width, output.height};
    for (int y = 0; y < size.tiles_y(); ++y) {
      for (int x = 0; x < size.tiles_x(); ++x) {
        const reference::ResizedTile expected = reference::resize_tile(in.reference.past, size, x, y);
        const std::size_t i = reference::index_of(size.tiles_x(), x, y);
        const testing::KernelTile tile = testing::to_kernel(expected.tile);
        const auto same = [&](const auto& a, const auto& b) {
          return testing::bytes_of(std::vector{a}) == testing::bytes_of(std::vector{b});
        };
        ASSERT_TRUE(same(static_cast<const TileReprojection&>(tile), made.tiles[i]))
            << what << " " << x << "," << y;
        ASSERT_TRUE(same(static_cast<const TileLight&>(tile), made.light[i])) << what << " " << x << "," << y;
        ASSERT_TRUE(same(testing::to_kernel(std::vector{expected.layers}).front(), made.layers[i]))
            << what << " " << x << "," << y;
      }
    }
  }

  void compare_history(const LayerStageInputs& in, Extent output, const Made& made, const std::string& what) {
    reference::TemporalInputs history = in.stage.reference;
    history.history = in.reference.past.far;
    const PixelFormat format = GetParam().history;
    const auto pixels = testing::decode(format, made.history);
    std::vector<double> alpha;
    if (GetParam().alpha) alpha = testing::decode_plane(format, made.alpha, pixels.size());
    const auto expected =
        testing::expected_pixels(output.width, output.height, [&]<typename Real>(Real, int x, int y) {
          return reference::resize_history<Real>(history, {output.width, output.height}, x, y);
        });
    for (std::size_t i = 0; i < expected.size(); ++i) {
      ++compared_;
      ASSERT_EQ(std::signbit(expected[i].value.texel[3]), std::signbit(pixels[i][3])) << what << " " << i;
      if (expected[i].undecided) continue;
      ++decided_;
      for (std::size_t c = 0; c < 4; ++c) {
        expect_near(expected[i].value.texel[c], expected[i].bound.texel[c], pixels[i][c],
                    fmt::format("{}: pixel {} channel {}", what, i, c), format);
        if (HasFatalFailure()) return;
      }
      if (alpha.empty()) continue;
      expect_near(expected[i].value.alpha, expected[i].bound.alpha, alpha[i],
                  fmt::format("{}: alpha {}", what, i), format);
      if (HasFatalFailure()) return;
    }
  }

  void compare_layers(const LayerStageInputs& in, Extent output, const Made& made, const std::string& what) {
    const OutputSize size{output.width, output.height};
    const auto near = testing::decode(GetParam().history, made.near);
    const auto states = testing::decode(PixelFormat::kRGBA16F, made.states);
    for (int y = 0; y < output.height; ++y) {
      for (int x = 0; x < output.width; ++x) {
        const std::size_t i = reference::index_of(output.width, x, y);
        const std::size_t tile =
            reference::index_of(size.tiles_x(), x / reference::kTile, y / reference::kTile);
        const std::string where = fmt::format("{}: pixel ({}, {})", what, x, y);
        if (made.layers[tile].is_layered == 0) {
          ASSERT_TRUE(is_poison(made.states, i, bytes_per_pixel(PixelFormat::kRGBA16F))) << where;
          continue;
        }
        const auto [value, bound, undecided] = reference::expected_of([&]<typename Real>(Real) {
          return reference::resize_layers<Real>(in.reference.past, size, x, y);
        });
        if (!value.is_split) {
          ASSERT_TRUE(is_poison(made.near, i, bytes_per_pixel(GetParam().history))) << where;
        }
        ++compared_;
        if (undecided) continue;
        ++decided_;
        for (std::size_t c = 0; c < 4; ++c) {
          if (std::isnan(value.state[c])) {  // depth that is not finite
            ASSERT_TRUE(std::isnan(states[i][c])) << where;
            continue;
          }
          expect_near(value.state[c], bound.state[c], states[i][c], where, PixelFormat::kRGBA16F);
          if (HasFatalFailure()) return;
        }
        if (!value.is_split) continue;
        ++split_;
        for (std::size_t c = 0; c < 4; ++c) {
          expect_near(value.near[c], bound.near[c], near[i][c], where, GetParam().history);
          if (HasFatalFailure()) return;
        }
      }
    }
  }

  static bool is_poison(const std::vector<unsigned char>& bytes, std::size_t texel, std::size_t size) {
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(texel * size);
    return std::all_of(first, first + static_cast<std::ptrdiff_t>(size),
                       [](unsigned char byte) { return byte == kPoison; });
  }

  LayerStages stages_;
  std::vector<testing::PassRig> rigs_;
  std::int64_t compared_ = 0;
  std::int64_t decided_ = 0;
  std::int64_t split_ = 0;

 private:
  static testing::PassRig rig_of(const char* kernel) {
    PlanFacts facts = TemporalStages(GetParam()).facts(TemporalPreset::kBalanced);
    facts.settings.output_extent = {2, 1};
    facts.settings.output.min_extent = {1, 1};
    return {facts.needs, facts.settings, kernel};
  }
};

TEST_P(Resize, MatchesTheReferenceAtEverySizeAndRatio) {
  unsigned seed = 0;
  for (const Extent from : {Extent{1, 1}, Extent{4, 4}, Extent{7, 5}, Extent{64, 64}, Extent{129, 65}}) {
    for (const auto& ratio : kRatios) {
      ++seed;
      const StageSpec spec{.output = from,
                           .render = {std::max(from.width / 2, 1), std::max(from.height / 2, 1)},
                           .previous = {from.width / 2 + 1, std::max(from.height / 2 - 1, 1)},
                           .seed = seed};
      Rig rig;
      const LayerStageInputs in = stages_.inputs(rig, spec);
      const Extent output = resized_extent(from, ratio);
      compare(in, output, run(in, output),
              fmt::format("{} to {}x{}", testing::name_of(spec), output.width, output.height));
      if (HasFatalFailure()) return;
    }
  }
  // Where nothing has a phase a place may lie on a texel, and a rounding beside it.
  EXPECT_GE(decided_, compared_ * 3 / 4);
  EXPECT_GE(split_, 4000);
}

// Depth outside the previous viewport, and all that no kernel stores, is poison in all inputs.
TEST_P(Resize, PoisonOutsideChangesNoBit) {
  for (const Extent from : {Extent{1, 1}, Extent{1, 9}, Extent{64, 33}}) {
    StageSpec spec{.output = from, .render = {9, 5}, .previous = {5, 9}, .seed = 5};
    for (const auto& ratio : kRatios) {
      const Extent output = resized_extent(from, ratio);
      Rig rig;
      const auto bytes = [&] { return run(stages_.inputs(rig, spec), output).bytes(); };
      spec.outside = 0;
      const auto clean = bytes();
      EXPECT_EQ(clean, bytes()) << "twice";
      for (const double poison : testing::kPoisons) {
        spec.outside = poison;
        EXPECT_EQ(clean, bytes()) << from.width << "x" << from.height << ", poison " << poison;
      }
    }
  }
}

// Small, for a memory checker.
TEST_P(Resize, ATightFrameIsReadWithinItsEdges) {
  for (const auto& ratio : {kRatios[1], kRatios[6]}) {
    const StageSpec spec{.output = {13, 9}, .render = {7, 3}, .previous = {3, 7}, .seed = 8, .tight = true};
    Rig rig;
    const LayerStageInputs in = stages_.inputs(rig, spec);
    const Extent output = resized_extent(spec.output, ratio);
    compare(in, output, run(in, output), "tight");
  }
  EXPECT_GT(decided_, 0);
}

TEST_P(Resize, RecordsKeepTheirPlacesInThePicture_small) {
  const Extent grid{13, 3};
  FrameInputs frame;
  frame.render_extent = grid;
  std::vector<cl_uint> keys(static_cast<std::size_t>(grid.area()));
  std::vector<LayerRecord> records(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto at = static_cast<float>(i);
    keys[i] = i % 3 == 0 ? 0 : static_cast<cl_uint>(i);
    records[i] = {at + .5f, 2 * at, .25f, -.5f * at, 3, .125f, at, static_cast<int>(i % 2)};
  }
  const cl::Buffer key_buffer = to_device(keys), record_buffer = to_device(records);
  // The output has twice the width and half the height.
  rigs_[3].run(frame, frame, {64, 20}, {},
               {{Resource::kPreviousRecordKeys, view_of(key_buffer)},
                {Resource::kPreviousRecords, view_of(record_buffer)}},
               {32, 40});
  const auto resized = from_device<LayerRecord>(record_buffer, records.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    LayerRecord expected = records[i];
    if (keys[i] != 0) {
      expected = {2 * expected.x,        expected.y / 2,       expected.depth,       2 * expected.motion_x,
                  expected.motion_y / 2, 2 * expected.drift_x, expected.drift_y / 2, expected.is_thin};
    }
    EXPECT_EQ(testing::bytes_of(std::vector{resized[i]}), testing::bytes_of(std::vector{expected})) << i;
  }
}

std::vector<StageVariant> variants() {
  using enum PixelFormat;
  return {{}, {.alpha = true}, {.history = kRGBA16F, .alpha = true}, {.storage = Storage::kImage}};
}

INSTANTIATE_TEST_SUITE_P(Variants, Resize, ::testing::ValuesIn(variants()),
                         testing::sample_names(variants(),
                                               [](const StageVariant& v) { return testing::name_of(v); }));

}  // namespace
}  // namespace quincunx

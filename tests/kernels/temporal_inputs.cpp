// SPDX-License-Identifier: MIT
// The inputs of the temporal upscaler's stages: zones that move, history, and tiles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "temporal_fixture.h"

namespace quincunx::testing {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double as_float(double value) {
  return static_cast<double>(static_cast<float>(value));
}

constexpr double kStageScales[][2] = {{.33, .4}, {.5, .71}, {.71, .5}, {1, 1}, {1.37, .83}, {2, 1.9}};

// A random number of each zone of the picture, and of each sample in it.
class Zones {
 public:
  explicit Zones(unsigned seed) : seed_(seed) {}
  std::mt19937 of(int x, int y) const {
    return std::mt19937(seed_ + static_cast<unsigned>(7919 * x + 104729 * y));
  }

 private:
  unsigned seed_;
};

// Output pixels a frame; thresholds of the kernels lie well between them.
constexpr double kZoneMoves[][2] = {{0, 0},     {0, 0},       {-.37, 0},   {3, -2},
                                    {.25, 1.8}, {-9.3, 14.6}, {2.6, -700}, {.3, .45}};

// Zones of 40 x 24 output pixels: three of four move as one.
std::vector<reference::Reprojection> make_moves(const reference::TemporalInputs& in, unsigned seed) {
  const Zones zones(seed);
  std::mt19937 random(seed + 1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<reference::Reprojection> moves;
  for (int y = 0; y < in.frame.height; ++y) {
    for (int x = 0; x < in.frame.width; ++x) {
      std::mt19937 zone =
          zones.of(static_cast<int>(x * in.spacing(0) / 40), static_cast<int>(y * in.spacing(1) / 24));
      const bool rigid = zone() % 4 != 0;
      const auto& motion = kZoneMoves[zone() % std::size(kZoneMoves)];
      reference::Reprojection move{.x = motion[0], .y = motion[1], .trust = 1};
      if (rigid && zone() % 3 == 0 && random() % 30 == 0) move.trust = .75;
      if (rigid && zone() % 3 == 0 && random() % 30 == 0) move.motion_edge = as_float(uniform(random) - .5);
      if (!rigid) {
        const double spread = zone() % 2 == 0 ? 1 : .02;  // little enough to show one surface
        move = {.x = spread * (12 * uniform(random) - 6),
                .y = spread * (8 * uniform(random) - 4),
                .trust = uniform(random)};
        if (random() % 2 == 0) move.trust = 1;
        if (random() % 20 == 0) move.trust = 0;
        if (random() % 2 == 0) move.motion_edge = as_float(3 * uniform(random) - 1.5);
        if (random() % 50 == 0) move = {.trust = kNan};
      }
      move.x = as_float(move.x / in.reprojection_scale(0));
      move.y = as_float(move.y / in.reprojection_scale(1));
      move.trust = as_float(move.trust);
      moves.push_back(move);
    }
  }
  return moves;
}

std::vector<reference::Tile> make_tiles_before(const reference::TemporalInputs& in, bool moves,
                                               unsigned seed) {
  const Zones zones(seed);
  std::vector<reference::Tile> tiles;
  for (int y = 0; y < in.tiles_y(); ++y) {
    for (int x = 0; x < in.tiles_x(); ++x) {
      std::mt19937 zone = zones.of(x / 4, y / 3);
      std::uniform_real_distribution<double> uniform(-.5, .5);
      reference::Tile tile;
      if (moves && zone() % 2 == 0)
        tile.reprojection.phase = {as_float(uniform(zone)), as_float(uniform(zone))};
      tile.light.persistence = as_float(uniform(zone));
      tiles.push_back(tile);
    }
  }
  return tiles;
}

std::vector<Pixel> make_history(const reference::TemporalInputs& in, PixelFormat format, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Pixel> history;
  for (int i = 0; i < in.output_width * in.output_height; ++i) {
    Pixel texel = {3 * uniform(random), uniform(random), 2 * uniform(random), 32 * uniform(random)};
    if (random() % 4 == 0) texel[3] = 2 * uniform(random);
    if (random() % 8 == 0) texel[3] = .3 * uniform(random);
    if (random() % 32 == 0) texel = {};
    for (double& value : texel)
      value = stored_value(format, value);
    history.push_back(texel);
  }
  return history;
}

// Returns for each sample whether it has a near layer, in zones of which some move as one.
std::vector<reference::LayerSplit> make_splits(const reference::TemporalInputs& in, unsigned seed) {
  const Zones zones(seed);
  std::mt19937 random(seed + 1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<reference::LayerSplit> splits;
  for (int y = 0; y < in.frame.height; ++y) {
    for (int x = 0; x < in.frame.width; ++x) {
      std::mt19937 zone =
          zones.of(static_cast<int>(x * in.spacing(0) / 40), static_cast<int>(y * in.spacing(1) / 24));
      const double spread = std::array{0., 0., .04, 1.}[zone() % 4];
      const auto& motion = kZoneMoves[zone() % std::size(kZoneMoves)];
      reference::LayerSplit split;
      if (zone() % 5 < 2 && random() % 3 == 0) {
        const double near_depth = .15 + .3 * uniform(random);
        split = {.near_depth = as_float(near_depth),
                 .far_depth = as_float(near_depth * (.2 + .7 * uniform(random))),
                 .motion = {as_float(motion[0] + spread * uniform(random)),
                            as_float(motion[1] - spread * uniform(random))}};
      }
      splits.push_back(split);
    }
  }
  return splits;
}

std::vector<int> make_marks(const reference::TemporalInputs& in) {
  std::vector<int> marks(in.before.size());
  for (int y = 0; y < in.frame.height; ++y) {
    for (int x = 0; x < in.frame.width; ++x) {
      if (!in.splits[reference::index_of(in.frame.width, x, y)].is_split()) continue;
      const int tile_x = static_cast<int>((x + .5 + in.frame.jitter_x) * in.spacing(0)) / kTemporalTile;
      const int tile_y = static_cast<int>((y + .5 + in.frame.jitter_y) * in.spacing(1)) / kTemporalTile;
      marks[reference::index_of(in.tiles_x(), std::min(tile_x, in.tiles_x() - 1),
                                std::min(tile_y, in.tiles_y() - 1))] = 1;
    }
  }
  return marks;
}

std::vector<reference::LayerTile> make_layers_before(const reference::TemporalInputs& in, unsigned seed) {
  const Zones zones(seed);
  std::uniform_real_distribution<double> phase(-.5, .5), depth(.2, .5);
  std::vector<reference::LayerTile> layers;
  for (int y = 0; y < in.tiles_y(); ++y) {
    for (int x = 0; x < in.tiles_x(); ++x) {
      std::mt19937 zone = zones.of(x / 3, y / 4);
      reference::LayerTile tile;
      tile.is_split = zone() % 5 == 0;
      tile.is_layered = tile.is_split || zone() % 3 == 0;
      if (tile.is_split) tile.between = as_float(depth(zone));
      tile.is_rigid = tile.is_split && zone() % 4 != 0;
      if (tile.is_rigid) tile.phase = {as_float(phase(zone)), as_float(phase(zone))};
      layers.push_back(tile);
    }
  }
  return layers;
}

void add_layers(reference::TemporalInputs& in, unsigned seed) {
  in.splits = make_splits(in, seed);
  in.split_marks = make_marks(in);
  in.layers_before = make_layers_before(in, seed + 1);
  // A negative confidence tells a texel of two layers.
  std::mt19937 random(seed + 2);
  for (Pixel& texel : in.history) {
    if (random() % 4 == 0) texel[3] = -texel[3];
  }
}

// Whole and empty in most places, as a matte is.
std::vector<double> make_alpha(std::size_t count, PixelFormat format, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> alpha;
  while (alpha.size() < count) {
    const auto kind = random() % 4;
    alpha.push_back(stored_value(format, kind == 0 ? 0 : kind == 1 ? 1 : uniform(random)));
  }
  return alpha;
}

}  // namespace

std::string name_of(const StageSpec& spec) {
  return fmt::format("{}x{} -> {}x{}, {}, seed {}", spec.render.width, spec.render.height, spec.output.width,
                     spec.output.height, name_of(spec.colour), spec.seed);
}

std::vector<StageSpec> all_stage_specs(const std::vector<Pattern>& patterns) {
  std::vector<StageSpec> specs;
  unsigned seed = 0;
  for (const Extent output : {Extent{1, 1}, Extent{4, 4}, Extent{7, 5}, Extent{64, 64}, Extent{257, 129}}) {
    for (const auto& scale : kStageScales) {
      for (const Pattern pattern : patterns) {
        ++seed;
        if (output.width == 257 && seed % 17 != 0) continue;
        const Extent render = scaled(output, scale[0], scale[1]);
        specs.push_back({.output = output,
                         .render = render,
                         .previous = {render.width + 2, std::max(render.height - 1, 1)},
                         .colour = pattern,
                         .seed = seed,
                         .light = pattern == Pattern::kNoise && seed % 3 == 0 ? 4. : 1.});
      }
    }
  }
  return specs;
}

StageInputs TemporalStages::inputs(Rig& rig, const StageSpec& spec) const {
  const double unit = variant_.colour == PixelFormat::kRGBA8 ? 1 : spec.light;
  std::vector<Pixel> colour = pattern_pixels(spec.colour, spec.render, spec.seed);
  for (Pixel& pixel : colour) {
    for (std::size_t c = 0; c < 4; ++c)
      pixel[c] = std::abs(pixel[c]) * (c < 3 ? unit : 1);  // light
  }
  const TestFrame made =
      make_frame(rig,
                 {.storage = variant_.storage,
                  .colour = variant_.colour,
                  .with_depth = variant_.layers,
                  .with_reactive = variant_.reactive},
                 {.render = spec.render,
                  .jitter = spec.jitter,
                  .velocity = spec.colour == Pattern::kNonFinite ? Pattern::kNonFinite : Pattern::kNoise,
                  .seed = spec.seed,
                  .outside = spec.outside,
                  .tight = spec.tight},
                 colour);
  StageInputs in;
  in.frame = made.inputs;
  in.exposure.factor = in.exposure.change = static_cast<float>(1 / unit);
  reference::TemporalInputs& out = in.reference;
  out.frame = reference::exposed(made.reference, 1 / unit);
  out.parity = spec.parity;
  out.previous_width = spec.previous.width;
  out.previous_height = spec.previous.height;
  out.output_width = spec.output.width;
  out.output_height = spec.output.height;
  out.history = make_history(out, variant_.history, spec.seed + 1000);
  if (variant_.alpha) out.history_alpha = make_alpha(out.history.size(), variant_.history, spec.seed + 1500);
  out.before = make_tiles_before(out, variant_.moves, spec.seed + 2000);
  if (variant_.reactive) {
    const TestFrame previous = make_frame(
        rig, {.storage = variant_.storage, .with_reactive = true},
        {.render = spec.previous, .seed = spec.seed + 500, .outside = spec.outside, .tight = spec.tight});
    in.reactive_before = previous.inputs.reactive;
    out.reactive_before = previous.reference.reactive;
  }
  if (!variant_.moves) return in;
  out.reprojections = make_moves(out, spec.seed + 3000);
  if (variant_.layers) add_layers(out, spec.seed + 4000);
  store_reprojections(rig, spec, in, out.splits);
  return in;
}

void store_reprojections(Rig& rig, const StageSpec& spec, StageInputs& in,
                         const std::vector<reference::LayerSplit>& splits) {
  std::vector<reference::Reprojection>& moves = in.reference.reprojections;
  std::vector<Pixel> stored;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const bool is_split = !splits.empty() && splits[i].is_split();
    if (is_split || moves[i].motion_edge == 0)
      moves[i].motion_edge = is_split ? -0. : 0;  // as layer_split has it
    stored.push_back({moves[i].x, moves[i].y, moves[i].trust, moves[i].motion_edge});
  }
  in.reprojection =
      rig.image(PixelFormat::kRGBA32F, Storage::kBuffer, spec.render, stored, spec.outside, spec.tight);
}

std::vector<reference::Tile> TemporalStages::tiles(const StageInputs& in, unsigned seed) const {
  const Zones zones(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<reference::Tile> made;
  for (const reference::Tile& tile : reference::temporal_tiles(in.reference)) {
    reference::Tile exact = to_reference(to_kernel(tile));
    const int i = static_cast<int>(made.size());
    std::mt19937 zone = zones.of(i % in.reference.tiles_x() / 5, i / in.reference.tiles_x() / 4);
    const bool rejects = zone() % 3 == 0;
    for (reference::CellLightOf<double>& cell : exact.light.cells) {
      if (rejects) cell.rejection = as_float(uniform(zone));
      exact.light.rejection = std::max(exact.light.rejection, cell.rejection);
    }
    if (zone() % 3 == 0) exact.light.gain = as_float(.25 + 2 * uniform(zone));
    exact.light.holds_back = zone() % 2 == 0;
    if (zone() % 3 == 0) exact.light.new_cut = as_float(uniform(zone));
    made.push_back(exact);
  }
  return made;
}

}  // namespace quincunx::testing

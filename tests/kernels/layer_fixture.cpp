// SPDX-License-Identifier: MIT
// The inputs of resolve_layers and display_layers: surfaces at two depths, splits, and a history of two layers.
#include "layer_fixture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace quincunx::testing {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Vec2 kPreviousJitter = {-.31f, .23f};

double as_float(double value) {
  return static_cast<double>(static_cast<float>(value));
}

// Reversed depths of what is near, far and in the middle. Thresholds of the kernels lie among what they vary by.
constexpr double kNear = .62;
constexpr double kFar = .26;
constexpr double kMiddle = .45;

// Random numbers of places: of each zone of so many output pixels, or of each place.
class Field {
 public:
  explicit Field(unsigned seed) : seed_(seed) {}

  std::mt19937 zone(double x, double y, double width, double height) const {
    return std::mt19937(seed_ + 7919 * static_cast<unsigned>(x / width) +
                        104729 * static_cast<unsigned>(y / height));
  }

 private:
  unsigned seed_;
};

double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

double about(std::mt19937& random, double value, double spread) {
  return as_float(value * (1 + uniform(random, -spread, spread)));
}

std::vector<double> make_depth(Extent render, Extent output, unsigned seed) {
  const Field field(seed);
  std::mt19937 random(seed + 1);
  std::vector<double> depths;
  for (int y = 0; y < render.height; ++y) {
    for (int x = 0; x < render.width; ++x) {
      std::mt19937 zone =
          field.zone(x * output.width / render.width, y * output.height / render.height, 5, 4);
      const bool is_near = zone() % 2 == 0;
      double depth = about(random, is_near ? kNear : kFar, .05);
      if (random() % 20 == 0) depth = about(random, kMiddle, .1);
      if (random() % 60 == 0) depth = kNan;
      depths.push_back(depth);
    }
  }
  return depths;
}

ImageView depth_image(Rig& rig, const StageSpec& spec, Storage storage, Extent render,
                      const std::vector<double>& depths) {
  std::vector<Pixel> pixels;
  for (const double depth : depths)
    pixels.push_back({depth, 0, 0, 0});
  return rig.image(PixelFormat::kR32F, storage, render, pixels, spec.outside, spec.tight);
}

// Output pixels a frame; rigid zones move as one.
constexpr double kNearMoves[][2] = {{0, 0}, {-.37, .22}, {3.2, -2.1}, {.25, 1.8}, {-9.3, 4.6}, {2.6, -700}};

std::vector<reference::LayerSplit> make_splits(const reference::TemporalInputs& in, unsigned seed) {
  const Field field(seed);
  std::mt19937 random(seed + 1);
  std::vector<reference::LayerSplit> splits;
  for (int y = 0; y < in.frame.height; ++y) {
    for (int x = 0; x < in.frame.width; ++x) {
      const double at_x = x * in.spacing(0);
      const double at_y = y * in.spacing(1);
      std::mt19937 area = field.zone(at_x, at_y, 48, 40);
      std::mt19937 zone = field.zone(at_x + 1000, at_y, 6, 9);
      const auto& motion = kNearMoves[area() % std::size(kNearMoves)];
      const bool is_rigid = area() % 3 != 0;
      const bool has_any = area() % 5 != 0;
      const bool may_cross = area() % 2 == 0;
      reference::LayerSplit split;
      if (has_any && zone() % 2 == 0) {
        const double spread = is_rigid ? 0 : may_cross ? 1.3 : .4;
        split = {about(random, kNear, .04),
                 about(random, kFar, .04),
                 {as_float(motion[0] + uniform(random, -spread, spread)),
                  as_float(motion[1] + uniform(random, -spread, spread))}};
      }
      splits.push_back(split);
    }
  }
  return splits;
}

std::vector<double> make_open_trust(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<double> trust;
  for (std::size_t i = 0; i < count; ++i) {
    double value = 1;
    if (random() % 4 == 0) value = as_float(uniform(random, 0, 1));
    if (random() % 20 == 0) value = 0;
    trust.push_back(value);
  }
  return trust;
}

void make_history(reference::LayerHistory& out, PixelFormat format, unsigned seed) {
  const Field field(seed);
  std::mt19937 random(seed + 1);
  const int tiles_x = (out.width + reference::kTile - 1) / reference::kTile;
  for (std::size_t i = 0; i < out.tiles.size(); ++i) {
    const int x = static_cast<int>(i) % tiles_x;
    const int y = static_cast<int>(i) / tiles_x;
    std::mt19937 area = field.zone(x, y, 5, 4);
    reference::LayerTile tile;
    tile.is_split = random() % 2 == 0;
    tile.is_layered = tile.is_split || random() % 4 == 0;
    tile.is_rigid = tile.is_split && area() % 3 != 0;
    if (tile.is_split) tile.between = about(random, kMiddle, .1);
    if (tile.is_rigid) {
      tile.phase[0] = as_float(uniform(area, -.5, .5));
      tile.phase[1] = as_float(uniform(area, -.5, .5));
    }
    out.layers.push_back(tile);
  }
  const auto half = [](double value) { return stored_value(PixelFormat::kRGBA16F, value); };
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      const reference::LayerTile& tile = out.layers[out.tile(x, y)];
      std::mt19937 zone = field.zone(x, y, 3, 4);
      const bool has_two = tile.is_split && zone() % 2 == 0;
      reference::StoredState state{kNan, kNan, kNan, kNan};
      Pixel near{kNan, kNan, kNan, kNan};
      if (tile.is_layered) {
        double depth = about(random, has_two || zone() % 2 == 0 ? kFar : kNear, .3);
        if (!has_two && random() % 60 == 0) depth = kNan;
        state = {half(std::pow(depth, .25)), 0, 0, 0};
      }
      if (has_two) {
        double confidence = uniform(random, 0, 8);
        if (random() % 4 == 0) confidence = uniform(random, 0, .5);
        if (random() % 16 == 0) confidence = 0;
        double coverage = uniform(random, 0, 1);
        if (random() % 4 == 0) coverage = 1;
        if (random() % 4 == 0) coverage = 0;
        state.near_root = half(std::pow(about(random, kNear, .12), .25));
        state.near_confidence = half(confidence);
        near = {3 * coverage * uniform(random, 0, 1), coverage * uniform(random, 0, 1),
                2 * coverage * uniform(random, 0, 1), coverage};
        if (!out.alpha.empty()) state.near_alpha = half(coverage * uniform(random, -.2, 1.2));
        Pixel& far = out.far[out.texel(x, y)];
        far[3] = -far[3];
      }
      for (double& value : near)
        value = stored_value(format, value);
      out.states.push_back(state);
      out.near.push_back(near);
    }
  }
}

std::vector<Pixel> make_picture(Extent output, PixelFormat format, unsigned seed) {
  std::vector<Pixel> picture = pattern_pixels(Pattern::kNoise, output, seed);
  for (Pixel& pixel : picture) {
    for (double& value : pixel)
      value = stored_value(format, std::abs(value));
  }
  return picture;
}

// The tile that holds an output position, clamped to the edge.
int tile_at(double at, int tiles) {
  return static_cast<int>(std::clamp(std::floor(at / reference::kTile), 0.0, tiles - 1.0));
}

// As layer_split and temporal_tiles would make them, but some tiles are layered besides.
std::vector<reference::LayerTile> make_layers(const reference::ResolveInputs& in, unsigned seed) {
  const reference::TemporalInputs& now = in.now;
  std::mt19937 random(seed);
  struct Found {
    bool any = false;
    std::array<double, 2> least = {1e9, 1e9}, most = {-1e9, -1e9};
  };
  std::vector<Found> found(in.tiles.size());
  for (int y = 0; y < now.frame.height; ++y) {
    for (int x = 0; x < now.frame.width; ++x) {
      const reference::LayerSplit& split = in.splits[reference::index_of(now.frame.width, x, y)];
      if (!split.is_split()) continue;
      Found& tile = found[reference::index_of(
          now.tiles_x(), tile_at((x + .5 + now.frame.jitter_x) * now.spacing(0), now.tiles_x()),
          tile_at((y + .5 + now.frame.jitter_y) * now.spacing(1), now.tiles_y()))];
      tile.any = true;
      tile.least = {std::min(tile.least[0], split.motion[0]), std::min(tile.least[1], split.motion[1])};
      tile.most = {std::max(tile.most[0], split.motion[0]), std::max(tile.most[1], split.motion[1])};
    }
  }
  std::vector<reference::LayerTile> layers;
  for (int y = 0; y < now.tiles_y(); ++y) {
    for (int x = 0; x < now.tiles_x(); ++x) {
      Found around;
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, now.tiles_y() - 1); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, now.tiles_x() - 1); ++i) {
          const Found& other = found[reference::index_of(now.tiles_x(), i, j)];
          around.any = around.any || other.any;
          for (std::size_t axis = 0; axis < 2; ++axis) {
            around.least[axis] = std::min(around.least[axis], other.least[axis]);
            around.most[axis] = std::max(around.most[axis], other.most[axis]);
          }
        }
      }
      reference::LayerTile tile;
      tile.is_split = around.any;
      tile.is_layered = around.any || random() % 4 == 0;
      if (around.any) {
        tile.motion_range =
            as_float(std::max(around.most[0] - around.least[0], around.most[1] - around.least[1]));
      }
      tile.is_rigid = around.any && around.most == around.least;
      if (tile.is_rigid) {
        const reference::LayerTile& from = in.past.layers[reference::index_of(
            now.tiles_x(), tile_at((x + .5) * reference::kTile + around.least[0], now.tiles_x()),
            tile_at((y + .5) * reference::kTile + around.least[1], now.tiles_y()))];
        const double place_x = from.phase[0] - around.least[0];
        const double place_y = from.phase[1] - around.least[1];
        tile.phase[0] = as_float(place_x - std::floor(place_x + .5));
        tile.phase[1] = as_float(place_y - std::floor(place_y + .5));
      }
      layers.push_back(tile);
    }
  }
  return layers;
}

std::vector<LayerSplit> splits_of(const std::vector<reference::LayerSplit>& splits) {
  std::vector<LayerSplit> made;
  for (const reference::LayerSplit& split : splits)
    made.push_back(to_kernel(split));
  return made;
}

PassRig rig_of(const TemporalStages& stages, TemporalPreset preset, std::string_view kernel) {
  const PlanFacts facts = stages.facts(preset);
  return {facts.needs, facts.settings, kernel};
}

}  // namespace

LayerStageInputs LayerStages::inputs(Rig& rig, const StageSpec& spec) const {
  LayerStageInputs in;
  in.stage = stages_.inputs(rig, spec);
  in.stage.frame.parity = std::max(spec.parity, 0);
  reference::ResolveInputs& out = in.reference;
  out.now = in.stage.reference;
  out.tiles = stages_.tiles(in.stage, spec.seed);
  out.now.frame.depth = make_depth(spec.render, spec.output, spec.seed + 4000);
  in.stage.frame.depth = depth_image(rig, spec, variant_.storage, spec.render, out.now.frame.depth);
  out.open_trust = make_open_trust(out.now.reprojections.size(), spec.seed + 5000);
  out.splits = make_splits(out.now, spec.seed + 6000);
  store_reprojections(rig, spec, in.stage, out.splits);
  out.now.reprojections = in.stage.reference.reprojections;

  reference::LayerHistory& past = out.past;
  past.width = spec.output.width;
  past.height = spec.output.height;
  past.far = out.now.history;
  past.alpha = out.now.history_alpha;
  past.tiles = out.now.before;
  past.frame.width = spec.previous.width;
  past.frame.height = spec.previous.height;
  past.frame.jitter_x = static_cast<double>(kPreviousJitter.x);
  past.frame.jitter_y = static_cast<double>(kPreviousJitter.y);
  past.frame.depth = make_depth(spec.previous, spec.output, spec.seed + 7000);
  make_history(past, variant_.history, spec.seed + 8000);
  out.layers = make_layers(out, spec.seed + 9000);

  in.picture = make_picture(spec.output, variant_.resolved, spec.seed + 10000);
  in.previous = in.stage.frame;
  in.previous.render_extent = spec.previous;
  in.previous.jitter = kPreviousJitter;
  in.previous.depth = depth_image(rig, spec, variant_.storage, spec.previous, past.frame.depth);
  return in;
}

ImageView view_of(const cl::Buffer& buffer) {
  return {.memory = buffer()};
}

std::vector<TileReprojection> reprojections_of(const std::vector<reference::Tile>& tiles) {
  std::vector<TileReprojection> made;
  for (const reference::Tile& tile : tiles)
    made.push_back(to_kernel(tile));
  return made;
}

std::vector<TileLight> lights_of(const std::vector<reference::Tile>& tiles) {
  std::vector<TileLight> made;
  for (const reference::Tile& tile : tiles)
    made.push_back(to_kernel(tile));
  return made;
}

cl::Buffer states_to_device(const std::vector<reference::StoredState>& states) {
  std::vector<Pixel> texels;
  for (const reference::StoredState& s : states)
    texels.push_back({s.far_root, s.near_root, s.near_confidence, s.near_alpha});
  return to_device(encode(PixelFormat::kRGBA16F, texels));
}

std::vector<LayerTile> to_kernel(const std::vector<reference::LayerTile>& tiles) {
  const auto number = [](double value) { return static_cast<float>(value); };
  std::vector<LayerTile> made;
  for (const reference::LayerTile& t : tiles) {
    made.push_back({number(t.phase[0]), number(t.phase[1]), number(t.between), number(t.motion_range),
                    t.is_rigid ? 1 : 0, t.is_split ? 1 : 0, t.is_layered ? 1 : 0});
  }
  return made;
}

// The layered tiles, the last first, and how many they are.
std::pair<cl::Buffer, cl::Buffer> list_layered(const std::vector<reference::LayerTile>& tiles) {
  std::vector<cl_int> listed;
  for (std::size_t i = tiles.size(); i-- > 0;) {
    if (tiles[i].is_layered) listed.push_back(static_cast<cl_int>(i));
  }
  TotalLight total{};
  total.layered = static_cast<int>(listed.size());
  listed.resize(tiles.size());
  return {to_device(listed), to_device(std::vector<TotalLight>{total})};
}

LayerStages::LayerStages(const StageVariant& variant, TemporalPreset preset)
    : variant_(variant),
      stages_(variant),
      resolve_(rig_of(stages_, preset, "resolve_layers")),
      display_(rig_of(stages_, preset, "display_layers")) {}

LayerStages::Resolved LayerStages::run_resolve(Rig& rig, const LayerStageInputs& in) {
  const reference::ResolveInputs& r = in.reference;
  const reference::LayerHistory& past = r.past;
  const Extent output{past.width, past.height};
  const std::size_t texels = past.far.size();
  std::vector<float> trust;
  for (const double value : r.open_trust)
    trust.push_back(static_cast<float>(trust.size() % 3 == 0 ? -value : value));  // the sign is not trust's
  const cl::Buffer open_trust = to_device(trust);
  const cl::Buffer splits = to_device(splits_of(r.splits));
  const Exposure& exposure = in.stage.exposure;
  const cl::Buffer far = to_device(encode(variant_.history, before_change(past.far, exposure)));
  const cl::Buffer near = to_device(encode(variant_.history, before_change(past.near, exposure)));
  const cl::Buffer states = states_to_device(past.states);
  const cl::Buffer tiles_before = to_device(reprojections_of(past.tiles));
  const cl::Buffer layers_before = to_device(to_kernel(past.layers));
  const cl::Buffer tiles = to_device(reprojections_of(r.tiles));
  const cl::Buffer layers = to_device(to_kernel(r.layers));
  const cl::Buffer light = to_device(lights_of(r.tiles));
  const auto [listed, total] = list_layered(r.layers);
  const std::size_t bytes = texels * bytes_per_pixel(variant_.history);
  const std::size_t state_bytes = texels * bytes_per_pixel(PixelFormat::kRGBA16F);
  const cl::Buffer updated = to_device(std::vector<unsigned char>(bytes, 0x7f));
  const std::size_t alpha_size = variant_.alpha ? encode_plane(variant_.history, past.alpha).size() : 1;
  const cl::Buffer alpha = variant_.alpha ? to_device(encode_plane(variant_.history, past.alpha)) : far;
  const cl::Buffer updated_alpha = to_device(std::vector<unsigned char>(alpha_size, 0x7f));
  const cl::Buffer updated_near = to_device(std::vector<unsigned char>(bytes, 0x7f));
  const cl::Buffer updated_states = to_device(std::vector<unsigned char>(state_bytes, 0x7f));
  const Counter counter = rig.counter();
  resolve_.set_exposure(exposure);
  resolve_.run(in.stage.frame, in.previous, output, counter,
               {{Resource::kReprojection, in.stage.reprojection},
                {Resource::kOpenTrust, view_of(open_trust)},
                {Resource::kSplits, view_of(splits)},
                {Resource::kPreviousHistory, view_of(far)},
                {Resource::kPreviousHistoryAlpha, view_of(alpha)},
                {Resource::kPreviousNearHistory, view_of(near)},
                {Resource::kPreviousLayerStates, view_of(states)},
                {Resource::kPreviousTileReprojection, view_of(tiles_before)},
                {Resource::kPreviousLayerTiles, view_of(layers_before)},
                {Resource::kTileReprojection, view_of(tiles)},
                {Resource::kLayerTiles, view_of(layers)},
                {Resource::kTileLight, view_of(light)},
                {Resource::kLayeredTileList, view_of(listed)},
                {Resource::kTotalLight, view_of(total)},
                {Resource::kHistory, view_of(updated)},
                {Resource::kHistoryAlpha, view_of(updated_alpha)},
                {Resource::kNearHistory, view_of(updated_near)},
                {Resource::kLayerStates, view_of(updated_states)}});
  return {from_device<unsigned char>(updated, bytes), from_device<unsigned char>(updated_near, bytes),
          from_device<unsigned char>(updated_states, state_bytes),
          from_device<unsigned char>(updated_alpha, alpha_size), rig.count(counter)};
}

std::vector<Pixel> LayerStages::run_display(Rig& rig, const LayerStageInputs& in) {
  const reference::LayerHistory& shown = in.reference.past;
  const Extent output{shown.width, shown.height};
  const cl::Buffer tiles = to_device(reprojections_of(shown.tiles));
  const cl::Buffer layers = to_device(to_kernel(shown.layers));
  const auto [listed, total] = list_layered(shown.layers);
  const cl::Buffer far = to_device(encode(variant_.history, shown.far));
  const cl::Buffer near = to_device(encode(variant_.history, shown.near));
  const cl::Buffer states = states_to_device(shown.states);
  const cl::Buffer alpha = variant_.alpha ? to_device(encode_plane(variant_.history, shown.alpha)) : far;
  const ImageView picture = rig.image(variant_.resolved, Storage::kBuffer, output, in.picture, -7);
  display_.run(in.previous, in.previous, output, rig.counter(),
               {{Resource::kTileReprojection, view_of(tiles)},
                {Resource::kLayerTiles, view_of(layers)},
                {Resource::kLayeredTileList, view_of(listed)},
                {Resource::kTotalLight, view_of(total)},
                {Resource::kHistory, view_of(far)},
                {Resource::kHistoryAlpha, view_of(alpha)},
                {Resource::kNearHistory, view_of(near)},
                {Resource::kLayerStates, view_of(states)},
                {picture_of(display_.facts()), picture}});
  return rig.pixels(picture, output);
}

}  // namespace quincunx::testing

// SPDX-License-Identifier: MIT
#include "layer_fixture.h"

#include <algorithm>

namespace quincunx::testing {
namespace {

std::vector<LayerSplit> splits_of(const std::vector<reference::LayerSplit>& splits) {
  const auto number = [](double value) { return static_cast<float>(value); };
  std::vector<LayerSplit> made;
  for (const reference::LayerSplit& s : splits)
    made.push_back({number(s.near_depth), number(s.far_depth), number(s.motion[0]), number(s.motion[1])});
  return made;
}

PassRig rig_of(const TemporalStages& stages, TemporalPreset preset, std::string_view kernel) {
  const PlanFacts facts = stages.facts(preset);
  return {facts.needs, facts.settings, kernel};
}

}  // namespace

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
    texels.push_back({s.far_root, s.near_root, s.near_confidence, 0});
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
    trust.push_back(static_cast<float>(value));
  const cl::Buffer open_trust = to_device(trust);
  const cl::Buffer splits = to_device(splits_of(r.splits));
  const cl::Buffer far = to_device(encode(variant_.history, past.far));
  const cl::Buffer near = to_device(encode(variant_.history, past.near));
  const cl::Buffer states = states_to_device(past.states);
  const cl::Buffer tiles_before = to_device(reprojections_of(past.tiles));
  const cl::Buffer layers_before = to_device(to_kernel(past.layers));
  const cl::Buffer tiles = to_device(reprojections_of(r.tiles));
  const cl::Buffer layers = to_device(to_kernel(r.layers));
  const cl::Buffer light = to_device(lights_of(r.tiles));
  const std::size_t bytes = texels * bytes_per_pixel(variant_.history);
  const std::size_t state_bytes = texels * bytes_per_pixel(PixelFormat::kRGBA16F);
  const cl::Buffer updated = to_device(std::vector<unsigned char>(bytes, 0x7f));
  const std::size_t alpha_size = variant_.alpha ? encode_plane(variant_.history, past.alpha).size() : 1;
  const cl::Buffer alpha = variant_.alpha ? to_device(encode_plane(variant_.history, past.alpha)) : far;
  const cl::Buffer updated_alpha = to_device(std::vector<unsigned char>(alpha_size, 0x7f));
  const cl::Buffer updated_near = to_device(std::vector<unsigned char>(bytes, 0x7f));
  const cl::Buffer updated_states = to_device(std::vector<unsigned char>(state_bytes, 0x7f));
  const Counter counter = rig.counter();
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
  const cl::Buffer far = to_device(encode(variant_.history, shown.far));
  const cl::Buffer near = to_device(encode(variant_.history, shown.near));
  const cl::Buffer states = states_to_device(shown.states);
  const ImageView picture = rig.image(variant_.resolved, Storage::kBuffer, output, in.picture, -7);
  display_.run(in.previous, in.previous, output, rig.counter(),
               {{Resource::kTileReprojection, view_of(tiles)},
                {Resource::kLayerTiles, view_of(layers)},
                {Resource::kHistory, view_of(far)},
                {Resource::kNearHistory, view_of(near)},
                {Resource::kLayerStates, view_of(states)},
                {picture_of(display_.facts()), picture}});
  return rig.pixels(picture, output);
}

}  // namespace quincunx::testing

// SPDX-License-Identifier: MIT
// The stages of the temporal upscaler one by one, on inputs that are made: the same on the device and for the
// references.
#pragma once

#include <string>
#include <vector>

#include "../reference/temporal.h"
#include "kernel_fixture.h"
#include "layers/layer.h"
#include "params.h"
#include "passes/tables.h"
#include "picture_params.h"
#include "temporal/temporal_params.h"

namespace quincunx::testing {

struct StageVariant {
  Storage storage = Storage::kBuffer;
  PixelFormat colour = PixelFormat::kRGBA16F;
  PixelFormat history = PixelFormat::kRGBA32F;
  PixelFormat resolved = PixelFormat::kRGBA32F;
  bool moves = true;
  bool reactive = false;  // only where nothing moves
  bool layers = false;    // only where something moves
  bool alpha = false;     // no background covers every pixel
  bool checkerboard = false;
};
std::string name_of(const StageVariant& variant);

struct StageSpec {
  Extent output;
  Extent render;
  Extent previous;
  Vec2 jitter = {.21f,
                 -.17f};  // no multiple of a small fraction: no place is half-way between two by rounding
  Pattern colour = Pattern::kNoise;
  unsigned seed = 1;
  double outside = 0;
  bool tight = false;
  int parity = -1;  // that of a checkerboard's shaded samples; -1: all are
  // A power of two: on the device light is this times the reference's exposed light, and the exposure has become so
  // much less in this frame. Not of RGBA8.
  double light = 1;
};

std::string name_of(const StageSpec& spec);
// Returns specs for all patterns in many sizes and scales; the largest are few, as references are slow.
std::vector<StageSpec> all_stage_specs(const std::vector<Pattern>& patterns);

// The inputs of a stage. Zones of the picture move as one or each sample on its own; the history's confidences range
// from 0 to 32, its tiles' phases change from zone to zone.
struct StageInputs {
  reference::TemporalInputs reference;
  FrameInputs frame;
  ImageView reactive_before;
  ImageView reprojection;
  Exposure exposure = {1, 1, 1, 1};
};

// Puts the reprojections of `in.reference` on the device, those of split samples as layer_split leaves them; none is
// split if `splits` is empty.
void store_reprojections(Rig& rig, const StageSpec& spec, StageInputs& in,
                         const std::vector<reference::LayerSplit>& splits);

template <typename Element>
cl::Buffer to_device(const std::vector<Element>& elements) {
  cl::Buffer buffer(impl().context, CL_MEM_READ_WRITE, elements.size() * sizeof(Element));
  impl().queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, elements.size() * sizeof(Element), elements.data());
  return buffer;
}

// Returns texels of history before the exposure changed.
std::vector<Pixel> before_change(std::vector<Pixel> texels, const Exposure& exposure);

template <typename Element>
std::vector<Element> from_device(const cl::Buffer& buffer, std::size_t count) {
  std::vector<Element> elements(count);
  impl().queue.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(Element), elements.data());
  return elements;
}

// A plane of single values in the format of one channel of `texels`, which are in fours; the last may be padded.
std::vector<unsigned char> encode_plane(PixelFormat texels, const std::vector<double>& values);
std::vector<double> decode_plane(PixelFormat texels, const std::vector<unsigned char>& bytes,
                                 std::size_t count);

// All that the kernels keep of a tile.
struct KernelTile : TileReprojection, TileEvidence, TileLight {};

KernelTile to_kernel(const reference::Tile& tile);
LayerSplit to_kernel(const reference::LayerSplit& split);  // not a number where the sample is not split
LayerTile to_kernel(const reference::LayerTile& tile);
reference::Tile to_reference(const KernelTile& tile);

// A variant of resolve_temporal.
struct ResolveVariant {
  TemporalPreset preset = TemporalPreset::kBalanced;
  std::vector<LayerTile> layers = {};  // none: LAYERS=0
};

class TemporalStages {
 public:
  explicit TemporalStages(const StageVariant& variant) : variant_(variant) {}

  StageInputs inputs(Rig& rig, const StageSpec& spec) const;

  // Tiles for resolve_temporal as temporal_tiles would make them of these inputs, some of them doubtful and
  // of other light; exact on both sides.
  std::vector<reference::Tile> tiles(const StageInputs& in, unsigned seed) const;

  struct Tiles {
    std::vector<KernelTile> tiles;  // but for TileLight
    std::vector<LayerTile> layers;
    std::vector<cl_int> listed;  // those that are layered
    TotalLight total;
  };
  Tiles run_tiles(const StageInputs& in) const;
  std::vector<TileLight> run_light(Extent tiles, const std::vector<reference::Tile>& before,
                                   const TotalLight& total, const std::vector<reference::Tile>& now) const;

  struct Result {
    std::vector<unsigned char> bytes;  // from resolve_temporal also those of alpha
    std::vector<Pixel> pixels;
    std::vector<double> alpha;  // from resolve_temporal, where there is one
    std::int64_t non_finite = 0;
  };
  // History holds bytes of 0x7f before, the picture -7.
  Result run_resolve(Rig& rig, const StageInputs& in, const std::vector<reference::Tile>& tiles,
                     const ResolveVariant& how = {}) const;
  struct Shown {
    TemporalPreset preset = TemporalPreset::kBalanced;
    bool first = false;  // the first of all frames
  };
  Result run_display(Rig& rig, const StageInputs& in, const std::vector<reference::Tile>& tiles,
                     const Shown& shown) const;

  PlanFacts facts(TemporalPreset preset) const;

 private:
  cl::Buffer history(const StageInputs& in) const;
  cl::Buffer history_alpha(const StageInputs& in) const;

  StageVariant variant_;
};

}  // namespace quincunx::testing

// SPDX-License-Identifier: MIT
// The temporal upscaler, kernel by kernel: the specification, which docs/temporal.md explains. Each function
// makes what one work-item makes: one tile or one pixel. error_bound.h tells what `Real` may be.
//
// Pictures are accumulated in a *history* of the output's extent: colour m and confidence W of each texel, W
// being the sum of the weights of the samples in it. Lengths are output pixels unless said otherwise.
#pragma once

#include <array>
#include <vector>

#include "error_bound.h"
#include "layers.h"
#include "reproject.h"

namespace quincunx::reference {

constexpr int kTile = 8;  // output pixels on either axis

// How a tile's texels take history over. In a rigid tile all samples move alike: its texels are copied, not
// resampled, and their picture lies apart from their centres by a phase that is carried from frame to frame.
template <typename Real>
struct TileReprojectionOf {
  std::array<Real, 2> phase = {};           // output pixels, within [-.5, .5]; 0 unless rigid
  std::array<double, 2> source_phase = {};  // phase of the texels that are copied
  std::array<int, 2> step = {};             // texel (x, y) is a copy of (x - step[0], y - step[1])
  bool is_rigid = false;
  bool is_trusted = false;       // rigid, all its samples are trusted, and no motion edge is near
  bool has_motion_edge = false;  // one above kRejectedEdgeMin
};
using TileReprojection = TileReprojectionOf<double>;

inline bool stands_still(const TileReprojection& tile) {
  return tile.is_rigid && tile.phase[0] == 0 && tile.phase[1] == 0 && tile.step[0] == 0 && tile.step[1] == 0;
}

// A tile has four cells, kTile / 2 pixels wide and high, row by row. Sums as in TileEvidence.
template <typename Real>
struct CellEvidenceOf {
  Real brightening = 0;
  int count = 0, brighter = 0;
};

// The evidence of a tile's samples s about the history h at their place, n being the mean of their four neighbours:
// sums over the samples that judge, of luma, each divided by 1 + s + h, or 1 + s + n.
template <typename Real>
struct TileEvidenceOf {
  Real brightening = 0;      // s - h
  Real light = 0;            // h
  Real history_error = 0;    // |s - h|: history's as a forecast of the sample
  Real neighbour_error = 0;  // |s - n|: the neighbours'
  int count = 0;             // samples
  int brighter = 0;  // those that are brighter than history by more than noise, less those that are darker
  int outliers = 0;  // those that are outliers, with two of their neighbours
  Real lag = 0, lit = 0;  // s - h and h, each by the luma weight of s instead
  std::array<CellEvidenceOf<Real>, 4> cells;
};
using TileEvidence = TileEvidenceOf<double>;

// What follows from a cell's own evidence.
template <typename Real>
struct CellLightOf {
  Real rejection = 0;         // of history, in [0, 1]
  Real mean_brightening = 0;  // mean over the samples
  Real flicker = 0;           // how far that goes to and fro from frame to frame: aliasing
  Real suspicion = 0;         // rejection by this frame alone, with the sign of the mean
  Real drift = 0;             // sum of the mean over frames, which fades
};

// The conclusions from the evidence.
template <typename Real>
struct TileLightOf {
  Real gain = 1;       // relighting gain: history times this has this frame's light
  Real rejection = 0;  // the largest of its cells'
  Real cut = 0,
       new_cut = 0;          // how far the whole picture is another one, now or of late, and by how much more
  Real persistence = 0;      // in [-1, 1]: of a coherent change of light, over frames
  Real confirmation = 0;     // 1 where a suspicion is confirmed; it fades
  Real recent_outliers = 0;  // 1 where samples are outliers, or beside; it fades
  bool holds_back = false;   // outliers are held back: they are the first ones
  Real trend = 0;            // part of the light by which it changes a frame, as learnt
  std::array<CellLightOf<Real>, 4> cells;
};
using TileLight = TileLightOf<double>;

struct Tile {
  TileReprojection reprojection = {};
  TileEvidence evidence = {};
  TileLight light = {};
};

// How far the history of a part of the picture lags behind: sums of the tiles' lag and lit over lit + .02 count.
template <typename Real>
struct LagTotalOf {
  Real lag = 0, lit = 0;
  Real usual_lag = 0, usual_lit = 0;  // each lag within .005; lit of the tiles whose lag is
};
constexpr int kLagColumns = 4, kLagRows = 3;

// The evidence of the whole picture: the sums over all tiles of their means, in units of 1 / kLightUnits.
template <typename Real>
struct TotalLightOf {
  Real light = 0, history_error = 0, neighbour_error = 0;
  int changed = 0;  // tiles with a history_error above .03 of their light
  std::array<LagTotalOf<Real>, kLagColumns* kLagRows> lags = {};
};
using TotalLight = TotalLightOf<double>;

// The inputs of the kernels.
struct TemporalInputs {
  Frame frame;  // colour, jitter; reactive where nothing moves
  int previous_width = 0;
  int previous_height = 0;
  std::vector<Reprojection> reprojections;  // one for each sample of the frame; empty: nothing moves
  std::vector<double> reactive_before;      // the previous viewport's, where frame.reactive counts
  int output_width = 0;
  int output_height = 0;
  // Red, green, blue and confidence of each output pixel; confidence is negative where there are two layers.
  std::vector<Pixel> history;
  std::vector<double> history_alpha;  // one for each output pixel; empty: the picture is opaque
  std::vector<Tile> before;           // tiles of the previous frame
  int parity = -1;  // on a checkerboard sample (x, y) is shaded where (x + y) % 2 is this; -1: all are
  // The second layer's inputs of temporal_tiles; empty: there is none.
  std::vector<LayerSplit> splits;        // one for each sample
  std::vector<int> split_marks;          // one for each tile: not 0 if a sample in it is split
  std::vector<LayerTile> layers_before;  // one for each tile of the previous frame

  bool has_layers() const { return !splits.empty(); }
  int tiles_x() const { return (output_width + kTile - 1) / kTile; }
  int tiles_y() const { return (output_height + kTile - 1) / kTile; }
  // Output pixels between neighbouring samples.
  double spacing(int axis) const {
    return axis == 0 ? static_cast<double>(output_width) / frame.width
                     : static_cast<double>(output_height) / frame.height;
  }
  // Output pixels to each pixel of the previous viewport, the unit of reprojections.
  double reprojection_scale(int axis) const {
    return axis == 0 ? static_cast<double>(output_width) / previous_width
                     : static_cast<double>(output_height) / previous_height;
  }
  const Reprojection& reprojection_at(int x, int y) const {
    return reprojections[index_of(frame.width, x, y)];
  }
  // Clamped to the edge.
  const Pixel& history_clamped(int x, int y) const;
  double alpha_clamped(int x, int y) const;
};

// Inputs in the number type that a stage computes with.
template <typename Real>
PixelOf<Real> as(const Pixel& pixel) {
  return {pixel[0], pixel[1], pixel[2], pixel[3]};
}
template <typename Real>
TileEvidenceOf<Real> as(const TileEvidence& e) {
  TileEvidenceOf<Real> made{e.brightening, e.light,    e.history_error, e.neighbour_error,
                            e.count,       e.brighter, e.outliers,      e.lag,
                            e.lit,         {}};
  for (std::size_t i = 0; i < 4; ++i)
    made.cells[i] = {e.cells[i].brightening, e.cells[i].count, e.cells[i].brighter};
  return made;
}
template <typename Real>
TileLightOf<Real> as(const TileLight& l) {
  TileLightOf<Real> made{l.gain,         l.rejection,       l.cut,        l.new_cut, l.persistence,
                         l.confirmation, l.recent_outliers, l.holds_back, l.trend,   {}};
  for (std::size_t i = 0; i < 4; ++i) {
    const CellLightOf<double>& cell = l.cells[i];
    made.cells[i] = {cell.rejection, cell.mean_brightening, cell.flicker, cell.suspicion, cell.drift};
  }
  return made;
}
template <typename Real>
TotalLightOf<Real> as(const TotalLight& t) {
  TotalLightOf<Real> made{t.light, t.history_error, t.neighbour_error, t.changed, {}};
  for (std::size_t i = 0; i < t.lags.size(); ++i)
    made.lags[i] = {t.lags[i].lag, t.lags[i].lit, t.lags[i].usual_lag, t.lags[i].usual_lit};
  return made;
}

// exposure: the factor of exposed light of a frame, after one that had `before` (0: it is the first) and wanted
// another. `given`: the caller's; 0: there is none.
double exposure_of(const Frame& frame, double given, double before, double wanted_before);

// Returns the frame in exposed light. What is brighter than halves can hold is the largest float below that.
Frame exposed(Frame frame, double factor);

// Whether a sample of exposed light takes part: a number, and not as dark as no half can be.
template <typename Real>
bool is_valid(const PixelOf<Real>& sample) {
  constexpr double kLargestHalf = 65504;
  return abs(sample[0]) < kLargestHalf && abs(sample[1]) < kLargestHalf && abs(sample[2]) < kLargestHalf &&
         abs(sample[3]) < kLargestHalf;
}

// temporal_tiles: how the tile is reprojected, and what its samples say of history at the places of
// `reprojection`.
template <typename Real>
TileReprojectionOf<Real> reproject_tile(const TemporalInputs& in, int tile_x, int tile_y);
template <typename Real>
TileEvidenceOf<Real> judge_history(const TemporalInputs& in, const TileReprojectionOf<Real>& reprojection,
                                   int tile_x, int tile_y);
// The two layers of a tile, and the reprojection of its far layer then: `reprojection`, or with the phase of the near
// layer that it was.
template <typename Real>
struct LayeredTileOf {
  LayerTileOf<Real> layers = {};
  TileReprojectionOf<Real> reprojection = {};
  bool is_hidden = false;  // no sample of it judges history
};
template <typename Real>
LayeredTileOf<Real> layer_tile(const TemporalInputs& in, const TileReprojectionOf<Real>& reprojection,
                               int tile_x, int tile_y);
// Returns every tile, row by row.
std::vector<Tile> temporal_tiles(const TemporalInputs& in);

struct LightInputs {
  int tiles_x = 0;
  int tiles_y = 0;
  std::vector<Tile> before;  // tiles of the previous frame: their light
  std::vector<Tile> tiles;   // tiles of this frame: their motion edges and evidence
  TotalLight total = {};
};

// temporal_light: of tile (x, y).
template <typename Real>
TileLightOf<Real> temporal_light(const LightInputs& in, int x, int y);

struct TemporalOptions {
  int taps = 16;  // texels of history that are read where it is resampled; 4: bilinear; 36: the cubic of six
};

template <typename Real>
struct HistoryTexel {
  PixelOf<Real> texel = {};  // colour and, in the fourth channel, confidence
  Real alpha = 1;
};

// resolve_temporal: the history of output pixel (x, y) after this frame.
template <typename Real>
HistoryTexel<Real> resolve_temporal(const TemporalInputs& in, const std::vector<Tile>& tiles,
                                    const TemporalOptions& options, int x, int y);

struct DisplayOptions {
  bool smooth = true;
};

// temporal_display: output pixel (x, y) of the picture that in.history holds.
template <typename Real>
PixelOf<Real> temporal_display(const TemporalInputs& in, const std::vector<Tile>& tiles,
                               const DisplayOptions& options, int x, int y);

// What a texel of two layers knows of its near one.
struct NearLayer {
  double coverage = 0, confidence = 0;
};

// merge_histories: what two histories of a pixel, both at its centre, come to; `own` is that of the frame's service.
template <typename Real>
HistoryTexel<Real> merge_histories(const HistoryTexel<double>& own, const NearLayer& near,
                                   const HistoryTexel<double>& other);

// (1 - t / 8)^8, close to exp(-t); 0 from t = 8 on.
template <typename Real>
Real bell(const Real& t) {
  const Real rest = max(1 - .125 * t, 0);
  const Real square = rest * rest;
  const Real fourth = square * square;
  return fourth * fourth;
}

}  // namespace quincunx::reference

// SPDX-License-Identifier: MIT
// The constants of the second layer of history, one a line: name, value, unit: meaning [source]. docs/layers.md has the
// formulas; docs/lab/constants.md, made by scripts/constants.py, what 25 % more or less of each costs.
//
// Sources: S found by search on the development scenes, 2026-11-22, T the same, 2026-11-23, N guards a division or a
// range of numbers, C bounds the cost, D derived.
// A limit ends in _MIN if something holds from it on, in _MAX if up to it. Motions are output pixels a frame.
#pragma once

// ---- Surfaces: which samples belong to two layers.
#define LAYER_GAP_MIN 0.03f          // of the nearer depth: surfaces closer together are one; .01 and .1 are worse [S]
#define LAYER_MOTION_MIN 0.05f       // px: surfaces that move apart by less are one, as samples of a rigid tile [D]
#define SLANT_RISE_MAX 0.5f          // of the step of depth to a neighbour: more beyond is a plane seen at a slant [S]

// ---- Records of near samples.
#define RECORD_AGE_MAX 8             // frames: how long a thin thing's record outlives its sample [S]
#define RECORD_DISTANCE_MAX 1.7f     // samples: from a sample to its record [S]
#define RECORD_AGE_COST 0.4f         // samples^2 a frame: what age adds to that distance, squared [S]
#define SAME_RECORD_DISTANCE_MAX 1.5f  // samples: from where a record comes from to that of the same thing [S]
#define DRIFT_SHARE 0.7f             // of a change of motion: the part that goes on [S]
#define DRIFT_MAX 0.25f              // of the motion: a larger drift is no steady change [S]
#define SUDDEN_MOTION_MIN 0.25f      // px: the least sudden change of motion of a thing at rest [T]
#define SUDDEN_MOTION_SHARE 0.25f    // of the new motion: added to that [T]
#define TURNED_RECORD_CELLS 3        // cells: around a record, where its new motion is sought [T]
#define KNOWN_RECORD_CELLS 2         // cells: around where a record comes from; without records there it is new [T]
#define MIXED_TRUST_MAX 0.2f         // trust: of history that holds both layers; 0 is .08 dB worse in jolts [T]

// ---- Tiles.
#define FETCH_REACH 3                // px: how far around a pixel's place fetching may read, 4x4 texels and a phase [D]
#define SOURCE_TILES_MAX 8           // tiles: between places of a tile's samples; farther apart it counts as split [C]

// ---- History: what its texels have of a layer.
#define NEAR_DEPTH_STEP_MAX 0.1f     // of the larger depth: a near layer of another depth is another thing's [S]
#define CROSSING_DEPTH_STEP_MAX 0.05f  // the same of near layers that may cross; those are close together [T]
#define FAR_DEPTH_STEP_MAX 0.2f      // the same of a far layer, which may be seen at a slant [S]
#define CROSSING_MOTION_MIN 1.0f     // px: a tile's near layers may cross; .25: courtyard -.03 dB, 2: crossings -.1 [T]
#define NEAR_COVERAGE_MIN 0.3f       // coverage: a near layer of more may stand for a surface alone [S]
#define EMPTY_CONFIDENCE_MAX 1.0f    // weights: that nothing of a near layer was where there was one layer [S]
#define COPIED_OFFSET_MAX 0.06f      // px: a place of a rigid layer this near to a texel is that texel [S]
#define CUBIC_WEIGHT_MIN 0.5f        // of all taps' weights: less is no cubic any more [S]
#define BILINEAR_WEIGHT_MIN 1e-3f    // of the middle taps' weights: with less a layer has nothing [N]
#define SCANNED_TILES_MAX 4          // tiles: between eight places; farther apart they are not looked at together [C]

// ---- This frame's samples, and the picture.
#define NEAR_REACH 0.6f              // samples: of a near layer, at least WIDE_REACH; spokes +.2 dB [S]
#define SHOWN_COVERAGE_MIN 0.02f     // coverage: a near layer of more has a colour [S]

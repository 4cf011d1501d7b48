// SPDX-License-Identifier: MIT
// The constants of the temporal upscaler, one a line: name, value, unit: meaning [source]. docs/temporal.md has the
// formulas; docs/lab/constants.md, made by scripts/constants.py, what 25 % more or less of each costs.
//
// Sources: S found by search on the development scenes, L in the laboratory of docs/lab/temporal.md, F fitted by least
// squares against truth, N guards a division or a range of numbers.
// Light, luma and tone are of exposed light (exposure.cl).
// A limit ends in _MIN if something holds from it on, in _MAX if up to it.
#pragma once

// ---- Confidence: the sum of the weights of the samples in a texel of history, each at most 1.
#define CONFIDENCE_MAX 32.0f           // weights: about 140 frames at scale .5 [S]
#define CONFIDENCE_MIN 0.15f           // weights: what reseeding gives; history of less is reseeded [L]
#define RESAMPLED_CONFIDENCE_MAX 8.0f  // weights: of what was resampled, which blurs with each frame [L]
#define RESAMPLED_MIN 0.01f            // of the way to half-way between texels: less is no resampling [S]
#define RESAMPLING_COST 0.2f           // 1/weights: q in W / (1 + q W), half-way between texels; .3 is .05 dB worse [L]
#define EDGE_COST 4.0f                 // 1/weights: the same at a whole motion edge; 2: +.02 dB, but more ghosts [L]

// ---- Motion edges, output pixels a frame: where neighbouring samples move apart.
#define REJECTED_EDGE_MIN 0.15f  // px: from here on history is brought into the range of the samples [S]
#define REJECTED_EDGE_MAX 0.6f   // px: from here on wholly [S]
#define COSTLY_EDGE_MIN 0.1f     // px: from here on confidence falls [S]
#define COSTLY_EDGE_MAX 1.0f     // px: from here on by all of EDGE_COST [S]

// ---- temporal_tiles.
#define RIGID_MOTION_RANGE_MAX 0.05f  // px on an axis: how far the motions of a rigid tile's samples differ [S]
#define STILL_MOTION_MAX 1e-4f        // px: what velocity's rounding leaves of none [N]
#define JUDGED_CONFIDENCE_MIN 0.1f    // weights: of history that is judged; one that was just reseeded has more [S]
#define JUDGING_TRUST_MIN 0.9f        // trust: of a sample that judges [S]
#define LUMA_CHANGE_MIN 0.01f         // relative luma: a sample is brighter or darker from here on [S]
#define CHANGED_TILE_ERROR_MIN 0.03f  // of a tile's light: error from which on the tile counts as changed [S]

// ---- temporal_tiles, temporal_light: the broad gain.
#define USUAL_LAG_MAX 0.005f       // of a tile's light: it counts for no more, in the usual lag [S]
#define LAG_AT_ONCE 0.02f          // of the light: of less a part is corrected [S]
#define LAG_PART_MIN 0.2f          // of a lag, a frame [S]
#define TREND_PART 0.02f           // of a lag, a frame: what is learnt of it [S]
#define TREND_SURPRISE_MAX 0.05f   // of the light: of more no more is learnt [S]
#define GAIN_CHANGE_MIN 0.0005f    // of the light: halves hold no less [S]
#define LAG_LIGHT_FLOOR 0.02f      // luma: added to a tile's light [S]
#define LAG_AGREEMENT_MIN 0.5f     // agreement of a part's tiles: from here on their lag is beyond doubt [S]
#define LAG_DOUBT 0.25f            // of a part's light: so much counts as lagging less, where tiles disagree [S]
#define LAG_TILES 64.0f            // by the 4th power of a part's tiles: so many of no lag beside them [S]
#define LAG_MAX 4.0f               // of a tile's light [N]

// ---- temporal_light: the local gain, and whether the whole picture is relit.
#define RELIGHT_COHERENCE_MIN 0.75f   // |sum| / sum of magnitudes, of brightenings of 3x3 tiles [S]
#define RELIGHT_CHANGE_MIN 0.05f      // of the light [S]
#define RELIGHT_MAJORITY_MIN 0.4f     // (samples for it - against it) / samples: seven of ten; +.02 dB [S]
#define PERSISTENCE_MEMORY 0.6f       // a frame [S]
#define PERSISTENCE_MIN 0.62f         // two frames give .64, one .4 [S]
#define GAIN_MAX 4.0f                 // factor, either way [S]
#define WHOLE_CHANGED_TILES_MIN 0.2f  // of all tiles: the rest may be black, or alike [S]
#define WHOLE_AGREEMENT_MIN 0.8f      // agreement of all tiles of the picture [S]
#define LIGHT_SUM_MIN 1e-6f           // luma [N]

// ---- temporal_light: rejection by cut. In cuts the ratio is 1.66 or more; textures finer than the samples have as
// much as long as history is new, and up to 1.44 later. So it is soft: what is rejected is new again.
#define CUT_RATIO_MIN 1.25f   // history's error / the neighbours', of the whole picture [S]
#define CUT_RATIO_RANGE 0.35f // of the neighbours' error: by how much more it rejects wholly [S]
#define CUT_ERROR_MIN 0.03f   // of the light: less is no error [S]
#define CUT_MEMORY 0.9f       // a frame: where each seems another picture there is no cut [S]

// ---- temporal_light: judging cells; judge_weights.h has the network.
#define JUDGE_ERROR_FLOOR 0.02f  // luma: added to the neighbours' error, in which changes are measured [S]
#define JUDGE_INPUT_MAX 8.0f     // of each input's magnitude [S]
#define JUDGED_CHANGE_MIN 0.002f  // relative luma: of a cell whose change and drift are no more nothing is rejected [S]
#define FLICKER_RATIO_MIN 4.0f   // change of a cell / its flicker: of less none is rejected; pan +.3 dB [S]
#define CONFIRMATION_MEMORY 0.97f         // a frame [S]
#define RIGID_TILE_CONFIRMATION_MAX 0.3f  // reached 40 frames after the last confirmed suspicion [S]
#define DRIFT_MEMORY 0.7f        // a frame [S]
#define FLICKER_MEMORY 0.9f      // a frame [S]

// ---- Outliers: samples that are held back for a frame.
#define OUTLIER_RATIO_MIN 5.0f        // of history's brightest channel and the floor [S]
#define OUTLIER_FLOOR 0.25f           // light: between two dark values every ratio may occur [S]
#define NEGATIVE_OUTLIER_FLOOR 0.1f   // light: colours of a wider gamut are that negative [S]
#define OUTLIER_MEMORY 0.9f           // a frame [S]
#define OUTLIER_REARM_MAX 0.15f       // reached 18 frames after the last outliers [S]

// ---- resolve_temporal: fetching history.
#define HISTORY_SHARPNESS -1.0f         // Keys' a; -.75 is .04 dB worse [L]
#define LONG_CUBIC_NEAR_SLOPE 0.9f      // of t[1] - t[-1]; exact for polynomials: 2/3, Lanczos' window: .83 [S]
#define LONG_CUBIC_FAR_SLOPE 0.25f      // of t[2] - t[-2]; exact for polynomials: 1/12, Lanczos' window: .21 [S]
#define COPIED_PHASE_ERROR_MAX 0.02f    // px: how far the phases of texels differ that are copied side by side [S]
#define SOURCE_DISTANCE_MAX 65536.0f    // px: keeps places within what an int can hold [N]

// ---- resolve_temporal: rectifying, in tone space.
#define EVEN_ALPHA_MAX 0.03125f  // alpha: history that varies by more around is at an edge [S]
#define BOX_SIZE 0.75f          // standard deviations on each side of the mean [S]
#define BOX_MARGIN 0.02f        // tone: a distance that takes all confidence where the samples are all alike [S]
#define TONE_REST_MIN 0x1p-16f  // of 1 - tone: where rounding would make the way back infinite [N]

// ---- resolve_temporal: reseeding.
#define SEED_FALLOFF 2.5f               // 1 / samples^2: 1 / (2 sigma^2), sigma .45 samples [L]
#define SEED_INERTIA 0.85f              // of a whole seed, as a weight: its first sample is in it already; +.01 dB [S]
#define SAME_SURFACE_MOTION_MAX 0.15f   // px a frame. Ghosts fell from .17 to .06 at most, for -.01 dB [S]
#define SIMILARITY_MIN 0x1p-10f         // not 0: the only valid sample counts whatever it shows [N]
#define SEED_DISTANCE_MAX 16            // samples: a larger hole without any valid sample is black [S]

// ---- resolve_temporal: accumulating.
#define SAMPLE_REACH 0.98f      // px: where a sample's weight becomes 0, in rigid tiles [S]
#define WIDE_REACH 1.05f        // px: the same elsewhere; .98: zoom -.2 dB [S]
#define STILL_REACH_MIN 0.82f   // px: the same of well known pixels in still tiles: it spreads as a pixel does [S]
#define REACH_NARROWING 0.05f   // px for each unit of confidence: there [S]
#define WEIGHT_SUM_MIN 1e-30f   // weights [N]

// ---- temporal_display.
#define DISPLAY_SHARPNESS -0.75f         // Keys' a [S]
#define SMOOTHED_CONFIDENCE_MAX 1.5f     // weights: from here on smoothing would not be seen [S]
#define SMOOTHING_NEIGHBOUR_WEIGHT 0.3f  // of each neighbour, beside a pixel of no confidence [S]
#define SMOOTHING_OWN_WEIGHT 0.02f       // of the pixel itself, beside its confidence [S]
#define SMOOTHING_FALLOFF 2.0f           // 1/weights: of the neighbours' weight [S]

// ---- temporal_refine: strengths, and what is added where little is known: NEW / (W + NEW_CONFIDENCE).
#define SHARPENING 0.05f                     // of the difference from the mean, one layer [F]
#define SHARPENING_NEW 0.35f                 // weights [F]
#define SHARPENING_NEW_CONFIDENCE 0.6f       // weights [F]
#define EDGE_SMOOTHING 0.03f                 // of the second derivative along an edge, one layer [F]
#define EDGE_SMOOTHING_NEW 0.5f              // weights [F]
#define EDGE_SMOOTHING_NEW_CONFIDENCE 0.15f  // weights [F]
#define EDGE_SMOOTHING_LAYERED 0.2f          // the same of two layers [F]
#define EDGE_SHARPENING_LAYERED -0.12f       // of the second derivative across an edge, two layers [F]
#define EDGE_GRADIENT_FLOOR 1e-3f            // squared tone: much weaker gradients make no edge [S]

// ---- temporal_denoise.
#define DENOISED_CONFIDENCE_FLOOR 0.03f  // weights: pixels of which nothing is known count, too [S]
#define DENOISED_PART_MAX 0.7f           // of the variance that the noise told gives; 1.5: -.14 dB [S]
#define DENOISED_ALBEDO_FLOOR 0.02f      // what is black may be lit by a mirror; .1: -.2 dB at 1 sample [S]
#define DENOISED_LIGHT_MAX 32768.0f      // light over albedo: tone space can bring back twice that [N]
#define DENOISED_VARIANCE_MIN 1e-12f     // squared tone, of 25 pixels [N]
#define DENOISED_DISTANCE_MIN 1e-7f      // squared tone, of 9 pixels: what rounding to halves moves [N]

// SPDX-License-Identifier: MIT
// ResolvePlan: the passes, buffers and bytes that follow from what a scene needs.
//
// Planning is pure: no device, no allocation on one. What a plan leaves out is neither allocated nor
// dispatched nor compiled, and explain() says why. A value; any thread may use its own copy.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "quincunx/image.h"
#include "quincunx/status.h"

namespace quincunx {

// How the picture is made from the frames. All are aware of the jitter. Above scale 1 (more samples than
// pixels) the filters widen with the ratio, so that nothing between output pixels is skipped; point and noise
// skip.
enum class Method {
  kPoint,        // nearest sample
  kBilinear,     // four samples
  kBSpline,      // 16 samples, cubic B-spline: smooth, never rings (Sigg and Hadwiger 2005)
  kCatmullRom,   // 16 samples, cubic: sharp
  kLanczos2,     // 16 samples, windowed sinc, for comparison (Duchon 1979)
  kNoise,        // nearest sample with film grain, the more the lower the scale (Binks 2012)
  kNoiseOffset,  // one of bilinear's four samples, at random by their weights (Binks 2012)
  kQuincunx,     // this frame and the previous one on the five-of-a-die pattern
  kTemporal,  // all frames so far, accumulated where the surfaces are: needs a jitter of many places (Halton)
};

// How kQuincunx weighs the previous frame.
enum class TwoFrameForm : std::uint8_t {
  kMean,         // the plain mean of both frames
  kVelocity,     // f = 1/(1 + K(|v0|^2 + |v1|^2)), v in render pixels a frame (Binks 2012)
  kReprojected,  // read where its surfaces were, dropped where they were hidden; samples weighted by distance
};

// How kMean and kVelocity read the frames.
enum class Sampling : std::uint8_t {
  kPoint,     // the nearest sample
  kBilinear,  // four samples
};

enum class ToneMap { kClamp, kReinhard, kAces };

const char* name_of(Method method);      // "quincunx"
const char* name_of(TwoFrameForm form);  // "velocity"
const char* name_of(Sampling sampling);  // "point"
const char* name_of(ToneMap tone_map);   // "aces"

// What the scene will ever do while this plan is used.
struct SceneNeeds {
  bool moving_objects = true;  // anything but the camera moves
  bool camera_motion = true;
  bool transparents = true;  // drawn without velocity, with reactive values
  bool background = true;    // something (a sky, a room) covers every pixel: colour needs no clear
};

struct QuincunxSettings {
  TwoFrameForm form = TwoFrameForm::kVelocity;
  Sampling sampling = Sampling::kBilinear;
  float velocity_weight = 1;  // K of kVelocity; >= 0
  // kReprojected: K of a factor 1/(1 + K|v0 - v1|^2), v1 of the previous sample there, in render pixels a
  // frame; 0 leaves it out, which is cheaper. It wins where surfaces with other motion uncover each other.
  float residual_weight = 0;
};

// What kTemporal spends. Each is the best picture found at its cost; docs/pipeline.md has the figures.
enum class TemporalPreset : std::uint8_t { kFast, kBalanced, kQuality };

// What the resolved picture of kTemporal shows.
enum class TemporalView : std::uint8_t {
  kPicture,
  kConfidence,  // how much is known of a pixel: 1 (white) is all that is ever kept
  kRejection,   // why history is doubted: red hidden, off screen or reactive; green an edge of motion; blue a
                // change
  kPhase,       // where between texels history was read: red x, green y; blue: how far it moved
};

const char* name_of(TemporalPreset preset);  // "balanced"
const char* name_of(TemporalView view);      // "confidence"

struct TemporalSettings {
  TemporalPreset preset = TemporalPreset::kBalanced;
  TemporalView view = TemporalView::kPicture;
  PixelFormat history = PixelFormat::kRGBA16F;  // RGBA16F or RGBA32F
};

// Motion blur of the resolved picture along velocity, as a shutter gives that was open until the frame's
// moment.
struct MotionBlurSettings {
  float shutter = 0;  // part of a frame's time that the shutter is open, in [0, 2]; 0: no blur
  int samples = 8;    // at most, of a pixel: 4, 8, 16, 32 or 64; slow motion takes fewer
};

struct ResolveSettings {
  Method method = Method::kQuincunx;
  Extent output = {};                            // the picture's size
  Extent target = {};                            // the inputs' allocated size: at least the largest viewport
  PixelFormat colour = PixelFormat::kRGBA16F;    // of the input: RGBA16F or RGBA32F
  PixelFormat velocity = PixelFormat::kRG16F;    // of the input: RG16F or RG32F
  PixelFormat resolved = PixelFormat::kRGBA32F;  // of the resolved picture: RGBA16F or RGBA32F
  Storage storage = Storage::kBuffer;            // of the inputs and the presented picture
  bool present = true;                           // run the present pass
  bool clear = false;                            // ResolveService::clear() will be called
  ToneMap tone_map = ToneMap::kAces;
  bool dither = true;  // of the present pass: +- half a code value, fixed pattern
  bool clamp_ringing =
      true;             // kCatmullRom, kLanczos2: stay in the range of the 2x2 samples next to the centre
  float grain = 0.25f;  // kNoise: amplitude of the grain as part of the colour, in [0, 1]; times 1 - scale
  bool noise_moves = true;  // kNoise, kNoiseOffset: another pattern every frame
  QuincunxSettings quincunx = {};
  TemporalSettings temporal = {};
  MotionBlurSettings blur = {};
  float sharpness = 0;  // how far the resolved picture is sharpened, before motion blur, in [0, 1]
};

// Where the resolve finds velocity.
enum class VelocitySource {
  kNone,    // nothing moves, or the method does not ask
  kTarget,  // a velocity target
  kCamera,  // a target that the service makes from depth and the camera's motion: only the camera moves
};

const char* name_of(VelocitySource source);

struct PlannedPass {
  std::string kernel;       // "resolve_quincunx"
  std::string options;      // the -D options of the variant
  std::string reason;       // why it is here
  std::uint64_t bytes = 0;  // read and written at the largest viewport, each texel once
};

// How the part of a buffer that is in use follows the resolution.
enum class Scaling : std::uint8_t {
  kScales,   // this frame's viewport, within `extent`
  kHistory,  // the viewport of the previous frame, which may be another
  kFixed,    // always the whole extent
};

const char* name_of(Scaling scaling);

struct PlannedBuffer {
  std::string name;
  Extent extent = {};
  PixelFormat format = PixelFormat::kNone;
  Scaling scaling = Scaling::kScales;
  std::uint64_t bytes = 0;
  bool owned = false;  // by the service; else the caller brings it
};

struct LeftOut {
  std::string what;
  std::string why;
};

struct ResolvePlan {
  SceneNeeds needs;
  ResolveSettings settings;
  VelocitySource velocity = VelocitySource::kNone;
  bool reads_depth = false;
  bool reads_reactive = false;
  std::vector<PlannedPass> passes;
  std::vector<PlannedBuffer> buffers;
  std::vector<LeftOut> left_out;

  // Some images of a frame are read by the next dispatch too.
  bool keeps_previous_frame() const { return settings.method == Method::kQuincunx || accumulates(); }
  bool accumulates() const { return settings.method == Method::kTemporal; }
  // kTemporal: whether samples are so dense, from 1.56 a pixel on, that a frame alone is the better picture.
  bool is_dense(Extent render) const;
  bool weighs_velocity() const;             // kVelocity, and something moves
  bool reprojects() const;                  // kReprojected, whether something moves or not
  bool follows() const;                     // where each sample was in the previous frame is computed
  bool weighs_residual() const;             // kReprojected reads the previous frame's velocity too
  bool sharpens() const;                    // sharpness is wanted, and of a picture
  bool blurs() const;                       // motion blur is wanted, and something moves
  std::vector<PixelFormat> clears() const;  // formats that ResolveService::clear() takes; texel sizes differ
  std::string explain() const;              // a page of plain text
};

// Errors: kInvalidArgument; the message names every bad field.
Result<ResolvePlan> plan_for(const SceneNeeds& needs, const ResolveSettings& settings);

}  // namespace quincunx

// SPDX-License-Identifier: MIT
// ResolvePlan: the passes, buffers and bytes that follow from what a scene needs.
//
// Planning is pure and needs no device. Only the parts of a plan are allocated, compiled and dispatched; explain() says
// why the others are left out. A value; any thread may use its own copy.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "quincunx/advanced/conventions.h"
#include "quincunx/advanced/export.h"
#include "quincunx/advanced/method.h"
#include "quincunx/image.h"
#include "quincunx/status.h"

namespace quincunx {

struct FrameInputs;

// Everything that the scene may do while this plan is used.
struct SceneNeeds {
  bool moving_objects = true;  // anything but the camera moves
  bool camera_motion = true;
  bool transparents = true;  // drawn without velocity, with reactive values
  bool background = true;    // something (a sky, a room) covers every pixel: colour needs no clear

  friend bool operator==(const SceneNeeds&, const SceneNeeds&) = default;
};

struct QuincunxSettings {
  TwoFrameForm form = TwoFrameForm::kVelocity;
  Sampling sampling = Sampling::kBilinear;
  float velocity_weight = 1;  // K of kVelocity; >= 0
  // kReprojected: K of a factor 1/(1 + K|v0 - v1|^2), v1 of the previous sample there, in render pixels a frame; 0
  // leaves it out, which is cheaper. It helps where surfaces with different motions disocclude each other.
  float residual_weight = 0;

  friend bool operator==(const QuincunxSettings&, const QuincunxSettings&) = default;
};

struct TemporalSettings {
  TemporalPreset preset = TemporalPreset::kBalanced;
  TemporalView view = TemporalView::kPicture;
  PixelFormat history = PixelFormat::kRGBA16F;  // RGBA16F or RGBA32F
  // Variance of a sample's noise, in parts of its square, in [0, 1]: for a path tracer about 1 / samples a pixel. Above
  // 0 the picture is shown denoised.
  float noise = 0;

  friend bool operator==(const TemporalSettings&, const TemporalSettings&) = default;
};

// Motion blur of the resolved picture along velocity: simulates a shutter that closes at the time of the frame.
struct MotionBlurSettings {
  float shutter = 0;  // part of a frame's time that the shutter is open, in [0, 2]; 0: no blur
  int samples = 8;    // at most, of a pixel: 4, 8, 16, 32 or 64; slow motion takes fewer

  friend bool operator==(const MotionBlurSettings&, const MotionBlurSettings&) = default;
};

// A part of the picture that is drawn a second time, at a larger scale, and resolved with a history of its own: see
// FocusInputs.
struct FocusSettings {
  Extent extent = {};  // size of the region in output pixels; 0x0: there is none
  Extent target_extent =
      {};             // the allocated size of its inputs, at least its largest viewport; 0x0: as extent
  bool mask = false;  // FocusInputs::mask is given

  friend bool operator==(const FocusSettings&, const FocusSettings&) = default;
};

// How the memory of a frame's images follows the resolution.
enum class Targets : std::uint8_t {
  kViewport,  // images of the largest viewport's size; a frame uses the top left part of each
  // Images of exactly the viewport's size, tightly packed in memory that is sized for the largest viewport. At each new
  // resolution they are made again, in a part of it that no frame in flight uses. Nothing lies outside the viewport
  // then. After D3D12's placed resources as used by Microsoft and Intel, "Dynamic Resolution Rendering Update for
  // DirectX 12", 2018.
  kPlaced,
};

QUINCUNX_API const char* name_of(Targets targets);  // "placed"

// A frame's images and their content.
struct TargetSettings {
  Storage storage = Storage::kBuffer;      // the inputs'; see ResolvePlan::presented_storage()
  Targets placement = Targets::kViewport;  // the inputs' and the service's own images'
  Shading shading = Shading::kFull;        // kCheckerboard: the other half is filled first
  // 0x0: the inputs' colour holds everything. Else particles are drawn apart, into a viewport of their own within
  // images of this size, at most the target's: see FrameInputs::particle_colour.
  Extent particle_extent = {};
  bool clear = false;  // ResolveService::clear() will be called

  friend bool operator==(const TargetSettings&, const TargetSettings&) = default;
};

// The finished picture, and the present pass, which makes 8 bits of it.
struct PictureSettings {
  // Makes the output dynamic, too ("dual"): FrameInputs::output_extent may have any size from this one to
  // settings.output_extent, to which the picture is then scaled. {0, 0}: not dynamic.
  Extent min_extent = {};
  PixelFormat linear = PixelFormat::kRGBA32F;  // RGBA16F or RGBA32F
  bool present = true;                         // run the present pass
  ToneMap tone_map = ToneMap::kAces;           // the present pass's; with RGBA8 colour the renderer's
  bool dither = true;                          // the present pass's: +- half a code value, fixed pattern

  friend bool operator==(const PictureSettings&, const PictureSettings&) = default;
};

// Settings of the methods that see one frame alone.
struct FilterSettings {
  // Filters that ring (SeparableFilter::rings) stay in the range of the 2x2 samples next to the centre.
  bool clamp_ringing = true;
  float grain = 0.25f;  // kNoise: amplitude of the grain as part of the colour, in [0, 1]; times 1 - scale
  bool noise_moves = true;  // kNoise, kNoiseOffset: another pattern every frame

  friend bool operator==(const FilterSettings&, const FilterSettings&) = default;
};

// Settings for a QualityController.
struct ControlSettings {
  bool measures_content = false;  // FrameReport::content is wanted
  bool fades = false;             // FrameInputs::fading_from may be given

  friend bool operator==(const ControlSettings&, const ControlSettings&) = default;
};

// The first seven say what most callers need; the groups have defaults for all others.
struct ResolveSettings {
  Method method = Method::kTemporal;
  Extent output_extent = {};  // the picture's size
  Extent target_extent = {};  // the largest viewport; inputs that are made once have its size
  PixelFormat colour = PixelFormat::kRGBA16F;  // the input's: RGBA8, RGBA16F or RGBA32F
  PixelFormat velocity = PixelFormat::kRG16F;  // the input's: RG16F or RG32F
  InputConventions conventions = {};           // what the inputs mean
  float sharpness = 0;  // how far the resolved picture is sharpened, before motion blur, in [0, 1]

  TargetSettings targets = {};
  PictureSettings output = {};
  FilterSettings filter = {};
  QuincunxSettings quincunx = {};
  TemporalSettings temporal = {};
  MotionBlurSettings blur = {};
  FocusSettings focus = {};
  ControlSettings control = {};
  bool checks_motion = false;  // for debugging: FrameReport::motion is wanted

  friend bool operator==(const ResolveSettings&, const ResolveSettings&) = default;
};

// Returns the settings' method.
QUINCUNX_API MethodVariant variant_of(const ResolveSettings& settings);

// Sets the method and the fields that belong to it; leaves all others as they are.
QUINCUNX_API void apply(const MethodVariant& variant, ResolveSettings& settings);

// The source of velocity.
enum class VelocitySource {
  kNone,    // nothing moves, or the method reads none
  kTarget,  // a velocity target
  kCamera,  // a target that the service makes from depth and the camera's motion: only the camera moves
};

QUINCUNX_API const char* name_of(VelocitySource source);

struct PlannedPass {
  std::string kernel;       // "resolve_quincunx"
  std::string options;      // the -D options of the variant
  std::string reason;       // why it is here
  std::uint64_t bytes = 0;  // read and written at the largest viewport, each texel once

  friend bool operator==(const PlannedPass&, const PlannedPass&) = default;
};

// The part of a buffer that is in use.
enum class Scaling : std::uint8_t {
  kScales,   // this frame's viewport, within `extent`
  kOwn,      // a viewport of their own, within `extent`, which may be another in each frame
  kHistory,  // the viewport of the previous frame, which may be another
  kFixed,    // always the whole extent
};

QUINCUNX_API const char* name_of(Scaling scaling);

struct PlannedBuffer {
  std::string name;
  Extent extent = {};
  PixelFormat format = PixelFormat::kNone;
  Scaling scaling = Scaling::kScales;
  std::uint64_t bytes = 0;
  bool owned = false;  // by the service; else the caller brings it
  // Where the caller brings it, with this frame or (kHistory) the one before; null: it is no image of FrameInputs.
  ImageView FrameInputs::*input = nullptr;

  friend bool operator==(const PlannedBuffer&, const PlannedBuffer&) = default;
};

struct LeftOut {
  std::string what;
  std::string why;

  friend bool operator==(const LeftOut&, const LeftOut&) = default;
};

// A plan that plan_for() made. To change it, change the settings and plan again: ResolveService::create() refuses one
// that differs from what plan_for() makes of its needs and settings.
struct QUINCUNX_API ResolvePlan {
  SceneNeeds needs;
  ResolveSettings settings;
  VelocitySource velocity = VelocitySource::kNone;
  bool reads_depth = false;         // FrameInputs::depth is needed
  bool reads_reactive = false;      // FrameInputs::reactive is needed
  std::vector<PlannedPass> passes;  // in the order in which they run
  std::vector<PlannedBuffer> buffers;
  std::vector<LeftOut> left_out;

  bool keeps_previous_frame() const;  // some images of a frame are read by the next dispatch, too
  bool accumulates() const;           // all frames since the last reset count
  bool blurs() const;                 // motion blur is wanted, and something moves
  bool has_focus() const;             // dispatch() takes FocusInputs
  bool is_dual() const;               // the output is dynamic: settings.output.min_extent
  bool undilates_velocity() const;    // conventions.drawn_velocity has an effect: velocity is drawn and read
  bool moves_sky() const;     // conventions.sky_motion has an effect: velocity is drawn, and the camera moves
  bool reads_camera() const;  // FrameInputs::camera is needed
  // Returns the storage of FrameOutputs::presented: settings.targets.storage, but a buffer if targets are placed,
  // because the output's size does not change and so needs no placement.
  Storage presented_storage() const;
  // Returns the plan of the focus's region: the same settings for a picture of its extent, with all pixels shaded.
  // FocusInputs::frame is a frame of that plan. Nothing where there is no focus.
  std::optional<ResolvePlan> focus_plan() const;
  // Returns the bytes of the caller's images for one frame, at the largest viewport; the same for both kinds of target.
  std::uint64_t frame_bytes() const;
  // Returns whether a frame of this viewport reads earlier frames where there are any. kTemporal ignores them from 1.56
  // samples a pixel on, where a frame alone is the better picture. `output`: the frame's; {0, 0}:
  // settings.output_extent.
  bool reads_history(Extent render, Extent output = {}) const;
  std::string explain() const;  // a page of plain text

  friend bool operator==(const ResolvePlan&, const ResolvePlan&) = default;
};

// Plans for a scene. Errors: kInvalidArgument; the message names every bad field. Extents have sides up to 32768 and up
// to 2^29 pixels, and with two layers of history up to 2^28 samples.
QUINCUNX_API Result<ResolvePlan> plan_for(const SceneNeeds& needs, const ResolveSettings& settings);

}  // namespace quincunx

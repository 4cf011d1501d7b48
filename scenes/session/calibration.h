// SPDX-License-Identifier: MIT
// quincunx-render --calibrate: what a scene's frames cost by resolution, and what each method errs and costs there (an
// ErrorFront of one scene, in seconds).
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "frames/frame_source.h"
#include "quincunx/control/error_front.h"
#include "quincunx/status.h"
#include "session/render_options.h"
#include "tools/image/image_metrics.h"

namespace quincunx::scenes {

// Draws and resolves a still moment of the scene at a few rungs of the ladder, from the lowest up, and writes the costs
// as a CostTable's JSON text to options.pacing.calibrate, whole or not at all. Then measures the scene's ErrorFront and
// writes it to where find_front() looks for it. Errors: of any part, as it words them.
Status run_calibration(const RenderOptions& options);

// The variants that fronts are measured for: those on a front of some class of scenes, as docs/lab/methods.md shows,
// in the order of growing effort.
std::span<const MethodVariant> front_variants();

struct FrontCalibration {
  Extent output;               // extent of the picture, at least 11 x 11
  std::vector<double> scales;  // ascending, in (0, 1]
  double fps = 60;
  double seconds = 0;        // scene time of the first moment
  double truth_seconds = 4;  // the longest that truth may take
  std::string command;       // for the front's source
  std::string date;
};

// Measures front_variants() on the pixels in the middle of the picture. Figures with the moment held stand for
// SceneClass::kStill; those taken as the scene goes on, less the part that stands still then, for every other class.
// Errors are against supersampled truth, with as many samples as there is time for; where truth is too dear, against
// temporal:quality at scale 1. FrontSource::truth says which. Times are those of whole pictures, the lowest of a few
// frames. One thread, that of the GL context of `stage`. Errors: of any part, as it words them; kUnsupported for a
// device that gives no times.
Result<ErrorFront> calibrate_front(FrameSource& stage, const FrontCalibration& calibration);

// Returns text for a terminal: a line a method, still and moving, FLIP and milliseconds by scale.
std::string text_of_scene(const ErrorFront& front);

// Returns the error of the part that moves, from that of the whole picture, of which `still_share`, in [0, 1), errs as
// the held moment does. At least half of the whole one: anything below is noise.
double error_of_moving(double whole, double held, double still_share);

// A part of the picture, at the picture's own density of pixels.
struct PictureCrop {
  Extent extent;
  ViewWindow window;
  float aspect = 0;  // aspect of the whole picture

  // Returns the middle of the picture, at most `most` pixels each way.
  static PictureCrop middle_of(Extent output, Extent most);
};

// A run of frames of one jitter at one scale, each resolved by several methods.
struct FrontFeed {
  PictureCrop crop;
  float scale = 1;
  double fps = 60;
  double seconds = 0;  // time of frame 0
  bool held = false;   // every frame is of that moment: nothing moves but the jitter
  int warm_up = 0;     // frames before frame 0
  int frames = 1;
};

// One frame of one method. `resolved`: linear RGBA of the crop's extent, valid until the callback is over.
struct FrontFrame {
  std::size_t method;  // index into `methods`
  int index;           // negative ones warm up
  const FrameReport& report;
  const ImageView& resolved;
};

// Calls `each` once a frame and method, frame by frame. `methods` want the same jitter. Shares scene, context and
// device of `stage`, and nothing else; one thread, that of the GL context. Errors: of any part, as it words them, and
// that of `each`, after which nothing more is drawn.
Status run_feed(const FrameSource& stage, const FrontFeed& feed, std::span<const MethodVariant> methods,
                const std::function<Status(const FrontFrame&)>& each);

// Returns how many samples truth has along each side of a pixel: as many as fit, 0 where not even the fewest do.
// `draw_seconds`: the time of one sample of all pictures. Pure.
int truth_samples(double draw_seconds, double most_seconds);

// The pictures that a scene's are held against.
struct FrontReference {
  std::string what;  // "64 samples a pixel of 320x180 in the middle"
  // The held moment once; each of the frames.
  std::vector<tools::MeasuredPicture> held, moving;
};

// Makes the reference of `feed`'s frames from its first, exposed as the scene asks. The scale does not count.
Result<FrontReference> reference_of(FrameSource& stage, const FrontFeed& feed, double most_seconds);

}  // namespace quincunx::scenes

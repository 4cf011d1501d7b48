// SPDX-License-Identifier: MIT
// Front calibration: an ErrorFront of one scene, in seconds.
#pragma once

#include <string>
#include <vector>

#include "programs/frame_source.h"
#include "quincunx/error_front.h"

namespace quincunx::scenes {

struct FrontCalibration {
  Extent output;               // of the picture, at least 11 x 11
  std::vector<double> scales;  // ascending, in (0, 1]
  double fps = 60;
  double seconds = 0;        // scene time of the first moment
  double truth_seconds = 4;  // the longest that truth may take
  std::string command;       // for the front's source
  std::string date;
};

// Of the pixels in the middle of the picture and front_methods(). What is measured with the moment held stands for
// SceneClass::kStill; what is measured as the scene goes on, less what stands still then, for every other class. Errors
// are against supersampled truth, with as many samples as there is time for; where truth is too dear, against
// temporal:quality at scale 1.
// FrontSource::truth says which. Times are of whole pictures, the least of a few frames. One thread, that of the GL
// context of `stage`. Errors: of any part, as it words them; kUnsupported for a device that gives no times.
Result<ErrorFront> calibrate_front(FrameSource& stage, const FrontCalibration& calibration);

// For a terminal: a line a method, still and moving, FLIP and milliseconds by scale.
std::string text_of_scene(const ErrorFront& front);

// The error of what does not stand still, from that of the whole picture, of which the share that does, in [0, 1), errs
// as the held moment. At least half of the whole one: what lies below is noise.
double error_of_moving(double whole, double held, double still_share);

}  // namespace quincunx::scenes

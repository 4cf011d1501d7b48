// SPDX-License-Identifier: MIT
#include "camera_params.h"

#include <algorithm>

namespace quincunx {

FarPlaces far_places(const FrameInputs& frame, Extent output) {
  const double aspect = static_cast<double>(output.width) / output.height;
  const double width = frame.render.width;
  const double height = frame.render.height;
  return {.step_x = static_cast<float>(aspect / width),
          .step_y = static_cast<float>(1 / height),
          .start_x = static_cast<float>(((.5 + frame.jitter.x) / width - .5) * aspect),
          .start_y = static_cast<float>((.5 + frame.jitter.y) / height - .5)};
}

CameraVelocity camera_params(const FrameInputs& frame) {
  const double width = frame.render.width;
  const double height = frame.render.height;
  CameraVelocity camera{};
  camera.step_x = static_cast<float>(2 / width);
  camera.step_y = static_cast<float>(-2 / height);
  camera.start_x = static_cast<float>((1 + 2.0 * frame.jitter.x) / width - 1);
  camera.start_y = static_cast<float>(1 - (1 + 2.0 * frame.jitter.y) / height);
  std::copy(frame.camera.clip_to_previous_clip.begin(), frame.camera.clip_to_previous_clip.end(),
            camera.to_previous);
  return camera;
}

float inverse_scale(double scale) {
  return scale != 0 ? static_cast<float>(1 / scale) : 0.0f;
}

}  // namespace quincunx

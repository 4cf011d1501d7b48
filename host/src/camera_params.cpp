// SPDX-License-Identifier: MIT
#include "camera_params.h"

#include <algorithm>

namespace quincunx {

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

}  // namespace quincunx

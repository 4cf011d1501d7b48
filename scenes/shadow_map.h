// SPDX-License-Identifier: MIT
// ShadowMap: the sun's depth map, drawn anew only when something that casts a shadow has moved.
#pragma once

#include <limits>

#include "draw_list.h"
#include "gpu_scene.h"
#include "quincunx/status.h"
#include "quincunx_gl/handle.h"
#include "stream_buffer.h"

namespace quincunx::scenes {

class ShadowMap {
 public:
  // A map that is not enabled (ShadowFit::enabled) owns nothing.
  static Result<ShadowMap> create(const Scene& scene, const SceneLayout& layout);

  // `placed`: the instances at `seconds`. The frame block, mesh buffers and vertex array are bound. Leaves
  // viewport, framebuffer and depth state changed.
  void update(const SceneLayout& layout, const GpuScene& gpu, const std::vector<InstanceData>& placed,
              double seconds);

  GLuint texture() const { return texture_.get(); }  // compares; 0: none

 private:
  void draw(const SceneLayout& layout, const GpuScene& gpu);

  gl::Texture texture_;
  gl::Framebuffer framebuffer_;
  gl::Program solid_;
  gl::Program cut_out_;
  std::vector<bool> mask_of_mesh_;
  StreamBuffer instances_;
  DrawList list_;
  double drawn_seconds_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace quincunx::scenes

// SPDX-License-Identifier: MIT
// ShadowMap: the sun's depth map. What stands still is drawn once; what moves is drawn over a copy of that.
#pragma once

#include <limits>

#include "quincunx/status.h"
#include "quincunx_gl/handle.h"
#include "render/draw_list.h"
#include "render/gpu_scene.h"
#include "render/stream_buffer.h"

namespace quincunx::scenes {

class ShadowMap {
 public:
  // A map that is not enabled (ShadowFit::enabled) owns nothing.
  static Result<ShadowMap> create(const Scene& scene, const SceneLayout& layout);

  // `placed`: the instances at `seconds`. What was drawn at a time no further away than `most_age` stays. The
  // frame block, mesh buffers and vertex array are bound. Leaves viewport, framebuffer and depth state
  // changed.
  void update(const SceneLayout& layout, const GpuScene& gpu, const std::vector<InstanceData>& placed,
              double seconds, double most_age);

  GLuint texture() const { return texture_.get(); }  // compares; 0: none

 private:
  void draw(const SceneLayout& layout, const GpuScene& gpu, GLuint framebuffer, StreamBuffer& instances);

  gl::Texture texture_;  // all casters
  gl::Framebuffer framebuffer_;
  gl::Texture still_texture_;  // only those that stand still, where others move: the start of each update
  gl::Framebuffer still_framebuffer_;
  gl::Program solid_;
  gl::Program cut_out_;
  std::vector<bool> mask_of_mesh_;
  StreamBuffer still_instances_;
  StreamBuffer moving_instances_;
  DrawList list_;
  double drawn_seconds_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace quincunx::scenes

// SPDX-License-Identifier: MIT
// ShadowMap: the sun's depth map. What stands still is drawn once; what moves is drawn over a copy of that.
//
// A frame uses the top left part of the map, `side` texels wide and high. The row and the column of texels next to it
// are kept lit, as the border of the whole map is: look-ups are clamped to their centres, so that they find beyond a
// part what they find beyond the whole, and no texel that an earlier, larger part has left is ever read.
#pragma once

#include <cstdint>

#include "quincunx/status.h"
#include "quincunx_gl/handle.h"
#include "render/draw_list.h"
#include "render/gl_state.h"
#include "render/gpu_scene.h"

namespace quincunx::scenes {

class ShadowMap {
 public:
  // A map that is not enabled (ShadowFit::enabled) owns nothing.
  static Result<ShadowMap> create(const Scene& scene, const SceneLayout& layout);

  // The casters that a frame draws.
  enum class Work : std::uint8_t { kNothing, kMoving, kEverything };

  // Returns the work for a frame at `seconds`: a map drawn at a time no further away than `most_age` stays; at another
  // `side` everything is drawn.
  Work work_for(const SceneLayout& layout, double seconds, double most_age, int side) const;

  // Does it. `placed`: the instances at `seconds`. The frame block, mesh buffers and vertex array are bound. Leaves
  // viewport, scissor, framebuffer and depth state changed.
  void update(Work work, const SceneLayout& layout, const GpuScene& gpu,
              const std::vector<InstanceData>& placed, double seconds, int side);

  GLuint texture() const { return texture_.get(); }  // compares; 0: none

 private:
  void draw(const SceneLayout& layout, const GpuScene& gpu, GLuint framebuffer, StreamBuffer& instances);

  gl::Texture texture_;  // all casters
  gl::Framebuffer framebuffer_;
  gl::Texture still_texture_;  // only those that stand still, where others move: the start of each update
  gl::Framebuffer still_framebuffer_;
  enum Caster : std::uint8_t { kSolid, kCutOut, kCutOutByTexture };
  std::array<gl::Program, 3> programs_;  // by Caster
  std::vector<Caster> program_of_mesh_;
  StreamBuffer still_instances_;
  StreamBuffer moving_instances_;
  DrawList list_;
  int side_ = 0;  // 0: nothing is drawn yet
  double drawn_seconds_ = 0;
};

}  // namespace quincunx::scenes

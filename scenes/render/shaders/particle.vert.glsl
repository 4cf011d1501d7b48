// particle.vert: quads that face the camera, instanced.
#include "frame.glsl"

layout(location = 0) in vec4 centre_radius;
layout(location = 1) in vec4 colour;  // premultiplied

out vec2 v_corner;
flat out vec4 v_colour;

void main() {
  v_corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 world = centre_radius.xyz +
               (frame.camera_right.xyz * v_corner.x + frame.camera_up.xyz * v_corner.y) * centre_radius.w;
  vec4 clip = frame.clip_from_world * vec4(world, 1.0);
  gl_Position = CLIP(vec4(clip.xy + frame.jitter_clip.xy * clip.w, clip.zw));
  v_colour = colour;
}

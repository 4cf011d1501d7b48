// surface.vert: meshes, instanced. Options (defined or not): VELOCITY, TEXTURED, VERTEX_COLOUR, UNLIT, DOUBLE_SIDED,
// SHADOWS (never with UNLIT).
#include "frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 colour;
layout(location = 4) in mat3x4 world_rows;     // world from mesh, this frame: rows of an affine matrix
layout(location = 7) in mat3x4 previous_rows;  // the same in the previous frame

invariant gl_Position;  // the variants with and without velocity draw the same picture

out vec3 v_position;
#ifndef UNLIT
out vec3 v_normal;
#endif
#ifdef SHADOWS
out vec3 v_shadow;
#ifdef DOUBLE_SIDED
out vec3 v_shadow_back;  // seen from the back
#endif
#endif
#ifdef TEXTURED
out vec2 v_uv;
#endif
#ifdef VERTEX_COLOUR
out vec4 v_colour;
#endif
#ifdef VELOCITY
out vec3 v_now;     // clip (x, y, w), jitter excluded
out vec3 v_before;  // the same in the previous frame
#endif

// Normals go by the matrix of cofactors, which needs no inverse, and the sign of the determinant: a mirrored mesh would
// have them inside.
vec3 world_normal(vec3 x, vec3 y, vec3 z) {
  vec3 yz = cross(y, z);
  vec3 n = vec3(dot(yz, normal), dot(cross(z, x), normal), dot(cross(x, y), normal));
  return n * (inversesqrt(max(dot(n, n), 1e-30)) * (dot(x, yz) < 0.0 ? -1.0 : 1.0));
}

#ifdef SHADOWS
vec3 shadow_place(vec3 at) {
  return (frame.shadow_from_world * vec4(at, 1.0)).xyz * vec3(frame.shadow.xx, 1.0);
}
#endif

void main() {
  vec4 local = vec4(position, 1.0);
  vec3 world = vec3(dot(world_rows[0], local), dot(world_rows[1], local), dot(world_rows[2], local));
  precise vec4 clip = frame.clip_from_world * vec4(world, 1.0);
  gl_Position = CLIP(vec4(clip.xy + frame.jitter_clip.xy * clip.w, clip.zw));
  v_position = world;
#ifndef UNLIT
  v_normal = world_normal(world_rows[0].xyz, world_rows[1].xyz, world_rows[2].xyz);
#endif
#ifdef SHADOWS
  vec3 lift = v_normal * (1.5 * frame.sun_irradiance.w);  // off its own shadow texels
  v_shadow = shadow_place(world + lift);
#ifdef DOUBLE_SIDED
  v_shadow_back = shadow_place(world - lift);
#endif
#endif
#ifdef TEXTURED
  v_uv = uv;
#endif
#ifdef VERTEX_COLOUR
  v_colour = colour;
#endif
#ifdef VELOCITY
  // The same arithmetic for both, so that what stands still has a velocity of exactly zero.
  vec3 before = vec3(dot(previous_rows[0], local), dot(previous_rows[1], local), dot(previous_rows[2], local));
  precise vec4 previous = frame.previous_clip_from_world * vec4(before, 1.0);
  v_now = clip.xyw;
  v_before = previous.xyw;
#endif
}

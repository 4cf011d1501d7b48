// shadow.vert: meshes as the sun sees them. Options: MASK, TEXTURED (with MASK).
#include "frame.glsl"

layout(location = 0) in vec3 position;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 colour;
layout(location = 4) in mat3x4 world_rows;

#ifdef MASK
out float v_alpha;
#endif
#ifdef TEXTURED
out vec2 v_uv;
#endif

void main() {
  vec4 local = vec4(position, 1.0);
  vec3 world = vec3(dot(world_rows[0], local), dot(world_rows[1], local), dot(world_rows[2], local));
  vec3 at = (frame.shadow_from_world * vec4(world, 1.0)).xyz;
  // Row 0 of the map is v = 0, whatever the clip origin: GL_UPPER_LEFT turns y over.
  // Casters before the near plane lie on it: the rasteriser clamps them or, where it cannot, their corners are clamped.
#ifdef CLAMPS_DEPTH
  at.z = max(at.z, 0.0);
#endif
  gl_Position = CLIP(vec4(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y, at.z, 1.0));
#ifdef MASK
  v_alpha = colour.a;
#endif
#ifdef TEXTURED
  v_uv = uv;
#endif
}

// particle.frag: a soft disc. No velocity: what it covers is marked reactive instead.
#include "frame.glsl"

in vec2 v_corner;
flat in vec4 v_colour;

layout(location = 0) out vec4 out_colour;
layout(location = 2) out float out_reactive;

void main() {
  float inside = max(1.0 - dot(v_corner, v_corner), 0.0);
  float cover = inside * inside;
  out_colour = vec4(storable(v_colour.rgb * cover), clamp(v_colour.a * cover, 0.0, 1.0));
  // Purely additive light has no alpha, yet changes the picture.
  float brightest = max(v_colour.r, max(v_colour.g, v_colour.b));
  out_reactive = clamp(max(v_colour.a, brightest) * cover, 0.0, 1.0);
}

// sky.frag: the background and its velocity, which is the camera's rotation. Options: VELOCITY, PLAIN, TRANSPARENT,
//           MOTIONLESS (velocity 0).
#include "frame.glsl"
#include "velocity.glsl"

layout(location = 0) out vec4 out_colour;
#ifdef VELOCITY
layout(location = 1) out vec2 out_velocity;
#endif

void main() {
  vec2 uv = (gl_FragCoord.xy + frame.jitter.xy) * frame.jitter.zw;
  vec2 ndc = vec2(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y);
#if defined(TRANSPARENT)
  out_colour = vec4(0.0);
#elif defined(PLAIN)
  out_colour = vec4(storable(frame.zenith.rgb), 1.0);
#else
  vec3 direction = normalize(frame.ray_centre.xyz + ndc.x * frame.ray_x.xyz + ndc.y * frame.ray_y.xyz);
  vec3 colour = sky_radiance(direction, 0.0);
  // The disc with a soft limb; 1 - cosine is about half the angle squared.
  float from_centre = 1.0 - dot(direction, frame.to_sun.xyz);
  float radius = frame.sun_radiance.w;
  colour += frame.sun_radiance.rgb * (1.0 - smoothstep(0.8 * radius, 1.2 * radius, from_centre));
  out_colour = vec4(storable(colour), 1.0);
#endif
#if defined(VELOCITY) && defined(MOTIONLESS)
  out_velocity = vec2(0.0);
#elif defined(VELOCITY)
  vec4 before = frame.clip_to_previous_clip * vec4(ndc, 0.0, 1.0);
  out_velocity = velocity_between(vec3(ndc, 1.0), before.xyw);
#endif
}

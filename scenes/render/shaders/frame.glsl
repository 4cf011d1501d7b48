// Per frame values, shared by all programs. Mirrors FrameBlock of frame_block.h.
layout(std140, binding = 0) uniform Frame {
  mat4 clip_from_world;           // jitter excluded
  mat4 previous_clip_from_world;  // jitter excluded
  mat4 clip_to_previous_clip;     // (ndc, depth, 1) of this frame to clip of the previous one
  mat4 shadow_from_world;         // to (u, v, depth) of the part of the shadow map in use
  vec4 jitter;                    // xy: render pixels, zw: 1 / render extent
  vec4 jitter_clip;               // xy: what to add to clip.xy per w so that pixel centre + jitter is sampled
  vec4 camera_position;           // w: texture LOD bias
  vec4 camera_right;
  vec4 camera_up;
  vec4 ray_centre;                // world direction of ndc (0, 0); of ndc (x, y): centre + x * ray_x + y * ray_y
  vec4 ray_x;
  vec4 ray_y;
  vec4 to_sun;                    // unit
  vec4 sun_irradiance;            // w: world size of a shadow texel, 0: no shadows
  vec4 sun_radiance;              // w: 1 - cosine of the disc's radius
  vec4 zenith;
  vec4 horizon;
  vec4 ground;
  vec4 display;                   // x: exposure, y: curve of encoded targets: 1 clamp, 2 Reinhard, 3 ACES; 0: no such
  vec4 shadow;                    // x: side of the map's part in use, part of the whole; y: the largest coordinate read
} frame;

const float kLargestHalf = 65504.0;

// Light on the screen, in [0, 1], by the curves of the present pass (colour.h).
vec3 shown(vec3 light) {
  vec3 x = min(light * frame.display.x, vec3(kLargestHalf));
  if (frame.display.y == 2.0) return x / (1.0 + x);
  if (frame.display.y == 3.0) x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
  return min(x, vec3(1.0));
}

// Finite in the target whatever came before: max() also turns NaN into 0 where min and max follow IEEE 754.
vec3 storable(vec3 colour) {
  vec3 light = min(max(colour, vec3(0.0)), vec3(kLargestHalf));
  return frame.display.y == 0.0 ? light : shown(light);
}

// Sky radiance along a unit direction, blurred as a surface of this roughness sees it.
vec3 sky_radiance(vec3 direction, float roughness) {
  float height = direction.y;
  vec3 above = mix(frame.horizon.rgb, frame.zenith.rgb, sqrt(max(height, 0.0)));
  float blur = max(roughness, 0.01);
  return mix(frame.ground.rgb, above, smoothstep(-blur, blur, height));
}

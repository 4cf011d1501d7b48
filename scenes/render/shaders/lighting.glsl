// Direct and ambient light on a metallic-roughness surface.
#include "frame.glsl"

#ifdef SHADOWS
layout(binding = 4) uniform sampler2DShadow shadow_map;
in vec3 v_shadow;  // place in the whole map
#ifdef DOUBLE_SIDED
in vec3 v_shadow_back;  // the same of what is seen from the back
#endif
#endif

#if POINT_LIGHTS > 0
// The lights in reach of the instances of this draw; the rest of the fixed count has no intensity.
layout(std140, binding = 2) uniform Lights {
  vec4 position[16];   // w: 1 / range^2
  vec4 intensity[16];
} lights;
#endif

const float kPi = 3.14159265;

struct Surface {
  vec3 diffuse;    // albedo
  vec3 specular;   // reflectance at normal incidence
  float roughness;
  vec3 normal;
  vec3 to_eye;
  float facing;    // cosine between the two
};

// Light reflected towards the eye per irradiance. Specular after Zioma, "Optimizing PBR for Mobile", SIGGRAPH 2015:
// GGX with an approximation of visibility and Fresnel in one; the half vector's cosines follow from those at hand.
vec3 reflected(Surface s, vec3 to_light, float cosine) {
  float twice_half = max(1.0 + dot(to_light, s.to_eye), 1e-3);  // 2 cos^2 between light and half vector
  float along = cosine + s.facing;
  float a2 = s.roughness * s.roughness;
  a2 *= a2;
  float d = min(along * along / (2.0 * twice_half), 1.0) * (a2 - 1.0) + 1.0;
  float specular = a2 / (2.0 * d * d * twice_half * (s.roughness + 0.5));
  return (s.diffuse + s.specular * specular) * (cosine / kPi);
}

// Two bilinear comparisons across a diagonal: a soft edge of two texels. What lies beyond the part of the map in use is
// read as the lit texels next to it: shadow_map.h.
float sunlight() {
#ifdef SHADOWS
  const vec2 kAside = vec2(0.5, -0.25) / float(SHADOWS);
  vec3 place = v_shadow;
#ifdef DOUBLE_SIDED
  if (!gl_FrontFacing) place = v_shadow_back;
#endif
  float depth = min(place.z, 1.0);
  vec2 one = min(place.xy + kAside, frame.shadow.y), other = min(place.xy - kAside, frame.shadow.y);
  return 0.5 * (texture(shadow_map, vec3(one, depth)) + texture(shadow_map, vec3(other, depth)));
#else
  return 1.0;
#endif
}

// The sky as an environment. Diffuse: its mean over the hemisphere, roughly. Specular: its blurred radiance times
// the scale and bias of Karis, "Physically Based Shading on Mobile", 2014.
vec3 ambient(Surface s) {
  vec3 up = mix(frame.horizon.rgb, frame.zenith.rgb, 0.55);
  vec3 diffuse = mix(frame.ground.rgb, up, 0.5 + 0.5 * s.normal.y);
  vec4 r = s.roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * s.facing)) * r.x + r.y;
  vec2 scale_bias = vec2(-1.04, 1.04) * a + r.zw;
  vec3 mirrored = 2.0 * dot(s.normal, s.to_eye) * s.normal - s.to_eye;
  return s.diffuse * diffuse + sky_radiance(mirrored, s.roughness) * (s.specular * scale_bias.x + scale_bias.y);
}

vec3 shade(Surface s, vec3 position) {
  vec3 colour = ambient(s);
  float cosine = dot(s.normal, frame.to_sun.xyz);
  colour += reflected(s, frame.to_sun.xyz, max(cosine, 0.0)) * frame.sun_irradiance.rgb * sunlight();
#if POINT_LIGHTS > 0
  for (int i = 0; i < POINT_LIGHTS; ++i) {
    vec3 offset = lights.position[i].xyz - position;
    float square = dot(offset, offset);
    float x = square * lights.position[i].w;
    float window = max(1.0 - x * x, 0.0);  // falls smoothly to zero at the range
    float inverse = 1.0 / max(square, 1e-4);
    vec3 to_light = offset * sqrt(inverse);
    float facing = max(dot(s.normal, to_light), 0.0);
    colour += reflected(s, to_light, facing) * lights.intensity[i].rgb * (window * window * inverse);
  }
#endif
  return colour;
}

// surface.frag: one material. Outputs colour (premultiplied), velocity or reactive.
// Options: VELOCITY, TEXTURED, VERTEX_COLOUR, UNLIT, MASK, BLEND, DOUBLE_SIDED, SHADOWS <texels>, POINT_LIGHTS <count>,
//          BASE_TEXTURE, SURFACE_TEXTURE (metallic, roughness), EMISSIVE_TEXTURE, NORMAL_TEXTURE.
#ifndef POINT_LIGHTS
#define POINT_LIGHTS 0
#endif
#include "lighting.glsl"
#include "velocity.glsl"

// Mirrors MaterialBlock of gpu_scene.h.
layout(std140, binding = 1) uniform Material {
  vec4 base_colour;
  vec4 emissive;  // w: alpha cut-off
  vec4 surface;   // metallic, roughness, normal scale, reactive
  vec4 uv[8];     // two rows of the uv transform of each texture: base, surface, emissive, normal
} material;

layout(binding = 0) uniform sampler2D base_texture;
layout(binding = 1) uniform sampler2D surface_texture;
layout(binding = 2) uniform sampler2D emissive_texture;
layout(binding = 3) uniform sampler2D normal_texture;

in vec3 v_position;
#ifndef UNLIT
in vec3 v_normal;
#endif
#ifdef TEXTURED
in vec2 v_uv;
#endif
#ifdef VERTEX_COLOUR
in vec4 v_colour;
#endif
#ifdef VELOCITY
in vec3 v_now;
in vec3 v_before;
#endif

layout(location = 0) out vec4 out_colour;
#ifdef VELOCITY
layout(location = 1) out vec2 out_velocity;
#endif
#ifdef BLEND
layout(location = 2) out float out_reactive;
#endif

#ifdef TEXTURED
vec2 uv_of(int slot) {
  vec3 uv1 = vec3(v_uv, 1.0);
  return vec2(dot(material.uv[2 * slot].xyz, uv1), dot(material.uv[2 * slot + 1].xyz, uv1));
}
#endif

#ifdef NORMAL_TEXTURE
// Tangent frame from derivatives: Schueler, "Normal Mapping Without Precomputed Tangents", ShaderX 5, 2006.
vec3 bumped(vec3 n) {
  vec2 uv = uv_of(3);
  vec3 map = texture(normal_texture, uv, frame.camera_position.w).xyz * 2.0 - 1.0;
  vec3 px = dFdx(v_position), py = dFdy(v_position);
  vec2 ux = dFdx(uv), uy = dFdy(uv);
  vec3 across_y = cross(py, n), across_x = cross(n, px);
  vec3 t = across_y * ux.x + across_x * uy.x;
  vec3 b = across_y * ux.y + across_x * uy.y;
  // The determinant's sign makes it right whichever way window y runs.
  float scale = sign(dot(px, across_y)) * inversesqrt(max(max(dot(t, t), dot(b, b)), 1e-30));
  // Texture rows run down while tangent space runs up, hence the minus.
  vec3 bent = (t * map.x - b * map.y) * (scale * material.surface.z) + n * map.z;
  return bent * inversesqrt(max(dot(bent, bent), 1e-30));
}
#endif

vec4 base_colour() {
  vec4 base = material.base_colour;
#ifdef VERTEX_COLOUR
  base *= v_colour;
#endif
#ifdef BASE_TEXTURE
  base *= texture(base_texture, uv_of(0), frame.camera_position.w);
#endif
  return base;
}

vec3 emitted() {
  vec3 emissive = material.emissive.rgb;
#ifdef EMISSIVE_TEXTURE
  emissive *= texture(emissive_texture, uv_of(2), frame.camera_position.w).rgb;
#endif
  return emissive;
}

#ifndef UNLIT
vec3 lit(vec3 base) {
  float metallic = material.surface.x, roughness = material.surface.y;
#ifdef SURFACE_TEXTURE
  vec2 read = texture(surface_texture, uv_of(1), frame.camera_position.w).bg;
  metallic *= read.x;
  roughness *= read.y;
#endif
  Surface s;
  s.diffuse = base * (1.0 - metallic);
  s.specular = mix(vec3(0.04), base, metallic);
  s.roughness = clamp(roughness, 0.08, 1.0);  // below, highlights leave the range of half float
  vec3 n = v_normal * inversesqrt(max(dot(v_normal, v_normal), 1e-30));
#ifdef DOUBLE_SIDED
  n = gl_FrontFacing ? n : -n;
#endif
#ifdef NORMAL_TEXTURE
  n = bumped(n);
#endif
  vec3 to_eye = frame.camera_position.xyz - v_position;
  s.to_eye = to_eye * inversesqrt(max(dot(to_eye, to_eye), 1e-30));
  s.normal = n;
  s.facing = clamp(dot(n, s.to_eye), 1e-3, 1.0);
  return shade(s, v_position);
}
#endif

void main() {
  vec4 base = base_colour();
#ifdef MASK
  if (base.a < material.emissive.w) discard;
#endif
#ifdef UNLIT
  vec3 colour = base.rgb + emitted();
#else
  vec3 colour = lit(base.rgb) + emitted();
#endif
#ifdef BLEND
  float alpha = clamp(base.a, 0.0, 1.0);
  out_colour = vec4(storable(colour) * alpha, alpha);
  out_reactive = alpha * material.surface.w;
#else
  out_colour = vec4(storable(colour), 1.0);
#endif
#ifdef VELOCITY
  out_velocity = velocity_between(v_now, v_before);
#endif
}

// SPDX-License-Identifier: MIT
// The GLSL peers: each filter as one would write it for a GPU, with its texture units doing what they can.
#pragma once

namespace quincunx::bench {

inline constexpr const char* kVersion = "#version 450 core\n";

inline constexpr const char* kFullScreenTriangle = R"(
out vec2 uv;
void main() {
  uv = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
  gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);
})";

inline constexpr const char* kInputs = R"(
layout(binding = 0) uniform sampler2D colour0;
layout(binding = 1) uniform sampler2D colour1;
layout(binding = 2) uniform sampler2D velocity0;
layout(binding = 3) uniform sampler2D velocity1;
in vec2 uv;
out vec4 result;
const float kJitter = 0.25;  // texels
)";

inline constexpr const char* kBilinear = R"(
void main() {
  result = texture(colour0, uv - kJitter / vec2(textureSize(colour0, 0)));
})";

// Sigg & Hadwiger, "Fast Third-Order Texture Filtering", 2005: four bilinear reads.
inline constexpr const char* kBSpline = R"(
void main() {
  vec2 size = vec2(textureSize(colour0, 0));
  vec2 p = uv * size - 0.5 - kJitter;
  vec2 base = floor(p), t = p - base, s = 1.0 - t;
  vec2 w0 = s * s * s / 6.0, w3 = t * t * t / 6.0;
  vec2 w1 = 2.0 / 3.0 - 0.5 * t * t * (2.0 - t);
  vec2 g0 = w0 + w1, g1 = 1.0 - g0, w2 = g1 - w3;
  vec2 lower = (base - 0.5 + w1 / g0) / size, upper = (base + 1.5 + w3 / (w2 + w3)) / size;
  result = g0.y * (g0.x * texture(colour0, lower) + g1.x * texture(colour0, vec2(upper.x, lower.y))) +
           g1.y * (g0.x * texture(colour0, vec2(lower.x, upper.y)) + g1.x * texture(colour0, upper));
})";

// Nine bilinear reads: the two inner weights of each axis share one.
inline constexpr const char* kCatmullRom = R"(
void main() {
  vec2 size = vec2(textureSize(colour0, 0));
  vec2 p = uv * size - kJitter;
  vec2 base = floor(p - 0.5) + 0.5, t = p - base;
  vec2 w0 = t * (-0.5 + t * (1.0 - 0.5 * t)), w1 = 1.0 + t * t * (-2.5 + 1.5 * t);
  vec2 w3 = t * t * (-0.5 + 0.5 * t), w2 = 1.0 - w0 - w1 - w3;
  vec2 inner = w1 + w2;
  vec2 c[3] = vec2[]((base - 1.0) / size, (base + w2 / inner) / size, (base + 2.0) / size);
  vec2 w[3] = vec2[](w0, inner, w3);
  result = vec4(0.0);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      result += w[i].x * w[j].y * texture(colour0, vec2(c[i].x, c[j].y));
})";

inline constexpr const char* kSeedResolve = R"(
void main() {
  vec2 size = vec2(textureSize(colour0, 0));
  vec2 shift = kJitter / size;
  vec2 v0 = texture(velocity0, uv).xy * size, v1 = texture(velocity1, uv).xy * size;
  float weight = 1.0 / (1.0 + dot(v0, v0) + dot(v1, v1));
  result = (texture(colour0, uv - shift) + weight * texture(colour1, uv + shift)) / (1.0 + weight);
})";

inline constexpr const char* kBlur = R"(
void main() {
  vec2 velocity = texture(velocity0, uv).xy;
  result = vec4(0.0);
  for (int i = 0; i < 8; ++i)
    result += texture(colour0, uv + velocity * ((float(i) + 0.5) / 8.0 - 0.5));
  result *= 1.0 / 8.0;
})";

}  // namespace quincunx::bench

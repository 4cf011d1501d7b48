#version 450
// SPDX-License-Identifier: MIT
// Squares with dark joints, and where they move, for vulkan.cpp.
layout(location = 0) in vec3 now;
layout(location = 1) in vec3 before;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec4 colour;
layout(location = 1) out vec2 velocity;
void main() {
  vec2 tile = fract(8.0 * uv);
  float light = min(tile.x, tile.y) < 0.12 ? 0.04 : mod(floor(8.0 * uv.x) + floor(8.0 * uv.y), 2.0) < 1.0 ? 0.9 : 0.35;
  colour = vec4(light * vec3(0.9, 0.2 + 0.6 * uv), 1.0);       // linear light
  velocity = 0.5 * (now.xy / now.z - before.xy / before.z);  // in uv, +y down, without jitter
}

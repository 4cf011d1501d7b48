#version 450
// SPDX-License-Identifier: MIT
// Turning cubes, for vulkan.cpp.
layout(push_constant) uniform Push { vec2 jitter; float time, time_before; };
layout(location = 0) out vec3 now;
layout(location = 1) out vec3 before;
layout(location = 2) out vec2 uv;
vec4 project(vec3 corner, float time) {  // without jitter; Vulkan's y points down
  float a = 0.5 * time + gl_InstanceIndex, b = 0.3 * time;
  corner.xz *= mat2(cos(a), sin(a), -sin(a), cos(a));
  corner.xy *= mat2(cos(b), sin(b), -sin(b), cos(b));
  vec3 p = corner + 2.2 * vec3(gl_InstanceIndex % 7 - 3, gl_InstanceIndex / 7 - 2, 0)
         - vec3(0, 0, 9 + gl_InstanceIndex % 3);
  return vec4(p.x, -16.0 / 9.0 * p.y, 0.1, -p.z);  // reversed infinite depth: near / distance
}
void main() {
  int face = gl_VertexIndex / 6, k = gl_VertexIndex % 6;
  uv = vec2(k == 1 || k == 2 || k == 4, k == 2 || k == 4 || k == 5);
  vec3 corner = 0.7 * vec3(2.0 * uv - 1.0, face % 2 == 0 ? 1.0 : -1.0);
  corner = face / 2 == 0 ? corner : face / 2 == 1 ? corner.zxy : corner.yzx;
  gl_Position = project(corner, time);
  now = gl_Position.xyw;
  before = project(corner, time_before).xyw;
  gl_Position.xy -= 2.0 * jitter * gl_Position.w;  // moves the samples by +jitter
}

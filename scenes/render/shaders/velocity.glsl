// Velocity: position of this frame minus that of the previous one, uv of the viewport, jitter excluded.
const float kLargestVelocity = 16.0;  // viewports per frame: far beyond use, and finite in half float
const float kSmallestW = 1e-4;        // points at or behind the previous camera go far, towards their own side

// Homogeneous (x, y, w) to uv less the constant half that the difference loses anyway.
vec2 centred_uv(vec3 clip) { return vec2(0.5, -0.5) * clip.xy / max(clip.z, kSmallestW); }

vec2 velocity_between(vec3 now, vec3 before) {
  return clamp(centred_uv(now) - centred_uv(before), -kLargestVelocity, kLargestVelocity);
}

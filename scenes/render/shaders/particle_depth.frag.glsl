// particle_depth.frag: the frame's depth at the resolution of its particles. Of the samples that a texel covers the
// nearest one's depth and the farthest one's, in turns.
layout(binding = 0) uniform sampler2D depth;     // reversed
layout(location = 0) uniform ivec2 frame_extent;  // viewports
layout(location = 1) uniform ivec2 extent;
layout(location = 2) uniform int parity;  // (x + y) % 2 of the samples that are shaded; -1: all of them

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  ivec2 first = texel * frame_extent / extent;
  ivec2 last = ((texel + 1) * frame_extent - 1) / extent;
  if (parity >= 0) {  // two samples on each axis have one that is shaded
    first = max(min(first, frame_extent - 2), ivec2(0));
    last = min(max(last, first + 1), frame_extent - 1);
  }
  float nearest = 0.0, farthest = 1.0;
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      if (parity >= 0 && ((x + y) & 1) != parity) continue;
      float sampled = texelFetch(depth, ivec2(x, y), 0).r;
      nearest = max(nearest, sampled);
      farthest = min(farthest, sampled);
    }
  }
  gl_FragDepth = ((texel.x + texel.y) & 1) == 0 ? nearest : farthest;
}

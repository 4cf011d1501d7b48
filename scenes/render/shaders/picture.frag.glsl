// picture.frag: the picture on the screen, pixel by pixel, or a part of it enlarged by a whole number; right of the
// split another picture of the same extent.
layout(location = 0) uniform ivec2 window;  // extent of the framebuffer
layout(location = 1) uniform ivec2 origin;  // picture pixel of the window's top left corner
layout(location = 2) uniform int zoom;      // window pixels for each picture pixel
layout(location = 3) uniform int split;     // first column of the other picture
layout(binding = 0) uniform sampler2D picture;  // RGBA8, encoded for the screen, row 0 on top
layout(binding = 1) uniform sampler2D other;

layout(location = 0) out vec4 out_colour;

void main() {
  ivec2 at = ivec2(int(gl_FragCoord.x), window.y - 1 - int(gl_FragCoord.y));
  ivec2 texel = origin + at / zoom;
  ivec2 size = textureSize(picture, 0);
  bool inside = all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, size));
  vec3 colour = at.x < split ? texelFetch(picture, texel, 0).rgb : texelFetch(other, texel, 0).rgb;
  out_colour = vec4(inside ? colour : vec3(0.06), 1.0);
}

// layer.frag: a layer of the window's extent, premultiplied, laid over what is there.
layout(binding = 0) uniform sampler2D layer;  // RGBA8, row 0 at the bottom

layout(location = 0) out vec4 out_colour;

void main() { out_colour = texelFetch(layer, ivec2(gl_FragCoord.xy), 0); }

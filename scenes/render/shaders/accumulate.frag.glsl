// accumulate.frag: one sub-frame, weighted, to be added to the sum (RGBA32F).
layout(location = 0) uniform float weight;
layout(binding = 0) uniform sampler2D sub_frame;  // RGBA16F, same extent

layout(location = 0) out vec4 out_sum;

void main() { out_sum = weight * texelFetch(sub_frame, ivec2(gl_FragCoord.xy), 0); }

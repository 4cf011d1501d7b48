// shadow.frag: leaves holes where the material is cut out. Options: TEXTURED.
layout(std140, binding = 1) uniform Material {
  vec4 base_colour;
  vec4 emissive;  // w: alpha cut-off
  vec4 surface;
  vec4 uv[8];
} material;

in float v_alpha;
#ifdef TEXTURED
layout(binding = 0) uniform sampler2D base_texture;
in vec2 v_uv;
#endif

void main() {
  float alpha = material.base_colour.a * v_alpha;
#ifdef TEXTURED
  vec3 uv1 = vec3(v_uv, 1.0);
  alpha *= texture(base_texture, vec2(dot(material.uv[0].xyz, uv1), dot(material.uv[1].xyz, uv1))).a;
#endif
  if (alpha < material.emissive.w) discard;
}

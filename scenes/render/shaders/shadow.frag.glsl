// shadow.frag: leaves holes where the material is cut out.
layout(std140, binding = 1) uniform Material {
  vec4 base_colour;
  vec4 emissive;  // w: alpha cut-off
  vec4 surface;
  vec4 uv[8];
} material;

layout(binding = 0) uniform sampler2D base_texture;

in vec2 v_uv;

void main() {
  vec3 uv1 = vec3(v_uv, 1.0);
  vec2 at = vec2(dot(material.uv[0].xyz, uv1), dot(material.uv[1].xyz, uv1));
  if (material.base_colour.a * texture(base_texture, at).a < material.emissive.w) discard;
}

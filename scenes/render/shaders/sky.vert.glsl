// sky.vert: one triangle over the viewport at infinity (depth 0).
void main() {
  vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
  gl_Position = CLIP(vec4(corner * 2.0 - 1.0, 0.0, 1.0));
}

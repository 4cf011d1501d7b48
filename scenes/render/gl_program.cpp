// SPDX-License-Identifier: MIT
#include "render/gl_program.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "embedded_shader_files.h"
#include "quincunx_gl/capabilities.h"

namespace quincunx::scenes {
namespace {

struct ShaderTraits {
  static void destroy(GLuint name) { glDeleteShader(name); }
};
using Shader = gl::Handle<ShaderTraits>;

std::string_view text_of(std::string_view name) {
  for (const EmbeddedFile& file : embedded_shader_files()) {
    if (file.name == name) return file.text;
  }
  return {};
}

// Appends the file with its includes; `seen` keeps each to one appearance.
Status append_file(std::string_view name, std::vector<std::string>& seen, std::string& source) {
  if (std::find(seen.begin(), seen.end(), name) != seen.end()) return {};
  seen.emplace_back(name);
  std::string_view text = text_of(name);
  if (text.empty())
    return Status::device(fmt::format("shader file '{}' is not embedded in this program", name));
  constexpr std::string_view kInclude = "#include \"";
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    if (!line.starts_with(kInclude)) {
      source.append(line);
      continue;
    }
    const std::string_view rest = line.substr(kInclude.size());
    Status status = append_file(rest.substr(0, rest.find('"')), seen, source);
    if (!status.ok()) return status;
  }
  return {};
}

std::string log_of(GLuint name, bool program) {
  GLint length = 0;
  program ? glGetProgramiv(name, GL_INFO_LOG_LENGTH, &length)
          : glGetShaderiv(name, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
  program ? glGetProgramInfoLog(name, length, nullptr, log.data())
          : glGetShaderInfoLog(name, length, nullptr, log.data());
  return log.c_str();  // up to the terminating zero
}

// Desktop OpenGL 4.5 or OpenGL ES 3.1, 3.2. CLIP turns a place of clip space, y up and depth from 0 to 1, into that of
// a context without clip control: rows top-down then come from the sign of y, and depth is spread to [-1, 1], from
// which the viewport brings it back.
std::string preamble() {
  const gl::Capabilities& can = gl::capabilities();
  std::string text = "#version 450 core\n";
  if (can.api == gl::Api::kEs3) {
    text = can.version >= 32 ? "#version 320 es\n" : "#version 310 es\n#define precise\n";
    text += "precision highp float;\nprecision highp int;\nprecision highp sampler2D;\n";
    text += "precision highp sampler2DShadow;\n";
  }
  text += can.clip_control ? "#define CLIP(p) (p)\n"
                           : "#define CLIP(p) vec4((p).x, -(p).y, 2.0 * (p).z - (p).w, (p).w)\n";
  if (!can.depth_clamp) text += "#define CLAMPS_DEPTH\n";
  return text;
}

Result<Shader> compile(GLenum stage, const std::string& file, const std::vector<std::string>& defines) {
  std::string source = preamble();
  for (const std::string& define : defines)
    source += "#define " + define + "\n";
  std::vector<std::string> seen;
  Status status = append_file(file, seen, source);
  if (!status.ok()) return status;

  Shader shader = Shader::adopt(glCreateShader(stage));
  const char* text = source.c_str();
  glShaderSource(shader.get(), 1, &text, nullptr);
  glCompileShader(shader.get());
  GLint compiled = 0;
  glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &compiled);
  if (compiled == 0) {
    return Status::device(fmt::format("glCompileShader failed for '{}' with defines [{}]: {}", file,
                                      fmt::join(defines, ", "), log_of(shader.get(), false)));
  }
  return shader;
}

}  // namespace

Result<gl::Program> link_program(const std::string& vertex, const std::string& fragment,
                                 const std::vector<std::string>& defines) {
  gl::Program program = gl::Program::create();
  Result<Shader> vertex_shader = compile(GL_VERTEX_SHADER, vertex, defines);
  if (!vertex_shader.ok()) return vertex_shader.status();
  glAttachShader(program.get(), vertex_shader->get());
  Result<Shader> fragment_shader = compile(GL_FRAGMENT_SHADER, fragment, defines);
  if (!fragment_shader.ok()) return fragment_shader.status();
  glAttachShader(program.get(), fragment_shader->get());
  glLinkProgram(program.get());
  GLint linked = 0;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
  if (linked == 0) {
    return Status::device(fmt::format("glLinkProgram failed for '{}' and '{}' with defines [{}]: {}", vertex,
                                      fragment, fmt::join(defines, ", "), log_of(program.get(), true)));
  }
  return program;
}

}  // namespace quincunx::scenes

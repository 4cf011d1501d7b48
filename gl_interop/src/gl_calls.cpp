// SPDX-License-Identifier: MIT
#include "quincunx_gl/gl_calls.h"

#include "quincunx_gl/capabilities.h"
#include "state_scope.h"

namespace quincunx::gl {
void texture_storage(GLuint texture, GLsizei levels, GLenum format, Extent extent) {
  const BindingScope bound = BindingScope::texture(texture);
  glTexStorage2D(GL_TEXTURE_2D, levels, format, extent.width, extent.height);
}

void texture_parameter(GLuint texture, GLenum name, GLint value) {
  const BindingScope bound = BindingScope::texture(texture);
  glTexParameteri(GL_TEXTURE_2D, name, value);
}

void texture_parameter(GLuint texture, GLenum name, GLfloat value) {
  const BindingScope bound = BindingScope::texture(texture);
  glTexParameterf(GL_TEXTURE_2D, name, value);
}

void texture_border(GLuint texture, const GLfloat colour[4]) {
  const BindingScope bound = BindingScope::texture(texture);
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, colour);
}

void texture_write(GLuint texture, GLint level, Extent extent, GLenum format, GLenum type,
                   const void* texels) {
  if (capabilities().api == Api::kGl45) {
    glTextureSubImage2D(texture, level, 0, 0, extent.width, extent.height, format, type, texels);
    return;
  }
  const BindingScope bound = BindingScope::texture(texture);
  glTexSubImage2D(GL_TEXTURE_2D, level, 0, 0, extent.width, extent.height, format, type, texels);
}

void texture_mipmaps(GLuint texture) {
  const BindingScope bound = BindingScope::texture(texture);
  glGenerateMipmap(GL_TEXTURE_2D);
}

void bind_texture(GLuint unit, GLuint texture) {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, texture);
  glActiveTexture(GL_TEXTURE0);
}

void buffer_storage(GLuint buffer, GLsizeiptr bytes) {
  const BindingScope bound = BindingScope::buffer(buffer);
  glBufferData(GL_COPY_WRITE_BUFFER, bytes, nullptr, GL_DYNAMIC_DRAW);
}

void buffer_write(GLuint buffer, GLintptr offset, GLsizeiptr bytes, const void* data) {
  if (capabilities().api == Api::kGl45) {
    glNamedBufferSubData(buffer, offset, bytes, data);
    return;
  }
  const BindingScope bound = BindingScope::buffer(buffer);
  glBufferSubData(GL_COPY_WRITE_BUFFER, offset, bytes, data);
}

void attach(GLuint framebuffer, GLenum attachment, GLuint texture) {
  const BindingScope bound = BindingScope::drawn(framebuffer);
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
}

void draw_buffers(GLuint framebuffer, std::initializer_list<GLenum> buffers) {
  const BindingScope bound = BindingScope::drawn(framebuffer);
  glDrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.begin());
}

GLenum framebuffer_status(GLuint framebuffer) {
  const BindingScope bound = BindingScope::drawn(framebuffer);
  return glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER);
}

void clear(GLuint framebuffer, GLenum buffer, GLint index, const GLfloat* value) {
  const BindingScope bound = BindingScope::drawn(framebuffer);
  glClearBufferfv(buffer, index, value);
}

void read_attachment(GLuint framebuffer, GLenum attachment, Extent extent, GLenum format, GLenum type,
                     void* pixels) {
  const BindingScope bound = BindingScope::read(framebuffer);
  GLint before = GL_NONE;
  glGetIntegerv(GL_READ_BUFFER, &before);
  glReadBuffer(attachment);
  glReadPixels(0, 0, extent.width, extent.height, format, type, pixels);
  glReadBuffer(static_cast<GLenum>(before));
}

}  // namespace quincunx::gl

// SPDX-License-Identifier: MIT
#include "quincunx_gl/gl_calls.h"

namespace quincunx::gl {
namespace {

class BoundTexture {
 public:
  explicit BoundTexture(GLuint texture) {
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &before_);
    glBindTexture(GL_TEXTURE_2D, texture);
  }
  ~BoundTexture() { glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(before_)); }
  BoundTexture(const BoundTexture&) = delete;
  BoundTexture& operator=(const BoundTexture&) = delete;

 private:
  GLint before_ = 0;
};

class BoundFramebuffer {
 public:
  explicit BoundFramebuffer(GLuint framebuffer, GLenum target = GL_DRAW_FRAMEBUFFER) : target_(target) {
    glGetIntegerv(target == GL_DRAW_FRAMEBUFFER ? GL_DRAW_FRAMEBUFFER_BINDING : GL_READ_FRAMEBUFFER_BINDING,
                  &before_);
    glBindFramebuffer(target, framebuffer);
  }
  ~BoundFramebuffer() { glBindFramebuffer(target_, static_cast<GLuint>(before_)); }
  BoundFramebuffer(const BoundFramebuffer&) = delete;
  BoundFramebuffer& operator=(const BoundFramebuffer&) = delete;

 private:
  GLenum target_;
  GLint before_ = 0;
};

}  // namespace

void texture_storage(GLuint texture, GLsizei levels, GLenum format, Extent extent) {
  const BoundTexture bound(texture);
  glTexStorage2D(GL_TEXTURE_2D, levels, format, extent.width, extent.height);
}

void texture_parameter(GLuint texture, GLenum name, GLint value) {
  const BoundTexture bound(texture);
  glTexParameteri(GL_TEXTURE_2D, name, value);
}

void texture_parameter(GLuint texture, GLenum name, GLfloat value) {
  const BoundTexture bound(texture);
  glTexParameterf(GL_TEXTURE_2D, name, value);
}

void texture_border(GLuint texture, const GLfloat colour[4]) {
  const BoundTexture bound(texture);
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, colour);
}

void texture_write(GLuint texture, GLint level, Extent extent, GLenum format, GLenum type,
                   const void* texels) {
  const BoundTexture bound(texture);
  glTexSubImage2D(GL_TEXTURE_2D, level, 0, 0, extent.width, extent.height, format, type, texels);
}

void texture_mipmaps(GLuint texture) {
  const BoundTexture bound(texture);
  glGenerateMipmap(GL_TEXTURE_2D);
}

void bind_texture(GLuint unit, GLuint texture) {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, texture);
  glActiveTexture(GL_TEXTURE0);
}

void buffer_storage(GLuint buffer, GLsizeiptr bytes) {
  glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
  glBufferData(GL_COPY_WRITE_BUFFER, bytes, nullptr, GL_DYNAMIC_DRAW);
}

void buffer_write(GLuint buffer, GLintptr offset, GLsizeiptr bytes, const void* data) {
  glBindBuffer(GL_COPY_WRITE_BUFFER, buffer);
  glBufferSubData(GL_COPY_WRITE_BUFFER, offset, bytes, data);
}

void attach(GLuint framebuffer, GLenum attachment, GLuint texture) {
  const BoundFramebuffer bound(framebuffer);
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
}

void draw_buffers(GLuint framebuffer, std::initializer_list<GLenum> buffers) {
  const BoundFramebuffer bound(framebuffer);
  glDrawBuffers(static_cast<GLsizei>(buffers.size()), buffers.begin());
}

GLenum framebuffer_status(GLuint framebuffer) {
  const BoundFramebuffer bound(framebuffer);
  return glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER);
}

void clear(GLuint framebuffer, GLenum buffer, GLint index, const GLfloat* value) {
  const BoundFramebuffer bound(framebuffer);
  glClearBufferfv(buffer, index, value);
}

void read_attachment(GLuint framebuffer, GLenum attachment, Extent extent, GLenum format, GLenum type,
                     void* pixels) {
  const BoundFramebuffer bound(framebuffer, GL_READ_FRAMEBUFFER);
  glReadBuffer(attachment);
  glReadPixels(0, 0, extent.width, extent.height, format, type, pixels);
}

}  // namespace quincunx::gl

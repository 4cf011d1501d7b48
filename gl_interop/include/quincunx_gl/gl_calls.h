// SPDX-License-Identifier: MIT
// Calls on an object by its name, which OpenGL 4.5 has and OpenGL ES has not: made by binding it, which both know. Each
// leaves texture and framebuffer bindings as they were; buffers are bound to GL_COPY_WRITE_BUFFER, which nobody else
// uses.
#pragma once

#include <epoxy/gl.h>

#include <initializer_list>

#include "quincunx/extent.h"

namespace quincunx::gl {

// Textures are of two dimensions and immutable.
void texture_storage(GLuint texture, GLsizei levels, GLenum format, Extent extent);
void texture_parameter(GLuint texture, GLenum name, GLint value);
void texture_parameter(GLuint texture, GLenum name, GLfloat value);
void texture_border(GLuint texture, const GLfloat colour[4]);
void texture_write(GLuint texture, GLint level, Extent extent, GLenum format, GLenum type,
                   const void* texels);
void texture_mipmaps(GLuint texture);
// Stays bound. Leaves unit 0 active.
void bind_texture(GLuint unit, GLuint texture);

void buffer_storage(GLuint buffer, GLsizeiptr bytes);  // for buffer_write()
void buffer_write(GLuint buffer, GLintptr offset, GLsizeiptr bytes, const void* data);

void attach(GLuint framebuffer, GLenum attachment, GLuint texture);
void draw_buffers(GLuint framebuffer, std::initializer_list<GLenum> buffers);
GLenum framebuffer_status(GLuint framebuffer);
void clear(GLuint framebuffer, GLenum buffer, GLint index, const GLfloat* value);
// The top left `extent` of a colour attachment, with the pack state that is set.
void read_attachment(GLuint framebuffer, GLenum attachment, Extent extent, GLenum format, GLenum type,
                     void* pixels);

}  // namespace quincunx::gl

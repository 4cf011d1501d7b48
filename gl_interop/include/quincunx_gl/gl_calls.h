// SPDX-License-Identifier: MIT
// Calls on an object by its name, which OpenGL ES does not have. Each puts bindings back as they were.
#pragma once

#include <epoxy/gl.h>

#include <initializer_list>

#include "quincunx/advanced/export.h"
#include "quincunx/advanced/extent.h"

namespace quincunx::gl {

// Textures are of two dimensions and immutable.
QUINCUNX_API void texture_storage(GLuint texture, GLsizei levels, GLenum format, Extent extent);
QUINCUNX_API void texture_parameter(GLuint texture, GLenum name, GLint value);
QUINCUNX_API void texture_parameter(GLuint texture, GLenum name, GLfloat value);
QUINCUNX_API void texture_border(GLuint texture, const GLfloat colour[4]);
QUINCUNX_API void texture_write(GLuint texture, GLint level, Extent extent, GLenum format, GLenum type,
                                const void* texels);
QUINCUNX_API void texture_mipmaps(GLuint texture);
// Binds a texture, which stays bound, and makes unit 0 active.
QUINCUNX_API void bind_texture(GLuint unit, GLuint texture);

QUINCUNX_API void buffer_storage(GLuint buffer, GLsizeiptr bytes);  // for buffer_write()
QUINCUNX_API void buffer_write(GLuint buffer, GLintptr offset, GLsizeiptr bytes, const void* data);

QUINCUNX_API void attach(GLuint framebuffer, GLenum attachment, GLuint texture);
QUINCUNX_API void draw_buffers(GLuint framebuffer, std::initializer_list<GLenum> buffers);
QUINCUNX_API GLenum framebuffer_status(GLuint framebuffer);
QUINCUNX_API void clear(GLuint framebuffer, GLenum buffer, GLint index, const GLfloat* value);
// Reads the top left `extent` of a colour attachment, with the pack state that is set.
QUINCUNX_API void read_attachment(GLuint framebuffer, GLenum attachment, Extent extent, GLenum format,
                                  GLenum type, void* pixels);

}  // namespace quincunx::gl

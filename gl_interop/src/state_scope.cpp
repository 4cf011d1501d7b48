// SPDX-License-Identifier: MIT
#include "state_scope.h"

#include "quincunx_gl/capabilities.h"

namespace quincunx::gl {
namespace {

struct PixelStore {
  GLenum name;
  GLint plain;
  bool in_es;
};

constexpr std::array kPixelStore = {
    PixelStore{GL_PACK_ALIGNMENT, 1, true},      PixelStore{GL_PACK_ROW_LENGTH, 0, true},
    PixelStore{GL_PACK_SKIP_ROWS, 0, true},      PixelStore{GL_PACK_SKIP_PIXELS, 0, true},
    PixelStore{GL_PACK_SWAP_BYTES, 0, false},    PixelStore{GL_PACK_LSB_FIRST, 0, false},
    PixelStore{GL_PACK_IMAGE_HEIGHT, 0, false},  PixelStore{GL_PACK_SKIP_IMAGES, 0, false},
    PixelStore{GL_UNPACK_ALIGNMENT, 1, true},    PixelStore{GL_UNPACK_ROW_LENGTH, 0, true},
    PixelStore{GL_UNPACK_SKIP_ROWS, 0, true},    PixelStore{GL_UNPACK_SKIP_PIXELS, 0, true},
    PixelStore{GL_UNPACK_SWAP_BYTES, 0, false},  PixelStore{GL_UNPACK_LSB_FIRST, 0, false},
    PixelStore{GL_UNPACK_IMAGE_HEIGHT, 0, true}, PixelStore{GL_UNPACK_SKIP_IMAGES, 0, true}};

struct Binding {
  GLenum target;
  GLenum query;
};

constexpr std::array kBuffers = {Binding{GL_PIXEL_PACK_BUFFER, GL_PIXEL_PACK_BUFFER_BINDING},
                                 Binding{GL_PIXEL_UNPACK_BUFFER, GL_PIXEL_UNPACK_BUFFER_BINDING},
                                 Binding{GL_COPY_WRITE_BUFFER, GL_COPY_WRITE_BUFFER_BINDING}};
constexpr std::array kFramebuffers = {Binding{GL_READ_FRAMEBUFFER, GL_READ_FRAMEBUFFER_BINDING},
                                      Binding{GL_DRAW_FRAMEBUFFER, GL_DRAW_FRAMEBUFFER_BINDING}};

constexpr std::array<GLenum, 5> kImage = {GL_IMAGE_BINDING_NAME, GL_IMAGE_BINDING_LEVEL,
                                          GL_IMAGE_BINDING_LAYER, GL_IMAGE_BINDING_ACCESS,
                                          GL_IMAGE_BINDING_FORMAT};

bool is_desktop() {
  return capabilities().api == Api::kGl45;
}

// Of the first viewport alone where there are several: the calls without an index change all of them.
void set_scissor(bool on, const std::array<GLint, 4>& box) {
  const bool indexed = is_desktop();
  if (indexed) {
    on ? glEnablei(GL_SCISSOR_TEST, 0) : glDisablei(GL_SCISSOR_TEST, 0);
    glScissorIndexed(0, box[0], box[1], box[2], box[3]);
  } else {
    on ? glEnable(GL_SCISSOR_TEST) : glDisable(GL_SCISSOR_TEST);
    glScissor(box[0], box[1], box[2], box[3]);
  }
}

}  // namespace

TransferScope::TransferScope() {
  const bool desktop = is_desktop();
  for (std::size_t i = 0; i < kPixelStore.size(); ++i) {
    if (!desktop && !kPixelStore[i].in_es) continue;
    glGetIntegerv(kPixelStore[i].name, &pixel_store_[i]);
    glPixelStorei(kPixelStore[i].name, kPixelStore[i].plain);
  }
  GLint* binding = bindings_.data();
  for (const Binding& buffer : kBuffers) {
    glGetIntegerv(buffer.query, binding++);
    glBindBuffer(buffer.target, 0);
  }
  for (const Binding& framebuffer : kFramebuffers)
    glGetIntegerv(framebuffer.query, binding++);
  if (!desktop) return;
  glGetIntegerv(GL_CLAMP_READ_COLOR, &clamp_read_);
  glClampColor(GL_CLAMP_READ_COLOR, GL_FALSE);
}

TransferScope::~TransferScope() {
  const bool desktop = is_desktop();
  for (std::size_t i = 0; i < kPixelStore.size(); ++i) {
    if (desktop || kPixelStore[i].in_es) glPixelStorei(kPixelStore[i].name, pixel_store_[i]);
  }
  const GLint* binding = bindings_.data();
  for (const Binding& buffer : kBuffers)
    glBindBuffer(buffer.target, static_cast<GLuint>(*binding++));
  for (const Binding& framebuffer : kFramebuffers)
    glBindFramebuffer(framebuffer.target, static_cast<GLuint>(*binding++));
  if (desktop) glClampColor(GL_CLAMP_READ_COLOR, static_cast<GLenum>(clamp_read_));
}

ComputeScope::ComputeScope() {
  glGetIntegerv(GL_CURRENT_PROGRAM, &program_);
  glGetIntegerv(GL_ACTIVE_TEXTURE, &active_unit_);
  glActiveTexture(GL_TEXTURE0);
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture_);
  glGetIntegerv(GL_SAMPLER_BINDING, &sampler_);
  for (std::size_t i = 0; i < kImage.size(); ++i)
    glGetIntegeri_v(kImage[i], 0, &image_[i]);
  glGetBooleani_v(GL_IMAGE_BINDING_LAYERED, 0, &layered_);
}

ComputeScope::~ComputeScope() {
  glBindImageTexture(0, static_cast<GLuint>(image_[0]), image_[1], layered_, image_[2],
                     static_cast<GLenum>(image_[3]), static_cast<GLenum>(image_[4]));
  glBindSampler(0, static_cast<GLuint>(sampler_));
  glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(texture_));
  glActiveTexture(static_cast<GLenum>(active_unit_));
  glUseProgram(static_cast<GLuint>(program_));
}

ClearScope::ClearScope() {
  for (GLuint i = 0; i < colour_.size(); ++i) {
    glGetBooleani_v(GL_COLOR_WRITEMASK, i, colour_[i].data());
    glColorMaski(i, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }
  glGetBooleanv(GL_DEPTH_WRITEMASK, &depth_);
  glDepthMask(GL_TRUE);
  discards_ = glIsEnabled(GL_RASTERIZER_DISCARD);
  glDisable(GL_RASTERIZER_DISCARD);
  scissored_ = glIsEnabled(GL_SCISSOR_TEST);
  glGetIntegerv(GL_SCISSOR_BOX, box_.data());
  set_scissor(false, box_);
}

ClearScope::~ClearScope() {
  for (GLuint i = 0; i < colour_.size(); ++i)
    glColorMaski(i, colour_[i][0], colour_[i][1], colour_[i][2], colour_[i][3]);
  glDepthMask(depth_);
  if (discards_ == GL_TRUE) glEnable(GL_RASTERIZER_DISCARD);
  set_scissor(scissored_ == GL_TRUE, box_);
}

void ClearScope::scissor(GLint width, GLint height) const {
  set_scissor(true, {0, 0, width, height});
}

}  // namespace quincunx::gl

// SPDX-License-Identifier: MIT
// Each public call puts OpenGL's state back as it was, however unusual, works whatever it is, and leaves errors of the
// caller's to the caller.
#include <fmt/format.h>

#include <functional>
#include <map>
#include <optional>

#include "cl_imports.h"
#include "cl_interposer.h"
#include "interop_fixture.h"
#include "quincunx_gl/frame_timer.h"
#include "skip.h"

namespace quincunx::gl::testing {
namespace {

constexpr Extent kTarget = {48, 32};
constexpr Extent kRender = {37, 21};
constexpr Extent kOutput = {24, 16};

struct Way {
  const char* name;
  Api api = Api::kGl45;
  bool shared = false;
  bool imports = false;
  bool placed = false;
  bool external = false;  // by fds where the device is a stand-in
};

constexpr std::array kWays = {Way{"Copy"},
                              Way{"CopyImports", Api::kGl45, false, true},
                              Way{"CopyPlaced", Api::kGl45, false, false, true},
                              Way{"External", Api::kGl45, false, false, false, true},
                              Way{"ExternalImports", Api::kGl45, false, true, false, true},
                              Way{"Shared", Api::kGl45, true},
                              Way{"SharedImports", Api::kGl45, true, true},
                              Way{"Es", Api::kEs3},
                              Way{"EsImports", Api::kEs3, false, true}};

class StateTest : public InteropTest, public ::testing::WithParamInterface<Way> {
 protected:
  Api api() const override { return GetParam().api; }
  bool desktop() const { return api() == Api::kGl45; }

  // Each value of the state by a name of its own.
  using State = std::map<std::string, std::vector<GLint64>>;
  State state() const;
  void make_unusual();

  // Runs a call while an error of the caller's waits, and compares.
  void keeps(const char* call, const std::function<void()>& run) {
    const State before = state();
    const GLenum error = raise_an_error();
    run();
    EXPECT_EQ(glGetError(), error) << call;
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR}) << call;
    const State after = state();
    for (const auto& [name, value] : before)
      EXPECT_EQ(after.at(name), value) << call << " changed " << name;
  }

  // Raises errors of each kind in turns, and returns which.
  GLenum raise_an_error() {
    switch (errors_++ % 4) {
      case 0:
        glEnable(GL_NONE);
        return GL_INVALID_ENUM;
      case 1:
        glViewport(0, 0, -1, -1);
        return GL_INVALID_VALUE;
      case 2:
        glUseProgram(unlinked_.get());
        return GL_INVALID_OPERATION;
      default:
        return GL_NO_ERROR;
    }
  }

  int errors_ = 0;
  Program unlinked_;
  std::vector<Texture> textures_;
  std::vector<Buffer> buffers_;
  std::vector<Framebuffer> framebuffers_;
  VertexArray vertices_;
  Program program_;
};

constexpr std::array kPixelStore = {GL_PACK_ALIGNMENT,    GL_PACK_ROW_LENGTH,    GL_PACK_SKIP_ROWS,
                                    GL_PACK_SKIP_PIXELS,  GL_UNPACK_ALIGNMENT,   GL_UNPACK_ROW_LENGTH,
                                    GL_UNPACK_SKIP_ROWS,  GL_UNPACK_SKIP_PIXELS, GL_UNPACK_IMAGE_HEIGHT,
                                    GL_UNPACK_SKIP_IMAGES};
constexpr std::array kDesktopPixelStore = {GL_PACK_SWAP_BYTES,  GL_PACK_LSB_FIRST,    GL_PACK_IMAGE_HEIGHT,
                                           GL_PACK_SKIP_IMAGES, GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST};
constexpr std::array kEnables = {GL_BLEND,
                                 GL_CULL_FACE,
                                 GL_DEPTH_TEST,
                                 GL_STENCIL_TEST,
                                 GL_SCISSOR_TEST,
                                 GL_DITHER,
                                 GL_RASTERIZER_DISCARD,
                                 GL_SAMPLE_COVERAGE,
                                 GL_POLYGON_OFFSET_FILL,
                                 GL_SAMPLE_ALPHA_TO_COVERAGE};
constexpr std::array kDesktopEnables = {GL_FRAMEBUFFER_SRGB, GL_DEPTH_CLAMP, GL_COLOR_LOGIC_OP,
                                        GL_PRIMITIVE_RESTART};
constexpr std::array kBuffers = {GL_ARRAY_BUFFER,        GL_PIXEL_PACK_BUFFER, GL_PIXEL_UNPACK_BUFFER,
                                 GL_COPY_READ_BUFFER,    GL_COPY_WRITE_BUFFER, GL_UNIFORM_BUFFER,
                                 GL_DRAW_INDIRECT_BUFFER};
constexpr std::array kQueries = {GL_ARRAY_BUFFER_BINDING,
                                 GL_PIXEL_PACK_BUFFER_BINDING,
                                 GL_PIXEL_UNPACK_BUFFER_BINDING,
                                 GL_COPY_READ_BUFFER_BINDING,
                                 GL_COPY_WRITE_BUFFER_BINDING,
                                 GL_UNIFORM_BUFFER_BINDING,
                                 GL_DRAW_INDIRECT_BUFFER_BINDING,
                                 GL_READ_FRAMEBUFFER_BINDING,
                                 GL_DRAW_FRAMEBUFFER_BINDING,
                                 GL_RENDERBUFFER_BINDING,
                                 GL_CURRENT_PROGRAM,
                                 GL_VERTEX_ARRAY_BINDING,
                                 GL_ACTIVE_TEXTURE,
                                 GL_VIEWPORT,
                                 GL_SCISSOR_BOX,
                                 GL_DEPTH_WRITEMASK,
                                 GL_DEPTH_FUNC,
                                 GL_DEPTH_RANGE,
                                 GL_STENCIL_WRITEMASK,
                                 GL_STENCIL_FUNC,
                                 GL_STENCIL_REF,
                                 GL_COLOR_CLEAR_VALUE,
                                 GL_DEPTH_CLEAR_VALUE,
                                 GL_STENCIL_CLEAR_VALUE,
                                 GL_BLEND_SRC_RGB,
                                 GL_BLEND_DST_RGB,
                                 GL_BLEND_SRC_ALPHA,
                                 GL_BLEND_DST_ALPHA,
                                 GL_BLEND_EQUATION_RGB,
                                 GL_BLEND_EQUATION_ALPHA,
                                 GL_BLEND_COLOR,
                                 GL_CULL_FACE_MODE,
                                 GL_FRONT_FACE,
                                 GL_READ_BUFFER,
                                 GL_DRAW_BUFFER0};
constexpr std::array kDesktopQueries = {GL_SHADER_STORAGE_BUFFER_BINDING,
                                        GL_CLAMP_READ_COLOR,
                                        GL_POLYGON_MODE,
                                        GL_CLIP_ORIGIN,
                                        GL_CLIP_DEPTH_MODE,
                                        GL_PROVOKING_VERTEX};
constexpr std::array kImageQueries = {GL_IMAGE_BINDING_NAME,    GL_IMAGE_BINDING_LEVEL,
                                      GL_IMAGE_BINDING_LAYERED, GL_IMAGE_BINDING_LAYER,
                                      GL_IMAGE_BINDING_ACCESS,  GL_IMAGE_BINDING_FORMAT};

StateTest::State StateTest::state() const {
  State state;
  const auto get = [&](int name) {
    std::vector<GLint64>& values = state[fmt::format("0x{:x}", name)];
    values.assign(4, 0);
    glGetInteger64v(static_cast<GLenum>(name), values.data());
  };
  const auto get_all = [&](const auto& names) {
    for (const auto name : names)
      get(static_cast<int>(name));
  };
  get_all(kPixelStore);
  get_all(kQueries);
  for (const auto name : kEnables)
    state[fmt::format("enable 0x{:x}", static_cast<int>(name))] = {glIsEnabled(static_cast<GLenum>(name))};
  for (GLuint buffer = 0; buffer < 4; ++buffer) {
    std::array<GLboolean, 4> mask = {};
    glGetBooleani_v(GL_COLOR_WRITEMASK, buffer, mask.data());
    state[fmt::format("colour mask {}", buffer)] = {mask[0], mask[1], mask[2], mask[3],
                                                    glIsEnabledi(GL_BLEND, buffer)};
  }
  GLint storage = 0;
  glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, 0, &storage);
  std::array<GLint64, 2> part = {};
  glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, 0, &part[0]);
  glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, 0, &part[1]);
  state["storage buffer 0"] = {storage, part[0], part[1]};
  for (const auto name : kImageQueries) {
    GLint value = 0;
    glGetIntegeri_v(static_cast<GLenum>(name), 0, &value);
    state[fmt::format("image 0x{:x}", static_cast<int>(name))] = {value};
  }
  if (desktop()) {
    get_all(kDesktopPixelStore);
    get_all(kDesktopQueries);
    for (const auto name : kDesktopEnables)
      state[fmt::format("enable 0x{:x}", static_cast<int>(name))] = {glIsEnabled(static_cast<GLenum>(name))};
    for (GLuint viewport = 0; viewport < 2; ++viewport) {
      std::array<GLint, 4> box = {};
      glGetIntegeri_v(GL_SCISSOR_BOX, viewport, box.data());
      state[fmt::format("scissor {}", viewport)] = {box[0], box[1], box[2], box[3],
                                                    glIsEnabledi(GL_SCISSOR_TEST, viewport)};
      std::array<GLfloat, 4> place = {};
      glGetFloati_v(GL_VIEWPORT, viewport, place.data());
      state[fmt::format("viewport {}", viewport)] = {static_cast<GLint64>(place[0]),
                                                     static_cast<GLint64>(place[2])};
    }
  }
  GLint active = 0;
  glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
  for (GLenum unit = 0; unit < 4; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    for (const auto name : {GL_TEXTURE_BINDING_2D, GL_TEXTURE_BINDING_CUBE_MAP, GL_SAMPLER_BINDING}) {
      GLint value = 0;
      glGetIntegerv(static_cast<GLenum>(name), &value);
      state[fmt::format("unit {} 0x{:x}", unit, static_cast<int>(name))] = {value};
    }
  }
  glActiveTexture(static_cast<GLenum>(active));
  return state;
}

Texture made_texture(GLenum format, Extent extent) {
  Texture texture = Texture::create();
  texture_storage(texture.get(), 1, format, extent);
  return texture;
}

void StateTest::make_unusual() {
  unlinked_ = Program::create();
  for (int i = 0; i < 4; ++i) {
    textures_.push_back(made_texture(GL_RGBA8, {8, 8}));
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
    glBindTexture(GL_TEXTURE_2D, textures_.back().get());
    GLuint sampler = 0;
    glGenSamplers(1, &sampler);  // lives as long as the context
    glBindSampler(static_cast<GLuint>(i), sampler);
  }
  glActiveTexture(GL_TEXTURE2);
  glBindImageTexture(0, textures_[3].get(), 0, GL_FALSE, 0, GL_READ_ONLY, GL_RGBA8);
  for (int i = 0; i < 2; ++i) {
    framebuffers_.push_back(Framebuffer::create());
    attach(framebuffers_.back().get(), GL_COLOR_ATTACHMENT1, textures_[static_cast<std::size_t>(i)].get());
    draw_buffers(framebuffers_.back().get(), {GL_NONE, GL_COLOR_ATTACHMENT1});
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers_[0].get());
  glReadBuffer(GL_COLOR_ATTACHMENT1);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffers_[1].get());
  for (const auto target : kBuffers) {
    buffers_.push_back(Buffer::create());
    glBindBuffer(static_cast<GLenum>(target), buffers_.back().get());
    glBufferData(static_cast<GLenum>(target), 64, nullptr, GL_STATIC_DRAW);
  }
  buffers_.push_back(Buffer::create());
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers_.back().get());
  glBufferData(GL_SHADER_STORAGE_BUFFER, 1024, nullptr, GL_STATIC_DRAW);
  glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 0, buffers_.back().get(), 256, 64);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers_.front().get());
  vertices_ = VertexArray::create();
  glBindVertexArray(vertices_.get());
  const char* source = "#version 310 es\nlayout(local_size_x = 1) in;\nvoid main() {}";
  program_ = Program::adopt(glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &source));
  glUseProgram(program_.get());

  GLint value = 1;
  for (const auto name : kPixelStore) {
    const bool is_alignment = name == GL_PACK_ALIGNMENT || name == GL_UNPACK_ALIGNMENT;
    glPixelStorei(static_cast<GLenum>(name), is_alignment ? 8 : value++);
  }
  for (const auto name : kEnables)
    name == GL_DITHER ? glDisable(GL_DITHER) : glEnable(static_cast<GLenum>(name));
  glViewport(3, 4, 5, 6);
  glScissor(1, 2, 3, 4);
  for (GLuint buffer = 0; buffer < 4; ++buffer)
    glColorMaski(buffer, GL_FALSE, buffer % 2 == 0, GL_FALSE, buffer % 2 == 1);
  glDepthMask(GL_FALSE);
  glDepthFunc(GL_NOTEQUAL);
  glDepthRangef(0.25f, 0.75f);
  glStencilMask(0x35);
  glStencilFunc(GL_NEVER, 3, 0x0f);
  glClearColor(0, 1, 0, 1);
  glClearDepthf(0.5f);
  glClearStencil(7);
  glBlendFuncSeparate(GL_DST_COLOR, GL_ONE, GL_ZERO, GL_SRC_ALPHA);
  glBlendEquation(GL_FUNC_REVERSE_SUBTRACT);
  glCullFace(GL_FRONT);
  glFrontFace(GL_CW);
  if (!desktop()) return;
  for (const auto name : kDesktopPixelStore)
    glPixelStorei(static_cast<GLenum>(name), 1);
  for (const auto name : kDesktopEnables)
    glEnable(static_cast<GLenum>(name));
  glScissorIndexed(1, 5, 6, 7, 8);
  glDisablei(GL_SCISSOR_TEST, 1);
  glViewportIndexedf(1, 9, 9, 9, 9);
  glClampColor(GL_CLAMP_READ_COLOR, GL_TRUE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
}

TEST_P(StateTest, EveryCallPutsItBackAndFramesArrive) {
  const Way& way = GetParam();
  std::unique_ptr<PretendSharing> driver;
  if (way.shared) {
    driver = std::make_unique<PretendSharing>(false);
    device_ = std::make_unique<Device>(open_device(*context_, "", Interop::kGl).value());
  }
  std::unique_ptr<PretendImports> imports;
  if (way.external) {
    if (!has_vulkan()) QUINCUNX_SKIP("Vulkan has no device that is OpenGL's");
    if (device_->info().kind == DeviceKind::kCpu) imports = std::make_unique<PretendImports>();
    device_ = std::make_unique<Device>(open_device(*context_, "", Interop::kExternal).value());
  }
  BridgeSettings settings = all_planes(kTarget, kOutput);
  settings.interop = way.shared ? Interop::kGl : way.external ? Interop::kExternal : Interop::kCopy;
  settings.imports = way.imports;
  settings.targets = way.placed ? Targets::kPlaced : Targets::kViewport;
  settings.checkerboard = way.placed;

  const Bytes drawn = finite_texels(settings.colour, kTarget, 3);
  const Bytes picture = random_texels(PixelFormat::kRGBA8, kOutput, 4);
  const Texture colour = made_texture(GL_RGBA16F, kTarget);
  const Texture depth = made_texture(GL_DEPTH_COMPONENT32F, kTarget);
  const Texture velocity = made_texture(GL_RG16F, kTarget);
  const Texture reactive = made_texture(GL_R8, kTarget);
  const Texture result = made_texture(GL_RGBA8, kOutput);
  texture_write(colour.get(), 0, kTarget, GL_RGBA, GL_HALF_FLOAT, drawn.data());
  make_unusual();
  ASSERT_EQ(glGetError(), GLenum{GL_NO_ERROR});

  std::unique_ptr<Bridge> bridge;
  keeps("create", [&] {
    auto made = Bridge::create(*context_, *device_, settings);
    ASSERT_TRUE(made.ok()) << made.status().message();
    bridge = std::move(made).value();
  });
  ASSERT_NE(bridge, nullptr);
  for (int frame = 0; frame < 5; ++frame) {
    const int slot = frame % bridge->slots();
    const Extent render = {kRender.width - frame, kRender.height};
    SharedFrame views;
    if (way.imports) {
      keeps("import", [&] {
        auto imported = bridge->import({colour.get(), depth.get(), velocity.get(), reactive.get()}, render);
        ASSERT_TRUE(imported.ok()) << imported.status().message();
        views = imported.value();
      });
    } else {
      const RenderTargets* targets = nullptr;
      keeps("begin_draw", [&] { targets = bridge->begin_draw(slot, render).value(); });
      keeps("clear", [&] { targets->clear(render); });
      keeps("submit", [&] { ASSERT_TRUE(bridge->submit(slot).ok()); });
      keeps("acquire", [&] { views = bridge->acquire(slot).value(); });
    }
    if (!way.shared) {
      const Bytes expected =
          way.imports ? crop(drawn, kTarget, render, 8) : Bytes(static_cast<std::size_t>(render.area()) * 8);
      EXPECT_TRUE(download(views.colour, render) == expected) << frame;
    }
    ImageView view;
    keeps("begin_present", [&] { view = bridge->begin_present().value(); });
    if (!way.shared) upload(view, picture);
    keeps("present", [&] { ASSERT_TRUE(bridge->present(frame % 2 == 0 ? 0 : result.get()).ok()); });
    keeps("presented_pixels", [&] {
      const std::uint8_t* pixels = bridge->presented_pixels();
      if (!way.shared) {
        EXPECT_TRUE(Bytes(pixels, pixels + picture.size()) == picture);
      }
    });
  }
  bridge.reset();
}

// The calls that no bridge makes.
class CallStateTest : public StateTest {};

TEST_P(CallStateTest, TargetsTimersAndCallsByNamePutItBack) {
  make_unusual();
  ASSERT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  std::optional<RenderTargets> targets;
  keeps("RenderTargets::create",
        [&] { targets = RenderTargets::create({.target_extent = kTarget, .checkerboard = true}).value(); });
  keeps("clear", [&] { targets->clear(kRender); });
  keeps("read_targets", [&] { EXPECT_EQ(read_targets(*targets, kRender)->depth.front(), 0); });

  const Texture texture = Texture::create();
  const std::array<std::uint8_t, 16> texels = {9};
  keeps("texture_storage", [&] { texture_storage(texture.get(), 2, GL_RGBA8, {2, 2}); });
  keeps("texture_parameter",
        [&] { texture_parameter(texture.get(), GL_TEXTURE_MIN_FILTER, GLint{GL_NEAREST}); });
  keeps("texture_parameter", [&] { texture_parameter(texture.get(), GL_TEXTURE_MIN_LOD, 0.5f); });
  keeps("texture_border", [&] { texture_border(texture.get(), std::array<GLfloat, 4>{}.data()); });
  keeps("texture_mipmaps", [&] { texture_mipmaps(texture.get()); });
  const Buffer buffer = Buffer::create();
  keeps("buffer_storage", [&] { buffer_storage(buffer.get(), 16); });
  keeps("buffer_write", [&] { buffer_write(buffer.get(), 0, 16, texels.data()); });
  const Framebuffer framebuffer = Framebuffer::create();
  keeps("attach", [&] { attach(framebuffer.get(), GL_COLOR_ATTACHMENT0, texture.get()); });
  keeps("draw_buffers", [&] { draw_buffers(framebuffer.get(), {GL_COLOR_ATTACHMENT0}); });
  keeps("framebuffer_status", [&] { EXPECT_NE(framebuffer_status(framebuffer.get()), GLenum{0}); });
  keeps("clear", [&] { clear(framebuffer.get(), GL_COLOR, 0, std::array<GLfloat, 4>{}.data()); });

  std::optional<FrameTimer> frames;
  keeps("FrameTimer::create", [&] { frames = FrameTimer::create().value(); });
  keeps("FrameTimer", [&] {
    frames->begin(1, kRender);
    frames->end();
    glFinish();
    EXPECT_TRUE(frames->poll().has_value());
  });
  for (const TimerMethod method : {TimerMethod::kQuery, TimerMethod::kFence}) {
    if (method == TimerMethod::kQuery && !capabilities().time_queries) continue;
    keeps("PartTimer", [&] {
      PartTimer parts = PartTimer::create(method).value();
      parts.begin(1, kRender);
      parts.end();
      glFinish();
      EXPECT_TRUE(parts.poll().has_value());
    });
  }
  keeps("Context::create", [&] { EXPECT_TRUE(Context::create(Platform::kCurrent).ok()); });
}

// While a query of the caller's is active none can be tried, and none may be ended.
TEST_P(CallStateTest, AnActiveQueryStaysActive) {
  if (!capabilities().time_queries) QUINCUNX_SKIP("a context without queries of time");
  const TimeQuery query = TimeQuery::create();
  glBeginQuery(GL_TIME_ELAPSED, query.get());
  EXPECT_EQ(FrameTimer::create().value().method(), TimerMethod::kFence);
  GLint active = 0;
  glGetQueryiv(GL_TIME_ELAPSED, GL_CURRENT_QUERY, &active);
  EXPECT_EQ(static_cast<GLuint>(active), query.get());
  glEndQuery(GL_TIME_ELAPSED);
}

std::string name_of_case(const ::testing::TestParamInfo<Way>& entry) {
  return entry.param.name;
}

INSTANTIATE_TEST_SUITE_P(All, StateTest, ::testing::ValuesIn(kWays), name_of_case);
INSTANTIATE_TEST_SUITE_P(Each, CallStateTest, ::testing::Values(Way{"Gl"}, Way{"Es", Api::kEs3}),
                         name_of_case);

}  // namespace
}  // namespace quincunx::gl::testing

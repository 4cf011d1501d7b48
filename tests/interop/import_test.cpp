// SPDX-License-Identifier: MIT
// Textures of the caller's: they arrive in OpenCL as they are, by each backend; what cannot be taken is refused in
// words; the picture comes back in a texture of the caller's.
#include <algorithm>
#include <cstring>

#include "cl_interposer.h"
#include "gl_call_counter.h"
#include "interop_fixture.h"
#include "quincunx/resolve_service.h"
#include "state_scope.h"

namespace quincunx::gl::testing {
namespace {

constexpr Extent kTarget = {61, 43};
constexpr Extent kOutput = {52, 38};

enum class Way { kCopy, kShared, kEs };

class ImportTest : public InteropTest, public ::testing::WithParamInterface<Way> {
 protected:
  Api api() const override { return GetParam() == Way::kEs ? Api::kEs3 : Api::kGl45; }

  void SetUp() override {
    InteropTest::SetUp();
    if (GetParam() != Way::kShared) return;
    driver_ = std::make_unique<PretendSharing>(false);
    device_ = std::make_unique<Device>(open_device(*context_, "", Interop::kGl).value());
  }

  void TearDown() override {
    device_.reset();
    driver_.reset();
    InteropTest::TearDown();
  }

  std::unique_ptr<Bridge> make(BridgeSettings settings) {
    settings.imports = true;
    settings.interop = GetParam() == Way::kShared ? Interop::kGl : Interop::kCopy;
    auto bridge = Bridge::create(*context_, *device_, settings);
    EXPECT_TRUE(bridge.ok()) << bridge.status().message();
    return bridge.ok() ? std::move(bridge).value() : nullptr;
  }

  void write_view(const ImageView& view, const Bytes& texels) {
    if (view.storage == Storage::kBuffer) return upload(view, texels);
    const std::array<std::size_t, 3> origin = {0, 0, 0};
    const std::array<std::size_t, 3> region = {static_cast<std::size_t>(view.extent.width),
                                               static_cast<std::size_t>(view.extent.height), 1};
    EXPECT_EQ(clEnqueueWriteImage(device_->queue(), view.memory, CL_TRUE, origin.data(), region.data(), 0, 0,
                                  texels.data(), 0, nullptr, nullptr),
              CL_SUCCESS);
  }

 private:
  std::unique_ptr<PretendSharing> driver_;
};

// A texture as engines make them: mutable, and with GL's own filters, which ask for levels that are not there.
Texture make_texture(GLenum internal, GLenum format, GLenum type, Extent extent, const void* texels) {
  Texture texture = Texture::create();
  glBindTexture(GL_TEXTURE_2D, texture.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal), extent.width, extent.height, 0, format, type,
               texels);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glBindTexture(GL_TEXTURE_2D, 0);
  return texture;
}

Texture make_texture(PixelFormat format, Extent extent, std::uint32_t seed) {
  const GlFormat names = gl_format(format);
  return make_texture(names.internal, names.format, names.type, extent,
                      finite_texels(format, extent, seed).data());
}

// Depth from [0, 1] without denormals, which a shader may flush.
std::vector<float> depths(Extent extent, std::uint32_t seed) {
  std::vector<float> values(static_cast<std::size_t>(extent.area()));
  std::uint32_t state = seed;
  for (float& value : values)
    value = static_cast<float>(next_random(state) >> 8) / static_cast<float>((1 << 24) - 1);
  values.front() = 1;
  values.back() = 0;
  return values;
}

struct Textures {
  Textures(const BridgeSettings& settings, Extent extent, std::uint32_t seed)
      : colour(make_texture(settings.colour, extent, seed)),
        depth(make_texture(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, extent,
                           depths(extent, seed).data())),
        velocity(make_texture(settings.velocity_format, extent, seed + 1)),
        reactive(make_texture(PixelFormat::kR8, extent, seed + 2)) {}

  FrameTextures names() const { return {colour.get(), depth.get(), velocity.get(), reactive.get()}; }

  Texture colour, depth, velocity, reactive;
};

Bytes crop_of(PixelFormat format, Extent extent, Extent render, std::uint32_t seed) {
  return crop(finite_texels(format, extent, seed), extent, render, bytes_per_pixel(format));
}

Bytes crop_of_depth(Extent extent, Extent render, std::uint32_t seed) {
  const std::vector<float> values = depths(extent, seed);
  const auto* start = reinterpret_cast<const std::uint8_t*>(values.data());
  return crop({start, start + 4 * values.size()}, extent, render, 4);
}

// The same textures every frame, larger than the bridge needs them, with another viewport each time. The frame before
// stays readable.
TEST_P(ImportTest, EveryFormatArrivesAndHistoryStays) {
  using enum PixelFormat;
  for (const auto& formats : {std::pair{kRGBA16F, kRG16F}, {kRGBA32F, kRG32F}, {kRGBA8, kRG16F}}) {
    const PixelFormat colour = formats.first;
    const PixelFormat velocity = formats.second;
    BridgeSettings settings = all_planes(kTarget, kOutput, colour);
    settings.velocity_format = velocity;
    const auto bridge = make(settings);
    ASSERT_NE(bridge, nullptr);
    constexpr Extent kAllocated = {70, 50};
    SharedFrame before;
    for (std::uint32_t frame = 1; frame <= 7; ++frame) {
      const Textures textures(settings, kAllocated, 10 * frame);
      const auto side = static_cast<int>(frame);
      const Extent render =
          frame == 4 ? Extent{1, 1} : Extent{kTarget.width - 3 * (side % 3), kTarget.height - side};
      auto imported = bridge->import(textures.names(), render);
      ASSERT_TRUE(imported.ok()) << imported.status().message();
      const auto expect = [&](const SharedFrame& views, std::uint32_t number, Extent part) {
        EXPECT_TRUE(bytes_in(views.colour, part) == crop_of(colour, kAllocated, part, 10 * number)) << number;
        EXPECT_TRUE(bytes_in(views.depth, part) == crop_of_depth(kAllocated, part, 10 * number)) << number;
        EXPECT_TRUE(bytes_in(views.velocity, part) == crop_of(velocity, kAllocated, part, 10 * number + 1))
            << number;
        EXPECT_TRUE(bytes_in(views.reactive, part) == crop_of(kR8, kAllocated, part, 10 * number + 2))
            << number;
      };
      EXPECT_EQ(imported->colour.format, colour);
      EXPECT_EQ(imported->velocity.format, velocity);
      expect(imported.value(), frame, render);
      if (frame > 1) expect(before, frame - 1, {1, 1});
      before = imported.value();
    }
  }
}

TEST_P(ImportTest, EveryFormatOfDepthArrives) {
  constexpr Extent kSize = {17, 9};
  BridgeSettings settings = {.target_extent = kSize, .output_extent = kOutput, .depth = true};
  const auto bridge = make(settings);
  ASSERT_NE(bridge, nullptr);
  const Texture colour = make_texture(PixelFormat::kRGBA16F, kSize, 1);
  std::vector<std::uint32_t> packed(static_cast<std::size_t>(kSize.area()));
  std::vector<float> expected(packed.size());
  for (std::size_t i = 0; i < packed.size(); ++i) {
    const auto code = static_cast<std::uint32_t>(i * 99991 % (1 << 24));
    packed[i] = code << 8 | 0x5a;  // with stencil
    expected[i] = static_cast<float>(code / static_cast<double>((1 << 24) - 1));
  }
  struct Case {
    GLenum internal, format, type;
    const void* texels;
    float tolerance;  // of a code of 24 bits
  };
  const std::array cases = {
      Case{GL_R32F, GL_RED, GL_FLOAT, expected.data(), 0},
      Case{GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, expected.data(), 0},
      Case{GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, packed.data(), 0x1p-24f}};
  for (const Case& c : cases) {
    const Texture depth = make_texture(c.internal, c.format, c.type, kSize, c.texels);
    bridge->textures_changed();  // the name may be that of the texture before
    const auto frame = bridge->import({.colour = colour.get(), .depth = depth.get()}, kSize);
    ASSERT_TRUE(frame.ok()) << frame.status().message();
    const Bytes bytes = bytes_in(frame->depth, kSize);
    std::vector<float> seen(expected.size());
    std::memcpy(seen.data(), bytes.data(), bytes.size());
    for (std::size_t i = 0; i < seen.size(); ++i)
      ASSERT_NEAR(seen[i], expected[i], c.tolerance) << i << " of format 0x" << std::hex << c.internal;
  }
}

// Counts the calls that ask OpenGL, those about textures apart.
class Questions {
 public:
  Questions() = default;
  int about_textures() const {
    return levels_.count() + parameters_.count() + direct_.count() + names_.count() + errors_.count();
  }
  int about_state() const {
    return integers_.count() + indexed_.count() + booleans_.count() + enabled_.count();
  }

  // libepoxy fills its pointers in at the first call.
  static void warm_up(bool desktop) {
    GLint value = 0;
    GLboolean flag = GL_FALSE;
    const Texture texture = Texture::create();
    const BindingScope bound = BindingScope::texture(texture.get());
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &value);
    glGetTexParameteriv(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, &value);
    if (desktop) glGetTextureParameteriv(texture.get(), GL_TEXTURE_MIN_FILTER, &value);
    glIsTexture(texture.get());
    glGetIntegeri_v(GL_IMAGE_BINDING_NAME, 0, &value);
    glGetBooleani_v(GL_IMAGE_BINDING_LAYERED, 0, &flag);
    glIsEnabled(GL_BLEND);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  }

 private:
  CallCounter<&epoxy_glGetTexLevelParameteriv> levels_;
  CallCounter<&epoxy_glGetTexParameteriv> parameters_;
  CallCounter<&epoxy_glGetTextureParameteriv> direct_;
  CallCounter<&epoxy_glIsTexture> names_;
  CallCounter<&epoxy_glGetError> errors_;
  CallCounter<&epoxy_glGetIntegerv> integers_;
  CallCounter<&epoxy_glGetIntegeri_v> indexed_;
  CallCounter<&epoxy_glGetBooleani_v> booleans_;
  CallCounter<&epoxy_glIsEnabled> enabled_;
};

TEST_P(ImportTest, ASteadyFrameAsksNothingAboutTextures) {
  for (const bool restores : {true, false}) {
    BridgeSettings settings = all_planes(kTarget, kOutput);
    settings.restores_state = restores;
    const auto bridge = make(settings);
    ASSERT_NE(bridge, nullptr);
    const Textures textures(settings, kTarget, 1);
    const Texture result = make_texture(PixelFormat::kRGBA8, kOutput, 2);
    const auto carry = [&] {
      EXPECT_TRUE(bridge->import(textures.names(), kTarget).ok());
      EXPECT_TRUE(bridge->begin_present().ok());
      EXPECT_TRUE(bridge->present(result.get()).ok());
    };
    carry();
    Questions::warm_up(api() == Api::kGl45);
    int about_textures = 0, about_state = 0;
    {
      const Questions asked;
      for (int frame = 0; frame < 4; ++frame)
        carry();
      about_textures = asked.about_textures();
      about_state = asked.about_state();
    }
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    EXPECT_EQ(about_textures, 0);
    if (GetParam() == Way::kCopy) {
      EXPECT_EQ(about_state, restores ? 4 * 14 : 0) << "5 of the pixel store and 3 more, 5 and 1 more";
    } else if (GetParam() == Way::kEs) {
      EXPECT_LE(about_state, restores ? 4 * 24 : 4);
    }
    bridge->textures_changed();
    const Questions again;
    EXPECT_TRUE(bridge->import(textures.names(), kTarget).ok());
    EXPECT_GT(again.about_textures(), 0);
  }
}

// A texture that has grown is noticed, as it seems too small; another format has to be told.
TEST_P(ImportTest, ATextureThatChangedIsAskedAboutAnew) {
  BridgeSettings settings = {.target_extent = kTarget, .output_extent = kOutput, .depth = true};
  const auto bridge = make(settings);
  ASSERT_NE(bridge, nullptr);
  const auto respecify = [](const Texture& texture, GLenum internal, GLenum format, Extent extent,
                            const void* texels) {
    const BindingScope bound = BindingScope::texture(texture.get());
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internal), extent.width, extent.height, 0, format,
                 GL_FLOAT, texels);
  };
  constexpr Extent kSmall = {20, 10};
  const Texture colour = make_texture(PixelFormat::kRGBA16F, kTarget, 1);
  const Texture depth = make_texture(GL_R32F, GL_RED, GL_FLOAT, kSmall, depths(kSmall, 3).data());
  const FrameTextures textures = {.colour = colour.get(), .depth = depth.get()};
  ASSERT_TRUE(bridge->import(textures, kSmall).ok());
  EXPECT_FALSE(bridge->import(textures, kTarget).ok());
  respecify(depth, GL_R32F, GL_RED, kTarget, depths(kTarget, 4).data());
  auto frame = bridge->import(textures, kTarget);
  ASSERT_TRUE(frame.ok()) << frame.status().message();
  EXPECT_TRUE(bytes_in(frame->depth, kTarget) == crop_of_depth(kTarget, kTarget, 4));
  respecify(depth, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, kTarget, depths(kTarget, 5).data());
  bridge->textures_changed();
  frame = bridge->import(textures, kTarget);
  ASSERT_TRUE(frame.ok()) << frame.status().message();
  EXPECT_TRUE(bytes_in(frame->depth, kTarget) == crop_of_depth(kTarget, kTarget, 5));
}

TEST_P(ImportTest, WhatCannotBeTakenIsNamed) {
  const BridgeSettings settings = all_planes(kTarget, kOutput);
  const auto bridge = make(settings);
  ASSERT_NE(bridge, nullptr);
  const Textures good(settings, kTarget, 1);
  const auto message = [&](const FrameTextures& textures, Extent render = kTarget) {
    const auto frame = bridge->import(textures, render);
    EXPECT_EQ(frame.status().code(), StatusCode::kInvalidArgument);
    return frame.status().message();
  };
  const auto with = [&](GLuint FrameTextures::*plane, GLuint name) {
    FrameTextures textures = good.names();
    textures.*plane = name;
    return textures;
  };
  EXPECT_EQ(message({}),
            "FrameTextures: colour is 0 and must be a texture of RGBA16F; depth is 0 and must be a texture "
            "of R32F or a "
            "depth format; velocity is 0 and must be a texture of RG16F; reactive is 0 and must be a texture "
            "of R8");
  EXPECT_EQ(message(with(&FrameTextures::depth, 4711)),
            "FrameTextures: depth is 4711, which is no texture of this context");
  EXPECT_EQ(message(with(&FrameTextures::colour, good.velocity.get())),
            "FrameTextures: colour holds R16G16F and must hold RGBA16F");
  EXPECT_EQ(message(with(&FrameTextures::velocity, good.depth.get())),
            "FrameTextures: velocity holds 32-bit depth and must hold RG16F");
  EXPECT_EQ(message(with(&FrameTextures::depth, good.reactive.get())),
            "FrameTextures: depth holds R8 and must hold R32F or a depth format");
  const Textures small(settings, {kTarget.width, 20}, 1);
  EXPECT_EQ(message(with(&FrameTextures::reactive, small.reactive.get())),
            "FrameTextures: reactive has 61x20 texels, fewer than the viewport's 61x43");
  EXPECT_NE(message(good.names(), {kTarget.width + 1, 1}).find("62x1"), std::string::npos);
  const Texture whole = make_texture(GL_RGBA8UI, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE, kTarget, nullptr);
  EXPECT_EQ(message(with(&FrameTextures::colour, whole.get())),
            "FrameTextures: colour holds R8G8B8A8 of whole numbers and must hold RGBA16F");

  GLuint name = 0;
  glGenTextures(1, &name);
  const Texture samples = Texture::adopt(name);
  glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, name);
  glTexStorage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, 4, GL_RGBA16F, kTarget.width, kTarget.height, GL_TRUE);
  glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, 0);
  EXPECT_EQ(message(with(&FrameTextures::colour, samples.get())),
            "FrameTextures: colour is multisampled; blit it into a plain GL_TEXTURE_2D first");
  glGenTextures(1, &name);
  const Texture cube = Texture::adopt(name);
  glBindTexture(GL_TEXTURE_CUBE_MAP, name);
  glBindTexture(GL_TEXTURE_CUBE_MAP, 0);
  EXPECT_EQ(message(with(&FrameTextures::colour, cube.get())), "FrameTextures: colour is no GL_TEXTURE_2D");

  EXPECT_TRUE(bridge->import(good.names(), kTarget).ok()) << "a refusal leaves nothing behind";
  EXPECT_NE(bridge->begin_draw(0, kTarget).status().message().find("call import()"), std::string::npos);
}

TEST_P(ImportTest, ABridgeWithTargetsOfItsOwnImportsNothing) {
  const BridgeSettings settings = all_planes(kTarget, kOutput);
  auto bridge = Bridge::create(*context_, *device_, settings);
  ASSERT_TRUE(bridge.ok()) << bridge.status().message();
  const Textures good(settings, kTarget, 1);
  const Status status = bridge.value()->import(good.names(), kTarget).status();
  EXPECT_NE(status.message().find("create it with imports"), std::string::npos) << status.message();
}

TEST_P(ImportTest, SettingsThatDoNotGoWithItAreNamed) {
  BridgeSettings settings = {
      .target_extent = kTarget, .output_extent = kOutput, .checkerboard = true, .imports = true};
  settings.colour = PixelFormat::kR8;
  settings.velocity_format = PixelFormat::kRGBA16F;
  settings.picture = PixelFormat::kR8;
  settings.targets = Targets::kPlaced;
  const auto bridge = Bridge::create(*context_, *device_, settings);
  EXPECT_EQ(bridge.status().message(),
            "BridgeSettings: colour is R8 and must be RGBA8, RGBA16F or RGBA32F; velocity_format is RGBA16F "
            "and must be "
            "RG16F or RG32F; checkerboard is set with imports, and is of the bridge's own targets; targets "
            "kPlaced is "
            "set with imports, and is of the bridge's own targets; picture is R8 and must be RGBA8, RGBA16F "
            "or RGBA32F");
}

// Reads a texture through a framebuffer, as OpenGL ES can.
Bytes texels_of(GLuint texture, PixelFormat format, Extent extent) {
  const GlFormat names = gl_format(format);
  const Framebuffer framebuffer = Framebuffer::create();
  attach(framebuffer.get(), GL_COLOR_ATTACHMENT0, texture);
  Bytes texels(static_cast<std::size_t>(extent.area()) * bytes_per_pixel(format));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  read_attachment(framebuffer.get(), GL_COLOR_ATTACHMENT0, extent, names.format, names.type, texels.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  return texels;
}

TEST_P(ImportTest, ThePictureComesBackInTheCallersTexture) {
  using enum PixelFormat;
  for (const auto& [format, internal] : {std::pair{kRGBA8, GL_RGBA8},
                                         {kRGBA8, GL_SRGB8_ALPHA8},
                                         {kRGBA16F, GL_RGBA16F},
                                         {kRGBA32F, GL_RGBA32F}}) {
    BridgeSettings settings = {.target_extent = kTarget, .output_extent = kOutput};
    settings.picture = format;
    const auto bridge = make(settings);
    ASSERT_NE(bridge, nullptr);
    constexpr Extent kLarger = {60, 40};
    const GlFormat names = gl_format(format);
    const Bytes poison = finite_texels(format, kLarger, 5);
    const Texture texture =
        make_texture(static_cast<GLenum>(internal), names.format, names.type, kLarger, poison.data());
    const Bytes picture = finite_texels(format, kOutput, 6);
    auto view = bridge->begin_present();
    ASSERT_TRUE(view.ok()) << view.status().message();
    EXPECT_EQ(view->format, format);
    if (format != kRGBA8) {
      EXPECT_EQ(view->storage, Storage::kBuffer);
    }
    write_view(view.value(), picture);
    const Status status = bridge->present(texture.get());
    ASSERT_TRUE(status.ok()) << status.message();
    const Bytes seen = texels_of(texture.get(), format, kLarger);
    const std::size_t texel = bytes_per_pixel(format);
    EXPECT_TRUE(crop(seen, kLarger, kOutput, texel) == picture);
    EXPECT_TRUE(overlay(seen, poison, kLarger, kOutput, texel) == poison) << "outside of the picture";

    // A texture that is wrong leaves the picture to be presented into another.
    ASSERT_TRUE(bridge->begin_present().ok());
    write_view(view.value(), picture);
    const Texture small = make_texture(format, {kOutput.width, 3}, 1);
    EXPECT_EQ(bridge->present(small.get()).message(),
              "present: the texture has 52x3 texels, fewer than the picture's 52x38");
    const Texture other = make_texture(kRG16F, kOutput, 1);
    EXPECT_NE(bridge->present(other.get()).message().find("holds R16G16F"), std::string::npos);
    ASSERT_TRUE(bridge->present().ok());
    EXPECT_TRUE(texels_of(bridge->presented_texture(), format, kOutput) == picture);
    const std::uint8_t* pixels = bridge->presented_pixels();
    EXPECT_TRUE(Bytes(pixels, pixels + picture.size()) == picture);
  }
}

// A texture whose lowest `rows` rows are turned about, as textures are where row 0 is the lowest.
Texture from_bottom(GLenum internal, GLenum format, GLenum type, Extent extent, int rows, Bytes texels) {
  const auto pitch = static_cast<std::ptrdiff_t>(texels.size() / static_cast<std::size_t>(extent.height));
  for (int y = 0; y < rows / 2; ++y) {
    const auto low = texels.begin() + y * pitch;
    std::swap_ranges(low, low + pitch, texels.begin() + (rows - 1 - y) * pitch);
  }
  return make_texture(internal, format, type, extent, texels.data());
}

// The pictures of three frames, each of another viewport of the same texels, whose rows begin where `origin` says.
std::vector<Bytes> pictures_from(Bridge& bridge, const Device& device, const ResolveSettings& resolve) {
  using enum PixelFormat;
  ResolveSettings settings = resolve;
  settings.targets.storage = bridge.storage();
  auto service = ResolveService::create(device, plan_for({}, settings).value()).value();
  std::vector<Bytes> pictures;
  for (int frame = 0; frame < 3; ++frame) {
    const Extent render = {kTarget.width - 7 * frame, 25 + 6 * frame};
    const bool bottom = settings.conventions.origin == Origin::kBottom;
    const int rows = bottom ? render.height : 0;
    const auto seed = static_cast<std::uint32_t>(10 * frame + 1);
    const auto plane = [&](PixelFormat format, std::uint32_t number) {
      const GlFormat names = gl_format(format);
      return from_bottom(names.internal, names.format, names.type, kTarget, rows,
                         finite_texels(format, kTarget, seed + number));
    };
    const std::vector<float> z = depths(kTarget, seed);
    Bytes depth_bytes(z.size() * sizeof(float));
    std::memcpy(depth_bytes.data(), z.data(), depth_bytes.size());
    const Texture colour = plane(kRGBA8, 0), velocity = plane(kRG16F, 1), reactive = plane(kR8, 2);
    const Texture depth = from_bottom(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, kTarget, rows,
                                      std::move(depth_bytes));
    const auto inputs =
        bridge.import({colour.get(), depth.get(), velocity.get(), reactive.get()}, render).value();
    const FrameReport report = service.dispatch({.colour = inputs.colour,
                                                 .depth = inputs.depth,
                                                 .velocity = inputs.velocity,
                                                 .reactive = inputs.reactive,
                                                 .render_extent = render,
                                                 .jitter = {0.25f, bottom ? -0.125f : 0.125f},
                                                 .velocity_scale = {0x1p-20f, 0x1p-20f}},
                                                {.presented = bridge.begin_present().value()});
    EXPECT_TRUE(report.ok()) << report.status.message();
    EXPECT_EQ(report.used_previous, frame > 0);
    EXPECT_TRUE(bridge.present().ok());
    const std::uint8_t* pixels = bridge.presented_pixels();
    pictures.emplace_back(pixels, pixels + static_cast<std::size_t>(kOutput.area()) * 4);
  }
  return pictures;
}

// The bridge carries rows as they lie, and the service knows which one is the first: textures and picture of OpenGL's
// own order need no flip.
TEST_P(ImportTest, RowsFromTheBottomGiveThePictureFromTheBottom) {
  BridgeSettings settings = all_planes(kTarget, kOutput, PixelFormat::kRGBA8);
  const auto bridge = make(settings);
  ASSERT_NE(bridge, nullptr);
  ResolveSettings resolve = {.output_extent = kOutput,
                             .target_extent = kTarget,
                             .colour = PixelFormat::kRGBA8,
                             .output = {.dither = false}};  // its pattern belongs to places
  const std::vector<Bytes> from_top = pictures_from(*bridge, *device_, resolve);
  resolve.conventions.origin = Origin::kBottom;
  const std::vector<Bytes> from_low = pictures_from(*bridge, *device_, resolve);
  const std::size_t pitch = static_cast<std::size_t>(kOutput.width) * 4;
  for (std::size_t frame = 0; frame < from_top.size(); ++frame) {
    Bytes turned;
    for (int y = kOutput.height - 1; y >= 0; --y) {
      const auto row = from_low[frame].begin() + static_cast<std::ptrdiff_t>(y * pitch);
      turned.insert(turned.end(), row, row + static_cast<std::ptrdiff_t>(pitch));
    }
    EXPECT_TRUE(turned == from_top[frame]) << frame;
    EXPECT_FALSE(turned == from_low[frame]) << frame;
  }
}

std::string name_of_case(const ::testing::TestParamInfo<Way>& entry) {
  return entry.param == Way::kCopy ? "Copy" : entry.param == Way::kShared ? "Shared" : "Es";
}

INSTANTIATE_TEST_SUITE_P(All, ImportTest, ::testing::Values(Way::kCopy, Way::kShared, Way::kEs),
                         name_of_case);

TEST(BridgeSettingsOfAPlan, HandOverWhatItsFramesNeed) {
  const ResolveSettings resolve = {.method = Method::kTemporal,
                                   .output_extent = kOutput,
                                   .target_extent = kTarget,
                                   .colour = PixelFormat::kRGBA32F,
                                   .velocity = PixelFormat::kRG32F};
  const BridgeSettings all = bridge_settings(plan_for({}, resolve).value());
  EXPECT_EQ(all.target_extent, kTarget);
  EXPECT_EQ(all.output_extent, kOutput);
  EXPECT_TRUE(all.depth && all.velocity && all.reactive);
  EXPECT_EQ(all.colour, PixelFormat::kRGBA32F);
  EXPECT_EQ(all.velocity_format, PixelFormat::kRG32F);
  const ResolveSettings one = {
      .method = Method::kBilinear, .output_extent = kOutput, .target_extent = kTarget};
  const BridgeSettings few = bridge_settings(plan_for({}, one).value());
  EXPECT_FALSE(few.depth || few.velocity || few.reactive);
}

}  // namespace
}  // namespace quincunx::gl::testing

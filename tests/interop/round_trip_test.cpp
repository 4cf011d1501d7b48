// SPDX-License-Identifier: MIT
// Targets arrive in OpenCL as GL holds them, bit for bit, and nothing but the viewport moves.
#include "cl_interposer.h"
#include "interop_fixture.h"
#include "quincunx/resolve_service.h"
#include "skip.h"

namespace quincunx::gl::testing {
namespace {

struct Case {
  const char* name;
  Extent target;
  Extent render;
};

constexpr std::array kCases = {
    Case{"smallest", {1, 1}, {1, 1}},
    Case{"one_pixel_of_many", {64, 48}, {1, 1}},
    Case{"odd_in_odd", {37, 29}, {7, 5}},
    Case{"whole_odd_target", {33, 17}, {33, 17}},
    Case{"one_column", {50, 40}, {1, 40}},
    Case{"one_row", {50, 40}, {50, 1}},
    Case{"as_many_rows_as_a_row_has_bytes", {128, 128}, {101, 128}},  // bytes of reactive values
    Case{"half_a_frame", {1280, 720}, {909, 511}},
    Case{"supersampled", {2560, 1440}, {1811, 1019}},
};

class RoundTripTest : public InteropTest {
 protected:
  virtual Bytes texels(PixelFormat format, Extent extent, std::uint32_t seed) const {
    return random_texels(format, extent, seed);
  }
  void expect_exact(const Case& c, Transfer transfer, PixelFormat colour = PixelFormat::kRGBA16F);
};

void RoundTripTest::expect_exact(const Case& c, Transfer transfer, PixelFormat colour) {
  const BridgeSettings settings = all_planes(c.target, {8, 8}, colour);
  HostCopy bridge(*device_, settings, "test", transfer);
  const std::vector<Plane> planes = planes_of(settings);

  // Twice in the same slot: the second time OpenCL's memory holds what must stay outside the viewport.
  for (const std::uint32_t seed : {11u, 12u}) {
    auto targets = bridge.begin_draw(0, c.render);
    ASSERT_TRUE(targets.ok()) << targets.status().message();
    for (const Plane& plane : planes) {
      fill_plane(*targets.value(), plane, texels(plane.format, c.target, seed));
    }
    ASSERT_TRUE(bridge.submit(0).ok());
    auto frame = bridge.acquire(0);
    ASSERT_TRUE(frame.ok()) << frame.status().message();
    for (const Plane& plane : planes) {
      const std::size_t texel = bytes_per_pixel(plane.format);
      const ImageView& view = view_of(frame.value(), plane.kind);
      EXPECT_EQ(view.extent, c.target);
      EXPECT_EQ(view.format, plane.format);
      EXPECT_EQ(view.offset % 16, 0u);
      EXPECT_EQ(view.pitch % 16, 0u);
      const Bytes drawn = texels(plane.format, c.target, seed);
      const Bytes poison = random_texels(plane.format, c.target, 99);
      const Bytes seen = download(view, c.target);
      EXPECT_TRUE(crop(seen, c.target, c.render, texel) == crop(drawn, c.target, c.render, texel))
          << c.name << ", plane " << static_cast<int>(plane.kind) << ", frame " << seed;
      if (seed == 12u) {
        EXPECT_TRUE(seen == overlay(poison, drawn, c.target, c.render, texel))
            << c.name << ", plane " << static_cast<int>(plane.kind) << " was touched outside the viewport";
      }
      upload(view, poison);
    }
    std::uint64_t bytes = 0;
    for (const Plane& plane : planes) {
      bytes += static_cast<std::uint64_t>(c.render.area()) * bytes_per_pixel(plane.format);
    }
    EXPECT_EQ(bridge.traffic().bytes_in, bytes);
  }
}

TEST_F(RoundTripTest, HostMemoryInPlace) {
  if (!device_->info().host_unified_memory) QUINCUNX_SKIP("this device's memory is not the host's");
  for (const Case& c : kCases)
    expect_exact(c, Transfer::kZeroCopy);
}

TEST_F(RoundTripTest, CopiedToTheDevice) {
  for (const Case& c : kCases)
    expect_exact(c, Transfer::kExplicit);
}

TEST_F(RoundTripTest, EncodedColour) {
  for (const Transfer transfer : transfers()) {
    for (const Case& c : kCases)
      expect_exact(c, transfer, PixelFormat::kRGBA8);
  }
}

TEST_F(RoundTripTest, PlanesThatWereNotAskedForAreEmpty) {
  auto bridge = Bridge::create(*context_, *device_, {.target_extent = {16, 16}, .output_extent = {16, 16}});
  ASSERT_TRUE(bridge.ok()) << bridge.status().message();
  auto targets = bridge.value()->begin_draw(0, {16, 16});
  ASSERT_TRUE(targets.ok());
  EXPECT_EQ(targets.value()->velocity(), 0u);
  EXPECT_EQ(targets.value()->reactive(), 0u);
  targets.value()->clear({16, 16});
  ASSERT_TRUE(bridge.value()->submit(0).ok());
  auto frame = bridge.value()->acquire(0);
  ASSERT_TRUE(frame.ok());
  EXPECT_TRUE(frame->colour);
  EXPECT_FALSE(frame->depth);
  EXPECT_FALSE(frame->velocity);
  EXPECT_FALSE(frame->reactive);
}

// OpenGL ES reads no depth: a shader carries it into R32F, and may flush what is smaller than the least normal number.
class EsRoundTripTest : public RoundTripTest {
 protected:
  Api api() const override { return Api::kEs3; }
  Bytes texels(PixelFormat format, Extent extent, std::uint32_t seed) const override {
    Bytes bytes = random_texels(format, extent, seed);
    for (std::size_t top = 3; format == PixelFormat::kR32F && top < bytes.size(); top += 4) {
      if (bytes[top] == 0 && bytes[top - 1] < 0x80) bytes[top] = 0x20;
    }
    return bytes;
  }
};

TEST_F(EsRoundTripTest, EveryBitOfEveryPlane) {
  for (const PixelFormat colour : {PixelFormat::kRGBA16F, PixelFormat::kRGBA8}) {
    for (const Transfer transfer : transfers()) {
      for (const Case& c : kCases)
        expect_exact(c, transfer, colour);
    }
  }
}

TEST_F(EsRoundTripTest, SharingIsRefusedWithItsReason) {
  BridgeSettings settings = all_planes({16, 16}, {8, 8});
  settings.interop = Interop::kGl;
  const auto bridge = Bridge::create(*context_, *device_, settings);
  ASSERT_FALSE(bridge.ok());
  EXPECT_NE(bridge.status().message().find("this is OpenGL ES"), std::string::npos)
      << bridge.status().message();
}

constexpr const char* kVertexSource = R"(#version 450 core
void main() {  // the upper left quarter of the viewport, as a person sees it
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(-1.0 + corner.x, corner.y, 0.25, 1.0);
}
)";
constexpr const char* kFragmentSource = R"(#version 450 core
layout(location = 0) out vec4 colour;
layout(location = 1) out vec2 velocity;
layout(location = 2) out float reactive;
void main() {
  colour = vec4(gl_FragCoord.xy, 3.0, 1.0);
  velocity = -gl_FragCoord.yx;
  reactive = 1.0;
}
)";

Program build(const char* vertex, const char* fragment) {
  Program program = Program::create();
  for (const auto& [stage, source] :
       {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment}}) {
    const GLuint shader = glCreateShader(static_cast<GLenum>(stage));
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    glAttachShader(program.get(), shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program.get());
  GLint linked = GL_FALSE;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
  EXPECT_EQ(linked, GL_TRUE);
  return program;
}

// A picture drawn by a shader: row 0 of OpenCL's view is the top of what was drawn.
TEST_F(RoundTripTest, DrawnPictureHasItsTopRowFirst) {
  constexpr Extent kTarget = {40, 30};
  constexpr Extent kRender = {20, 14};
  auto bridge = Bridge::create(*context_, *device_, all_planes(kTarget, {8, 8}));
  ASSERT_TRUE(bridge.ok()) << bridge.status().message();
  auto targets = bridge.value()->begin_draw(1, kRender);
  ASSERT_TRUE(targets.ok());
  const Program program = build(kVertexSource, kFragmentSource);
  const VertexArray vertices = VertexArray::create();
  glBindVertexArray(vertices.get());
  glUseProgram(program.get());
  glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glBindFramebuffer(GL_FRAMEBUFFER, targets.value()->framebuffer());
  glViewport(0, 0, kRender.width, kRender.height);
  targets.value()->clear(kRender);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  ASSERT_TRUE(bridge.value()->submit(1).ok());
  auto frame = bridge.value()->acquire(1);
  ASSERT_TRUE(frame.ok());

  const Bytes depth = download(frame->depth, kRender);
  const Bytes reactive = download(frame->reactive, kRender);
  const Bytes colour = download(frame->colour, kRender);
  for (int y = 0; y < kRender.height; ++y) {
    for (int x = 0; x < kRender.width; ++x) {
      const bool covered = x < kRender.width / 2 && y < kRender.height / 2;
      const std::size_t at = static_cast<std::size_t>(y) * kRender.width + x;
      EXPECT_EQ(reactive[at], covered ? 255 : 0) << x << ", " << y;
      EXPECT_EQ(depth[4 * at + 3], covered ? 0x3e : 0) << x << ", " << y;   // the top byte of 0.25f
      EXPECT_EQ(colour[8 * at + 5], covered ? 0x42 : 0) << x << ", " << y;  // the top byte of half 3
    }
  }
  // Halves of (0.5, 0.5) at the top left, of (0.5, 1.5) one row below.
  EXPECT_EQ(colour[1], 0x38);
  EXPECT_EQ(colour[3], 0x38);
  EXPECT_EQ(colour[8 * kRender.width + 1], 0x38);
  EXPECT_EQ(colour[8 * kRender.width + 3], 0x3e);
}

// A device whose memory is not the host's: the bridge that Bridge::create() makes for it carries whole frames to the
// service and back, with the bits of a device that shares the host's memory.

constexpr Extent kTarget = {96, 80};
constexpr Extent kOutput = {64, 48};
constexpr int kFrames = 8;

class SeparateMemory : public InteropTest {
 protected:
  // The picture of each frame of a run over all slots, every frame with another viewport.
  std::vector<Bytes> pictures(const Device& device) const {
    BridgeSettings settings = all_planes(kTarget, kOutput);
    settings.interop = Interop::kCopy;
    auto bridge = Bridge::create(*context_, device, settings);
    const ResolvePlan plan =
        plan_for({}, {.method = Method::kQuincunx, .output_extent = kOutput, .target_extent = kTarget})
            .value();
    auto service = ResolveService::create(device, plan);
    EXPECT_TRUE(bridge.ok()) << bridge.status().message();
    EXPECT_TRUE(service.ok()) << service.status().message();
    std::vector<Bytes> made;
    for (int frame = 0; frame < kFrames; ++frame)
      made.push_back(picture(*bridge.value(), service.value(), settings, frame));
    return made;
  }

 private:
  static Bytes picture(Bridge& bridge, ResolveService& service, const BridgeSettings& settings, int frame) {
    const int slot = frame % bridge.slots();
    const Extent render = {kTarget.width - 5 * frame, 20 + 7 * frame};
    auto targets = bridge.begin_draw(slot, render);
    EXPECT_TRUE(targets.ok()) << targets.status().message();
    for (const Plane& plane : planes_of(settings)) {
      const auto seed = static_cast<std::uint32_t>(10 * frame + static_cast<int>(plane.kind));
      fill_plane(*targets.value(), plane, finite_texels(plane.format, kTarget, seed));
    }
    EXPECT_TRUE(bridge.submit(slot).ok());
    const auto inputs = bridge.acquire(slot);
    EXPECT_TRUE(inputs.ok()) << inputs.status().message();
    const auto presented = bridge.begin_present();
    EXPECT_TRUE(presented.ok()) << presented.status().message();
    const FrameReport report = service.dispatch(inputs_of(*inputs, render), {.presented = presented.value()});
    EXPECT_TRUE(report.ok()) << report.status.message();
    EXPECT_EQ(report.used_previous, frame > 0);
    EXPECT_TRUE(bridge.present().ok());
    const std::uint8_t* pixels = bridge.presented_pixels();
    return {pixels, pixels + static_cast<std::size_t>(kOutput.area()) * bytes_per_pixel(PixelFormat::kRGBA8)};
  }
};

TEST_F(SeparateMemory, WholeFramesHaveTheSameBits) {
  if (!device_->info().host_unified_memory) QUINCUNX_SKIP("this device's memory is not the host's");
  cl_counts() = {};
  const std::vector<Bytes> expected = pictures(*device_);
  EXPECT_GT(cl_counts().maps, kFrames) << "in place: buffers change owner";

  const PretendSeparateMemory pretend;
  auto separate = open_device(*context_, "", Interop::kCopy);
  ASSERT_TRUE(separate.ok()) << separate.status().message();
  ASSERT_FALSE(separate->info().host_unified_memory);
  cl_counts() = {};
  const std::vector<Bytes> made = pictures(separate.value());
  EXPECT_EQ(cl_counts().maps, 0) << "copied: nothing is mapped";
  for (std::size_t frame = 0; frame < expected.size(); ++frame)
    EXPECT_TRUE(made[frame] == expected[frame]) << frame;
  EXPECT_FALSE(expected[1] == expected[2]) << "the frames differ";
}

}  // namespace

}  // namespace quincunx::gl::testing

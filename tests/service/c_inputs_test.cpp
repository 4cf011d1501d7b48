// SPDX-License-Identifier: MIT
// What a frame may bring besides its images, over the C interface: particles, focus, fade, exposure, a dynamic output,
// events. The pictures are those of the C++ interface.
#include <gtest/gtest.h>

#include <cstring>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "c_fixture.h"
#include "real_function.h"
#include "service_fixture.h"

namespace {
bool g_cannot_read = false;
}

// The library calls this in place of OpenCL's.
extern "C" cl_int clEnqueueReadBufferRect(cl_command_queue queue, cl_mem buffer, cl_bool blocking,
                                          const size_t* origin, const size_t* to, const size_t* region,
                                          size_t row, size_t slice, size_t host_row, size_t host_slice,
                                          void* memory, cl_uint waits, const cl_event* list,
                                          cl_event* event) {
  if (g_cannot_read) return CL_OUT_OF_RESOURCES;
  static const auto real = REAL(clEnqueueReadBufferRect);
  return real(queue, buffer, blocking, origin, to, region, row, slice, host_row, host_slice, memory, waits,
              list, event);
}

namespace quincunx {
namespace {

using testing::c_device;
using testing::c_inputs;
using testing::c_plan;
using testing::c_service;
using testing::COwner;
using testing::HostFrame;
using testing::HostPicture;
using testing::Pixel;
using testing::random_frame;
using testing::sized;

constexpr Extent kOutput{48, 36};
constexpr Extent kTarget{64, 48};
constexpr Extent kParticles{40, 30};
constexpr Extent kRegion{24, 18};
constexpr Extent kRegionTarget{32, 24};

// One picture in host memory, and on the device for the C++ interface: two of these, in turns.
struct Plane {
  PixelFormat format;
  Extent size;
  HostPicture host{size, format};
  Image images[2] = {};

  ImageView upload(const Device& device, Extent part, std::size_t turn) {
    if (!images[turn]) images[turn] = device.allocate(size, format).value();
    const quincunx_image& from = *host.image();
    EXPECT_TRUE(device.upload(images[turn].view(), part, from.memory, from.pitch).ok());
    return images[turn].view();
  }
};

// Colour, depth, velocity and reactive values of frames up to a size.
struct Planes {
  explicit Planes(Extent size)
      : colour{PixelFormat::kRGBA32F, size},
        depth{PixelFormat::kR32F, size},
        velocity{PixelFormat::kRG32F, size},
        reactive{PixelFormat::kR8, size} {}

  void fill(const HostFrame& frame) {
    colour.host.fill<Pixel>(frame.render, frame.colour);
    depth.host.fill<float>(frame.render, frame.depth);
    velocity.host.fill<Vec2>(frame.render, frame.velocity);
    reactive.host.fill<std::uint8_t>(frame.render, frame.reactive);
  }

  FrameInputs upload(const Device& device, const HostFrame& frame, std::size_t turn) {
    return {.colour = colour.upload(device, frame.render, turn),
            .depth = depth.upload(device, frame.render, turn),
            .velocity = velocity.upload(device, frame.render, turn),
            .reactive = reactive.upload(device, frame.render, turn),
            .render_extent = frame.render,
            .jitter = frame.jitter};
  }

  quincunx_inputs inputs(const HostFrame& frame) {
    quincunx_inputs made = c_inputs(colour.host.image(), frame.render);
    made.depth = depth.host.image();
    made.velocity = velocity.host.image();
    made.reactive = reactive.host.image();
    made.jitter_x = frame.jitter.x;
    made.jitter_y = frame.jitter.y;
    return made;
  }

  Plane colour, depth, velocity, reactive;
};

struct Extras {
  const char* name;
  ResolveSettings settings;
  bool particles = false, focus = false, fade = false;
};

class CExtras : public ::testing::TestWithParam<Extras> {};

TEST_P(CExtras, FromHostMemoryAreThoseOfCpp) {
  const Extras& with = GetParam();
  ResolveSettings settings = with.settings;
  settings.output_extent = kOutput;
  settings.target_extent = kTarget;
  settings.colour = PixelFormat::kRGBA32F;
  settings.velocity = PixelFormat::kRG32F;
  const Device device = Device::open().value();
  const ResolvePlan expected_plan = plan_for({}, settings).value();
  ResolveService expected = ResolveService::create(device, expected_plan).value();
  const Image linear = device.allocate(kOutput, PixelFormat::kRGBA32F).value();
  const Image presented = device.allocate(kOutput, PixelFormat::kRGBA8).value();

  const auto plan = c_plan({}, settings);
  const auto opened = c_device();
  const auto service = c_service(opened, plan);
  HostPicture c_linear(kOutput, PixelFormat::kRGBA32F), c_presented(kOutput, PixelFormat::kRGBA8);
  const quincunx_outputs outputs = {sizeof(outputs), c_linear.image(), c_presented.image()};

  Planes scene(kTarget), particles(kParticles), region(kRegionTarget);
  Plane mask{PixelFormat::kR8, kRegion}, exposure{PixelFormat::kR32F, {1, 1}},
      other{PixelFormat::kRGBA32F, kOutput};
  std::mt19937 random(21);
  int focused = 0, known = 0;
  for (std::size_t n = 0; n < 16; ++n) {
    const std::size_t turn = n % 2;
    const HostFrame frame = random_frame(random, kTarget), dust = random_frame(random, kParticles);
    HostFrame close = random_frame(random, kRegionTarget), old = random_frame(random, kOutput);
    close.reset = false;
    old.render = kOutput;
    const float brightness = 0.25f * static_cast<float>(1 + n % 5);
    scene.fill(frame);
    exposure.host.fill<float>({1, 1}, [=](int, int) { return brightness; });

    FrameInputs own = scene.upload(device, frame, turn);
    own.exposure_image = exposure.upload(device, {1, 1}, turn);
    own.reset = frame.reset;
    own.frame_index = n;
    quincunx_inputs inputs = scene.inputs(frame);
    inputs.exposure_image = exposure.host.image();
    inputs.reset = frame.reset;
    inputs.frame_index = n;
    if (settings.output.min_extent != Extent{}) {
      own.output_extent = {24 + static_cast<int>(random() % 25), 18 + static_cast<int>(random() % 19)};
      inputs.output_width = own.output_extent.width;
      inputs.output_height = own.output_extent.height;
    }
    quincunx_particles c_particles = {};
    if (with.particles) {
      particles.fill(dust);
      own.particle_colour = particles.colour.upload(device, dust.render, turn);
      own.particle_depth = particles.depth.upload(device, dust.render, turn);
      own.particle_reactive = particles.reactive.upload(device, dust.render, turn);
      own.particle_render_extent = dust.render;
      c_particles = {sizeof(c_particles),
                     particles.colour.host.image(),
                     particles.depth.host.image(),
                     particles.reactive.host.image(),
                     dust.render.width,
                     dust.render.height};
      inputs.particles = &c_particles;
    }
    quincunx_fade fade = {};
    if (with.fade && n % 3 != 0) {
      other.host.fill<Pixel>(kOutput, old.colour);
      own.fading_from = other.upload(device, kOutput, turn);
      own.fade_weight = 0.25f;
      fade = {sizeof(fade), other.host.image(), 0.25f, 0};
      inputs.fade = &fade;
    }
    FocusInputs own_focus;
    quincunx_focus focus = {};
    quincunx_inputs close_inputs = {};
    const quincunx_rectangle rectangle = {5, 4, 20, 12};
    const bool is_focused = with.focus && n % 5 != 4;
    if (is_focused) {
      region.fill(close);
      mask.host.fill<std::uint8_t>(kRegion,
                                   [](int x, int y) { return static_cast<std::uint8_t>(7 * x + y); });
      own_focus = {.frame = region.upload(device, close, turn),
                   .x = 3,
                   .y = 2,
                   .rectangles = {{{5, 4, 20, 12}}},
                   .rectangle_count = 1,
                   .feather = 4,
                   .mask = mask.upload(device, kRegion, turn)};
      close_inputs = region.inputs(close);
      focus = {sizeof(focus), &close_inputs, 3, 2, &rectangle, 1, 4, mask.host.image()};
      inputs.focus = &focus;
    }

    const FrameOutputs to = {linear.view(), presented.view()};
    const FrameReport report =
        is_focused ? expected.dispatch(own, own_focus, to) : expected.dispatch(own, to);
    ASSERT_TRUE(report.ok()) << report.status.message();
    quincunx_report c_report = {};
    int in_focus[QUINCUNX_MAX_PASSES] = {};
    auto content = sized<quincunx_content>();
    c_report.struct_size = sizeof(c_report);
    c_report.pass_capacity = QUINCUNX_MAX_PASSES;
    c_report.in_focus = in_focus;
    c_report.content = &content;
    ASSERT_EQ(quincunx_dispatch(service.get(), &inputs, &outputs, &c_report), QUINCUNX_OK)
        << quincunx_last_error();
    EXPECT_EQ(c_report.focused, report.focused);
    focused += c_report.focused;
    EXPECT_EQ((Extent{c_report.output_width, c_report.output_height}), report.output_extent);
    ASSERT_EQ(c_report.pass_count, static_cast<int>(report.passes.size()));
    for (std::size_t i = 0; i < report.passes.size(); ++i)
      EXPECT_EQ(in_focus[i], report.passes[i].in_focus) << report.passes[i].kernel;

    std::vector<unsigned char> texels(static_cast<std::size_t>(kOutput.area()) * sizeof(Pixel));
    ASSERT_TRUE(device.download(linear.view(), kOutput, texels.data()).ok());
    ASSERT_EQ(c_linear.texels(), texels) << "frame " << n;
    texels.resize(static_cast<std::size_t>(kOutput.area()) * 4);
    ASSERT_TRUE(device.download(presented.view(), kOutput, texels.data()).ok());
    ASSERT_EQ(c_presented.texels(), texels) << "frame " << n;

    const auto done = expected.next_completed();
    ASSERT_TRUE(done.has_value());
    ASSERT_EQ(quincunx_next_report(service.get(), &c_report), QUINCUNX_OK) << quincunx_last_error();
    ASSERT_EQ(c_report.content_known, done->content.has_value());
    known += c_report.content_known;
    if (!done->content) continue;
    EXPECT_EQ(content.moving, done->content->moving);
    EXPECT_EQ(content.speed_px, done->content->speed_px);
    EXPECT_EQ(content.light, done->content->light);
    EXPECT_EQ(content.judged, done->content->judged);
    EXPECT_EQ(content.struct_size, sizeof(content));
  }
  EXPECT_EQ(focused > 0, with.focus);
  EXPECT_EQ(known > 0, settings.control.measures_content);
}

const Extras kExtras[] = {
    {.name = "particles", .settings = {.targets = {.particle_extent = kParticles}}, .particles = true},
    {.name = "fade",
     .settings = {.output = {.min_extent = {24, 18}}, .control = {.measures_content = true, .fades = true}},
     .fade = true},
    {.name = "focus",
     .settings = {.focus = {.extent = kRegion, .target_extent = kRegionTarget, .mask = true}},
     .focus = true},
    {.name = "all",
     .settings = {.targets = {.particle_extent = kParticles},
                  .output = {.min_extent = {24, 18}},
                  .blur = {.shutter = 0.5f},
                  .focus = {.extent = kRegion, .target_extent = kRegionTarget, .mask = true},
                  .control = {.measures_content = true, .fades = true}},
     .particles = true,
     .focus = true,
     .fade = true},
};
INSTANTIATE_TEST_SUITE_P(Inputs, CExtras, ::testing::ValuesIn(kExtras),
                         [](const auto& instance) { return instance.param.name; });

// A frame's work waits for the caller's events, and its end is one.
TEST(CSync, EventsInAndOut) {
  const Device device = Device::open().value();
  quincunx_device* borrowed = nullptr;
  ASSERT_EQ(quincunx_device_borrow(device.context(), device.id(), device.queue(), &borrowed), QUINCUNX_OK);
  const COwner<quincunx_device> owner(borrowed);
  const auto plan = c_plan({}, {.method = Method::kBilinear,
                                .output_extent = kOutput,
                                .target_extent = kOutput,
                                .colour = PixelFormat::kRGBA32F,
                                .output = {.present = false}});
  const auto service = c_service(owner, plan);
  const Image colour = device.allocate(kOutput, PixelFormat::kRGBA32F).value();
  const Image picture = device.allocate(kOutput, PixelFormat::kRGBA32F).value();
  const auto image = [](const Image& of) {
    return quincunx_image{
        sizeof(quincunx_image), QUINCUNX_BUFFER, QUINCUNX_RGBA32F, kOutput.width, kOutput.height, 0, 0,
        of.view().memory};
  };
  const quincunx_image in = image(colour), out = image(picture);
  quincunx_inputs inputs = c_inputs(&in, kOutput);
  const quincunx_outputs outputs = {sizeof(outputs), &out, nullptr};

  cl_event gate = clCreateUserEvent(device.context(), nullptr);
  void* waits[] = {gate};
  void* done = nullptr;
  quincunx_sync sync = {sizeof(sync), waits, 1, 0, &done, nullptr, nullptr, 0, 0};
  inputs.sync = &sync;
  ASSERT_EQ(quincunx_dispatch(service.get(), &inputs, &outputs, nullptr), QUINCUNX_OK)
      << quincunx_last_error();
  auto* end = static_cast<cl_event>(done);
  ASSERT_NE(end, nullptr);
  cl_int state = CL_COMPLETE;
  clGetEventInfo(end, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof(state), &state, nullptr);
  EXPECT_NE(state, CL_COMPLETE);
  clSetUserEventStatus(gate, CL_COMPLETE);
  EXPECT_EQ(clWaitForEvents(1, &end), CL_SUCCESS);
  clReleaseEvent(end);
  clReleaseEvent(gate);

  const auto refuses = [&](const char* words) {
    done = &sync;  // anything but NULL
    return quincunx_dispatch(service.get(), &inputs, &outputs, nullptr) == QUINCUNX_INVALID_ARGUMENT &&
           done == nullptr && std::string(quincunx_last_error()).find(words) != std::string::npos;
  };
  waits[0] = nullptr;
  EXPECT_TRUE(refuses("wait_for[0] is null; leave it out")) << quincunx_last_error();
  sync.wait_for = nullptr;
  EXPECT_TRUE(refuses("sync.wait_for is NULL; it must point to 1 events")) << quincunx_last_error();
  sync.wait_count = -1;
  EXPECT_TRUE(refuses("sync.wait_count is -1; it must be at least 0")) << quincunx_last_error();
}

// Memory that was handed back, or never taken, goes with its last owner.
TEST(CMemory, NothingIsLeftOfImports) {
  const auto device = c_device("cpu");
  const auto contexts_users = [&] {
    cl_uint count = 0;
    EXPECT_EQ(clFinish(static_cast<cl_command_queue>(quincunx_device_queue(device.get()))), CL_SUCCESS);
    EXPECT_EQ(clGetContextInfo(static_cast<cl_context>(quincunx_device_context(device.get())),
                               CL_CONTEXT_REFERENCE_COUNT, sizeof(count), &count, nullptr),
              CL_SUCCESS);
    return count;
  };
  const cl_uint before = contexts_users();
  alignas(4096) static std::array<unsigned char, 4096> page;
  auto external = sized<quincunx_external_memory>();
  external.handle = QUINCUNX_MAPPED;
  external.mapped = page.data();
  external.bytes = page.size();
  for (const int changes : {0, 1, 2}) {
    quincunx_memory* imported = nullptr;
    ASSERT_EQ(quincunx_memory_import(device.get(), &external, &imported), QUINCUNX_OK)
        << quincunx_last_error();
    const COwner<quincunx_memory> memory(imported);
    if (changes > 0) {
      EXPECT_EQ(quincunx_memory_acquire(imported), QUINCUNX_OK) << quincunx_last_error();
    }
    if (changes > 1) {
      EXPECT_EQ(quincunx_memory_release(imported, nullptr), QUINCUNX_OK) << quincunx_last_error();
    }
  }
  EXPECT_EQ(contexts_users(), before);
}

// A pointer to memory of another API's, whose frames and pictures lie where they are.
TEST(CMemory, FramesAndPicturesLieInMemoryOfOthers) {
  const auto plan = c_plan({}, {.method = Method::kPoint,
                                .output_extent = kOutput,
                                .target_extent = kOutput,
                                .colour = PixelFormat::kRGBA32F,
                                .output = {.present = false}});
  const auto device = c_device("cpu");
  const auto service = c_service(device, plan);
  constexpr std::size_t kFloats = 4 * std::size_t{kOutput.width} * kOutput.height, kBytes = 4 * kFloats;
  struct alignas(4096) Page {
    std::array<float, 1024> floats;
  };
  std::vector<Page> pages((2 * kBytes + sizeof(Page) - 1) / sizeof(Page));  // the frame, then the picture
  float* const texels = pages.front().floats.data();
  auto external = sized<quincunx_external_memory>();
  external.handle = QUINCUNX_MAPPED;
  external.mapped = texels;
  external.bytes = 2 * kBytes;
  quincunx_memory* imported = nullptr;
  ASSERT_EQ(quincunx_memory_import(device.get(), &external, &imported), QUINCUNX_OK) << quincunx_last_error();
  COwner<quincunx_memory> memory(imported);
  quincunx_image in = {
      sizeof(quincunx_image),          QUINCUNX_BUFFER, QUINCUNX_RGBA32F, kOutput.width, kOutput.height, 0, 0,
      quincunx_memory_object(imported)};
  quincunx_image out = in;
  out.offset = kBytes;
  quincunx_inputs inputs = c_inputs(&in, kOutput);
  const quincunx_outputs outputs = {sizeof(outputs), &out, nullptr};
  for (int frame = 1; frame <= 3; ++frame) {
    for (std::size_t i = 0; i < kFloats; ++i)
      texels[i] = static_cast<float>(frame) * static_cast<float>(i % 97);
    ASSERT_EQ(quincunx_memory_acquire(imported), QUINCUNX_OK) << quincunx_last_error();
    ASSERT_EQ(quincunx_dispatch(service.get(), &inputs, &outputs, nullptr), QUINCUNX_OK)
        << quincunx_last_error();
    void* done = nullptr;
    ASSERT_EQ(quincunx_memory_release(imported, &done), QUINCUNX_OK) << quincunx_last_error();
    auto* event = static_cast<cl_event>(done);
    ASSERT_EQ(clWaitForEvents(1, &event), CL_SUCCESS);
    clReleaseEvent(event);
    EXPECT_TRUE(std::equal(texels, texels + kFloats, texels + kFloats)) << frame;
  }

  const auto refuses = [&](const quincunx_external_memory& bad, quincunx_status code, const char* words) {
    quincunx_memory* none = imported;
    return quincunx_memory_import(device.get(), &bad, &none) == code && none == nullptr &&
           std::string(quincunx_last_error()).find(words) != std::string::npos;
  };
  quincunx_external_memory bad = external;
  bad.handle = 3;
  EXPECT_TRUE(refuses(bad, QUINCUNX_INVALID_ARGUMENT, "external.handle is 3")) << quincunx_last_error();
  bad.handle = QUINCUNX_OPAQUE_FD;
  EXPECT_TRUE(refuses(bad, QUINCUNX_UNSUPPORTED, "cl_khr_external_memory_opaque_fd"))
      << quincunx_last_error();
  bad = external;
  bad.bytes = 0;
  EXPECT_TRUE(refuses(bad, QUINCUNX_INVALID_ARGUMENT, "bytes is 0")) << quincunx_last_error();
  quincunx_semaphore* semaphore = nullptr;
  EXPECT_EQ(quincunx_semaphore_import(device.get(), 0, &semaphore), QUINCUNX_UNSUPPORTED);
  EXPECT_EQ(quincunx_memory_acquire(nullptr), QUINCUNX_INVALID_ARGUMENT);
  auto sync = sized<quincunx_sync>();
  sync.wait_semaphore_count = 1;
  inputs.sync = &sync;
  EXPECT_EQ(quincunx_dispatch(service.get(), &inputs, &outputs, nullptr), QUINCUNX_INVALID_ARGUMENT);
  EXPECT_STREQ(quincunx_last_error(),
               "sync.wait_semaphore_count is 1; wait_semaphores must point to so many, at least 0");
}

TEST(CSync, AFrameWhosePictureIsLostHasNoEvent) {
  const auto plan = c_plan({}, {.method = Method::kBilinear,
                                .output_extent = kOutput,
                                .target_extent = kOutput,
                                .colour = PixelFormat::kRGBA32F,
                                .output = {.present = false}});
  const auto device = c_device();
  const auto service = c_service(device, plan);
  HostPicture colour(kOutput, PixelFormat::kRGBA32F), picture(kOutput, PixelFormat::kRGBA32F);
  void* done = nullptr;
  quincunx_sync sync = {sizeof(sync), nullptr, 0, 0, &done, nullptr, nullptr, 0, 0};
  quincunx_inputs inputs = c_inputs(colour.image(), kOutput);
  inputs.sync = &sync;
  const quincunx_outputs outputs = {sizeof(outputs), picture.image(), nullptr};

  g_cannot_read = true;
  EXPECT_EQ(quincunx_dispatch(service.get(), &inputs, &outputs, nullptr), QUINCUNX_DEVICE_FAILURE);
  g_cannot_read = false;
  EXPECT_EQ(done, nullptr);
  EXPECT_NE(std::string(quincunx_last_error()).find("download"), std::string::npos) << quincunx_last_error();
  ASSERT_EQ(quincunx_dispatch(service.get(), &inputs, &outputs, nullptr), QUINCUNX_OK)
      << quincunx_last_error();
  ASSERT_NE(done, nullptr);
  clReleaseEvent(static_cast<cl_event>(done));
}

}  // namespace
}  // namespace quincunx

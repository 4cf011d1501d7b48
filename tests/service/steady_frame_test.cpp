// SPDX-License-Identifier: MIT
// A steady frame allocates nothing, compiles nothing and never waits for the device. The OpenCL entry points
// that could do so are replaced in this executable by ones that count and pass on, and so is operator new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "real_function.h"
#include "service_fixture.h"

namespace {

std::atomic<bool> g_counting = false;
std::atomic<int> g_heap = 0;
std::atomic<int> g_create = 0;
std::atomic<int> g_compile = 0;
std::atomic<int> g_wait = 0;
std::atomic<int> g_enqueue = 0;

void count(std::atomic<int>& counter) {
  if (g_counting) ++counter;
}

}  // namespace

// Not inlined: GCC would see one half of a pair only and warn of a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  count(g_heap);
  void* memory = std::malloc(size != 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  count(g_heap);
  return std::malloc(size != 0 ? size : 1);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

extern "C" {

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* host, cl_int* error) {
  count(g_create);
  static const auto real = REAL(clCreateBuffer);
  return real(context, flags, size, host, error);
}
cl_mem clCreateImage(cl_context context, cl_mem_flags flags, const cl_image_format* format,
                     const cl_image_desc* desc, void* host, cl_int* error) {
  count(g_create);
  static const auto real = REAL(clCreateImage);
  return real(context, flags, format, desc, host, error);
}
cl_kernel clCreateKernel(cl_program program, const char* name, cl_int* error) {
  count(g_create);
  static const auto real = REAL(clCreateKernel);
  return real(program, name, error);
}
cl_int clBuildProgram(cl_program program, cl_uint count_of, const cl_device_id* devices, const char* options,
                      void(CL_CALLBACK* notify)(cl_program, void*), void* user) {
  count(g_compile);
  static const auto real = REAL(clBuildProgram);
  return real(program, count_of, devices, options, notify, user);
}
cl_int clFinish(cl_command_queue queue) {
  count(g_wait);
  static const auto real = REAL(clFinish);
  return real(queue);
}
cl_int clWaitForEvents(cl_uint count_of, const cl_event* events) {
  count(g_wait);
  static const auto real = REAL(clWaitForEvents);
  return real(count_of, events);
}
cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset,
                           size_t size, void* memory, cl_uint waits, const cl_event* list, cl_event* event) {
  if (blocking) count(g_wait);
  static const auto real = REAL(clEnqueueReadBuffer);
  return real(queue, buffer, blocking, offset, size, memory, waits, list, event);
}
cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset,
                            size_t size, const void* memory, cl_uint waits, const cl_event* list,
                            cl_event* event) {
  if (blocking) count(g_wait);
  static const auto real = REAL(clEnqueueWriteBuffer);
  return real(queue, buffer, blocking, offset, size, memory, waits, list, event);
}
void* clEnqueueMapBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, cl_map_flags flags,
                         size_t offset, size_t size, cl_uint waits, const cl_event* list, cl_event* event,
                         cl_int* error) {
  if (blocking) count(g_wait);
  static const auto real = REAL(clEnqueueMapBuffer);
  return real(queue, buffer, blocking, flags, offset, size, waits, list, event, error);
}
cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                              const size_t* offset, const size_t* global, const size_t* local, cl_uint waits,
                              const cl_event* list, cl_event* event) {
  count(g_enqueue);
  static const auto real = REAL(clEnqueueNDRangeKernel);
  return real(queue, kernel, dimensions, offset, global, local, waits, list, event);
}

}  // extern "C"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::ServiceRig;

void reset_counts() {
  g_heap = g_create = g_compile = g_wait = g_enqueue = 0;
}

// The same memory, as placed images of another size.
void place(FrameInputs& inputs, Extent render) {
  for (ImageView* image : {&inputs.colour, &inputs.velocity, &inputs.depth, &inputs.reactive}) {
    image->extent = render;
    image->pitch = 0;
  }
}

// With a focus where the plan has one, from the upper left part of the frame's own images.
FrameReport dispatch(ServiceRig& rig, const FrameInputs& inputs) {
  if (!rig.service().plan().has_focus()) return rig.dispatch(inputs);
  FocusInputs focus{.frame = inputs, .x = inputs.render_extent.width % 30, .y = 4};
  focus.frame.render_extent = {1 + inputs.render_extent.width % 48, 1 + inputs.render_extent.height % 36};
  return rig.service().dispatch(inputs, focus, {rig.resolved_view(), rig.presented_view()});
}

void run_steady_frames(const SceneNeeds& needs, const ResolveSettings& settings) {
  constexpr int kFrames = 200;
  ServiceRig rig(needs, settings, {64, 48}, {96, 72});
  rig.service().allow_timing_waits(true);  // events are believed here, so that this changes nothing
  const bool placed = settings.targets.placement == Targets::kPlaced;
  const int slots = placed ? 2 : 3;
  // Two frames and more in each slot: every path (first frame, steady) has been taken once.
  std::vector<FrameInputs> frames;
  for (int i = 0; i < slots; ++i)
    frames.push_back(rig.upload({.render = {48, 36}}));
  for (int i = 0; i < 6; ++i)
    ASSERT_TRUE(dispatch(rig, frames[i % slots]).ok());
  ASSERT_TRUE(rig.service().finish().ok());
  while (rig.service().next_completed()) {
  }
  reset_counts();
  int refused = 0;
  int taken = 0;
  g_counting = true;
  for (int i = 0; i < kFrames; ++i) {
    FrameInputs inputs = frames[i % slots];
    inputs.render_extent = {1 + (i * 37) % 96, 1 + (i * 23) % 72};
    if (placed) place(inputs, inputs.render_extent);
    if (settings.output.min_extent != Extent{})
      inputs.output_extent = {1 + (i / 2 * 29) % 64, 1 + (i / 2 * 17) % 48};
    inputs.jitter = jitter(static_cast<std::uint64_t>(i), inputs.render_extent, {64, 48});
    inputs.camera.clip_to_previous_clip[12] = .01f;
    inputs.reset = i % 50 == 49;
    refused += dispatch(rig, inputs).ok() ? 0 : 1;
    while (rig.service().next_completed())
      ++taken;
    if (i % 4 == 3) {
      // A renderer waits for its pictures; so as not to run far ahead of the device, this loop stands still
      // here.
      g_counting = false;
      ASSERT_TRUE(rig.service().finish().ok());
      g_counting = true;
    }
  }
  g_counting = false;
  EXPECT_EQ(refused, 0);
  EXPECT_GE(g_enqueue.load(), kFrames) << "the counters must see the frames";
  EXPECT_EQ(g_create.load(), 0) << "memory or kernel objects were created";
  EXPECT_EQ(g_compile.load(), 0) << "a program was built";
  EXPECT_EQ(g_wait.load(), 0) << "the host waited for the device";
  EXPECT_EQ(g_heap.load(), 0) << "the host allocated";
  ASSERT_TRUE(rig.service().finish().ok());
  while (rig.service().next_completed())
    ++taken;
  EXPECT_EQ(taken, kFrames);
}

TEST(SteadyFrame, Point) {
  run_steady_frames({}, {.method = Method::kPoint});
}
TEST(SteadyFrame, Bilinear) {
  run_steady_frames({}, {.method = Method::kBilinear});
}
TEST(SteadyFrame, QuincunxWithVelocityTarget) {
  run_steady_frames({}, {.method = Method::kQuincunx});
}
TEST(SteadyFrame, QuincunxWithCameraVelocity) {
  run_steady_frames({.moving_objects = false, .transparents = false}, {.method = Method::kQuincunx});
}

TEST(SteadyFrame, ReprojectedSharpenedWithMotionBlur) {
  run_steady_frames({}, {.method = Method::kQuincunx,
                         .sharpness = .5f,
                         .quincunx = {.form = TwoFrameForm::kReprojected, .residual_weight = 1},
                         .blur = {.shutter = .5f}});
}
TEST(SteadyFrame, TemporalWithVelocityTarget) {
  run_steady_frames({}, {.method = Method::kTemporal});
}
TEST(SteadyFrame, TemporalOfAStillScene) {
  run_steady_frames({.moving_objects = false, .camera_motion = false}, {.method = Method::kTemporal});
}
TEST(SteadyFrame, PlacedTargetsOfAnotherSizeEveryFrame) {
  run_steady_frames({}, {.method = Method::kTemporal, .targets = {.placement = Targets::kPlaced}});
  run_steady_frames({.moving_objects = false},
                    {.method = Method::kQuincunx, .targets = {.placement = Targets::kPlaced}});
}
TEST(SteadyFrame, AnOutputOfAnotherSizeEverySecondFrame) {
  run_steady_frames({}, {.method = Method::kTemporal, .output = {.min_extent = {1, 1}}});
  run_steady_frames({}, {.method = Method::kCatmullRom, .output = {.min_extent = {1, 1}}});
}
TEST(SteadyFrame, CatmullRomThatWidens) {
  run_steady_frames({}, {.method = Method::kCatmullRom});
}

TEST(SteadyFrame, AFocusThatWanders) {
  run_steady_frames({},
                    {.method = Method::kTemporal, .focus = {.extent = {32, 24}, .target_extent = {48, 36}}});
}

TEST(SteadyFrame, TheCountersCount) {
  Device device = Device::open().value();
  reset_counts();
  g_counting = true;
  {
    const auto image = device.allocate({4, 4}, PixelFormat::kR8);
    static_cast<void>(device.finish());
    const auto heap = std::make_unique<std::vector<int>>(4);
  }
  g_counting = false;
  EXPECT_GT(g_heap.load(), 0);
  EXPECT_EQ(g_create.load(), 1);
  EXPECT_EQ(g_wait.load(), 1);
}

}  // namespace
}  // namespace quincunx

// SPDX-License-Identifier: MIT
// Events in and out of a dispatch: frames among the work of other queues.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>

#include "service_fixture.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::ServiceRig;

constexpr Extent kSize = {16, 12};

HostFrame frame_of(float value) {
  return {.render = kSize, .colour = [value](int, int) { return Pixel{value, value, value, 1}; }};
}

cl_int state_of(cl_event event) {
  cl_int state = CL_COMPLETE;
  EXPECT_EQ(clGetEventInfo(event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof(state), &state, nullptr),
            CL_SUCCESS);
  return state;
}

FrameReport dispatch(ServiceRig& rig, const FrameInputs& inputs, const FrameSync& sync) {
  FrameOutputs outputs;
  outputs.presented = rig.presented_view();
  return rig.service().dispatch(inputs, outputs, sync);
}

TEST(FrameSync, AFrameWaitsForTheEventsAndTellsItsEnd) {
  ServiceRig rig({}, Method::kPoint, kSize, kSize);
  ASSERT_TRUE(dispatch(rig, rig.upload(frame_of(0)), {}).ok());
  const std::vector<std::uint8_t> before = rig.presented();
  const FrameInputs inputs = rig.upload(frame_of(1));

  cl_int code = CL_SUCCESS;
  const cl_event gate = clCreateUserEvent(rig.device().context(), &code);
  ASSERT_EQ(code, CL_SUCCESS);
  cl_event done = nullptr;
  const FrameReport report = dispatch(rig, inputs, {.wait_for = {&gate, 1}, .done = &done});
  ASSERT_TRUE(report.ok()) << report.status.message();
  ASSERT_NE(done, nullptr);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // long for a frame of this size
  EXPECT_NE(state_of(done), CL_COMPLETE);

  ASSERT_EQ(clSetUserEventStatus(gate, CL_COMPLETE), CL_SUCCESS);
  ASSERT_EQ(clWaitForEvents(1, &done), CL_SUCCESS);
  EXPECT_EQ(state_of(done), CL_COMPLETE);
  EXPECT_NE(rig.presented(), before);
  EXPECT_EQ(clReleaseEvent(gate), CL_SUCCESS);
  EXPECT_EQ(clReleaseEvent(done), CL_SUCCESS);
}

// The device writes into the service's memory until its last frame is done.
TEST(FrameSync, AssignmentWaitsAsTheDestructorDoes) {
  ServiceRig rig({}, Method::kPoint, kSize, kSize);
  ResolveService other = ResolveService::create(rig.device(), rig.service().plan()).value();
  const FrameInputs inputs = rig.upload(frame_of(1));
  cl_int code = CL_SUCCESS;
  const cl_event gate = clCreateUserEvent(rig.device().context(), &code);
  ASSERT_EQ(code, CL_SUCCESS);
  cl_event done = nullptr;
  ASSERT_TRUE(dispatch(rig, inputs, {.wait_for = {&gate, 1}, .done = &done}).ok());
  std::thread later([gate] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    clSetUserEventStatus(gate, CL_COMPLETE);
  });
  rig.service() = std::move(other);
  EXPECT_EQ(state_of(done), CL_COMPLETE);
  later.join();
  ASSERT_EQ(clWaitForEvents(1, &done), CL_SUCCESS);
  EXPECT_TRUE(dispatch(rig, inputs, {}).ok());
  ResolveService& same = rig.service();
  rig.service() = std::move(same);
  EXPECT_TRUE(dispatch(rig, inputs, {}).ok()) << "assigned to itself";
  EXPECT_EQ(clReleaseEvent(gate), CL_SUCCESS);
  EXPECT_EQ(clReleaseEvent(done), CL_SUCCESS);
}

// Inputs that another queue writes and outputs that it reads, ordered by events alone.
TEST(FrameSync, AnotherQueueFeedsAndReadsFrames) {
  ServiceRig rig({}, Method::kPoint, kSize, kSize);
  ServiceRig alone({}, Method::kPoint, kSize, kSize);
  cl_int code = CL_SUCCESS;
  const cl_command_queue queue = clCreateCommandQueue(rig.device().context(), rig.device().id(), 0, &code);
  ASSERT_EQ(code, CL_SUCCESS);
  for (int n = 0; n < 20; ++n) {
    const float value = static_cast<float>(n % 5) / 4;
    const FrameInputs inputs = rig.upload(frame_of(1 - value));
    const std::vector<Pixel> colour(static_cast<std::size_t>(kSize.area()), Pixel{value, value, value, 1});
    cl_event written = nullptr;
    ASSERT_EQ(clEnqueueWriteBuffer(queue, inputs.colour.memory, CL_FALSE, inputs.colour.offset,
                                   colour.size() * sizeof(Pixel), colour.data(), 0, nullptr, &written),
              CL_SUCCESS);
    ASSERT_EQ(clFlush(queue), CL_SUCCESS);
    cl_event done = nullptr;
    ASSERT_TRUE(dispatch(rig, inputs, {.wait_for = {&written, 1}, .done = &done}).ok());
    std::array<std::uint8_t, 4> pixel = {};
    ASSERT_EQ(clEnqueueReadBuffer(queue, rig.presented_view().memory, CL_TRUE, rig.presented_view().offset,
                                  pixel.size(), pixel.data(), 1, &done, nullptr),
              CL_SUCCESS);
    const std::vector<std::uint8_t> shown = rig.presented();
    EXPECT_TRUE(std::equal(pixel.begin(), pixel.end(), shown.begin())) << n;
    ASSERT_TRUE(dispatch(alone, alone.upload(frame_of(value)), {}).ok());
    EXPECT_EQ(shown, alone.presented()) << n;
    clReleaseEvent(written);
    clReleaseEvent(done);
  }
  clReleaseCommandQueue(queue);
}

TEST(FrameSync, EventsThatCannotBeWaitedForRefuseTheFrame) {
  ServiceRig rig({}, Method::kPoint, kSize, kSize);
  const FrameInputs inputs = rig.upload(frame_of(1));
  cl_int code = CL_SUCCESS;
  const Device other = Device::open().value();
  const cl_event foreign = clCreateUserEvent(other.context(), &code);
  ASSERT_EQ(code, CL_SUCCESS);
  const cl_event own = clCreateUserEvent(rig.device().context(), &code);
  ASSERT_EQ(code, CL_SUCCESS);
  int placeholder = 0;
  auto* done = reinterpret_cast<cl_event>(&placeholder);
  const std::array<cl_event, 2> with_null = {own, nullptr};
  EXPECT_EQ(dispatch(rig, inputs, {.wait_for = with_null, .done = &done}).status.message(),
            "wait_for[1] is null; leave it out");
  EXPECT_EQ(done, nullptr);
  const FrameReport report = dispatch(rig, inputs, {.wait_for = {&foreign, 1}});
  EXPECT_EQ(report.status.code(), StatusCode::kInvalidArgument);
  EXPECT_EQ(
      report.status.message(),
      "wait_for[0] is no event of the device's OpenCL context; make it on a queue of Device::context()");
  EXPECT_TRUE(dispatch(rig, inputs, {}).ok()) << "nothing was enqueued that waits";
  EXPECT_TRUE(rig.service().finish().ok());
  for (const cl_event event : {foreign, own}) {
    clSetUserEventStatus(event, CL_COMPLETE);
    clReleaseEvent(event);
  }
}

// What it sees is what the passes will read, of accepted frames alone; the first begins without history.
TEST(FrameObserver, SeesFramesUntilItHasEnough) {
  ServiceRig rig({.transparents = false}, Method::kTemporal, kSize, kSize);
  ASSERT_TRUE(dispatch(rig, rig.upload(frame_of(0)), {}).ok());
  std::vector<float> seen;
  rig.service().observe([&](const FrameInputs& inputs, const FocusInputs* focus) {
    std::vector<Pixel> texels(static_cast<std::size_t>(kSize.area()));
    EXPECT_TRUE(rig.service().device().download(inputs.colour, kSize, texels.data()).ok());
    EXPECT_EQ(focus, nullptr);
    seen.push_back(texels[0][0]);
    return seen.size() < 2;
  });
  EXPECT_FALSE(dispatch(rig, {}, {}).ok());
  EXPECT_FALSE(dispatch(rig, rig.upload(frame_of(1)), {}).used_previous);
  EXPECT_TRUE(dispatch(rig, rig.upload(frame_of(2)), {}).used_previous);
  ASSERT_TRUE(dispatch(rig, rig.upload(frame_of(3)), {}).ok());
  EXPECT_EQ(seen, (std::vector<float>{1, 2}));
}

}  // namespace
}  // namespace quincunx

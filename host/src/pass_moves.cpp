// SPDX-License-Identifier: MIT
#include "pass_moves.h"

#include <cmath>

#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx {
namespace {

// On one axis, from sample i of one frame to its place among the samples of another: i * step + start.
struct Axis {
  float step;
  float start;
};

Axis axis_between(int from, double from_jitter, int to, double to_jitter) {
  const double step = static_cast<double>(to) / from;
  return {static_cast<float>(step), static_cast<float>((.5 + from_jitter) * step - .5 - to_jitter)};
}

void set_positions(ReprojectParams& params, const FrameInputs& current, const FrameInputs& previous) {
  const Axis x =
      axis_between(current.render.width, current.jitter.x, previous.render.width, previous.jitter.x);
  const Axis y =
      axis_between(current.render.height, current.jitter.y, previous.render.height, previous.jitter.y);
  const VelocityScale to_previous = velocity_scale_to(current, previous.render);
  params.step_x = x.step;
  params.step_y = y.step;
  params.start_x = x.start;
  params.start_y = y.start;
  params.motion_x = static_cast<float>(-to_previous.x);
  params.motion_y = static_cast<float>(-to_previous.y);
  params.edge_x = -.5f - previous.jitter.x;
  params.edge_y = -.5f - previous.jitter.y;
}

void set_motion_edge(ReprojectParams& params, const FrameInputs& current, Extent output) {
  const VelocityScale to_output = velocity_scale_to(current, output);
  params.motion_edge_x = static_cast<float>(to_output.x);
  params.motion_edge_y = static_cast<float>(to_output.y);
}

void set_speeds(ReprojectParams& params, const FrameInputs& current, const FrameInputs& previous,
                float weight) {
  const double root = std::sqrt(static_cast<double>(weight));
  const VelocityScale now = velocity_scale_to(current, current.render);
  const VelocityScale before = velocity_scale_to(previous, previous.render);
  params.speed0_x = static_cast<float>(root * now.x);
  params.speed0_y = static_cast<float>(root * now.y);
  params.speed1_x = static_cast<float>(root * before.x);
  params.speed1_y = static_cast<float>(root * before.y);
}

}  // namespace

MovePass::MovePass(const Device::Impl& device, const ResolvePlan& plan)
    : device_(device),
      settings_(plan.settings),
      reads_reactive_(plan.reads_reactive),
      reads_residual_(plan.weighs_residual()),
      kernel_(build_kernel(device, kernel_name(), reproject_options(plan))) {
  const std::size_t bytes = sizeof(Reprojection) * static_cast<std::size_t>(settings_.target.area());
  moves_[0] = cl::Buffer(device.context, CL_MEM_READ_WRITE, bytes);
  moves_[1] = plan.accumulates() ? cl::Buffer(device.context, CL_MEM_READ_WRITE, bytes) : moves_[0];
}

void MovePass::forget(const cl::CommandQueue& queue) {
  queue.enqueueFillBuffer(moves_[newest_], cl_uint{0}, 0,
                          sizeof(Reprojection) * static_cast<std::size_t>(settings_.target.area()));
}

ImageView MovePass::view() const {
  return {.memory = moves_[newest_](), .format = PixelFormat::kRGBA32F, .extent = settings_.target};
}

void MovePass::enqueue(const cl::CommandQueue& queue, const FrameInputs& current, const FrameInputs& previous,
                       cl::Event* event) {
  ReprojectParams params{};
  params.width = current.render.width;
  params.height = current.render.height;
  params.previous_width = previous.render.width;
  params.previous_height = previous.render.height;
  params.velocity0 = layout_of(current.velocity);
  params.velocity1 = layout_of(previous.velocity);
  params.depth0 = layout_of(current.depth);
  params.depth1 = layout_of(previous.depth);
  params.reprojection = layout_of(view());
  params.columns_per_item = columns_per_item(device_, current.render.width);
  set_positions(params, current, previous);
  set_motion_edge(params, current, settings_.output);
  if (reads_residual_) set_speeds(params, current, previous, settings_.quincunx.residual_weight);
  if (reads_reactive_) {
    params.reactive0 = layout_of(current.reactive);
    params.reactive1 = layout_of(previous.reactive);
  }
  kernel_.setArg(0, params);
  set_memory(kernel_, 1, current.velocity.memory);
  set_memory(kernel_, 2, (reads_residual_ ? previous.velocity : current.velocity).memory);
  set_memory(kernel_, 3, current.depth.memory);
  set_memory(kernel_, 4, previous.depth.memory);
  set_memory(kernel_, 5, (reads_reactive_ ? current.reactive : current.depth).memory);
  set_memory(kernel_, 6, (reads_reactive_ ? previous.reactive : previous.depth).memory);
  kernel_.setArg(7, moves_[newest_]);
  newest_ = 1 - newest_;
  kernel_.setArg(8, moves_[newest_]);
  enqueue_rows(device_, queue, kernel_, current.render, params.columns_per_item, event);
}

}  // namespace quincunx

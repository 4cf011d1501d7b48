// SPDX-License-Identifier: MIT
#include "pass_reproject.h"

#include <algorithm>
#include <cmath>

#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx {
namespace {

float falloff(int render, int output) {
  const double reach = sample_reach(render, output);
  return static_cast<float>(1 / (reach * reach));
}

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
  params.move_x = static_cast<float>(-to_previous.x);
  params.move_y = static_cast<float>(-to_previous.y);
  params.edge_x = -.5f - previous.jitter.x;
  params.edge_y = -.5f - previous.jitter.y;
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

double sample_reach(int render, int output) {
  return std::clamp(.7 + .35 * render / output, .875, 1.0);
}

ReprojectPass::ReprojectPass(const Device::Impl& device, const ResolvePlan& plan)
    : device_(device),
      settings_(plan.settings),
      reads_reactive_(plan.reads_reactive),
      reads_residual_(plan.weighs_residual()),
      tables_(device, plan.settings.output),
      resolve_(build_kernel(device, kKernels[1], reprojected_options(plan))) {
  std::size_t moves = sizeof(Move);
  if (plan.velocity != VelocitySource::kNone) {
    reproject_ = build_kernel(device, kKernels[0], reproject_options(plan));
    moves *= static_cast<std::size_t>(settings_.target.area());
  }
  moves_ = cl::Buffer(device.context, CL_MEM_READ_WRITE, moves);
}

ImageView ReprojectPass::move_view() const {
  return {.memory = moves_(), .format = PixelFormat::kRGBA32F, .extent = settings_.target};
}

void ReprojectPass::warm_up(const cl::CommandQueue& queue) {
  Scratch scratch(device_);
  PositionTables tables(device_, {1, 1});
  FrameInputs frame;
  frame.colour = scratch.view(settings_.storage, settings_.colour);
  frame.velocity = scratch.view(settings_.storage, settings_.velocity);
  frame.depth = scratch.view(settings_.storage, PixelFormat::kR32F);
  frame.reactive = scratch.view(settings_.storage, PixelFormat::kR8);
  frame.render = {1, 1};
  launch(queue, tables, frame, frame, scratch.view(Storage::kBuffer, settings_.resolved), scratch.counter(),
         nullptr);
  queue.finish();
}

void ReprojectPass::enqueue(const cl::CommandQueue& queue, const FrameInputs& current,
                            const FrameInputs& previous, const ImageView& output, Counter counter,
                            cl::Event* events) {
  launch(queue, tables_, current, previous, output, counter, events);
}

void ReprojectPass::launch(const cl::CommandQueue& queue, PositionTables& tables, const FrameInputs& current,
                           const FrameInputs& previous, const ImageView& output, Counter counter,
                           cl::Event* events) {
  if (reproject_) {
    reproject(queue, current, previous, events);
    if (events != nullptr) ++events;
  }
  const Extent extent = tables.output();
  const Extent now = current.render;
  const Extent before = previous.render;
  ReprojectedParams params{.output_width = extent.width,
                           .output_height = extent.height,
                           .frame0 = {now.width, now.height, layout_of(current.colour), {}, {}},
                           .frame1 = {before.width, before.height, layout_of(previous.colour), {}, {}},
                           .moves = layout_of(move_view()),
                           .output = layout_of(output),
                           .columns = tables.columns(),
                           .counter = counter.index,
                           .columns_per_item = columns_per_item(device_, extent.width, kReprojectedBlock),
                           .falloff0_x = falloff(now.width, extent.width),
                           .falloff0_y = falloff(now.height, extent.height),
                           .falloff1_x = falloff(before.width, extent.width),
                           .falloff1_y = falloff(before.height, extent.height)};
  if (reads_reactive_) {
    params.frame0.reactive = layout_of(current.reactive);
    params.frame1.reactive = layout_of(previous.reactive);
  }
  resolve_.setArg(0, params);
  resolve_.setArg(1, tables.get(queue, now, current.jitter));
  resolve_.setArg(2, tables.get(queue, before, previous.jitter));
  set_memory(resolve_, 3, current.colour.memory);
  set_memory(resolve_, 4, previous.colour.memory);
  resolve_.setArg(5, moves_);
  // What a variant does not read may be any image or buffer.
  set_memory(resolve_, 6, (reads_reactive_ ? current.reactive : current.colour).memory);
  set_memory(resolve_, 7, (reads_reactive_ ? previous.reactive : previous.colour).memory);
  set_memory(resolve_, 8, output.memory);
  set_memory(resolve_, 9, counter.memory);
  enqueue_rows(device_, queue, resolve_, extent, params.columns_per_item, events);
}

void ReprojectPass::reproject(const cl::CommandQueue& queue, const FrameInputs& current,
                              const FrameInputs& previous, cl::Event* event) {
  ReprojectParams params{};
  params.width = current.render.width;
  params.height = current.render.height;
  params.previous_width = previous.render.width;
  params.previous_height = previous.render.height;
  params.velocity0 = layout_of(current.velocity);
  params.velocity1 = layout_of(previous.velocity);
  params.depth0 = layout_of(current.depth);
  params.depth1 = layout_of(previous.depth);
  params.moves = layout_of(move_view());
  params.columns_per_item = columns_per_item(device_, current.render.width);
  set_positions(params, current, previous);
  if (reads_residual_) set_speeds(params, current, previous, settings_.quincunx.residual_weight);
  if (reads_reactive_) {
    params.reactive0 = layout_of(current.reactive);
    params.reactive1 = layout_of(previous.reactive);
  }
  reproject_->setArg(0, params);
  set_memory(*reproject_, 1, current.velocity.memory);
  set_memory(*reproject_, 2, (reads_residual_ ? previous.velocity : current.velocity).memory);
  set_memory(*reproject_, 3, current.depth.memory);
  set_memory(*reproject_, 4, previous.depth.memory);
  set_memory(*reproject_, 5, (reads_reactive_ ? current.reactive : current.depth).memory);
  set_memory(*reproject_, 6, (reads_reactive_ ? previous.reactive : previous.depth).memory);
  reproject_->setArg(7, moves_);
  enqueue_rows(device_, queue, *reproject_, current.render, params.columns_per_item, event);
}

}  // namespace quincunx

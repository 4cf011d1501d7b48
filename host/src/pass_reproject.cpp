// SPDX-License-Identifier: MIT
#include "pass_reproject.h"

#include <algorithm>

#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx {
namespace {

float falloff(int render, int output) {
  const double reach = sample_reach(render, output);
  return static_cast<float>(1 / (reach * reach));
}

}  // namespace

double sample_reach(int render, int output) {
  return std::clamp(.7 + .35 * render / output, .875, 1.0);
}

ReprojectPass::ReprojectPass(const Device::Impl& device, const ResolvePlan& plan)
    : device_(device),
      settings_(plan.settings),
      reads_reactive_(plan.reads_reactive),
      tables_(device, plan.settings.output),
      resolve_(build_kernel(device, kKernels[1], reprojected_options(plan))) {
  if (plan.velocity != VelocitySource::kNone) moves_.emplace(device, plan);
}

void ReprojectPass::warm_up(const cl::CommandQueue& queue) {
  Scratch scratch(device_);
  PositionTables tables(device_, {1, 1});
  const FrameInputs frame = scratch.frame(settings_);
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
  if (moves_) {
    moves_->enqueue(queue, current, previous, events);
    if (events != nullptr) ++events;
  }
  const Extent extent = tables.output();
  const Extent now = current.render;
  const Extent before = previous.render;
  ReprojectedParams params{.output_width = extent.width,
                           .output_height = extent.height,
                           .frame0 = {now.width, now.height, layout_of(current.colour), {}, {}},
                           .frame1 = {before.width, before.height, layout_of(previous.colour), {}, {}},
                           .reprojection = moves_ ? layout_of(moves_->view()) : TexelLayout{},
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
  // What a variant does not read may be any image or buffer.
  set_memory(resolve_, 5, (moves_ ? moves_->view() : output).memory);
  set_memory(resolve_, 6, (reads_reactive_ ? current.reactive : current.colour).memory);
  set_memory(resolve_, 7, (reads_reactive_ ? previous.reactive : previous.colour).memory);
  set_memory(resolve_, 8, output.memory);
  set_memory(resolve_, 9, counter.memory);
  enqueue_rows(device_, queue, resolve_, extent, params.columns_per_item, events);
}

}  // namespace quincunx

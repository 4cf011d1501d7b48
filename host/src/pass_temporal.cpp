// SPDX-License-Identifier: MIT
#include "pass_temporal.h"

#include <cstddef>

#include "kernel_options.h"
#include "program_cache.h"
#include "temporal/temporal_params.h"

namespace quincunx {
namespace {

// From one extent to another, on each axis.
struct Ratio {
  float x, y;
};

Ratio ratio_of(Extent to, Extent from) {
  return {static_cast<float>(static_cast<double>(to.width) / from.width),
          static_cast<float>(static_cast<double>(to.height) / from.height)};
}

}  // namespace

Extent temporal_tiles(Extent output) {
  return {(output.width + kTemporalTile - 1) / kTemporalTile,
          (output.height + kTemporalTile - 1) / kTemporalTile};
}

TileBytes temporal_tile_bytes(Extent output) {
  const auto count = static_cast<std::size_t>(temporal_tiles(output).area());
  return {count * sizeof(TileReprojection), count * sizeof(TileEvidence), count * sizeof(TileLight)};
}

TemporalPass::TemporalPass(const Device::Impl& device, const ResolvePlan& plan)
    : device_(device),
      settings_(plan.settings),
      reads_reactive_(plan.reads_reactive),
      tables_(device, plan.settings.output),
      tiles_kernel_(build_kernel(device, kKernels[1], temporal_tiles_options(plan))),
      light_kernel_(build_kernel(device, kKernels[2], "")),
      resolve_kernel_(build_kernel(device, kKernels[3], temporal_options(plan))),
      total_(device.context, CL_MEM_READ_WRITE, sizeof(TotalLight)) {
  if (plan.follows()) moves_.emplace(device, plan);
  if (settings_.temporal.view == TemporalView::kPicture)
    display_kernel_ = build_kernel(device, kKernels[4], temporal_display_options(plan));
  const std::size_t texel = bytes_per_pixel(settings_.temporal.history);
  for (cl::Buffer& history : histories_) {
    history = cl::Buffer(device.context, CL_MEM_READ_WRITE,
                         static_cast<std::size_t>(settings_.output.area()) * texel);
  }
  const TileBytes bytes = temporal_tile_bytes(settings_.output);
  for (cl::Buffer& tiles : tiles_)
    tiles = cl::Buffer(device.context, CL_MEM_READ_WRITE, bytes.reprojection);
  for (cl::Buffer& light : light_)
    light = cl::Buffer(device.context, CL_MEM_READ_WRITE, bytes.light);
  evidence_ = cl::Buffer(device.context, CL_MEM_READ_WRITE, bytes.evidence);
}

ImageView TemporalPass::history() const {
  return {.memory = histories_[newest_](), .format = settings_.temporal.history, .extent = settings_.output};
}

void TemporalPass::warm_up(const cl::CommandQueue& queue) {
  Scratch scratch(device_);
  PositionTables tables(device_, {1, 1});
  const FrameInputs frame = scratch.frame(settings_);
  forget(queue);
  const ImageView output = scratch.view(Storage::kBuffer, settings_.resolved);
  launch(queue, tables, {frame, frame, output, scratch.counter()}, nullptr);
  queue.finish();
}

void TemporalPass::forget(const cl::CommandQueue& queue) {
  const ImageView view = history();
  queue.enqueueFillBuffer(histories_[newest_], cl_uint{0}, 0,
                          static_cast<std::size_t>(view.extent.area()) * bytes_per_pixel(view.format));
  const TileBytes bytes = temporal_tile_bytes(settings_.output);
  queue.enqueueFillBuffer(tiles_[newest_], cl_uint{0}, 0, bytes.reprojection);
  queue.enqueueFillBuffer(light_[newest_], cl_uint{0}, 0, bytes.light);
  if (moves_) moves_->forget(queue);
  is_first_ = true;
}

void TemporalPass::enqueue(const cl::CommandQueue& queue, const FrameInputs& current,
                           const FrameInputs& previous, const ImageView& output, Counter counter,
                           cl::Event* events) {
  launch(queue, tables_, {current, previous, output, counter}, events);
}

void TemporalPass::launch(const cl::CommandQueue& queue, PositionTables& tables, const Frame& frame,
                          cl::Event* events) {
  const auto next = [&events] { return events != nullptr ? events++ : nullptr; };
  if (moves_) moves_->enqueue(queue, frame.current, frame.previous, next());
  launch_tiles(queue, frame, next());
  launch_light(queue, next());
  launch_resolve(queue, tables, frame, next());
  newest_ = 1 - newest_;
  if (display_kernel_) launch_display(queue, tables, frame, next());
  is_first_ = false;
}

void TemporalPass::launch_tiles(const cl::CommandQueue& queue, const Frame& frame, cl::Event* event) {
  const Extent output = settings_.output;
  const Extent render = frame.current.render;
  const Extent tiles = temporal_tiles(output);
  const Ratio spacing = ratio_of(output, render);
  const Ratio motion = ratio_of(output, frame.previous.render);
  const TemporalTileParams params{
      .frame = {render.width, render.height, layout_of(frame.current.colour), {}, {}},
      .output_width = output.width,
      .output_height = output.height,
      .tiles_x = tiles.width,
      .tiles_y = tiles.height,
      .reprojection = reprojection_layout(),
      .spacing_x = spacing.x,
      .spacing_y = spacing.y,
      .start_x = (.5f + frame.current.jitter.x) * spacing.x,
      .start_y = (.5f + frame.current.jitter.y) * spacing.y,
      .motion_x = motion.x,
      .motion_y = motion.y,
      .judged_apart = settings_.temporal.preset == TemporalPreset::kFast ? 4 : 2};
  queue.enqueueFillBuffer(total_, cl_uint{0}, 0, sizeof(TotalLight));
  tiles_kernel_.setArg(0, params);
  set_memory(tiles_kernel_, 1, frame.current.colour.memory);
  // What a variant does not read may be any buffer.
  set_memory(tiles_kernel_, 2, reprojection_or(frame.output));
  tiles_kernel_.setArg(3, histories_[newest_]);
  tiles_kernel_.setArg(4, tiles_[newest_]);
  tiles_kernel_.setArg(5, tiles_[1 - newest_]);
  tiles_kernel_.setArg(6, evidence_);
  tiles_kernel_.setArg(7, total_);
  enqueue_rows(device_, queue, tiles_kernel_, tiles, 1, event);
}

void TemporalPass::launch_light(const cl::CommandQueue& queue, cl::Event* event) {
  const Extent tiles = temporal_tiles(settings_.output);
  light_kernel_.setArg(0, tiles.width);
  light_kernel_.setArg(1, tiles.height);
  light_kernel_.setArg(2, tiles_[1 - newest_]);
  light_kernel_.setArg(3, evidence_);
  light_kernel_.setArg(4, total_);
  light_kernel_.setArg(5, light_[newest_]);
  light_kernel_.setArg(6, light_[1 - newest_]);
  enqueue_rows(device_, queue, light_kernel_, tiles, 1, event);
}

void TemporalPass::launch_resolve(const cl::CommandQueue& queue, PositionTables& tables, const Frame& frame,
                                  cl::Event* event) {
  const Extent output = tables.output();
  const Extent now = frame.current.render;
  const Extent before = frame.previous.render;
  const Extent tiles = temporal_tiles(output);
  const Ratio spacing = ratio_of(output, now);
  const Ratio motion = ratio_of(output, before);
  TemporalParams params{.output_width = output.width,
                        .output_height = output.height,
                        .frame0 = {now.width, now.height, layout_of(frame.current.colour), {}, {}},
                        .frame1 = {before.width, before.height, {}, {}, {}},
                        .reprojection = reprojection_layout(),
                        .output = layout_of(frame.output),
                        .columns = tables.columns(),
                        .counter = frame.counter.index,
                        .columns_per_item = columns_per_item(device_, output.width, kTemporalTile),
                        .motion_x = motion.x,
                        .motion_y = motion.y,
                        .spacing_x = spacing.x,
                        .spacing_y = spacing.y,
                        .tiles_x = tiles.width,
                        .tiles_y = tiles.height};
  if (reads_reactive_) {
    params.frame0.reactive = layout_of(frame.current.reactive);
    params.frame1.reactive = layout_of(frame.previous.reactive);
  }
  resolve_kernel_.setArg(0, params);
  resolve_kernel_.setArg(1, tables.get(queue, now, frame.current.jitter));
  set_memory(resolve_kernel_, 2, frame.current.colour.memory);
  set_memory(resolve_kernel_, 3, reprojection_or(frame.output));
  set_memory(resolve_kernel_, 4, (reads_reactive_ ? frame.current.reactive : frame.current.colour).memory);
  set_memory(resolve_kernel_, 5, (reads_reactive_ ? frame.previous.reactive : frame.current.colour).memory);
  resolve_kernel_.setArg(6, histories_[newest_]);
  resolve_kernel_.setArg(7, tiles_[newest_]);
  resolve_kernel_.setArg(8, tiles_[1 - newest_]);
  resolve_kernel_.setArg(9, light_[1 - newest_]);
  resolve_kernel_.setArg(10, histories_[1 - newest_]);
  set_memory(resolve_kernel_, 11, frame.output.memory);
  set_memory(resolve_kernel_, 12, frame.counter.memory);
  enqueue_rows(device_, queue, resolve_kernel_, output, params.columns_per_item, event);
}

void TemporalPass::launch_display(const cl::CommandQueue& queue, PositionTables& tables, const Frame& frame,
                                  cl::Event* event) {
  const Extent output = tables.output();
  const Extent render = frame.current.render;
  const TemporalDisplayParams params{
      .output_width = output.width,
      .output_height = output.height,
      .frame0 = {render.width, render.height, layout_of(frame.current.colour), {}, {}},
      .output = layout_of(frame.output),
      .tiles_x = temporal_tiles(output).width,
      .columns = tables.columns(),
      .columns_per_item = columns_per_item(device_, output.width, kTemporalTile),
      .first = is_first_ ? 1 : 0};
  display_kernel_->setArg(0, params);
  display_kernel_->setArg(1, tables.get(queue, render, frame.current.jitter));
  set_memory(*display_kernel_, 2, frame.current.colour.memory);
  display_kernel_->setArg(3, tiles_[newest_]);
  display_kernel_->setArg(4, histories_[newest_]);
  set_memory(*display_kernel_, 5, frame.output.memory);
  enqueue_rows(device_, queue, *display_kernel_, output, params.columns_per_item, event);
}

}  // namespace quincunx

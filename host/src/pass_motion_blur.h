// SPDX-License-Identifier: MIT
// MotionBlurPass: motion_tiles, motion_neighbours and motion_blur, from the resolved picture to a blurred
// one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "axis_table.h"
#include "pass_common.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class MotionBlurPass {
 public:
  MotionBlurPass(const Device::Impl& device, const ResolveSettings& settings);

  static constexpr std::array<const char*, 3> kKernels = {"motion_tiles", "motion_neighbours", "motion_blur"};

  void warm_up(const cl::CommandQueue& queue);  // blocks

  // Reads velocity, velocity_scale, depth, render and jitter of `inputs` and the whole output extent of
  // `resolved`; writes that of `blurred`, which is other memory of the same format. `events`: one of each
  // kernel, or null.
  void enqueue(const cl::CommandQueue& queue, AxisTables& tables, const FrameInputs& inputs,
               const ImageView& resolved, const ImageView& blurred, cl::Event* events);

  Extent tiles() const { return tiles_of(settings_.output); }

  // TileBlur::kind of each tile of the last frame, row by row. Blocks.
  std::vector<std::uint8_t> tile_kinds(const cl::CommandQueue& queue) const;

 private:
  static Extent tiles_of(Extent output);

  const Device::Impl& device_;
  ResolveSettings settings_;
  std::array<cl::Kernel, 3> kernels_;
  cl::Buffer streaks_;  // TileStreaks of each tile
  cl::Buffer longest_;  // int: the longest streak of the frame
  cl::Buffer blurs_;    // TileBlur of each tile
};

}  // namespace quincunx

// SPDX-License-Identifier: MIT
// TemporalPass: from this frame and a history of its own to the output extent.
#pragma once

#include <array>
#include <optional>

#include "pass_common.h"
#include "pass_moves.h"
#include "position_table.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"
#include "temporal/tile.h"

namespace quincunx {

class TemporalPass {
 public:
  TemporalPass(const Device::Impl& device, const ResolvePlan& plan);

  // In the order in which they run. Without velocity the first is left out, with a view other than the
  // picture the last.
  static constexpr std::array<const char*, 5> kKernels = {"reproject", "temporal_tiles", "temporal_light",
                                                          "resolve_temporal", "temporal_display"};

  void warm_up(const cl::CommandQueue& queue);  // blocks

  // What the next frame finds is no history.
  void forget(const cl::CommandQueue& queue);

  // Reads of `current` colour, velocity, depth and reactive as planned, render, jitter and velocity_scale; of
  // `previous`, the frame before, depth, reactive, render and jitter. Writes the whole output extent of
  // `output`, and the history. `events`, if not null, takes one a kernel.
  void enqueue(const cl::CommandQueue& queue, const FrameInputs& current, const FrameInputs& previous,
               const ImageView& output, Counter counter, cl::Event* events);

  // What was written last: RGB and confidence, output extent, tight.
  ImageView history() const;

 private:
  struct Frame {
    const FrameInputs& current;
    const FrameInputs& previous;
    const ImageView& output;
    Counter counter;
  };
  void launch(const cl::CommandQueue& queue, PositionTables& tables, const Frame& frame, cl::Event* events);
  void launch_tiles(const cl::CommandQueue& queue, const Frame& frame, cl::Event* event);
  void launch_light(const cl::CommandQueue& queue, cl::Event* event);
  void launch_resolve(const cl::CommandQueue& queue, PositionTables& tables, const Frame& frame,
                      cl::Event* event);
  void launch_display(const cl::CommandQueue& queue, PositionTables& tables, const Frame& frame,
                      cl::Event* event);
  TexelLayout reprojection_layout() const { return moves_ ? layout_of(moves_->view()) : TexelLayout{}; }
  cl_mem reprojection_or(const ImageView& other) const {
    return moves_ ? moves_->view().memory : other.memory;
  }

  const Device::Impl& device_;
  ResolveSettings settings_;
  bool reads_reactive_;
  PositionTables tables_;
  std::optional<MovePass> moves_;
  cl::Kernel tiles_kernel_;
  cl::Kernel light_kernel_;
  cl::Kernel resolve_kernel_;
  std::optional<cl::Kernel> display_kernel_;
  std::array<cl::Buffer, 2> histories_;
  std::array<cl::Buffer, 2> tiles_;  // TileReprojection of each tile
  std::array<cl::Buffer, 2> light_;  // TileLight of each tile
  cl::Buffer evidence_;              // TileEvidence of each tile
  cl::Buffer total_;                 // TotalLight
  std::size_t newest_ = 0;           // of histories_, tiles_ and light_
  bool is_first_ = true;             // there is no history
};

// Tiles of an output, and the memory that each kind of struct takes for all of them.
Extent temporal_tiles(Extent output);
struct TileBytes {
  std::size_t reprojection, evidence, light;
};
TileBytes temporal_tile_bytes(Extent output);

}  // namespace quincunx

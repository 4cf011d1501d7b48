// SPDX-License-Identifier: MIT
// ReprojectPass: reproject and resolve_reprojected, from this frame and the previous one to the output
// extent.
#pragma once

#include <array>
#include <optional>

#include "pass_common.h"
#include "pass_moves.h"
#include "position_table.h"
#include "quincunx/frame.h"
#include "quincunx/resolve_plan.h"

namespace quincunx {

class ReprojectPass {
 public:
  ReprojectPass(const Device::Impl& device, const ResolvePlan& plan);

  // In the order in which they run; without velocity the second alone.
  static constexpr std::array<const char*, 2> kKernels = {"reproject", "resolve_reprojected"};
  bool moves() const { return moves_.has_value(); }

  void warm_up(const cl::CommandQueue& queue);  // blocks

  // Reads of both frames: colour, velocity and depth as planned, render, jitter; of `current` also reactive
  // and velocity_scale, of `previous` that only where residuals count. Writes the whole output extent of
  // `output`. `events`, if not null, takes one a kernel.
  void enqueue(const cl::CommandQueue& queue, const FrameInputs& current, const FrameInputs& previous,
               const ImageView& output, Counter counter, cl::Event* events);

  ImageView move_view() const { return moves_->view(); }  // see MovePass; only where moves()

 private:
  void launch(const cl::CommandQueue& queue, PositionTables& tables, const FrameInputs& current,
              const FrameInputs& previous, const ImageView& output, Counter counter, cl::Event* events);

  const Device::Impl& device_;
  ResolveSettings settings_;
  bool reads_reactive_;
  PositionTables tables_;
  std::optional<MovePass> moves_;
  cl::Kernel resolve_;
};

// How far a sample reaches, in render pixels, on an axis with `render` samples under `output` pixels: the
// fewer samples, the sharper. Within [0.875, 1]; measured, see docs/pipeline.md.
double sample_reach(int render, int output);

}  // namespace quincunx

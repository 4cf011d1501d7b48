// SPDX-License-Identifier: MIT
// PassChain: the passes of a plan, compiled, with the resources that they keep between them, and the loop that runs a
// frame.
//
// Everything is allocated at construction. Not thread-safe. May throw cl::Error, construction also BuildError and
// StatusError.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "passes/pass.h"
#include "quincunx/device.h"

namespace quincunx {

// Sets the views of the caller's inputs from frame.inputs and frame.previous.
void bind_inputs(PassFrame& frame);

// Throws StatusError.
Image allocate_image(const Device& device, Extent extent, PixelFormat format,
                     Storage storage = Storage::kBuffer);

// Says once in the log that kernels are being compiled, where that takes longer than a user waits without asking.
class CompileNotice {
 public:
  explicit CompileNotice(std::chrono::milliseconds patience = std::chrono::seconds(2))
      : patience_(patience) {}
  // To be called before each of `kernels` on that device.
  void before_kernel(std::size_t kernels, const std::string& device);

 private:
  std::chrono::milliseconds patience_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool said_ = false;
};

class PassChain {
 public:
  PassChain(const Device& device, const PlanFacts& facts);
  PassChain(const PassChain&) = delete;
  PassChain& operator=(const PassChain&) = delete;

  const PlanFacts& facts() const { return facts_; }

  // Returns the extent of the frame's picture.
  Extent output_of(const FrameInputs& inputs) const {
    return inputs.output_extent == Extent{} ? facts_.settings.output_extent : inputs.output_extent;
  }

  // Runs every pass once on a picture of one pixel, so that the device finishes compiling it. Blocks.
  void warm_up();

  // A frame with every resource of the plan bound: the caller's images, the outputs, and what the chain owns.
  // `previous` null: no history.
  PassFrame frame(const FrameInputs& inputs, const FrameInputs* previous, const FrameOutputs& outputs,
                  Counter counter);

  // Enqueues what the outputs need, in order. Adds each pass to the report and, if not null, its event to `events`.
  // Afterwards the frame's resources are those of the previous frame.
  void run(PassFrame frame, const FrameOutputs& outputs, FrameReport& report, cl::Event* events);

  // Enqueues those that follow merge_histories alone: the picture of the merged history, which is bound. The previous
  // frame's resources stay what they are.
  void show(const PassFrame& frame, const FrameOutputs& outputs, FrameReport& report, cl::Event* events);

  // From now on run() waits for each pass, and its time in the report is the host clock's.
  void wait_for_each_pass(bool wait) { waits_ = wait; }

  // Whether a pass reads or writes it.
  bool has(Resource resource) const;

  // The pass of a kernel; null where the plan has none.
  Pass* find(std::string_view kernel) const;
  // Enqueues one pass alone.
  static void enqueue(Pass& pass, const PassFrame& frame, cl::Event* event);
  const std::vector<std::unique_ptr<Pass>>& passes() const { return passes_; }

  // A resource that the chain owns, as it was written last. Empty where the plan has none.
  ImageView newest(Resource resource) const;

 private:
  struct Owned {
    Resource resource;
    Area area;
    std::array<Image, 2> images;  // the second only where the previous frame's is read, too
    bool is_resampled = false;    // where the output has another size than the history
  };

  void allocate(const ResourceUse& use);
  bool is_resampled(Resource resource) const;
  void take_resampled(PassFrame& frame);
  void forget(const PassFrame& frame);
  // Those from `first` on.
  void mark_needed(const PassFrame& frame, const FrameOutputs& outputs, std::size_t first);
  void run_needed(PassFrame& frame, FrameReport& report, cl::Event* events);
  // Whether a pass of the next frame reads it.
  bool keeps(Resource resource) const {
    return previous_of(resource) != resource && has(previous_of(resource));
  }

  Device device_;
  PlanFacts facts_;
  CompileNotice notice_;
  PassTables tables_;
  std::vector<ResourceUse> resources_;
  std::vector<std::unique_ptr<Pass>> passes_;
  std::vector<Owned> owned_;
  std::array<bool, kResourceCount> kept_ = {};  // keeps(), of each resource
  std::vector<bool> needed_;                    // whether the frame that runs needs each pass
  bool waits_ = false;                          // for each pass
  std::size_t next_ = 0;                        // the image of each pair that the next frame writes
};

}  // namespace quincunx

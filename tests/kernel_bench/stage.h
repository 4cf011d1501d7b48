// SPDX-License-Identifier: MIT
// Cases of the kernel benchmark, their timing, and Stage: the images that the kernels of one output size work on.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "passes/pass.h"
#include "passes/tables.h"
#include "quincunx/device.h"
#include "quincunx/frame.h"

namespace quincunx::bench {

struct Case {
  std::string name;
  double scale = 1;                  // render extent / output extent
  double wanted = 0;                 // aim of the project, in times of the first case; 0: none
  std::uint64_t bytes = 0;           // read and written, each texel counted once
  std::function<double()> run = {};  // runs once, to the end, and returns ms on the clock that suits it
};

struct Timing {
  double median = 0, p95 = 0, minimum = 0;
};

struct Figures {
  Case what;
  Timing ms;            // as Case::run returned them
  Timing processor_ms;  // the whole process, all threads: on a CPU what the run cost, however busy it was
};

// Times many cases side by side, after `warm_rounds` that do not count: every round runs each case once, so that a busy
// machine slows all alike.
std::vector<Figures> run_interleaved(const std::vector<Case>& cases, int warm_rounds, int rounds);

// Wall clock of one run, ms.
double wall_ms(const std::function<void()>& run);

std::uint64_t bytes_of(Extent extent, PixelFormat format);
Extent scaled(Extent output, double scale);

// Lives longer than the cases that use it.
class Stage {
 public:
  Stage(Device device, Extent output);

  const Device& device() const { return device_; }
  const Device::Impl& impl() const { return *device_.impl(); }
  Extent output() const { return output_; }
  AxisTables& tables() { return tables_; }
  Counter counter() const { return {counter_(), 0}; }

  // Seeded noise; floats and halves lie between 0.1 and 1, without denormals or infinities to slow a kernel
  // down. One image for each extent, format and `index`, shared by all who ask for it.
  ImageView noise(Extent extent, PixelFormat format, int index = 0);

  // The same with one value, 0.5, in every channel.
  ImageView constant(Extent extent, PixelFormat format);

  // A velocity target whose texel (x, y) holds (value(x, y), 0).
  ImageView velocity(Extent extent, const std::function<float(int x, int y)>& value);

  // Colour, velocity, depth and reactive values of one frame at `render`.
  FrameInputs frame(Extent render, PixelFormat colour, float jitter, int index);

  // Adds to `cases` a case that times `enqueue` by the events of its `kernels` kernels.
  using Enqueue = std::function<void(cl::Event*)>;
  static void add(std::vector<Case>& cases, Case what, Enqueue enqueue, int kernels = 1);

  // The float4 copy of the output, the unit of speed.
  void add_copy(std::vector<Case>& cases);

 private:
  struct Noise {
    Extent extent;
    PixelFormat format;
    int index;
    Image image;
  };

  Device device_;
  Extent output_;
  AxisTables tables_;
  cl::Buffer counter_;
  std::vector<Noise> images_;
  std::vector<Image> velocities_;
  std::vector<Image> constants_;
};

}  // namespace quincunx::bench

// SPDX-License-Identifier: MIT
#include "stage.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <stdexcept>
#include <utility>

#include "bench/harness/measuring.h"

namespace quincunx::bench {
namespace {

double milliseconds(const cl::Event& event) {
  event.wait();
  const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
  return static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() - start) * 1e-6;
}

// Random bytes whose floats or halves have exponents of 2^-3 and 2^-2 or so.
std::vector<unsigned char> noise_bytes(std::size_t count, PixelFormat format) {
  const bool half = format == PixelFormat::kRGBA16F || format == PixelFormat::kRG16F;
  const bool single =
      format == PixelFormat::kRGBA32F || format == PixelFormat::kR32F || format == PixelFormat::kRG32F;
  std::mt19937 random(1);
  std::vector<unsigned char> bytes(count);
  for (unsigned char& byte : bytes)
    byte = static_cast<unsigned char>(random());
  for (std::size_t i = 1; half && i < count; i += 2)
    bytes[i] = static_cast<unsigned char>(0x34 + random() % 8);
  for (std::size_t i = 3; single && i < count; i += 4)
    bytes[i] = static_cast<unsigned char>(0x3e);
  return bytes;
}

Timing summarise(std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  return {ms[ms.size() / 2], ms[ms.size() * 95 / 100], ms.front()};
}

}  // namespace

std::uint64_t bytes_of(Extent extent, PixelFormat format) {
  return static_cast<std::uint64_t>(extent.area()) * bytes_per_pixel(format);
}

Extent scaled(Extent output, double scale) {
  return {std::max(1, static_cast<int>(std::lround(output.width * scale))),
          std::max(1, static_cast<int>(std::lround(output.height * scale)))};
}

Stage::Stage(Device device, Extent output)
    : device_(std::move(device)),
      output_(output),
      tables_(*device_.impl(), output),
      counter_(device_.impl()->context, CL_MEM_READ_WRITE, sizeof(cl_uint)) {}

ImageView Stage::noise(Extent extent, PixelFormat format, int index) {
  for (const Noise& noise : images_) {
    if (noise.extent == extent && noise.format == format && noise.index == index) return noise.image.view();
  }
  Result<Image> image = device_.allocate(extent, format);
  if (!image.ok()) throw std::runtime_error(image.status().message());
  const std::vector<unsigned char> texels = noise_bytes(bytes_of(extent, format), format);
  const Status status = device_.upload(image->view(), extent, texels.data());
  if (!status.ok()) throw std::runtime_error(status.message());
  images_.push_back({extent, format, index, std::move(image).value()});
  return images_.back().image.view();
}

ImageView Stage::constant(Extent extent, PixelFormat format) {
  Result<Image> image = device_.allocate(extent, format);
  if (!image.ok()) throw std::runtime_error(image.status().message());
  const bool half = format == PixelFormat::kRGBA16F;
  std::vector<unsigned char> texels(bytes_of(extent, format));
  const std::uint32_t bits = half ? 0x38003800u : 0x3f000000u;  // 0.5, twice as halves
  for (std::size_t i = 0; i < texels.size(); i += sizeof(bits))
    std::memcpy(texels.data() + i, &bits, sizeof(bits));
  const Status status = device_.upload(image->view(), extent, texels.data());
  if (!status.ok()) throw std::runtime_error(status.message());
  constants_.push_back(std::move(image).value());
  return constants_.back().view();
}

ImageView Stage::velocity(Extent extent, const std::function<float(int x, int y)>& value) {
  Result<Image> image = device_.allocate(extent, PixelFormat::kRG32F);
  if (!image.ok()) throw std::runtime_error(image.status().message());
  std::vector<Vec2> texels;
  for (int y = 0; y < extent.height; ++y) {
    for (int x = 0; x < extent.width; ++x)
      texels.push_back({value(x, y), 0});
  }
  const Status status = device_.upload(image->view(), extent, texels.data());
  if (!status.ok()) throw std::runtime_error(status.message());
  velocities_.push_back(std::move(image).value());
  return velocities_.back().view();
}

FrameInputs Stage::frame(Extent render, PixelFormat colour, float jitter, int index) {
  FrameInputs inputs;
  inputs.colour = noise(render, colour, index);
  inputs.velocity = noise(render, PixelFormat::kRG16F, index);
  inputs.depth = noise(render, PixelFormat::kR32F, index);
  inputs.reactive = noise(render, PixelFormat::kR8, index);
  inputs.render_extent = render;
  inputs.jitter = {jitter, jitter};
  return inputs;
}

void Stage::add(std::vector<Case>& cases, Case what, Enqueue enqueue, int kernels) {
  what.run = [enqueue = std::move(enqueue), kernels] {
    std::vector<cl::Event> events(static_cast<std::size_t>(kernels));
    enqueue(events.data());
    double ms = 0;
    for (const cl::Event& event : events)
      ms += milliseconds(event);
    return ms;
  };
  cases.push_back(std::move(what));
}

void Stage::add_copy(std::vector<Case>& cases) {
  auto made = CopyKernel::create(device_, output_);
  if (!made.ok()) throw std::runtime_error(made.status().message());
  const auto copy = std::make_shared<CopyKernel>(std::move(made).value());
  cases.push_back({.name = "copy", .bytes = copy->bytes(), .run = [copy] {
                     auto ms = copy->run();
                     if (!ms.ok()) throw std::runtime_error(ms.status().message());
                     return ms.value();
                   }});
}

std::vector<Figures> run_interleaved(const std::vector<Case>& cases, int warm_rounds, int rounds) {
  struct Samples {
    std::vector<double> ms, processor;
  };
  std::vector<Samples> samples(cases.size());
  for (int round = -warm_rounds; round < rounds; ++round) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const double start = processor_ms();
      const double ms = cases[i].run();
      const double processor = processor_ms() - start;
      if (round < 0) continue;
      samples[i].ms.push_back(ms);
      samples[i].processor.push_back(processor);
    }
  }
  std::vector<Figures> figures;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    figures.push_back({cases[i], summarise(samples[i].ms), summarise(samples[i].processor)});
  }
  return figures;
}

double wall_ms(const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace quincunx::bench

// SPDX-License-Identifier: MIT
// quincunx-kernel-bench: device time of each pass beside a float4 copy of the output, the unit of speed.
//
// Every round runs the copy and then each case once, so that a busy machine slows all of them alike; the
// ratio is that of the medians. Times are CL events of the kernels alone.
#include <fmt/format.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "kernel_options.h"
#include "pass_clear.h"
#include "pass_present.h"
#include "pass_resolve.h"
#include "pass_scale.h"
#include "program_cache.h"

namespace quincunx {
namespace {

constexpr const char* kCopySource = R"(
__kernel void copy(__global const float4* source, __global float4* output, int width, int height) {
  const int x = get_global_id(0);
  const int y = get_global_id(1);
  if (x >= width || y >= height) return;
  output[y * width + x] = source[y * width + x];
})";

struct Options {
  std::string device;
  std::string filter;
  std::string json;
  std::vector<int> output = {1280, 720};
  std::vector<double> scales = {0.5, 0.71, 1.0};
  int rounds = 40;
  int warm_rounds = 5;
};

struct Case {
  std::string name;
  std::uint64_t bytes = 0;
  std::function<void(cl::Event*)> run;
  std::vector<double> ms = {};
  std::vector<double> cpu_ms = {};
};

// Processor time of this process, all threads: on a CPU device what the kernel cost, however busy the machine
// is.
double processor_ms() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

struct Summary {
  double median, p95, minimum;
};

Summary summarise(std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  return {ms[ms.size() / 2], ms[ms.size() * 95 / 100], ms.front()};
}

double milliseconds(const cl::Event& event) {
  event.wait();
  const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
  return static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() - start) * 1e-6;
}

// Everything that the cases use; alive until the last has run.
class Bench {
 public:
  Bench(Device device, const Options& options)
      : device_(std::move(device)),
        impl_(*device_.impl()),
        output_{options.output[0], options.output[1]},
        tables_(impl_, output_),
        counter_(impl_.context, CL_MEM_READ_WRITE, sizeof(cl_uint)) {
    add_copy();
    for (const double scale : options.scales)
      add_scaled(scale);
    add_presents();
    add_clears();
    std::erase_if(cases_, [&](const Case& c) {
      return c.name != "copy" && c.name.find(options.filter) == std::string::npos;
    });
  }

  void run(const Options& options) {
    for (int round = -options.warm_rounds; round < options.rounds; ++round) {
      for (Case& one : cases_) {
        cl::Event event;
        const double cpu_start = processor_ms();
        one.run(&event);
        const double ms = milliseconds(event);
        if (round < 0) continue;
        one.ms.push_back(ms);
        one.cpu_ms.push_back(processor_ms() - cpu_start);
      }
    }
  }

  const std::vector<Case>& cases() const { return cases_; }
  const DeviceInfo& info() const { return device_.info(); }

 private:
  // Seeded noise in [0, 1): half and float alike, no denormals or infinities to slow a kernel down.
  ImageView noise(Extent extent, PixelFormat format) {
    Image image = std::move(device_.allocate(extent, format).value());
    std::mt19937 random(1);
    const std::size_t bytes = static_cast<std::size_t>(extent.area()) * bytes_per_pixel(format);
    std::vector<unsigned char> texels(bytes);
    const bool half = format == PixelFormat::kRGBA16F || format == PixelFormat::kRG16F;
    const bool single =
        format == PixelFormat::kRGBA32F || format == PixelFormat::kR32F || format == PixelFormat::kRG32F;
    for (std::size_t i = 0; i < bytes; ++i)
      texels[i] = static_cast<unsigned char>(random());
    for (std::size_t i = 1; half && i < bytes; i += 2)
      texels[i] = static_cast<unsigned char>(0x34 + random() % 8);
    for (std::size_t i = 3; single && i < bytes; i += 4)
      texels[i] = static_cast<unsigned char>(0x3e);
    if (!device_.upload(image.view(), extent, texels.data()).ok()) std::abort();
    images_.push_back(std::move(image));
    return images_.back().view();
  }

  void add(std::string name, std::uint64_t bytes, std::function<void(cl::Event*)> run) {
    cases_.push_back({std::move(name), bytes, std::move(run), {}});
  }

  std::uint64_t bytes_of(Extent extent, PixelFormat format) const {
    return static_cast<std::uint64_t>(extent.area()) * bytes_per_pixel(format);
  }

  void add_copy() {
    cl::Program program(impl_.context, kCopySource);
    program.build(impl_.device, kCommonBuildOptions);
    cl::Kernel kernel(program, "copy");
    set_memory(kernel, 0, noise(output_, PixelFormat::kRGBA32F).memory);
    set_memory(kernel, 1, noise(output_, PixelFormat::kRGBA32F).memory);
    kernel.setArg(2, output_.width);
    kernel.setArg(3, output_.height);
    add("copy", 2 * bytes_of(output_, PixelFormat::kRGBA32F), [this, kernel](cl::Event* event) {
      const auto groups = static_cast<std::size_t>((output_.width + 63) / 64);
      impl_.queue.enqueueNDRangeKernel(kernel, cl::NullRange,
                                       cl::NDRange(groups * 64, static_cast<std::size_t>(output_.height)),
                                       cl::NDRange(64, 1), nullptr, event);
    });
  }

  FrameInputs frame(Extent render, PixelFormat colour, float jitter) {
    FrameInputs inputs;
    inputs.colour = noise(render, colour);
    inputs.velocity = noise(render, PixelFormat::kRG16F);
    inputs.depth = noise(render, PixelFormat::kR32F);
    inputs.reactive = noise(render, PixelFormat::kR8);
    inputs.render = render;
    inputs.jitter = {jitter, jitter};
    return inputs;
  }

  void add_scale(const std::string& suffix, Method method, const ResolveSettings& settings,
                 const FrameInputs& inputs) {
    auto pass = std::make_shared<ScalePass>(impl_, method, settings);
    const ImageView resolved = noise(output_, settings.resolved);
    add(pass->kernel_name() + suffix,
        bytes_of(inputs.render, settings.colour) + bytes_of(output_, settings.resolved),
        [=, this](cl::Event* event) {
          pass->enqueue(impl_.queue, tables_, inputs, resolved, {counter_(), 0}, event);
        });
  }

  void add_resolve(const std::string& suffix, const ResolvePlan& plan, const FrameInputs& current,
                   const FrameInputs& previous) {
    auto pass = std::make_shared<ResolvePass>(impl_, plan);
    const ImageView resolved = noise(output_, plan.settings.resolved);
    std::uint64_t bytes =
        2 * bytes_of(current.render, plan.settings.colour) + bytes_of(output_, plan.settings.resolved);
    if (plan.velocity != VelocitySource::kNone) bytes += 2 * bytes_of(current.render, PixelFormat::kRG16F);
    add("resolve_quincunx" + suffix, bytes, [=, this](cl::Event* event) {
      pass->enqueue(impl_.queue, tables_, current, previous, resolved, {counter_(), 0}, event);
    });
  }

  void add_scaled(double scale) {
    const Extent render{static_cast<int>(output_.width * scale + .5),
                        static_cast<int>(output_.height * scale + .5)};
    for (const PixelFormat colour : {PixelFormat::kRGBA16F, PixelFormat::kRGBA32F}) {
      const char* name = colour == PixelFormat::kRGBA16F ? "half" : "float";
      ResolvePlan plan;
      plan.settings = {.output = output_, .target = render, .colour = colour};
      plan.velocity = VelocitySource::kTarget;
      const FrameInputs current = frame(render, colour, .25f);
      const FrameInputs previous = frame(render, colour, -.25f);
      const std::string suffix = fmt::format(" {:.2f} {}", scale, name);
      add_scale(suffix, Method::kPoint, plan.settings, current);
      add_scale(suffix, Method::kBilinear, plan.settings, current);
      add_resolve(suffix, plan, current, previous);
      if (colour != PixelFormat::kRGBA16F) continue;
      plan.reads_reactive = true;
      add_resolve(suffix + " reactive", plan, current, previous);
      plan.reads_reactive = false;
      plan.velocity = VelocitySource::kNone;
      add_resolve(suffix + " still", plan, current, previous);
      plan.velocity = VelocitySource::kCamera;
      add_resolve(suffix + " camera", plan, current, previous);
      plan.velocity = VelocitySource::kTarget;
      plan.settings.resolved = PixelFormat::kRGBA16F;
      add_scale(suffix + " to half", Method::kBilinear, plan.settings, current);
      add_resolve(suffix + " to half", plan, current, previous);
    }
  }

  void add_presents() {
    for (const PixelFormat resolved : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F}) {
      for (const ToneMap tone_map : {ToneMap::kClamp, ToneMap::kReinhard, ToneMap::kAces}) {
        const ResolveSettings settings{.output = output_, .resolved = resolved, .tone_map = tone_map};
        auto pass = std::make_shared<PresentPass>(impl_, settings);
        const ImageView source = noise(output_, resolved);
        const ImageView presented = noise(output_, PixelFormat::kRGBA8);
        add(fmt::format("present {} {}", name_of(tone_map),
                        resolved == PixelFormat::kRGBA32F ? "float" : "half"),
            bytes_of(output_, resolved) + bytes_of(output_, PixelFormat::kRGBA8),
            [=, this](cl::Event* event) {
              pass->enqueue(impl_.queue, source, 1.0f, presented, {counter_(), 0}, event);
            });
      }
    }
  }

  void add_clears() {
    for (const PixelFormat format : {PixelFormat::kRGBA16F, PixelFormat::kRG16F}) {
      auto pass = std::make_shared<ClearPass>(impl_, Storage::kBuffer, format);
      const ImageView image = noise(output_, format);
      add(fmt::format("clear_region {}", name_of(format)), bytes_of(output_, format),
          [=, this](cl::Event* event) {
            const float value[4] = {0, 0, 0, 1};
            pass->enqueue(impl_.queue, image, output_, value, event);
          });
    }
  }

  Device device_;
  const Device::Impl& impl_;
  Extent output_;
  AxisTables tables_;
  cl::Buffer counter_;
  std::vector<Image> images_;
  std::vector<Case> cases_;
};

void print(const Bench& bench, const Options& options) {
  const double unit = summarise(bench.cases().front().ms).median;
  const double cpu_unit = summarise(bench.cases().front().cpu_ms).median;
  fmt::print("{} | {} {}\noutput {}x{}, {} rounds; ratio = median / median of a float4 copy\n\n",
             bench.info().name, bench.info().platform, bench.info().driver, options.output[0],
             options.output[1], options.rounds);
  fmt::print("{:<38} {:>9} {:>9} {:>9} {:>7} {:>9} {:>7} {:>7}\n", "pass", "median ms", "p95 ms", "min ms",
             "ratio", "cpu ms", "ratio", "GB/s");
  for (const Case& one : bench.cases()) {
    const Summary s = summarise(one.ms);
    const Summary cpu = summarise(one.cpu_ms);
    fmt::print("{:<38} {:>9.3f} {:>9.3f} {:>9.3f} {:>7.2f} {:>9.3f} {:>7.2f} {:>7.1f}\n", one.name, s.median,
               s.p95, s.minimum, s.median / unit, cpu.median, cpu.median / cpu_unit,
               static_cast<double>(one.bytes) / s.median * 1e-6);
  }
}

std::string json_text(const Bench& bench, const Options& options) {
  const double unit = summarise(bench.cases().front().ms).median;
  const auto quoted = [](const std::string& text) {
    std::string safe;
    for (const char c : text)
      safe += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
    return "\"" + safe + "\"";
  };
  std::string text = fmt::format(
      "{{\n  \"device\": {},\n  \"platform\": {},\n  \"driver\": {},\n  \"output\": [{}, {}],\n  \"rounds\": "
      "{},\n"
      "  \"passes\": [",
      quoted(bench.info().name), quoted(bench.info().platform), quoted(bench.info().driver),
      options.output[0], options.output[1], options.rounds);
  const char* separator = "";
  for (const Case& one : bench.cases()) {
    const Summary s = summarise(one.ms);
    text += fmt::format(
        "{}\n    {{\"name\": {}, \"median_ms\": {:.4f}, \"p95_ms\": {:.4f}, \"min_ms\": {:.4f}, "
        "\"ratio_to_copy\": {:.3f}, "
        "\"processor_ms\": {:.4f}, "
        "\"bytes\": {}}}",
        separator, quoted(one.name), s.median, s.p95, s.minimum, s.median / unit,
        summarise(one.cpu_ms).median, one.bytes);
    separator = ",";
  }
  return text + "\n  ]\n}\n";
}

int run(const Options& options) {
  Result<Device> device = Device::open(options.device);
  if (!device.ok()) {
    fmt::print(stderr, "{}\n", device.status().message());
    return 1;
  }
  Bench bench(std::move(device).value(), options);
  bench.run(options);
  print(bench, options);
  if (options.json.empty()) return 0;
  std::ofstream file(options.json);
  file << json_text(bench, options);
  if (file.flush()) return 0;
  fmt::print(stderr, "cannot write '{}'; give --json a path in a folder that exists\n", options.json);
  return 1;
}

}  // namespace
}  // namespace quincunx

int main(int argc, char** argv) {
  quincunx::Options options;
  CLI::App app("Device time of each Quincunx kernel, in units of a float4 copy");
  app.add_option("--device", options.device, "part of a device's name, its number, cpu or gpu");
  app.add_option("--output", options.output, "output width and height")
      ->expected(2)
      ->check(CLI::Range(1, 16384));
  app.add_option("--scales", options.scales, "render scales")->check(CLI::Range(.01, 4.0));
  app.add_option("--rounds", options.rounds, "measured rounds")->check(CLI::Range(1, 100000));
  app.add_option("--filter", options.filter, "only passes whose name contains this");
  app.add_option("--json", options.json, "also write the figures to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    return quincunx::run(options);
  } catch (const cl::Error& error) {
    fmt::print(stderr, "{} failed: {}\n", error.what(), quincunx::error_name(error.err()));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
  }
  return 1;
}

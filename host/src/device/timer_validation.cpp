// SPDX-License-Identifier: MIT
#include "device/device_impl.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "device/program_cache.h"
#include "quincunx/advanced/cache_folder.h"
#include "quincunx/advanced/log.h"

namespace quincunx {
namespace {

// The host's span holds the event's; the rest is for clocks of another rate and for stamps that are rounded.
constexpr double kMostOfHost = 1.1;
// The smallest share of the growth that the host saw. It saw submission and waking up, too, which may by chance take
// longer for the heavy run.
constexpr double kLeastGrowth = 0.5;

// Stamps are in order when this is asked.
double duration_ms(const EventStamps& stamps) {
  return static_cast<double>(stamps.ended - stamps.started) * 1e-6;
}

std::string doubt_about(const TimedLoad& load) {
  const EventStamps& stamps = load.stamps;
  if (stamps.ended < stamps.started) return "they end before they start";
  if (stamps.started < stamps.submitted) return "they start before they are submitted";
  const double ms = duration_ms(stamps);
  if (ms == 0) return "they last 0 ms";
  if (ms > kMostOfHost * load.host_ms)
    return fmt::format("one lasts {:.3f} ms of the {:.3f} ms that the host saw", ms, load.host_ms);
  return {};
}

namespace fs = std::filesystem;

// A chain of operations, each of which needs the one before, so that no compiler can leave one out.
constexpr const char* kSource = R"(
__kernel void known_load(__global uint* output, uint steps) {
  uint value = get_global_id(0);
  for (uint i = 0; i < steps; ++i) value = value * 1664525u + 1013904223u;
  output[get_global_id(0)] = value;
})";
constexpr const char* kKernel = "known_load";
constexpr const char* kOptions = "-cl-std=CL1.2";

class KnownLoad {
 public:
  explicit KnownLoad(const Device::Impl& device)
      : queue_(device.context, device.device, CL_QUEUE_PROFILING_ENABLE),
        output_(device.context, CL_MEM_WRITE_ONLY, kItems * sizeof(cl_uint)) {
    cl::Program program(device.context, std::string(kSource));
    program.build(device.device, kOptions);
    kernel_ = cl::Kernel(program, kKernel);
    kernel_.setArg(0, output_);
    run(1);  // the first run may still compile
  }

  TimedLoad run(cl_uint steps) {
    kernel_.setArg(1, steps);
    cl::Event event;
    const auto start = std::chrono::steady_clock::now();
    queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(kItems), cl::NDRange(kGroup), nullptr,
                                &event);
    queue_.finish();
    const auto end = std::chrono::steady_clock::now();
    return {{event.getProfilingInfo<CL_PROFILING_COMMAND_SUBMIT>(),
             event.getProfilingInfo<CL_PROFILING_COMMAND_START>(),
             event.getProfilingInfo<CL_PROFILING_COMMAND_END>()},
            std::chrono::duration<double, std::milli>(end - start).count()};
  }

 private:
  static constexpr std::size_t kItems = 1024;
  static constexpr std::size_t kGroup = 64;
  cl::CommandQueue queue_;
  cl::Buffer output_;
  cl::Kernel kernel_;
};

// Grows the load until it is long beside submission and waking up; then the last two runs are compared.
std::string doubt_about_one_growth(KnownLoad& load) {
  constexpr double kEnoughMs = 4;
  constexpr cl_uint kMostSteps = 1u << 27;
  cl_uint steps = kHeavyLoad;
  TimedLoad light = load.run(1);
  TimedLoad heavy = load.run(steps);
  while (heavy.host_ms < kEnoughMs && steps < kMostSteps) {
    light = heavy;
    steps *= kHeavyLoad;
    heavy = load.run(steps);
  }
  return doubt_about(light, heavy);
}

std::string doubt_about_events(const Device::Impl& device) {
  constexpr int kAttempts = 5;  // a busy machine may make one seem wrong
  KnownLoad load(device);
  std::string doubt;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    doubt = doubt_about_one_growth(load);
    if (doubt.empty()) break;
  }
  return doubt;
}

PassTimer believed(const Device::Impl& device, const std::string& doubt) {
  if (doubt.empty()) {
    log_line(LogLevel::kDebug,
             fmt::format("pass times of '{}': OpenCL events agree with the host's clock", device.info.name));
    return PassTimer::kEvents;
  }
  log_line(LogLevel::kInfo,
           fmt::format("pass times of '{}': host clock, because OpenCL events are not believed: {}",
                       device.info.name, doubt));
  return PassTimer::kHostClock;
}

// Only that events are believed is kept: a doubt may come from others who use the device at this moment.
bool are_known_to_be_right(const fs::path& path) {
  const auto bytes = read_cache_entry(path);
  return bytes && std::string(bytes->begin(), bytes->end()) == name_of(PassTimer::kEvents);
}

}  // namespace

std::string doubt_about(const TimedLoad& light, const TimedLoad& heavy) {
  for (const TimedLoad* load : {&light, &heavy}) {
    if (std::string doubt = doubt_about(*load); !doubt.empty()) return doubt;
  }
  const double grown = duration_ms(heavy.stamps) - duration_ms(light.stamps);
  const double host_grown = heavy.host_ms - light.host_ms;
  if (grown > 0 && grown >= kLeastGrowth * host_grown) return {};
  return fmt::format("with {} times the work they grow by {:.3f} ms, where the host saw {:.3f} ms",
                     kHeavyLoad, grown, host_grown);
}

PassTimer validated_timer(const Device::Impl& device) {
  if ((device.queue.getInfo<CL_QUEUE_PROPERTIES>() & CL_QUEUE_PROFILING_ENABLE) == 0) return PassTimer::kNone;
  const std::optional<fs::path> folder = cache_folder();
  const fs::path path =
      folder ? *folder / fmt::format("pass_timer-{}.txt", cache_key(device, kSource, kOptions)) : fs::path();
  if (are_known_to_be_right(path)) return PassTimer::kEvents;
  try {
    const PassTimer timer = believed(device, doubt_about_events(device));
    const std::string text = name_of(timer);
    if (folder && timer == PassTimer::kEvents) write_cache_entry(path, {text.begin(), text.end()});
    return timer;
  } catch (const cl::Error& error) {
    return believed(device,
                    fmt::format("{} failed: {} ({})", error.what(), error_name(error.err()), error.err()));
  }
}

PassTimer pass_timer(const Device& device) {
  return device.impl()->timer;
}

const char* name_of(PassTimer timer) {
  switch (timer) {
    case PassTimer::kEvents:
      return "OpenCL event";
    case PassTimer::kHostClock:
      return "host clock";
    case PassTimer::kNone:
      break;
  }
  return "not timed";
}

}  // namespace quincunx

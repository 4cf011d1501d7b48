// SPDX-License-Identifier: MIT
// The inside of a Device, its profile and its clock.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "device/opencl.h"
#include "quincunx/advanced/device_profile.h"
#include "quincunx/advanced/pass_timer.h"
#include "quincunx/device.h"

namespace quincunx {

// The programs that were built in a context, by kernel and options. A driver that keeps its programs still preprocesses
// their source whenever it is handed it, which takes PoCL longer than all else that a service needs to be made.
struct BuiltPrograms {
  std::mutex mutex;
  std::unordered_map<std::string, cl::Program> programs;
};

struct Device::Impl {
  DeviceInfo info;
  cl::Device device;
  cl::Context context;
  cl::CommandQueue queue;
  PassTimer timer = PassTimer::kNone;
  DeviceProfile profile;
  int lanes = 1;  // pixels that a work-item makes at once: 8 or 1 (kernels/include/lanes.h)
  bool limits_registers =
      false;  // cl_nv_compiler_options: the compiler takes a limit of a work-item's registers
  // The driver itself keeps what it compiles from one run to the next, so the program cache leaves kernels to it.
  bool keeps_programs = false;
  std::shared_ptr<BuiltPrograms> built = std::make_shared<BuiltPrograms>();

  // Flags of memory for pictures. PoCL takes it from the host when a kernel first wants it, and ends the process where
  // there is none; so asked, it takes it at once, and says so.
  cl_mem_flags picture_flags() const {
    return CL_MEM_READ_WRITE | (info.kind == DeviceKind::kCpu ? cl_mem_flags{CL_MEM_ALLOC_HOST_PTR} : 0);
  }
};

// Returns the position of the device that a selector of Device::open() names. A number is an index where there is such
// a device, and elsewhere a part of a name.
std::optional<std::size_t> choose_device(const std::string& selector, const std::vector<DeviceInfo>& infos);

bool has_extension(const cl::Device& device, const std::string& extension);

// How long the host waits for commands, in ms; 0: for ever, until the program first waits for a semaphore of another
// API (external.cpp). One that is never signalled would hold the queue, and the host, for ever.
extern std::atomic<int> longest_wait_ms;

// Waits for a command that was flushed. Throws cl::Error, and StatusError after longest_wait_ms.
void wait_for(const cl::Event& event);

// Finds out which handles of other APIs the device takes, and its UUID.
void learn_imports(const cl::Device& device, DeviceInfo& info);

// ---- Device profiles as JSON: the tuned ones of cache_folder(), the shipped ones of host/profiles.

// The device and driver that a profile belongs to.
struct ProfileOwner {
  std::string platform;
  std::string device;
  std::string kind;  // "cpu"
  std::string driver;
};
ProfileOwner owner_of(const DeviceInfo& info);

struct ProfileFile {
  ProfileOwner owner;
  DeviceProfile profile;  // its source is left to the reader
};

// Reads a file's text. Errors: kInvalidArgument, one sentence without the file's name: what is wrong and what would be
// right. Pure.
Result<ProfileFile> parse_profile(const std::string& text);

std::string profile_text(const ProfileFile& file);

// Finds the tuned, shipped or default profile. A tuned file that is damaged, of another version or of another device or
// driver is warned of in one sentence, and passed over.
DeviceProfile find_profile(const Device::Impl& device);

// ---- The choice of the clock that times the passes of a device (timer_validation.cpp); see advanced/pass_timer.h.

// Returns the clock from the cache, or from a known load on a queue of its own, which takes some tens of milliseconds,
// and is logged. Where the load cannot run at all, the host's clock is the answer, and none is kept. Thread-safe. May
// throw cl::Error, of the device's queue.
PassTimer validated_timer(const Device::Impl& device);

// CL_PROFILING_COMMAND_SUBMIT, _START and _END of one event: nanoseconds of the device's own clock.
struct EventStamps {
  std::uint64_t submitted = 0;
  std::uint64_t started = 0;
  std::uint64_t ended = 0;
};

// One run of a known kernel. `host_ms`: from before it was enqueued until it was known to be done.
struct TimedLoad {
  EventStamps stamps;
  double host_ms = 0;
};

inline constexpr int kHeavyLoad = 8;  // times the work of the light one

// Returns why the stamps of a light and a heavy run are not believed, as a clause ("they last 0 ms"); empty where they
// are. Host times may be too long, as on a busy machine, so a doubt is certain only when it comes again. Pure.
std::string doubt_about(const TimedLoad& light, const TimedLoad& heavy);

}  // namespace quincunx

// SPDX-License-Identifier: MIT
#include "quincunx_gl/bridge.h"

#include <CL/cl_gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "caller_texture.h"
#include "gl_sharing.h"
#include "host_copy.h"
#include "quincunx/advanced/log.h"
#include "state_scope.h"

namespace quincunx::gl {
namespace {

void note(std::string* why, const std::string& name, const std::string& obstacle) {
  *why += fmt::format("{}'{}' {}", why->empty() ? "" : "; ", name, obstacle);
}

// The first of `candidates` that makes a context for the GL context; `why` gathers what kept the others.
std::optional<Device> open_sharing(const Context& context, const std::vector<DeviceInfo>& candidates,
                                   std::string* why) {
  const bool is_egl = context.info().system == WindowSystem::kEgl;
  const std::array<cl_context_properties, 5> properties = {
      CL_GL_CONTEXT_KHR, reinterpret_cast<cl_context_properties>(context.context()),
      is_egl ? CL_EGL_DISPLAY_KHR : CL_GLX_DISPLAY_KHR,
      reinterpret_cast<cl_context_properties>(context.display()), 0};
  for (const DeviceInfo& candidate : candidates) {
    if (!candidate.gl_sharing) {
      note(why, candidate.name, "does not offer cl_khr_gl_sharing");
      continue;
    }
    auto device = Device::open(std::to_string(candidate.index), properties.data());
    if (device.ok()) return std::move(device).value();
    note(why, candidate.name,
         fmt::format("does not share with this OpenGL context ({})", device.status().message()));
  }
  return std::nullopt;
}

constexpr int kMinSlots = 2;
constexpr int kMaxSlots = 16;

void check_extent(const char* field, Extent extent, int limit, std::string* faults) {
  if (extent.width >= 1 && extent.height >= 1 && extent.width <= limit && extent.height <= limit) return;
  *faults += fmt::format("{}{} is {}x{} and must lie within 1x1 and {}x{}", faults->empty() ? "" : "; ",
                         field, extent.width, extent.height, limit, limit);
}

void check_format(const char* field, PixelFormat format, std::initializer_list<PixelFormat> allowed,
                  std::string* faults) {
  if (std::find(allowed.begin(), allowed.end(), format) != allowed.end()) return;
  std::string names;
  for (const PixelFormat* other = allowed.begin(); other != allowed.end(); ++other) {
    if (other != allowed.begin()) names += other + 1 == allowed.end() ? " or " : ", ";
    names += name_of(*other);
  }
  *faults +=
      fmt::format("{}{} is {} and must be {}", faults->empty() ? "" : "; ", field, name_of(format), names);
}

void check_absent(const char* field, bool given, std::string* faults) {
  if (given)
    *faults += fmt::format("{}{} is set with imports, and is of the bridge's own targets",
                           faults->empty() ? "" : "; ", field);
}

Status check(const Context& context, const BridgeSettings& settings) {
  if (current_context().context != context.context()) {
    return Status::invalid(
        "Bridge::create: the OpenGL context is not current on this thread; call make_current()");
  }
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  std::string faults;
  check_extent("target_extent", settings.target_extent, limit, &faults);
  check_extent("output_extent", settings.output_extent, limit, &faults);
  if (settings.slots < kMinSlots || settings.slots > kMaxSlots) {
    faults += fmt::format("{}slots is {} and must be {} to {}", faults.empty() ? "" : "; ", settings.slots,
                          kMinSlots, kMaxSlots);
  }
  using enum PixelFormat;
  if (settings.imports) {
    check_format("colour", settings.colour, {kRGBA8, kRGBA16F, kRGBA32F}, &faults);
    check_format("velocity_format", settings.velocity_format, {kRG16F, kRG32F}, &faults);
    check_absent("checkerboard", settings.checkerboard, &faults);
    check_absent("targets kPlaced", settings.targets == Targets::kPlaced, &faults);
  } else {
    check_format("colour", settings.colour, {kRGBA8, kRGBA16F}, &faults);
    check_format("velocity_format", settings.velocity_format, {kRG16F}, &faults);
  }
  check_format("picture", settings.picture, {kRGBA8, kRGBA16F, kRGBA32F}, &faults);
  if (!faults.empty()) return Status::invalid("BridgeSettings: " + faults);
  return {};
}

// Where pixels would else cross to the device and back. A CPU's copies are in place already.
bool gains_by_external(const DeviceInfo& device) {
  return device.imports_opaque_fds && !device.host_unified_memory;
}

Result<std::unique_ptr<Bridge>> make_external(const Device& device, const BridgeSettings& settings) {
  const ErrorScope callers;
  try {
    const auto exporter = Exporter::create(device);
    return std::unique_ptr<Bridge>(std::make_unique<HostCopy>(
        device, settings, exporter->reason(), Transfer::kShared, PlacedForm{}, exporter.get()));
  } catch (const std::exception& error) {
    return Status::unsupported(error.what());
  }
}

Status insisted(const char* way, const Status& status) {
  return {status.code(),
          fmt::format("interop '{}' cannot be used: {}; use 'copy' or 'auto'", way, status.message())};
}

Result<std::unique_ptr<Bridge>> make_host_copy(const Device& device, const BridgeSettings& settings,
                                               std::string reason) {
  const Transfer transfer = device.info().host_unified_memory ? Transfer::kZeroCopy : Transfer::kExplicit;
  try {
    return std::unique_ptr<Bridge>(std::make_unique<HostCopy>(device, settings, std::move(reason), transfer,
                                                              placed_form_for(device.info())));
  } catch (const std::exception& error) {
    return Status::device(
        fmt::format("the copying bridge to '{}' could not be made: {}", device.info().name, error.what()));
  }
}

}  // namespace

Result<Device> open_device(const Context& context, const std::string& selector, Interop interop) {
  if (interop == Interop::kCopy) return Device::open(selector);

  std::optional<Result<Device>> named;  // opened once: a fault of its profile is told once
  if (!selector.empty()) {
    named = Device::open(selector);
    if (!named->ok()) return *named;
  }
  const auto candidates = named ? std::vector<DeviceInfo>{named->value().info()} : Device::list();
  std::string why;
  if (interop != Interop::kExternal) {
    if (auto device = open_sharing(context, candidates, &why)) return *std::move(device);
  }
  if (interop != Interop::kGl) {
    for (const DeviceInfo& candidate : candidates) {
      if (candidate.imports_opaque_fds && candidate.uuid == gl_device_uuid())
        return named ? *named : Device::open(std::to_string(candidate.index));
    }
  }
  if (interop == Interop::kGl) {
    return Status::unsupported(
        fmt::format("interop 'gl' needs an OpenCL device that shares with '{}', and {}; use "
                    "'copy' or 'auto'",
                    context.info().renderer, why.empty() ? "there is none" : why));
  }
  return named ? *named : Device::open(selector);
}

const char* name_of(Interop interop) {
  switch (interop) {
    case Interop::kAuto:
      return "auto";
    case Interop::kGl:
      return "gl";
    case Interop::kExternal:
      return "external";
    case Interop::kCopy:
      return "copy";
  }
  return "unknown";
}

BridgeSettings bridge_settings(const ResolvePlan& plan) {
  return {.target_extent = plan.settings.target_extent,
          .output_extent = plan.settings.output_extent,
          .depth = plan.reads_depth,
          .velocity = plan.velocity == VelocitySource::kTarget,
          .reactive = plan.reads_reactive,
          .checkerboard = plan.settings.targets.shading == Shading::kCheckerboard,
          .colour = plan.settings.colour,
          .velocity_format = plan.settings.velocity,
          .targets = plan.settings.targets.placement};
}

Status Bridge::check_owner(const char* call, bool imports) const {
  if (imports == settings_.imports) return {};
  const char* const reason =
      imports ? "has targets of its own; create it with imports to hand over textures of yours"
              : "was created with imports and has no targets; call import() with yours";
  return Status::invalid(fmt::format("{}: this bridge {}", call, reason));
}

Bridge::Bridge(const BridgeSettings& settings, std::string reason)
    : settings_(settings), reason_(std::move(reason)), textures_(std::make_unique<CallerTextures>()) {}

Bridge::~Bridge() = default;

void Bridge::textures_changed() {
  textures_->forget();
}

bool Bridge::has_depth_format(GLuint depth) {
  return !settings_.imports || textures_->facts(PlaneKind::kDepth, depth).depth_bits > 0;
}

Before Bridge::before() const {
  return settings_.restores_state ? Before::kAsked : Before::kDefault;
}

Status Bridge::check_present(bool begun, GLuint into) {
  if (!begun) {
    return Status::invalid("present: no picture was begun; call begin_present() and dispatch into it first");
  }
  return into == 0 ? Status() : textures_->check_picture(into, settings_.picture, settings_.output_extent);
}

Result<SharedFrame> Bridge::import(const FrameTextures& textures, Extent render) {
  const int slot = next_slot_;
  if (Status status = submit(slot, textures, render); !status.ok()) return status;
  next_slot_ = (slot + 1) % slots();
  return acquire(slot);
}

Result<std::unique_ptr<Bridge>> Bridge::create(const Context& context, const Device& device,
                                               const BridgeSettings& settings) {
  if (Status status = check(context, settings); !status.ok()) return status;
  std::string reason = "copying was asked for";
  const bool placed = settings.targets == Targets::kPlaced;
  if (placed && settings.interop == Interop::kGl) {
    return Status::invalid(
        "interop 'gl' cannot have placed targets, because textures lie in memory of OpenGL's own; use 'copy' "
        "or "
        "'auto', or viewport targets");
  }
  if (placed && settings.interop == Interop::kAuto) {
    reason = "placed targets lie in memory of OpenCL's, not in OpenGL's textures";
  } else if (settings.interop == Interop::kAuto || settings.interop == Interop::kGl) {
    auto shared = GlSharing::create(context, device, settings);
    if (shared.ok()) {
      log_line(LogLevel::kInfo, fmt::format("interop: gl ({})", shared.value()->reason()));
      return shared;
    }
    if (settings.interop == Interop::kGl) return insisted("gl", shared.status());
    reason = shared.status().message();
  }
  if (settings.interop == Interop::kExternal ||
      (settings.interop == Interop::kAuto && gains_by_external(device.info()))) {
    auto external = make_external(device, settings);
    if (external.ok()) {
      log_line(LogLevel::kInfo, fmt::format("interop: external ({})", external.value()->reason()));
      return external;
    }
    if (settings.interop == Interop::kExternal) return insisted("external", external.status());
    reason += "; " + external.status().message();
  }
  auto copy = make_host_copy(device, settings, reason);
  if (copy.ok()) log_line(LogLevel::kInfo, fmt::format("interop: copy ({})", reason));
  return copy;
}

}  // namespace quincunx::gl

// SPDX-License-Identifier: MIT
#include "quincunx_gl/bridge.h"

#include <epoxy/egl.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "gl_sharing.h"
#include "host_copy.h"

namespace quincunx::gl {
namespace {

constexpr int kMinSlots = 2;
constexpr int kMaxSlots = 16;

void check_extent(const char* field, Extent extent, int limit, std::string* faults) {
  if (extent.width >= 1 && extent.height >= 1 && extent.width <= limit && extent.height <= limit) return;
  *faults += fmt::format("{}{} is {}x{} and must lie within 1x1 and {}x{}", faults->empty() ? "" : "; ",
                         field, extent.width, extent.height, limit, limit);
}

Status check(const EglContext& context, const BridgeSettings& settings) {
  if (eglGetCurrentContext() != context.context()) {
    return Status::invalid(
        "Bridge::create: the OpenGL context is not current on this thread; call make_current()");
  }
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  std::string faults;
  check_extent("target", settings.target, limit, &faults);
  check_extent("output", settings.output, limit, &faults);
  if (settings.slots < kMinSlots || settings.slots > kMaxSlots) {
    faults += fmt::format("{}slots is {} and must be {} to {}", faults.empty() ? "" : "; ", settings.slots,
                          kMinSlots, kMaxSlots);
  }
  if (settings.colour != PixelFormat::kRGBA16F && settings.colour != PixelFormat::kRGBA8) {
    faults += fmt::format("{}colour is {} and must be RGBA8 or RGBA16F", faults.empty() ? "" : "; ",
                          name_of(settings.colour));
  }
  if (!faults.empty()) return Status::invalid("BridgeSettings: " + faults);
  return {};
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

const char* name_of(Interop interop) {
  switch (interop) {
    case Interop::kAuto:
      return "auto";
    case Interop::kGl:
      return "gl";
    case Interop::kCopy:
      return "copy";
  }
  return "unknown";
}

Result<std::unique_ptr<Bridge>> Bridge::create(const EglContext& context, const Device& device,
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
  } else if (settings.interop != Interop::kCopy) {
    auto shared = GlSharing::create(context, device, settings);
    if (shared.ok()) {
      spdlog::info("interop: gl ({})", shared.value()->reason());
      return shared;
    }
    if (settings.interop == Interop::kGl) {
      return Status(
          shared.status().code(),
          fmt::format("interop 'gl' cannot be used: {}; use 'copy' or 'auto'", shared.status().message()));
    }
    reason = shared.status().message();
  }
  auto copy = make_host_copy(device, settings, reason);
  if (copy.ok()) spdlog::info("interop: copy ({})", reason);
  return copy;
}

}  // namespace quincunx::gl

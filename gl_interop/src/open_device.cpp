// SPDX-License-Identifier: MIT
#include <CL/cl_gl.h>
#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "quincunx_gl/bridge.h"

namespace quincunx::gl {
namespace {

void note(std::string* why, const std::string& name, const std::string& obstacle) {
  *why += fmt::format("{}'{}' {}", why->empty() ? "" : "; ", name, obstacle);
}

// The first of `candidates` that makes a context for the GL context; `why` gathers what kept the others.
std::optional<Device> open_sharing(const EglContext& context, const std::vector<DeviceInfo>& candidates,
                                   std::string* why) {
  const std::array<cl_context_properties, 5> properties = {
      CL_GL_CONTEXT_KHR, reinterpret_cast<cl_context_properties>(context.context()), CL_EGL_DISPLAY_KHR,
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

}  // namespace

Result<Device> open_device(const EglContext& context, const std::string& selector, Interop interop) {
  if (interop == Interop::kCopy) return Device::open(selector);

  std::vector<DeviceInfo> candidates;
  if (selector.empty()) {
    candidates = Device::list();
  } else {
    auto named = Device::open(selector);
    if (!named.ok()) return named;
    candidates.push_back(named->info());
  }
  std::string why;
  if (auto device = open_sharing(context, candidates, &why)) return *std::move(device);
  if (interop == Interop::kGl) {
    return Status::unsupported(
        fmt::format("interop 'gl' needs an OpenCL device that shares with '{}', and {}; use "
                    "'copy' or 'auto'",
                    context.info().renderer, why.empty() ? "there is none" : why));
  }
  return Device::open(selector);
}

}  // namespace quincunx::gl

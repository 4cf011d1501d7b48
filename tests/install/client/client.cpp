// SPDX-License-Identifier: MIT
// The smallest user of the library: scales a constant picture from 32x32 to 64x48 and looks at one pixel.
#include <quincunx/resolve_service.h>

#include <cmath>
#include <cstdio>
#include <vector>

using namespace quincunx;

static int fail(const Status& status) {
  std::fprintf(stderr, "%s\n", status.message().c_str());
  return 1;
}

int main() {
  const Extent render{32, 32}, output{64, 48};
  auto device = Device::open("cpu");
  if (!device.ok()) return fail(device.status());
  const SceneNeeds needs{.background = false};  // so the plan holds a clear
  auto plan = plan_for(needs, {.method = Method::kBilinear,
                               .output_extent = output,
                               .target_extent = output,
                               .present = false,
                               .clear = true});
  if (!plan.ok()) return fail(plan.status());
  auto service = ResolveService::create(device.value(), plan.value());
  if (!service.ok()) return fail(service.status());
  auto colour = device->allocate(output, PixelFormat::kRGBA16F);
  auto resolved = device->allocate(output, PixelFormat::kRGBA32F);
  if (!colour.ok() || !resolved.ok()) return fail(Status::device("no memory"));

  const float value[4] = {0.25f, 0.5f, 2.0f, 1.0f};
  if (auto status = service->clear(colour->view(), render, value); !status.ok()) return fail(status);
  const FrameReport report =
      service->dispatch({.colour = colour->view(), .render_extent = render}, {.linear = resolved->view()});
  if (!report.ok()) return fail(report.status);
  std::vector<float> pixels(output.area() * 4);
  if (auto status = device->download(resolved->view(), output, pixels.data()); !status.ok())
    return fail(status);
  const float* pixel = &pixels[(20 * 64 + 30) * 4];
  std::printf("%g %g %g %g\n", pixel[0], pixel[1], pixel[2], pixel[3]);
  for (int c = 0; c < 4; ++c) {
    if (!(std::abs(pixel[c] - value[c]) < 1e-6f)) return 1;
  }
  return 0;
}

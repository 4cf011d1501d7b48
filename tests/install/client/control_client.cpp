// SPDX-License-Identifier: MIT
// Control alone: frames that take too long are drawn smaller, and the built-in front is found.
#include <quincunx/control/front_file.h>
#include <quincunx/control/resolution_controller.h>

#include <cstdio>

int main() {
  const quincunx::Extent output = {1280, 720};
  const auto controller =
      quincunx::make_proportional_controller({.ladder = {.output_extent = output}, .target_ms = 10});
  for (std::uint64_t frame = 1; frame <= 100; ++frame) {
    const quincunx::Status status = controller.value()->observe(
        {.frame = frame, .render_extent = controller.value()->next(), .gpu_ms = 15, .interval_ms = 15});
    if (!status.ok()) return std::fprintf(stderr, "%s\n", status.message().c_str()), 1;
  }
  const quincunx::FoundFront found = quincunx::find_front({.device = "none", .driver = "", .scene = ""});
  std::printf("%d pixels wide; %s\n", controller.value()->next().width, found.explanation.c_str());
  return controller.value()->next().area() < output.area() && found.front.is_built_in() ? 0 : 1;
}

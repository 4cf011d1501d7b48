// SPDX-License-Identifier: MIT
#include <quincunx_gl/bridge.h>

#include <cstdio>

int main() {
  auto context = quincunx::gl::Context::create();
  if (!context.ok()) {
    std::fprintf(stderr, "%s\n", context.status().message().c_str());
    return 1;
  }
  std::printf("%s\n", context->info().renderer.c_str());
  return context->info().renderer.empty() ? 1 : 0;
}

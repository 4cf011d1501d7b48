// SPDX-License-Identifier: MIT
// From frames in host memory to a picture of twice their width and height.
//
//   minimal PICTURE.ppm
#include <quincunx/resolve_service.h>

#include <cmath>
#include <cstdio>
#include <vector>

using namespace quincunx;

constexpr Extent kOutput = {640, 360}, kRender = {320, 180};
constexpr float kSpeed = 0.3f / 640;  // the scene goes to the right: uv a frame

// Your renderer: thin lines, of which a frame sees one place a pixel.
float light_at(float u, float v, int frame) {
  const float across = 40 * (u - kSpeed * static_cast<float>(frame)) + 11 * v;
  return across - std::floor(across) < 0.15f ? 0.8f : 0.02f;
}

std::vector<float> draw(Extent extent, Vec2 jitter, int frame) {
  std::vector<float> rgba;
  for (int y = 0; y < extent.height; ++y) {
    for (int x = 0; x < extent.width; ++x) {
      const float u = (static_cast<float>(x) + 0.5f + jitter.x) / static_cast<float>(extent.width);
      const float v = (static_cast<float>(y) + 0.5f + jitter.y) / static_cast<float>(extent.height);
      const float light = light_at(u, v, frame);
      rgba.insert(rgba.end(), {light, light, light, 1});  // linear light
    }
  }
  return rgba;
}

int main(int argc, char** argv) {
  const Device device = Device::open().value();  // the first GPU, else the CPU
  const ResolvePlan plan = plan_for({.transparents = false}, {.output_extent = kOutput,
                                                              .target_extent = kRender,
                                                              .colour = PixelFormat::kRGBA32F,
                                                              .velocity = PixelFormat::kRG32F})
                               .value();
  ResolveService service = ResolveService::create(device, plan).value();
  const Image picture = device.allocate(kOutput, PixelFormat::kRGBA8).value();
  struct {
    Image colour, depth, velocity;
  } slots[2];  // two, since the frame before is still read
  for (auto& [colour, depth, velocity] : slots) {
    colour = device.allocate(kRender, PixelFormat::kRGBA32F).value();
    depth = device.allocate(kRender, PixelFormat::kR32F).value();
    velocity = device.allocate(kRender, PixelFormat::kRG32F).value();
  }

  for (int n = 0; n < 64; ++n) {
    const auto& [colour, depth, velocity] = slots[n % 2];
    const Vec2 jitter = quincunx::jitter(static_cast<std::uint64_t>(n), kRender, kOutput);
    const std::vector<float> rgba = draw(kRender, jitter, n), far(rgba.size() / 4, 0.01f);
    std::vector<float> motion;
    for (std::size_t i = 0; i < far.size(); ++i)
      motion.insert(motion.end(), {kSpeed, 0});  // where it is less where it was
    for (const Status& status : {device.upload(colour.view(), kRender, rgba.data()),
                                 device.upload(depth.view(), kRender, far.data()),
                                 device.upload(velocity.view(), kRender, motion.data())}) {
      if (!status.ok()) return std::fprintf(stderr, "%s\n", status.message().c_str()), 1;
    }
    const FrameReport report = service.dispatch({.colour = colour.view(),
                                                 .depth = depth.view(),
                                                 .velocity = velocity.view(),
                                                 .render_extent = kRender,
                                                 .jitter = jitter},
                                                {.presented = picture.view()});
    if (!report.ok()) return std::fprintf(stderr, "%s\n", report.status.message().c_str()), 1;
  }

  std::vector<unsigned char> rgba(static_cast<std::size_t>(kOutput.area()) * 4);
  const Status status = device.download(picture.view(), kOutput, rgba.data());
  std::FILE* file = std::fopen(argc > 1 ? argv[1] : "picture.ppm", "wb");
  if (!status.ok() || file == nullptr) return 1;
  std::fprintf(file, "P6 %d %d 255\n", kOutput.width, kOutput.height);
  for (std::size_t i = 0; i < rgba.size(); i += 4)
    std::fwrite(&rgba[i], 1, 3, file);
  return std::fclose(file);
}

// SPDX-License-Identifier: MIT
#include "programs/presenter.h"

namespace quincunx::scenes {

Result<Presenter> Presenter::create(const Device& device, Extent extent, ToneMap tone_map, bool dither,
                                    float exposure) {
  ResolveSettings settings;
  settings.method = Method::kPoint;  // at scale 1 the identity
  settings.output = settings.target = extent;
  settings.colour = PixelFormat::kRGBA32F;
  settings.tone_map = tone_map;
  settings.dither = dither;
  auto plan = plan_for({}, settings);
  if (!plan.ok()) return plan.status();
  auto service = ResolveService::create(device, plan.value());
  if (!service.ok()) return service.status();
  auto linear = device.allocate(extent, PixelFormat::kRGBA32F);
  if (!linear.ok()) return linear.status();
  auto encoded = device.allocate(extent, PixelFormat::kRGBA8);
  if (!encoded.ok()) return encoded.status();
  return Presenter(device, std::move(service).value(), std::move(linear).value(), std::move(encoded).value(),
                   exposure);
}

Result<std::vector<std::uint8_t>> Presenter::present(const std::vector<float>& rgba) {
  const Extent extent = linear_.view().extent;
  if (Status status = device_.upload(linear_.view(), extent, rgba.data()); !status.ok()) return status;
  FrameInputs inputs;
  inputs.colour = linear_.view();
  inputs.render = extent;
  inputs.exposure = exposure_;
  const FrameReport report = service_.dispatch(inputs, {.presented = encoded_.view()});
  if (!report.ok()) return report.status;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(extent.area()) * 4);
  if (Status status = device_.download(encoded_.view(), extent, pixels.data()); !status.ok()) return status;
  return pixels;
}

}  // namespace quincunx::scenes

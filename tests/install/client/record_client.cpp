// SPDX-License-Identifier: MIT
// record_client FOLDER: records two frames of grey.
#include <quincunx_record/record.h>

#include <cstdio>
#include <vector>

using namespace quincunx;

int main(int, char** arguments) {
  constexpr Extent kSize = {16, 9};
  const Device device = Device::open().value();
  const ResolvePlan plan = plan_for({}, {.method = Method::kBilinear,
                                         .output_extent = kSize,
                                         .target_extent = kSize,
                                         .colour = PixelFormat::kRGBA32F})
                               .value();
  ResolveService service = ResolveService::create(device, plan).value();
  const Recording recording = record_frames(service, arguments[1], {.frames = 2, .overwrite = true}).value();
  const Image colour = device.allocate(kSize, PixelFormat::kRGBA32F).value();
  const Image picture = device.allocate(kSize, PixelFormat::kRGBA8).value();
  const std::vector<float> grey(static_cast<std::size_t>(kSize.area()) * 4, 0.5f);
  if (!device.upload(colour.view(), kSize, grey.data()).ok()) return 1;
  while (!recording.done()) {
    const FrameInputs inputs = {.colour = colour.view(), .render_extent = kSize};
    if (!service.dispatch(inputs, {.presented = picture.view()}).ok()) return 1;
  }
  std::printf("%d frames %s\n", recording.frames(), recording.status().message().c_str());
  return recording.frames() == 2 ? 0 : 1;
}

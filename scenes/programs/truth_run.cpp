// SPDX-License-Identifier: MIT
#include "truth_run.h"

#include <fmt/format.h>

#include <vector>

#include "quincunx/resolve_service.h"
#include "scene_catalog.h"
#include "target_file.h"
#include "tools/frame_pattern.h"
#include "tools/image_io.h"
#include "tools/progress.h"
#include "truth.h"

namespace quincunx::scenes {
namespace {

// Brings a linear picture to 8 bits with the same present pass as every other frame: at scale 1 point
// sampling is the identity.
class Presenter {
 public:
  static Result<Presenter> create(const RenderOptions& options, float exposure) {
    auto device = Device::open(options.device);
    if (!device.ok()) return device.status();
    ResolveSettings settings;
    settings.method = Method::kPoint;
    settings.output = settings.target = options.output;
    settings.colour = PixelFormat::kRGBA32F;
    settings.tone_map = options.tone_map;
    settings.dither = options.dither;
    auto plan = plan_for({}, settings);
    if (!plan.ok()) return plan.status();
    auto service = ResolveService::create(device.value(), plan.value());
    if (!service.ok()) return service.status();
    auto linear = device->allocate(options.output, PixelFormat::kRGBA32F);
    if (!linear.ok()) return linear.status();
    auto encoded = device->allocate(options.output, PixelFormat::kRGBA8);
    if (!encoded.ok()) return encoded.status();
    return Presenter(device.value(), std::move(service).value(), std::move(linear).value(),
                     std::move(encoded).value(), exposure);
  }

  Result<std::vector<std::uint8_t>> present(const std::vector<float>& rgba) {
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

 private:
  Presenter(Device device, ResolveService service, Image linear, Image encoded, float exposure)
      : device_(std::move(device)),
        service_(std::move(service)),
        linear_(std::move(linear)),
        encoded_(std::move(encoded)),
        exposure_(exposure) {}

  Device device_;
  ResolveService service_;
  Image linear_;
  Image encoded_;
  float exposure_;
};

Status write_truth(Presenter& presenter, const tools::FramePattern& pattern, std::int64_t index,
                   Extent extent, const std::vector<float>& rgba) {
  const std::string path = pattern.expand(index);
  if (pattern.format() == tools::FileFormat::kExr) return write_rgba(path, extent, rgba);
  auto pixels = presenter.present(rgba);
  if (!pixels.ok()) return pixels.status();
  return tools::write_png(path, extent, pixels.value().data());
}

}  // namespace

Status run_truth(const RenderOptions& options) {
  if (options.out.empty()) return Status::invalid("--truth needs --out: the pattern of the files to write");
  auto pattern = tools::FramePattern::parse(options.out);
  if (!pattern.ok()) return pattern.status();
  if (Status status = pattern->check_count(options.frames); !status.ok()) return status;
  auto scene = open_scene(options.scene, options.seed);
  if (!scene.ok()) return scene.status();
  auto source = source_settings_for(options);
  if (!source.ok()) return source.status();
  auto sequence = FrameSequence::create(source->sequence);
  if (!sequence.ok()) return sequence.status();
  auto context = gl::EglContext::create(options.platform);
  if (!context.ok()) return context.status();
  auto renderer = Renderer::create(scene.value());
  if (!renderer.ok()) return renderer.status();
  auto presenter = Presenter::create(options, options.exposure > 0 ? options.exposure : scene->exposure);
  if (!presenter.ok()) return presenter.status();

  const TruthSettings settings = {options.output, options.truth, options.shutter / options.fps};
  using Show = tools::Progress::Show;
  tools::Progress progress("truth", options.frames, options.quiet ? Show::kNever : Show::kOnTerminal);
  for (std::int64_t index = 0; index < options.frames; ++index) {
    auto rgba = render_truth(renderer.value(), settings, sequence->at(index).seconds);
    if (!rgba.ok()) return rgba.status();
    if (Status status = write_truth(presenter.value(), pattern.value(), index, options.output, rgba.value());
        !status.ok()) {
      return status;
    }
    progress.update(index + 1);
  }
  return {};
}

}  // namespace quincunx::scenes

// SPDX-License-Identifier: MIT
#include "programs/truth_run.h"

#include <fmt/format.h>

#include <vector>

#include "catalog/scene_catalog.h"
#include "programs/presenter.h"
#include "programs/target_file.h"
#include "render/truth.h"
#include "tools/image/image_io.h"
#include "tools/program/progress.h"
#include "tools/sequence/frame_pattern.h"

namespace quincunx::scenes {
namespace {

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
  auto context = gl::EglContext::create(options.platform, options.api);
  if (!context.ok()) return context.status();
  auto renderer = Renderer::create(scene.value());
  if (!renderer.ok()) return renderer.status();
  auto device = Device::open(options.device);
  if (!device.ok()) return device.status();
  auto presenter =
      Presenter::create(device.value(), options.output, options.resolve.tone_map, options.resolve.dither,
                        options.exposure > 0 ? options.exposure : scene->exposure);
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

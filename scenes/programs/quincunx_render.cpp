// SPDX-License-Identifier: MIT
// quincunx-render: draws a scene at a dynamic resolution and makes the picture from it.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "catalog/scene_catalog.h"
#include "frames/method_resolves.h"
#include "frames/target_file.h"
#include "quincunx/control/front_file.h"
#include "quincunx/status.h"
#include "render/truth.h"
#include "session/calibration.h"
#include "session/render_options.h"
#include "session/render_session.h"
#include "session/why_picture.h"
#include "tools/image/image_io.h"
#include "tools/page/page.h"
#include "tools/program/frame_pattern.h"
#include "tools/program/program.h"
#ifdef QUINCUNX_HAS_WINDOW
#include "window/window_session.h"
#endif

namespace quincunx::scenes {
namespace {

Status write_truth(PicturePresenter& presenter, const tools::FramePattern& pattern, std::int64_t index,
                   Extent extent, const std::vector<float>& rgba, const tools::Display& display) {
  const std::string path = pattern.expand(index);
  if (!tools::has_8_bits(format_of(pattern)))
    return tools::write_light(path, extent, rgba, tools::ChannelType::kHalf, display);
  auto pixels = presenter.present(rgba);
  if (!pixels.ok()) return pixels.status();
  return tools::write_picture(path, extent, pixels.value().data());
}

// --truth: renders and writes supersampled frames instead of resolved ones; .png and .jpg through the present pass.
Status run_truth(const RenderOptions& options) {
  if (options.out.empty()) return Status::invalid("--truth needs --out: the pattern of the files to write");
  auto pattern = tools::output_pattern(options.out);
  if (!pattern.ok()) return pattern.status();
  if (Status status = pattern->check_count(options.frames); !status.ok()) return status;
  auto settings = source_settings_for(options);
  if (!settings.ok()) return settings.status();
  auto opened = FrameSource::create(settings.value());
  if (!opened.ok()) return opened.status();
  FrameSource& source = *opened.value();
  const tools::Display display = {options.resolve.output.tone_map, source.exposure()};
  auto presenter = PicturePresenter::create(source.device(), options.output, display.tone_map,
                                            options.resolve.output.dither, display.exposure);
  if (!presenter.ok()) return presenter.status();

  const TruthSettings truth = {options.output, options.truth, options.shutter / options.fps};
  using Show = tools::Progress::Show;
  tools::Progress progress("truth", options.frames, options.quiet ? Show::kNever : Show::kOnTerminal);
  for (std::int64_t index = 0; index < options.frames; ++index) {
    auto rgba = render_truth(source.renderer(), truth, source.sequence().at(index).seconds);
    if (!rgba.ok()) return rgba.status();
    if (Status status =
            write_truth(presenter.value(), pattern.value(), index, options.output, rgba.value(), display);
        !status.ok()) {
      return status;
    }
    progress.update(index + 1);
  }
  return {};
}

// Names the figures that a controller which chooses methods goes by. Empty where there is no OpenCL device.
std::string front_text(const std::optional<FoundFront>& found) {
  return found ? fmt::format("Error front    {}\n", found->explanation) : std::string();
}

// Explains the method that this controller begins with, before it has seen a frame, and puts it into `settings`.
Result<std::string> choose_first(const RenderOptions& options, const std::optional<FoundFront>& found,
                                 ResolveSettings& settings) {
  if (!options.pacing.chooses_method()) return std::string();
  const auto pacing =
      frame_pacing_for(options.pacing, options.output, found ? found->front : ErrorFront::built_in());
  if (!pacing.ok()) return pacing.status();
  settings = method_settings(settings, pacing->choice()->method);
  return "At the first frame, before any was timed:\n" + pacing->reasons();
}

// Returns the way of the plan's frames to OpenCL and back on this machine, what it costs, and why it is chosen.
Result<std::string> crossing_of(const Result<gl::Context>& context, const Result<Device>& device,
                                const ResolvePlan& plan, gl::Interop interop) {
  if (!context.ok()) return context.status();
  if (!device.ok()) return device.status();
  gl::BridgeSettings settings = gl::bridge_settings(plan);
  settings.interop = interop;
  auto made = gl::Bridge::create(context.value(), device.value(), settings);
  if (!made.ok()) return made.status();
  gl::Bridge& bridge = *made.value();
  for (int slot = 0; slot < bridge.slots(); ++slot) {  // the first times are the longest
    if (auto targets = bridge.begin_draw(slot, settings.target_extent); !targets.ok())
      return targets.status();
    if (Status status = bridge.submit(slot); !status.ok()) return status;
    if (auto frame = bridge.acquire(slot); !frame.ok()) return frame.status();
    if (auto output = bridge.begin_present(); !output.ok()) return output.status();
    if (Status status = bridge.present(); !status.ok()) return status;
  }
  return fmt::format("{} ({})", crossing_text(bridge), bridge.reason());
}

int explain(const RenderOptions& options) {
  auto source = source_settings_for(options);
  if (!source.ok()) return tools::fail(source.status());
  auto sequence = FrameSequence::create(source->sequence);
  if (!sequence.ok()) return tools::fail(sequence.status());
  auto scene = open_scene(options.scene, options.seed);
  if (!scene.ok()) return tools::fail(scene.status());
  const bool has_particles = static_cast<bool>(scene->particles);
  ResolveSettings settings = options.resolve;
  settings.output_extent = sequence->output();
  if (source->sequence.outputs) settings.output.min_extent = source->sequence.outputs->min_output();
  settings.target_extent = sequence->target();
  if (has_particles)
    settings.targets.particle_extent = particle_target(source->parts, settings.target_extent);
  if (source->focus.target) {
    auto focus = FocusRegion::create(source->focus, scene.value(), source->sequence);
    if (!focus.ok()) return tools::fail(focus.status());
    if (focus.value()) settings.focus = focus.value()->settings();
  }
  // The bridge's line in the log is in the text, too.
  spdlog::set_level(std::max(spdlog::get_level(), spdlog::level::warn));
  Device::list();  // some drivers want OpenCL enumerated before a GL context exists
  const auto context = gl::Context::create(source->platform, source->api);
  const auto device = context.ok() ? gl::open_device(context.value(), source->device, source->interop)
                                   : Device::open(source->device);
  std::optional<FoundFront> found;
  if (device.ok()) found = find_front(front_key(device->info(), scene->name));
  const auto first = choose_first(options, found, settings);
  if (!first.ok()) return tools::fail(first.status());
  auto plan = plan_for(needs_of(scene.value()), settings);
  if (!plan.ok()) return tools::fail(plan.status());
  const auto crossing = crossing_of(context, device, plan.value(), source->interop);
  fmt::print("Scene          {}: {}\n{}{}{}Frames         {}\n{}{}", scene->name, scene->summary,
             front_text(found), first.value(), tools::device_lines(device),
             crossing.ok() ? crossing.value() : "do not cross: " + crossing.status().message(),
             explain(source->parts, has_particles), plan->explain());
  return tools::kDone;
}

// Draws the same frames at fixed scales, beside those of the report.
Status compare(const RenderSession& session, const std::vector<float>& scales, tools::RunReport& report) {
  for (const float scale : scales) {
    auto fixed = session.at_fixed_scale(scale);
    if (!fixed.ok()) return fixed.status();
    if (Status status = fixed.value()->run(); !status.ok()) return status;
    report.pacing.push_back(fixed.value()->report().pacing.front());
  }
  return {};
}

Status run_window([[maybe_unused]] const RenderOptions& options) {
#ifdef QUINCUNX_HAS_WINDOW
  auto session = WindowSession::create(options);
  return session.ok() ? session.value()->run() : session.status();
#else
  return Status::unsupported(
      "this build has no window; install the Debian packages libglfw3-dev and libimgui-dev and build again");
#endif
}

int render(const RenderOptions& options) {
  if (options.truth > 0) {
    const Status status = run_truth(options);
    return status.ok() ? tools::kDone : tools::fail(status);
  }
  if (!options.pacing.calibrate.empty()) {
    const Status status = run_calibration(options);
    return status.ok() ? tools::kDone : tools::fail(status);
  }
  if (!options.why.empty()) {
    const Status status = draw_why(options);
    return status.ok() ? tools::kDone : tools::fail(status);
  }
  if (options.window) {
    const Status status = run_window(options);
    return status.ok() ? tools::kDone : tools::fail(status);
  }
  auto session = RenderSession::create(options);
  if (!session.ok()) return tools::fail(session.status());
  if (Status status = session.value()->run(); !status.ok()) return tools::fail(status);
  tools::RunReport report = session.value()->report();
  if (Status status = compare(*session.value(), options.pacing.compared_scales, report); !status.ok()) {
    return tools::fail(status);
  }
  if (options.json) {
    fmt::print("{}\n", tools::to_json(report));
  } else if (!options.quiet) {
    fmt::print("{}", tools::to_text(report));
  }
  if (!options.report.empty()) {
    const Status status = tools::write_report(options.report, report, session.value()->pictures());
    if (!status.ok()) return tools::fail(status);
  }
  return tools::kDone;
}

int run(int argc, char** argv) {
  RenderOptions options;
  if (const auto exit_code = parse_command_line(argc, argv, options)) return *exit_code;
  tools::set_up_log(options.quiet, options.verbosity);
  if (options.list_scenes) {
    print_scenes();
  } else if (options.list_devices) {
    print_devices(options);
  } else {
    return options.explain ? explain(options) : render(options);
  }
  return tools::kDone;
}

}  // namespace
}  // namespace quincunx::scenes

int main(int argc, char** argv) {
  return quincunx::tools::run_program("quincunx-render", quincunx::scenes::run, argc, argv);
}

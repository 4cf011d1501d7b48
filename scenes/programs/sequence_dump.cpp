// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "frames/frame_source.h"
#include "frames/target_file.h"
#include "programs/dump_session.h"
#include "render/truth.h"
#include "tools/image/display_light.h"
#include "tools/image/image_io.h"
#include "tools/program/atomic_file.h"
#include "tools/program/frame_pattern.h"
#include "tools/program/program.h"
#include "tools/program/work_queue.h"

namespace quincunx::scenes {
namespace {

std::filesystem::path folder_of(const std::string& pattern) {
  return std::filesystem::path(pattern).parent_path();
}

nlohmann::ordered_json pair_of(Extent extent) {
  return {extent.width, extent.height};
}

std::string description(const DumpOptions& options, const FrameSource& source) {
  nlohmann::ordered_json json;
  json["format"] = "quincunx sequence 1";
  json["scene"] = source.scene().name;
  json["seed"] = options.seed;
  json["frames"] = options.frames;
  json["first_frame"] = 0;
  json["fps"] = options.fps;
  json["start_seconds"] = options.start;
  json["output_size"] = pair_of(options.output);
  json["largest_render_size"] = pair_of(source.sequence().target());
  json["jitter_kind"] = name_of(jitter_for(options));
  json["near"] = source.scene().camera(options.start).near_plane;
  json["depth_kind"] = options.device_depth ? "device-reversed" : "linear";
  const bool encoded = options.resolve.colour == PixelFormat::kRGBA8;
  json["exposure"] = encoded ? 1 : source.exposure();
  if (encoded) json["tone_map"] = name_of(options.resolve.output.tone_map);
  if (options.truth > 0) json["truth_samples"] = options.truth * options.truth;
  json["drawn_velocity"] = name_of(options.dilate_velocity ? DrawnVelocity::kDilated : DrawnVelocity::kOwn);
  json["conventions"] = {
      {"pixels",
       "rows top-down; pixel (x, y) covers [x, x + 1] x [y, y + 1]; data and display window are the "
       "viewport"},
      {"colour", fmt::format("R G B A: linear{}, premultiplied, half; one sample a pixel at its centre + "
                             "quincunx:jitter",
                             encoded ? " light of the screen (exposed, tone mapped, of 8-bit sRGB)" : "")},
      {"jitter", "quincunx:jitter of each frame, pixels of that frame, +x right, +y down"},
      {"Z", options.device_depth ? "near / distance, 0 where nothing was seen"
                                 : "distance along the view axis, 1e10 where nothing was seen"},
      {"motion",
       "backward.u, backward.v: previous - current position; forward.u, forward.v: next - current position; "
       "pixels of that frame, +u right, +v up, jitter excluded"},
      {"reactive",
       "reactive.mask: 0 trust history, 1 ignore it; of transparents, which have no motion of their own"},
  };
  return json.dump(1) + "\n";
}

Status write_truth_at(double seconds, FrameSource& source, std::int64_t index, const DumpOptions& options,
                      tools::WorkQueue& writer) {
  const auto pattern = tools::FramePattern::parse((folder_of(options.sequence) / "truth.%04d.exr").string());
  if (!pattern.ok()) return pattern.status();
  const Extent output = options.output;
  auto rgba = render_truth(source.renderer(), {.output = output, .samples = options.truth}, seconds);
  if (!rgba.ok()) return rgba.status();
  if (options.resolve.colour == PixelFormat::kRGBA8)
    rgba = tools::display_light(rgba.value(), options.resolve.output.tone_map, source.exposure());
  return writer.push([path = pattern->expand(index), output, pixels = std::move(rgba).value()] {
    return tools::write_light(path, output, pixels);
  });
}

}  // namespace

Status dump_sequence(const DumpOptions& options) {
  auto pattern = tools::FramePattern::parse(options.sequence);
  if (!pattern.ok()) return pattern.status();
  if (format_of(*pattern) != tools::FileFormat::kExr) {
    return Status::invalid("--sequence '" + options.sequence +
                           "' must end in .exr: only EXR holds depth and motion");
  }
  if (Status status = pattern->check_count(options.frames); !status.ok()) return status;
  auto settings = source_settings_for(options);
  if (!settings.ok()) return settings.status();
  auto source = FrameSource::create(settings.value());
  if (!source.ok()) return source.status();
  FrameSource& frames = *source.value();
  auto plan = frames.connect(options.resolve, HandOver::kEvery);
  if (!plan.ok()) return plan.status();

  using Show = tools::Progress::Show;
  tools::Progress progress("sequence", options.frames, options.quiet ? Show::kNever : Show::kOnTerminal);
  tools::WorkQueue writer;
  for (std::int64_t index = 0; index < options.frames; ++index) {
    if (Status status = frames.draw(index, true); !status.ok()) return status;
    DrawnFrame& frame = frames.oldest();
    const double seconds = frame.view.seconds;
    const double next = seconds + 1 / options.fps;
    // The last frame of a shot has no motion to the next one.
    auto relative = frames.draw_relative_to(is_cut(frames.scene(), seconds, next) ? seconds : next);
    if (!relative.ok()) return relative.status();
    if (options.dilate_velocity) {
      dilate_velocity(frame.targets);
      dilate_velocity(relative.value());
    }
    TargetFile file = {.frame = std::move(frame),
                       .relative_to_next = std::move(relative).value(),
                       .camera = frames.scene().camera(seconds),
                       .output = options.output,
                       .fps = options.fps,
                       .linear_depth = !options.device_depth};
    const Status status = writer.push(
        [path = pattern->expand(index), file = std::move(file)] { return write_targets(path, file); });
    if (!status.ok()) return status;
    if (options.truth > 0) {
      if (Status truth = write_truth_at(seconds, frames, index, options, writer); !truth.ok()) return truth;
    }
    frames.release();
    progress.update(index + 1);
  }
  if (Status status = writer.finish(); !status.ok()) return status;
  return tools::write_text((folder_of(options.sequence) / "sequence.json").string(),
                           description(options, frames));
}

}  // namespace quincunx::scenes

// SPDX-License-Identifier: MIT
#include "tools/sequence/resolve_task.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "tools/program/resolve_settings_options.h"
#include "tools/program/work_queue.h"
#include "tools/sequence/resolve_advice.h"
#include "tools/sequence/sequence_reader.h"

namespace quincunx::tools {
namespace {

// An accumulated picture depends on all frames before it. So many are resolved before a chunk's first frame, and
// not written: still pictures improve for some 100 frames, moving ones for ten.
constexpr int kChunkHistoryFrames = 48;

// Frames before one that its pixels depend on: the camera's motion is that since the previous frame, too.
int history_of(const ResolvePlan& plan) {
  if (plan.accumulates()) return kChunkHistoryFrames;
  return plan.keeps_previous_frame() || plan.reads_camera() ? 1 : 0;
}

Result<FramePattern> parse_input(const std::string& text, const std::string& what) {
  auto pattern = FramePattern::parse(text, what);
  if (!pattern.ok()) return pattern.status();
  if (!pattern->has_number()) {
    return Status::invalid(
        fmt::format("{} '{}' has no frame number; put %04d, # or @ where it stands", what, text));
  }
  return pattern;
}

std::string recorded_pattern(const std::string& folder) {
  return (std::filesystem::path(folder) / "frame.%04d.exr").string();
}

// A cut where no frame is would do nothing. Of a chunk (--frames), later frames may not be rendered yet.
Status check_cuts(const std::vector<std::int64_t>& cuts, const FramePattern& input) {
  if (cuts.empty()) return {};
  const auto frames = input.frames_on_disk();
  if (!frames.ok() || frames->empty()) return frames.status();
  for (const std::int64_t cut : cuts) {
    if (cut < frames->front() || cut > frames->back())
      return Status::invalid(fmt::format("--cuts: there is no frame {}; the frames are {} to {}", cut,
                                         frames->front(), frames->back()));
  }
  return {};
}

// The first frame that can be opened, or with bad frames the first at all, whose failure is the error.
Result<SequenceFormat> settle_by_first(const ResolveOptions& options, const ResolveTask& task,
                                       const SequenceInput& input) {
  Status first_error;
  for (const std::int64_t number : task.asked) {
    const std::string path = task.input.expand(number);
    auto reader = ImageReader::open(path);
    Result<FrameAttributes> attributes = reader.status();
    if (reader.ok()) {
      const auto picture = choose_picture(path, reader->header(), input.picture);
      if (!picture.ok()) return picture.status();
      attributes = frame_attributes(path, reader->header(), picture->part);
    }
    if (attributes.ok()) return settle(input, path, reader->header(), attributes.value());
    if (first_error.ok()) {
      std::error_code error;
      first_error = std::filesystem::exists(path, error) || error
                        ? attributes.status()
                        : Status::io(fmt::format("frame {} is missing: there is no '{}'", number, path));
    }
    if (!options.skip_bad_frames) break;
  }
  return first_error;
}

// Frames of more samples a pixel are clean to --noise auto.
constexpr float kNoisySamplesMax = 64;

// A chunk's neighbours must come to the same, whenever they are begun.
Result<float> noise_by_frames(const ResolveOptions& options, const ResolveTask& task) {
  const float samples = task.format.samples;
  if (samples >= 1) return samples <= kNoisySamplesMax ? 1 / samples : 0;
  const auto noise = noise_of(task.input, task.format);
  if (noise || !options.frames) return noise.value_or(0);
  return Status::io(
      "--noise auto with --frames needs the first 33 files of the sequence, whole, without gap and of one "
      "size, for all chunks to agree; begin when they are there, or say --noise SPP");
}

void settle_method(const ResolveOptions& options, ResolveTask& task) {
  task.resolve = options.resolve;
  if (options.method_named) return;
  const JitterKind jitter = kind_of(jitters_about(task.input, task.format, task.asked.front()));
  const MethodDefault suited = default_method(task.format, jitter, task.resolve);
  apply(suited.method, task.resolve);
  task.method_reason = suited.why;
}

ResolveSettings settings_for(const ResolveTask& task, Extent target, bool half_colour) {
  ResolveSettings settings = task.resolve;
  settings.output_extent = task.format.output;
  settings.target_extent = target;
  settings.colour = half_colour ? PixelFormat::kRGBA16F : PixelFormat::kRGBA32F;
  settings.velocity = PixelFormat::kRG32F;
  settings.output.linear = PixelFormat::kRGBA32F;
  settings.targets.storage = Storage::kBuffer;
  settings.output.present = task.output && task.output->presents();
  settings.targets.clear = false;
  return settings;
}

Result<std::optional<SequenceOutput>> output_for(const ResolveOptions& options, const ResolveTask& task) {
  if (options.out.empty()) return std::optional<SequenceOutput>();
  auto pattern = output_pattern(options.out);
  if (!pattern.ok()) return pattern.status();
  SequenceOutput output = {.pattern = pattern.value(),
                           .extent = task.format.output,
                           .stored = options.stored,
                           .tone_map = task.resolve.output.tone_map};
  output.settings = fmt::format("{}; output {}x{}; stored as {}", resolve_settings_text(task.resolve),
                                task.format.output.width, task.format.output.height,
                                options.stored == ChannelType::kHalf ? "half" : "float");
  if (options.exposure > 0) output.settings += fmt::format("; exposure {}", options.exposure);
  return std::optional(std::move(output));
}

// Sorts what is there already out of `asked`; what is left is returned.
std::vector<std::int64_t> left_to_do(const ResolveOptions& options, ResolveTask& task) {
  if (!options.resume) return task.asked;
  std::vector<Made> made(task.asked.size());
  for_each_index(made.size(), options.threads,
                 [&](std::size_t i) { made[i] = task.output->made(task.asked[i]); });
  std::vector<std::int64_t> left;
  for (std::size_t i = 0; i < made.size(); ++i) {
    (made[i] == Made::kAsWanted ? task.there : left).push_back(task.asked[i]);
    if (made[i] == Made::kOtherwise) task.stale.push_back(task.asked[i]);
  }
  return left;
}

// Returns those frames, out of the ones that an uninterrupted run reads, that the frames left to do depend on.
std::vector<std::int64_t> to_read(const ResolveOptions& options, const ResolveTask& task,
                                  const std::vector<std::int64_t>& left, int history) {
  const int warm_up = options.warm_up.value_or(history);
  const std::int64_t first = first_in_reach(task.input, task.asked.front(), warm_up);
  std::vector<std::int64_t> read = with_history(task.asked, warm_up, first);
  const int reach = std::max(warm_up, history), ahead = task.format.two_way;
  // What begins without history ends without future: it may be another shot.
  if (ahead > 0) read = with_future(task.input, task.asked, read, std::min(ahead_of_first(ahead), warm_up));
  std::erase_if(read, [&](std::int64_t number) {
    const auto next = std::lower_bound(left.begin(), left.end(), number);
    if (next != left.end() && *next - reach <= number) return false;
    if (ahead == 0 || next == left.begin()) return true;
    return number >= (window_of(*std::prev(next)) + 1) * kWindowFrames + ahead_of_first(ahead);
  });
  return read;
}

Status settle_plan(ResolveTask& task, Extent target, bool half_colour) {
  auto plan = plan_for(needs_of(task.format), settings_for(task, target, half_colour));
  if (!plan.ok()) return plan.status();
  task.plan = std::move(plan).value();
  return {};
}

Status settle_frames(const ResolveOptions& options, ResolveTask& task) {
  if (options.frames) {
    task.asked = *options.frames;
    return {};
  }
  auto frames = all_frames(task.input);
  if (!frames.ok()) return frames.status();
  task.asked = std::move(frames).value();
  return {};
}

Status settle_sequence(const ResolveOptions& options, ResolveTask& task) {
  SequenceInput sequence = options.sequence;
  auto jitter = JitterSource::parse(options.jitter);
  if (!jitter.ok()) return jitter.status();
  sequence.jitter = std::move(jitter).value();
  auto format = settle_by_first(options, task, sequence);
  if (!format.ok()) return format.status();
  task.format = std::move(format).value();
  settle_method(options, task);
  if (options.noise_by_frames && !options.diagnose) {
    const auto noise = noise_by_frames(options, task);
    if (!noise.ok()) return noise.status();
    task.resolve.temporal.noise = noise.value();
  }
  auto output = output_for(options, task);
  if (!output.ok()) return output.status();
  task.output = std::move(output).value();
  // Which channels are read follows from a plan of any size.
  if (Status status = settle_plan(task, task.format.output, true); !status.ok()) return status;
  if (options.diagnose) return {};
  if (Status status = keep_what_is_read(task.format, task.plan); !status.ok()) return status;
  if (Status status = settle_two_way(options.sequence, task.plan, task.format); !status.ok()) return status;
  if (task.output) task.output->settings += "; " + summary_of(task.format);
  return {};
}

// The settings say all but which frames there are.
Status settle_recorded(const ResolveOptions& options, ResolveTask& task) {
  task.resolve = options.resolve;
  task.format.recording = options.input;
  task.format.jitter = JitterSource::parse("attribute").value();
  task.format.output = task.resolve.output_extent;
  auto output = output_for(options, task);
  if (!output.ok()) return output.status();
  task.output = std::move(output).value();
  ResolveSettings settings = task.resolve;
  settings.output.present |= task.output && task.output->presents();
  auto plan = plan_for(options.recorded->needs, settings);
  if (!plan.ok()) return plan.status();
  task.plan = std::move(plan).value();
  if (task.output && settings.colour == PixelFormat::kRGBA8) task.output->tone_map = ToneMap::kClamp;
  ChannelNames& channels = task.format.channels;
  for (const InputImage& input : kInputs) {
    if (input.viewport != &FrameInputs::render_extent || planned_for(task.plan, input) == nullptr) continue;
    channels[plane_of(input)].assign(input.channels.begin(),
                                     std::find(input.channels.begin(), input.channels.end(), nullptr));
  }
  if (task.output)
    task.output->settings += "; " + to_line({.needs = options.recorded->needs, .settings = settings});
  return {};
}

}  // namespace

Status take_recorded(ResolveOptions& options) {
  auto recorded = read_settings(options.input);
  if (!recorded.ok()) return recorded.status();
  options = {};
  options.resolve = recorded->settings;
  options.stored =
      recorded->settings.output.linear == PixelFormat::kRGBA32F ? ChannelType::kFloat : ChannelType::kHalf;
  options.recorded = std::move(recorded).value();
  return {};
}

Status ResolveTask::check(bool skip_bad_frames) const {
  if (Status status = scan.problem(); !status.ok() && !skip_bad_frames) return status;
  if (!scan.frames.empty() && scan.target() == Extent{})
    return Status::io(fmt::format("no frame can be used; {}", scan.problem().message()));
  std::vector<std::string> read;
  for (const ScannedFrame& frame : scan.frames)
    read.push_back(input.expand(frame.number));
  for (const std::int64_t frame : asked) {
    if (truth) read.push_back(truth->pattern.expand(frame));
  }
  if (Status status = output ? output->check_names(scan.wanted(), read) : Status(); !status.ok())
    return status;
  if (!truth || scan.wanted().empty()) return {};
  return SequenceScores::create(*truth, format.output, scan.wanted(), false).status();
}

Result<ResolveTask> prepare(const ResolveOptions& options) {
  const bool recorded = options.recorded.has_value();
  auto input = parse_input(recorded ? recorded_pattern(options.input) : options.input, "input pattern");
  if (!input.ok()) return input.status();
  ResolveTask task = {.input = std::move(input).value()};
  if (!options.truth.empty()) {
    auto truth = parse_input(options.truth, "truth pattern");
    if (!truth.ok()) return truth.status();
    task.truth = {.pattern = std::move(truth).value(),
                  .layer = options.truth_colour,
                  .colour_space = options.sequence.colour_space};
  }
  if (Status status = settle_frames(options, task); !status.ok()) return status;
  if (!options.frames) {
    if (Status status = check_cuts(options.sequence.cuts, task.input); !status.ok()) return status;
  }
  const Status settled = recorded ? settle_recorded(options, task) : settle_sequence(options, task);
  if (!settled.ok()) return settled;
  if (task.truth) task.truth->view = task.format.view;
  const int history = recorded ? std::numeric_limits<int>::max() : history_of(task.plan);
  if (task.output && options.warm_up.value_or(history) < history)
    task.output->settings += "; begun without history";
  const std::vector<std::int64_t> left = left_to_do(options, task);
  const std::vector<std::int64_t> read = to_read(options, task, left, history);
  task.scan = scan_sequence(task.input, task.format, read, left, options.threads);
  if (task.format.two_way > 0) drop_unseen(task.scan, task.asked.back(), task.format.two_way);
  task.format.background = task.scan.background();
  for (const ScannedFrame& frame : task.scan.frames) {
    if (task.format.two_way == 0 || !frame.problem.empty() || task.plan.reads_history(frame.render)) continue;
    if (options.sequence.two_way) {
      return Status::invalid(
          fmt::format("--two-way merges histories, but frame {} has {}x{} pixels for {}x{} and so none; say "
                      "--two-way 0",
                      frame.number, frame.render.width, frame.render.height, task.format.output.width,
                      task.format.output.height));
    }
    spdlog::warn(
        "frame {} has {}x{} pixels for {}x{} and so no history: this run goes one way; a chunk without such "
        "a "
        "frame would not, so say --two-way 0 to all",
        frame.number, frame.render.width, frame.render.height, task.format.output.width,
        task.format.output.height);
    task.format.two_way = 0;
  }
  if (const Extent target = task.scan.target(); target != Extent{} && !recorded) {
    if (Status status = settle_plan(task, target, task.scan.half_colour()); !status.ok()) return status;
  }
  return task;
}

}  // namespace quincunx::tools

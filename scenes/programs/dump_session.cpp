// SPDX-License-Identifier: MIT
#include "programs/dump_session.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/gtc/packing.hpp>

#include "frames/method_resolves.h"
#include "frames/target_file.h"
#include "render/truth.h"
#include "tools/image/display_light.h"
#include "tools/image/image_io.h"
#include "tools/image/image_metrics.h"

namespace quincunx::scenes {
namespace {

constexpr int kDefaultTruth = 8;

// The channels that carry the numbers of a stage in a file that holds several.
std::vector<tools::Channel> channels_of(const StagePlanes& planes, const std::string& layer) {
  std::vector<tools::Channel> channels;
  for (std::size_t i = 0; i < planes.planes.size(); ++i) {
    channels.push_back({.name = layer.empty() ? planes.channels[i] : layer + "." + planes.channels[i],
                        .type = tools::ChannelType::kFloat,
                        .data = planes.planes[i].data(),
                        .stored = planes.stored});
  }
  return channels;
}

bool is_colour(Stage stage) {
  switch (stage) {
    case Stage::kColour:
    case Stage::kParticles:
    case Stage::kFocus:
    case Stage::kHistory:
    case Stage::kResolved:
    case Stage::kBlurred:
    case Stage::kDisplayed:
    case Stage::kTruth:
      return true;
    default:
      return false;
  }
}

// Tells whether a viewer shows it first of its file.
bool is_only_colour(Stage stage) {
  return stage == Stage::kResolved || stage == Stage::kDisplayed || stage == Stage::kHistory ||
         stage == Stage::kParticles;
}

// Opaque where the fourth plane is no alpha.
std::vector<float> interleaved(const StagePlanes& planes) {
  std::vector<float> rgba(planes.planes[0].size() * 4, 1.0f);
  for (std::size_t c = 0; c < (planes.channels[3] == "A" ? 4u : 3u); ++c) {
    for (std::size_t i = 0; i < planes.planes[c].size(); ++i)
      rgba[4 * i + c] = planes.planes[c][i];
  }
  return rgba;
}

// Mean of the three colour values, a pixel.
std::vector<float> error_of(const tools::MeasuredPicture& picture, const tools::MeasuredPicture& truth) {
  std::vector<float> error(picture.tone_mapped().size() / 3);
  for (std::size_t i = 0; i < error.size(); ++i) {
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
      error[i] += std::abs(picture.tone_mapped()[c] - truth.tone_mapped()[c]) / 3;
  }
  return error;
}

Status write_canvas(const std::string& path, const tools::Canvas& canvas) {
  std::vector<std::uint8_t> rgba;
  rgba.reserve(canvas.rgb.size() / 3 * 4);
  for (std::size_t i = 0; i < canvas.rgb.size(); i += 3)
    rgba.insert(rgba.end(), {canvas.rgb[i], canvas.rgb[i + 1], canvas.rgb[i + 2], 255});
  return tools::write_picture(path, canvas.extent, rgba.data());
}

}  // namespace

Result<std::unique_ptr<DumpSession>> DumpSession::create(const DumpOptions& options) {
  auto session = std::unique_ptr<DumpSession>(new DumpSession(options));
  if (Status status = session->open(); !status.ok()) return status;
  if (Status status = session->choose_stages(); !status.ok()) return status;
  return session;
}

Status DumpSession::open() {
  options_.frames = std::max(options_.frames, options_.frame + 1);
  auto settings = source_settings_for(options_);
  if (!settings.ok()) return settings.status();
  auto source = FrameSource::create(settings.value());
  if (!source.ok()) return source.status();
  source_ = std::move(source).value();
  exposure_ = source_->exposure();
  auto plan = source_->connect(options_.resolve, HandOver::kEvery);
  if (!plan.ok()) return plan.status();
  auto service = ResolveService::create(source_->device(), plan.value());
  if (!service.ok()) return service.status();
  service_.emplace(std::move(service).value());
  auto made = source_->device().allocate(options_.output, plan->settings.output.linear);
  if (made.ok()) linear_ = std::move(made).value();
  return made.status();
}

std::string DumpSession::why_missing(Stage stage) const {
  const ResolvePlan& plan = service_->plan();
  if (stage == Stage::kParticles && plan.settings.targets.particle_extent == Extent())
    return source_->scene().particles ? "they are drawn with everything else; give --particle-scale"
                                      : "the scene has none";
  if (stage == Stage::kHistory && !plan.accumulates() &&
      plan.settings.targets.shading == Shading::kCheckerboard)
    return "the previous frame that is read is the filled one, which only the service has";
  if (stage == Stage::kHistory && !uses_earlier_frames(plan.settings.method)) {
    return fmt::format("the method '{}' uses one frame only", name_of(plan.settings.method));
  }
  if (stage == Stage::kHistory && (options_.frame == 0 || options_.warm_up == 0)) {
    return "no frame comes before the one that is shown; give a later --frame and --warm-up";
  }
  if (stage == Stage::kFocus && !plan.has_focus()) return "no part is in focus; give --focus";
  if ((stage == Stage::kTiles || stage == Stage::kBlurred) && !plan.blurs()) {
    return plan.settings.blur.shutter > 0 ? "nothing moves in this scene"
                                          : "there is no motion blur; give --blur";
  }
  if (stage == Stage::kDisplayed && !plan.is_dual())
    return "the picture is shown in the size in which it is made; give --dual";
  return {};
}

Status DumpSession::choose_stages() {
  const bool all = options_.stages.empty();
  std::vector<Stage> asked = options_.stages;
  for (int i = 0; all && i < kStageCount; ++i) {
    const auto stage = static_cast<Stage>(i);
    if (!needs_truth(stage) || options_.truth > 0) asked.push_back(stage);
  }
  options_.stages.clear();
  for (const Stage stage : asked) {
    const std::string missing = why_missing(stage);
    if (missing.empty()) options_.stages.push_back(stage);
    if (!missing.empty() && !all)
      return Status::invalid(fmt::format("there is no stage '{}': {}", name_of(stage), missing));
  }
  if (options_.truth == 0 && std::any_of(asked.begin(), asked.end(), needs_truth))
    options_.truth = kDefaultTruth;
  return {};
}

// Tells whether every colour stage, truth included, is as a screen shows it, so that errors are those of the picture.
bool DumpSession::is_display_referred() const {
  return options_.resolve.colour == PixelFormat::kRGBA8;
}

bool DumpSession::wants(Stage stage) const {
  return std::find(options_.stages.begin(), options_.stages.end(), stage) != options_.stages.end();
}

Status DumpSession::resolve_up_to_the_frame() {
  const std::int64_t first = std::max<std::int64_t>(0, options_.frame - options_.warm_up);
  for (std::int64_t index = first; index <= options_.frame; ++index) {
    if (Status status = source_->draw(index, true); !status.ok()) return status;
    if (index == options_.frame && wants(Stage::kHistory)) {
      if (Status status = collect_history(); !status.ok()) return status;
    }
    if (Status status = resolve_next(); !status.ok()) return status;
    current_ = std::move(source_->oldest());
    source_->release();
  }
  return {};
}

Status DumpSession::resolve_next() {
  auto inputs = source_->acquire();
  if (!inputs.ok()) return inputs.status();
  auto presented = source_->bridge().begin_present();
  if (!presented.ok()) return presented.status();
  const FrameReport report =
      dispatch(*service_, inputs.value(), source_->focus(), {linear_.view(), presented.value()});
  if (!report.ok()) return report.status;
  return source_->bridge().present();
}

// Reads what the frame that is drawn and not yet resolved will read of the past.
Status DumpSession::collect_history() {
  const DrawnFrame& next = source_->oldest();
  const ResolvePlan& plan = service_->plan();
  const bool reads_past = !next.reset && plan.reads_history(next.view.render, next.output);
  if (!plan.accumulates()) {
    planes_[Stage::kHistory] =
        colour_planes(current_->view.render, colour_of(current_->targets), tools::ChannelType::kHalf);
  } else {
    const bool half = plan.settings.temporal.history == PixelFormat::kRGBA16F;
    auto history = accumulated();
    if (!history.ok()) return history.status();
    // In the size that it has: resizing it is the next frame's work.
    const Extent extent = current_ ? current_->output : options_.output;
    planes_[Stage::kHistory] =
        colour_planes(extent, history.value(), half ? tools::ChannelType::kHalf : tools::ChannelType::kFloat);
    planes_[Stage::kHistory].channels[3] = "confidence";
  }
  for (std::vector<float>& plane : planes_[Stage::kHistory].planes) {
    if (!reads_past) std::fill(plane.begin(), plane.end(), 0.0f);
  }
  return {};
}

// R, G, B and confidence; all zero where there is no history.
Result<std::vector<float>> DumpSession::accumulated() const {
  const Extent extent = current_ ? current_->output : options_.output;
  std::vector<float> texels(static_cast<std::size_t>(extent.area()) * 4);
  const auto history = service_->history();
  if (!history.ok()) return history.status();
  if (!history.value()) return texels;
  if (history->format == PixelFormat::kRGBA32F)
    return download_rgba(source_->device(), history.value(), extent);
  std::vector<std::uint16_t> halves(texels.size());
  if (Status status = source_->device().download(history.value(), history->extent, halves.data());
      !status.ok())
    return status;
  std::transform(halves.begin(), halves.end(), texels.begin(), glm::unpackHalf1x16);
  return texels;
}

Status DumpSession::collect_targets() {
  const TargetFile file = {.frame = *current_,
                           .camera = source_->scene().camera(current_->view.seconds),
                           .output = options_.output,
                           .fps = options_.fps};
  const Extent render = current_->view.render;
  planes_[Stage::kColour] = colour_planes(render, colour_of(current_->targets), tools::ChannelType::kHalf);
  if (const Extent region = current_->focus.render_extent; region.area() > 0) {
    planes_[Stage::kFocus] = colour_planes(region, colour_of(current_->focus), tools::ChannelType::kHalf);
  } else if (std::erase(options_.stages, Stage::kFocus) > 0) {
    spdlog::warn("there is no stage 'focus': --focus {} is not in the picture", options_.focus);
  }
  planes_[Stage::kDepth] = {render, {"Z"}, {depth_of(file)}};
  StagePlanes motion{render, {"backward.u", "backward.v"}, {{}, {}}};
  for (const Vec2 vector : backward_motion(current_->targets)) {
    motion.planes[0].push_back(vector.x);
    motion.planes[1].push_back(vector.y);
  }
  planes_[Stage::kVelocity] = std::move(motion);
  if (!current_->particles.colour.empty()) {
    planes_[Stage::kParticles] =
        colour_planes(current_->view.particles, colour_of(current_->particles), tools::ChannelType::kHalf);
  }
  planes_[Stage::kReactive] = {render, {"mask"}, {reactive_mask(file)}, tools::ChannelType::kHalf};

  const bool placed = service_->plan().settings.targets.placement == Targets::kPlaced;
  const Extent target = placed ? render : source_->sequence().target();
  std::vector<float> cleared(static_cast<std::size_t>(target.area()));
  for (int y = 0; y < render.height; ++y) {
    const auto row = cleared.begin() + static_cast<std::ptrdiff_t>(y) * target.width;
    std::fill(row, row + render.width, 1.0f);
  }
  planes_[Stage::kClear] = {target, {"mask"}, {std::move(cleared)}, tools::ChannelType::kHalf};
  if (!options_.exr) return {};
  files_.push_back(path_of("render.exr"));
  return write_targets(files_.back(), file);
}

Status DumpSession::collect_output() {
  const Extent output = options_.output;
  const auto collect = [this](Stage stage, const ImageView& image, Extent extent) -> Status {
    auto rgba = download_rgba(source_->device(), image ? image : linear_.view(), extent);
    if (rgba.ok()) planes_[stage] = colour_planes(extent, rgba.value(), tools::ChannelType::kFloat);
    return rgba.status();
  };
  const Extent made_in = current_->output;
  Status status = collect(Stage::kResolved, service_->picture(PictureStage::kResolved), made_in);
  if (status.ok() && service_->plan().is_dual()) status = collect(Stage::kDisplayed, linear_.view(), output);
  if (status.ok() && service_->plan().blurs())
    status = collect(Stage::kBlurred, service_->picture(PictureStage::kBlurred), made_in);
  if (!status.ok()) return status;
  if (service_->plan().blurs()) {
    auto tiles = service_->tile_kinds();
    if (!tiles.ok()) return tiles.status();
    planes_[Stage::kTiles] = {tiles->tiles, {"kind"}, {{tiles->kinds.begin(), tiles->kinds.end()}}};
  }
  const std::uint8_t* codes = source_->bridge().presented_pixels();
  presented_.assign(codes, codes + output.area() * 4);
  std::vector<float> presented(presented_.size());
  std::transform(presented_.begin(), presented_.end(), presented.begin(),
                 [](std::uint8_t code) { return static_cast<float>(code) / 255.0f; });
  planes_[Stage::kPresented] = colour_planes(output, presented, tools::ChannelType::kFloat);
  if (options_.truth == 0) return {};
  auto truth = render_truth(source_->renderer(),
                            {.output = output,
                             .samples = options_.truth,
                             .shutter_seconds = options_.resolve.blur.shutter / options_.fps},
                            current_->view.seconds);
  if (!truth.ok()) return truth.status();
  if (is_display_referred())
    truth = tools::display_light(truth.value(), options_.resolve.output.tone_map, exposure_);
  planes_[Stage::kTruth] = colour_planes(output, truth.value(), tools::ChannelType::kFloat);
  auto finished = download_rgba(source_->device(), linear_.view(), output);
  if (!finished.ok()) return finished.status();
  const tools::MeasuredPicture picture(output, std::move(finished).value());
  const tools::MeasuredPicture target(output, truth.value());
  planes_[Stage::kError] = {output, {"absolute"}, {error_of(picture, target)}};
  planes_[Stage::kFlip] = {
      output, {"map"}, {tools::flip_map(output, picture.tone_mapped(), target.tone_mapped())}};
  return {};
}

std::string DumpSession::path_of(const std::string& ending) const {
  return (std::filesystem::path(options_.out) / fmt::format("frame.{:04}.{}", options_.frame, ending))
      .string();
}

// One file for each extent: EXR has one size a part.
Status DumpSession::write_exr_files() {
  std::vector<std::pair<std::string, std::vector<Stage>>> groups = {
      {"particles.exr", {Stage::kParticles}}, {"focus.exr", {Stage::kFocus}},
      {"history.exr", {Stage::kHistory}},     {"target.exr", {Stage::kClear}},
      {"tiles.exr", {Stage::kTiles}},         {"output.exr", {Stage::kResolved, Stage::kBlurred}},
  };
  if (service_->plan().is_dual()) groups.push_back({"displayed.exr", {Stage::kDisplayed}});
  for (const Stage stage : {Stage::kPresented, Stage::kTruth, Stage::kError, Stage::kFlip})
    groups.back().second.push_back(stage);
  for (const auto& [ending, stages] : groups) {
    std::vector<tools::Channel> channels;
    Extent extent;
    for (const Stage stage : stages) {
      if (!wants(stage)) continue;
      extent = planes_[stage].extent;
      // The resolved picture is what a viewer shows first.
      const std::string layer = is_only_colour(stage) ? "" : name_of(stage);
      for (tools::Channel& channel : channels_of(planes_[stage], layer))
        channels.push_back(std::move(channel));
    }
    if (channels.empty()) continue;
    files_.push_back(path_of(ending));
    if (Status status = tools::write_exr(files_.back(), extent, channels); !status.ok()) return status;
  }
  return {};
}

Status DumpSession::write_pictures() {
  for (const Stage stage : options_.stages) {
    const StagePlanes& planes = planes_[stage];
    files_.push_back(path_of(std::string(name_of(stage)) + ".png"));
    Status status;
    if (stage == Stage::kPresented) {
      status = tools::write_picture(files_.back(), planes.extent, presented_.data());
    } else if (is_colour(stage)) {
      const bool shown = is_display_referred();
      auto presenter = PicturePresenter::create(source_->device(), planes.extent,
                                                shown ? ToneMap::kClamp : options_.resolve.output.tone_map,
                                                options_.resolve.output.dither, shown ? 1 : exposure_);
      if (!presenter.ok()) return presenter.status();
      auto codes = presenter->present(interleaved(planes));
      if (!codes.ok()) return codes.status();
      status = tools::write_picture(files_.back(), planes.extent, codes.value().data());
    } else {
      status = write_canvas(files_.back(), false_colour_of(stage, planes));
    }
    if (!status.ok()) return status;
  }
  return {};
}

Status DumpSession::run() {
  if (Status status = resolve_up_to_the_frame(); !status.ok()) return status;
  if (Status status = collect_targets(); !status.ok()) return status;
  if (Status status = collect_output(); !status.ok()) return status;
  if (options_.exr) {
    if (Status status = write_exr_files(); !status.ok()) return status;
  }
  return options_.png ? write_pictures() : Status();
}

}  // namespace quincunx::scenes

// SPDX-License-Identifier: MIT
#include "kernel_options.h"

#include <fmt/format.h>

namespace quincunx {
namespace {

// An image carries its format with it, so the options name it for buffers only.
std::string source(const ResolveSettings& settings) {
  if (settings.storage == Storage::kImage) return "-D SOURCE_STORAGE=IMAGE";
  return fmt::format("-D SOURCE_STORAGE=BUFFER -D SOURCE_FORMAT={}",
                     settings.colour == PixelFormat::kRGBA16F ? "HALF" : "FLOAT");
}

const char* resolved(const ResolveSettings& settings) {
  return settings.resolved == PixelFormat::kRGBA16F ? "HALF" : "FLOAT";
}

const char* velocity(const ResolveSettings& settings) {
  return settings.velocity == PixelFormat::kRG16F ? "HALF" : "FLOAT";
}

const char* history(const ResolveSettings& settings) {
  return settings.temporal.history == PixelFormat::kRGBA16F ? "HALF" : "FLOAT";
}

const char* storage_name(Storage storage) {
  return storage == Storage::kImage ? "IMAGE" : "BUFFER";
}

const char* curve(ToneMap tone_map) {
  switch (tone_map) {
    case ToneMap::kClamp:
      return "TONE_CLAMP";
    case ToneMap::kReinhard:
      return "TONE_REINHARD";
    case ToneMap::kAces:
      return "TONE_ACES";
  }
  return "TONE_CLAMP";
}

const char* view_name(TemporalView view) {
  switch (view) {
    case TemporalView::kPicture:
      return "PICTURE";
    case TemporalView::kConfidence:
      return "CONFIDENCE";
    case TemporalView::kRejection:
      return "REJECTION";
    case TemporalView::kPhase:
      return "PHASE";
  }
  return "PICTURE";
}

}  // namespace

std::string scale_options(const ResolveSettings& settings) {
  return fmt::format("{} -D OUTPUT_FORMAT={}", source(settings), resolved(settings));
}

std::string velocity_options(const ResolveSettings& settings) {
  if (settings.storage == Storage::kImage) return "-D SOURCE_STORAGE=IMAGE";
  return fmt::format("-D SOURCE_STORAGE=BUFFER -D VELOCITY_FORMAT={}", velocity(settings));
}

std::string filter_options(Filter filter, const ResolveSettings& settings, int taps) {
  const bool rings = filter == Filter::kCatmullRom || filter == Filter::kLanczos2;
  return fmt::format("-D TAPS={} -D CLAMP={} {}", taps, rings && settings.clamp_ringing ? 1 : 0,
                     scale_options(settings));
}

std::string blur_options(const ResolveSettings& settings) {
  return fmt::format("{} -D SOURCE_FORMAT={} -D OUTPUT_FORMAT={}", velocity_options(settings),
                     resolved(settings), resolved(settings));
}

std::string quincunx_options(const ResolvePlan& plan) {
  const ResolveSettings& settings = plan.settings;
  const bool weighs = plan.weighs_velocity();
  std::string format;
  if (weighs && settings.storage == Storage::kBuffer)
    format = fmt::format(" -D VELOCITY_FORMAT={}", velocity(settings));
  return fmt::format("-D SAMPLING={} -D WEIGHT={} -D REACTIVE={} {}{} -D OUTPUT_FORMAT={}",
                     settings.quincunx.sampling == Sampling::kPoint ? "POINT" : "BILINEAR", weighs ? 1 : 0,
                     plan.reads_reactive ? 1 : 0, source(settings), format, resolved(settings));
}

std::string reproject_options(const ResolvePlan& plan) {
  return fmt::format("-D REACTIVE={} -D RESIDUAL={} -D MOTION_EDGE={} {}", plan.reads_reactive ? 1 : 0,
                     plan.weighs_residual() ? 1 : 0, plan.accumulates() ? 1 : 0,
                     velocity_options(plan.settings));
}

std::string reprojected_options(const ResolvePlan& plan) {
  const bool moves = plan.velocity != VelocitySource::kNone;
  return fmt::format("-D MOTION={} -D REACTIVE={} {}", moves ? 1 : 0, !moves && plan.reads_reactive ? 1 : 0,
                     scale_options(plan.settings));
}

std::string temporal_tiles_options(const ResolvePlan& plan) {
  return fmt::format("-D MOTION={} {} -D HISTORY_FORMAT={}", plan.follows() ? 1 : 0, source(plan.settings),
                     history(plan.settings));
}

std::string temporal_options(const ResolvePlan& plan) {
  const TemporalPreset preset = plan.settings.temporal.preset;
  const bool moves = plan.follows();
  const TemporalView view = plan.settings.temporal.view;
  std::string format;
  if (view != TemporalView::kPicture) format = fmt::format(" -D OUTPUT_FORMAT={}", resolved(plan.settings));
  return fmt::format(
      "-D MOTION={} -D REACTIVE={} -D TAPS={} -D TRUST={} -D VIEW={} {} -D HISTORY_FORMAT={}{}",
      moves ? 1 : 0, !moves && plan.reads_reactive ? 1 : 0, moves && preset == TemporalPreset::kFast ? 4 : 16,
      moves && preset == TemporalPreset::kQuality ? "BILINEAR" : "NEAREST", view_name(view),
      source(plan.settings), history(plan.settings), format);
}

std::string temporal_display_options(const ResolvePlan& plan) {
  return fmt::format("-D ALPHA={} -D SMOOTH={} {} -D HISTORY_FORMAT={}", plan.needs.background ? 0 : 1,
                     plan.settings.temporal.preset == TemporalPreset::kFast ? 0 : 1,
                     scale_options(plan.settings), history(plan.settings));
}

std::string sharpen_options(const ResolveSettings& settings) {
  return fmt::format("-D SOURCE_FORMAT={0} -D OUTPUT_FORMAT={0}", resolved(settings));
}

std::string present_options(const ResolveSettings& settings) {
  return fmt::format("-D TONE_MAP={} -D DITHER={} -D SOURCE_FORMAT={} -D OUTPUT_STORAGE={}",
                     curve(settings.tone_map), settings.dither ? 1 : 0, resolved(settings),
                     storage_name(settings.storage));
}

std::string clear_options(Storage storage, PixelFormat format) {
  if (storage == Storage::kImage) return "-D OUTPUT_STORAGE=IMAGE";
  return fmt::format("-D OUTPUT_STORAGE=BUFFER -D TEXEL_BYTES={}", bytes_per_pixel(format));
}

}  // namespace quincunx

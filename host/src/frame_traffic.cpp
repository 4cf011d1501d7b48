// SPDX-License-Identifier: MIT
#include "frame_traffic.h"

#include "params.h"
#include "pass_temporal.h"

namespace quincunx {
namespace {

std::uint64_t bytes_of(Extent extent, PixelFormat format) {
  return static_cast<std::uint64_t>(extent.area()) * bytes_per_pixel(format);
}

std::uint64_t read_of_frame(const ResolvePlan& plan, Extent render) {
  std::uint64_t bytes = bytes_of(render, plan.settings.colour);
  if (plan.weighs_velocity()) bytes += bytes_of(render, plan.settings.velocity);
  return bytes;
}

std::uint64_t reactive_bytes(Extent render, Extent previous_render) {
  return bytes_of(render, PixelFormat::kR8) + bytes_of(previous_render, PixelFormat::kR8);
}

std::uint64_t tiles_of(Extent output) {
  const auto side = [](int pixels) {
    return static_cast<std::uint64_t>((pixels + kTileSide - 1) / kTileSide);
  };
  return side(output.width) * side(output.height);
}

}  // namespace

std::uint64_t scale_bytes(const ResolveSettings& settings, Extent render) {
  return bytes_of(render, settings.colour) + bytes_of(settings.output, settings.resolved);
}

std::uint64_t velocity_bytes(const ResolveSettings& settings, Extent render) {
  return bytes_of(render, PixelFormat::kR32F) + bytes_of(render, settings.velocity);
}

std::uint64_t quincunx_bytes(const ResolvePlan& plan, Extent render, Extent previous_render) {
  const std::uint64_t reactive = plan.reads_reactive ? reactive_bytes(render, previous_render) : 0;
  return read_of_frame(plan, render) + read_of_frame(plan, previous_render) + reactive +
         bytes_of(plan.settings.output, plan.settings.resolved);
}

std::uint64_t reproject_bytes(const ResolvePlan& plan, Extent render, Extent previous_render) {
  const PixelFormat velocity = plan.settings.velocity;
  std::uint64_t bytes = bytes_of(render, velocity) + bytes_of(render, PixelFormat::kR32F) +
                        bytes_of(previous_render, PixelFormat::kR32F) +
                        static_cast<std::uint64_t>(render.area()) * sizeof(Reprojection);
  if (plan.weighs_residual()) bytes += bytes_of(previous_render, velocity);
  if (plan.reads_reactive) bytes += reactive_bytes(render, previous_render);
  return bytes;
}

std::uint64_t reprojected_bytes(const ResolvePlan& plan, Extent render, Extent previous_render) {
  std::uint64_t bytes = bytes_of(render, plan.settings.colour) +
                        bytes_of(previous_render, plan.settings.colour) +
                        bytes_of(plan.settings.output, plan.settings.resolved);
  if (plan.velocity != VelocitySource::kNone) {
    bytes += static_cast<std::uint64_t>(render.area()) * sizeof(Reprojection);
  } else if (plan.reads_reactive) {
    bytes += reactive_bytes(render, previous_render);
  }
  return bytes;
}

std::uint64_t temporal_tiles_bytes(const ResolvePlan& plan, Extent render) {
  const ResolveSettings& settings = plan.settings;
  const TileBytes tile = temporal_tile_bytes(settings.output);
  std::uint64_t bytes = 2 * tile.reprojection + tile.evidence + bytes_of(render, settings.colour) +
                        bytes_of(settings.output, settings.temporal.history);
  if (plan.follows()) bytes += static_cast<std::uint64_t>(render.area()) * sizeof(Reprojection);
  return bytes;
}

std::uint64_t temporal_light_bytes(const ResolvePlan& plan) {
  const TileBytes tile = temporal_tile_bytes(plan.settings.output);
  return tile.reprojection + tile.evidence + 2 * tile.light;
}

std::uint64_t temporal_bytes(const ResolvePlan& plan, Extent render, Extent previous_render) {
  const ResolveSettings& settings = plan.settings;
  const TileBytes tile = temporal_tile_bytes(settings.output);
  std::uint64_t bytes = bytes_of(render, settings.colour) + 2 * tile.reprojection + tile.light +
                        2 * bytes_of(settings.output, settings.temporal.history);
  if (plan.follows()) {
    bytes += static_cast<std::uint64_t>(render.area()) * sizeof(Reprojection);
  } else if (plan.reads_reactive) {
    bytes += reactive_bytes(render, previous_render);
  }
  if (settings.temporal.view != TemporalView::kPicture) bytes += bytes_of(settings.output, settings.resolved);
  return bytes;
}

std::uint64_t temporal_display_bytes(const ResolvePlan& plan, Extent render) {
  const ResolveSettings& settings = plan.settings;
  const std::uint64_t alpha = plan.needs.background ? 0 : bytes_of(render, settings.colour);
  return alpha + temporal_tile_bytes(settings.output).reprojection +
         bytes_of(settings.output, settings.temporal.history) + bytes_of(settings.output, settings.resolved);
}

std::uint64_t motion_tiles_bytes(const ResolveSettings& settings, Extent render) {
  return bytes_of(render, settings.velocity) + tiles_of(settings.output) * sizeof(TileStreaks);
}

std::uint64_t motion_neighbours_bytes(const ResolveSettings& settings) {
  return tiles_of(settings.output) * (sizeof(TileStreaks) + sizeof(TileBlur));
}

std::uint64_t motion_blur_bytes(const ResolveSettings& settings, Extent render) {
  return 2 * bytes_of(settings.output, settings.resolved) + bytes_of(render, settings.velocity) +
         bytes_of(render, PixelFormat::kR32F) + tiles_of(settings.output) * sizeof(TileBlur);
}

std::uint64_t sharpen_bytes(const ResolveSettings& settings) {
  return 2 * bytes_of(settings.output, settings.resolved);
}

std::uint64_t present_bytes(const ResolveSettings& settings) {
  return bytes_of(settings.output, settings.resolved) + bytes_of(settings.output, PixelFormat::kRGBA8);
}

}  // namespace quincunx

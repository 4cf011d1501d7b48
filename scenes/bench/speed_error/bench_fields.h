// SPDX-License-Identifier: MIT
// The names of all fields of a BenchResult, once for JSON in both directions and CSV: an archive is called
// with each name and field.
#pragma once

#include "bench/speed_error/bench_result.h"

namespace quincunx::bench {

template <typename Archive>
void fields(Archive& io, Extent& value) {
  io("width", value.width);
  io("height", value.height);
}

template <typename Archive>
void fields(Archive& io, Spread& value) {
  io("median", value.median);
  io("p95", value.p95);
  io("low", value.low);
  io("high", value.high);
}

// Named for what they are of, with the region behind it: "psnr_thin".
template <typename Archive>
void region_fields(Archive& io, const std::string& prefix, RegionFigures& value) {
  constexpr std::array<const char*, kRegions> kNames = {"thin", "behind_thin", "disoccluded", "edge", "rest"};
  for (std::size_t i = 0; i < kRegions; ++i)
    io((prefix + kNames[i]).c_str(), value[i]);
}

template <typename Archive>
void fields(Archive& io, Quality& value) {
  io("psnr", value.psnr);
  io("psnr_linear", value.psnr_linear);
  io("ssim", value.ssim);
  io("flip", value.flip);
  io("error_p99", value.error_p99);
  io("relative_error", value.relative_error);
  io("worst_window", value.worst_window);
  io("worst_frame", value.worst_frame);
  io("worst_x", value.worst_x);
  io("worst_y", value.worst_y);
  io("flicker", value.flicker);
  io("ghosting", value.ghosting);
  region_fields(io, "psnr_", value.region_psnr);
  io("psnr_focus", value.psnr_focus);
  io("psnr_outside", value.psnr_outside);
  io("non_finite", value.non_finite);
}

template <typename Archive>
void fields(Archive& io, Speed& value) {
  io("ms", value.ms);
  io("least_ms", value.least_ms);
  io("processor_ms", value.processor_ms);
  io("ratio", value.ratio);
  io("processor_ratio", value.processor_ratio);
  io("bytes", value.bytes);
  io("gigabytes_per_second", value.gigabytes_per_second);
  io("kernels", value.kernels);
}

template <typename Archive>
void fields(Archive& io, Row& value) {
  io("scene", value.scene);
  io("scale", value.scale);
  io("method", value.method);
  io("render", value.render);
  io("quality", value.quality);
  io("speed", value.speed);
  io("front", value.front);
}

template <typename Archive>
void fields(Archive& io, CopyRow& value) {
  io("scene", value.scene);
  io("scale", value.scale);
  io("ms", value.ms);
  io("processor_ms", value.processor_ms);
  io("gigabytes_per_second", value.gigabytes_per_second);
}

template <typename Archive>
void fields(Archive& io, FrameRow& value) {
  io("scene", value.scene);
  io("scale", value.scale);
  io("method", value.method);
  io("render", value.render);
  io("draw_ms", value.draw_ms);
  io("interop_ms", value.interop_ms);
  io("resolve_ms", value.resolve_ms);
  io("frame_ms", value.frame_ms);
  io("draw_processor_ms", value.draw_processor_ms);
  io("interop_processor_ms", value.interop_processor_ms);
  io("resolve_processor_ms", value.resolve_processor_ms);
  io("frame_processor_ms", value.frame_processor_ms);
  io("interop_bytes", value.interop_bytes);
}

template <typename Archive>
void fields(Archive& io, SceneRow& value) {
  io("name", value.name);
  io("summary", value.summary);
  io("reason", value.reason);
  io("truth_flicker", value.truth_flicker);
  io("disoccluded", value.disoccluded);
  region_fields(io, "part_", value.region_part);
}

template <typename Archive>
void fields(Archive& io, MethodRow& value) {
  io("name", value.name);
  io("summary", value.summary);
  io("jitter", value.jitter);
  io("lod_bias", value.lod_bias);
}

template <typename Archive>
void fields(Archive& io, Machine& value) {
  io("processor", value.processor);
  io("processors", value.processors);
  io("memory_gib", value.memory_gib);
  io("system", value.system);
  io("cl_device", value.cl_device);
  io("cl_platform", value.cl_platform);
  io("cl_driver", value.cl_driver);
  io("cl_version", value.cl_version);
  io("cl_on_processor", value.cl_on_processor);
  io("gl_renderer", value.gl_renderer);
  io("gl_version", value.gl_version);
  io("interop", value.interop);
  io("load_before", value.load_before);
  io("load_after", value.load_after);
}

template <typename Archive>
void fields(Archive& io, Conditions& value) {
  io("output", value.output);
  io("frames", value.frames);
  io("warm_up", value.warm_up);
  io("history_warm_up", value.history_warm_up);
  io("rounds", value.rounds);
  io("truth_samples", value.truth_samples);
  io("seed", value.seed);
  io("fps", value.fps);
  io("start", value.start);
  io("focus", value.focus);
  io("focus_scale", value.focus_scale);
}

template <typename Archive>
void fields(Archive& io, BenchResult& value) {
  io("version", value.version);
  io("command", value.command);
  io("date", value.date);
  io("wall_seconds", value.wall_seconds);
  io("machine", value.machine);
  io("conditions", value.conditions);
  io("scenes", value.scenes);
  io("methods", value.methods);
  io("copies", value.copies);
  io("rows", value.rows);
  io("frames", value.frames);
}

}  // namespace quincunx::bench

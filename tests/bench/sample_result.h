// SPDX-License-Identifier: MIT
// A small made-up result: one scene, two methods at four scales.
#pragma once

#include "bench/speed_error/bench_result.h"

namespace quincunx::testing {

inline bench::Spread spread(double median, double half_width) {
  return {.median = median,
          .p95 = median + 2 * half_width,
          .low = median - half_width,
          .high = median + half_width};
}

// Two methods' rows at four scales; the second one's PSNR is infinite, the first one's flicker absent. No pixel is
// disoccluded or at an edge of motion.
inline bench::BenchResult sample_result() {
  bench::BenchResult result;
  result.version = "1.2.3";
  result.machine.processor = "a processor";
  result.machine.processors = 2;
  result.machine.cl_on_processor = true;
  result.conditions = {.output = {64, 36},
                       .frames = 2,
                       .warm_up = 1,
                       .history_warm_up = 5,
                       .rounds = 3,
                       .truth_samples = 4,
                       .fps = 60};
  result.scenes.push_back(
      {"pan", "a \"pan\"", "tests </script> <!-- names", 0.01, 0.5, {0.25, 0.25, {}, {}, 0.5}});
  result.methods = {{"bilinear", "four samples", "none", 0}, {"quincunx:mean", "a, b", "quincunx", -0.5}};
  for (const double scale : {0.5, 0.7, 0.85, 1.0}) {
    for (const bench::MethodRow& method : result.methods) {
      const bool plain = method.name == "bilinear";
      bench::Row row;
      row.scene = "pan";
      row.scale = scale;
      row.method = method.name;
      row.render = {32, 18};
      row.front = {"flip"};
      row.quality.psnr = plain ? 30 : std::numeric_limits<double>::infinity();
      row.quality.psnr_linear = 28;
      row.quality.flip = plain ? 0.1 : 0.08;
      if (!plain) row.quality.flicker = 0.25;
      row.quality.region_psnr = {plain ? 20 : 25, plain ? 28 : 27, {}, {}, bench::kHighestRegionPsnr};
      row.speed.ms = spread(plain ? 1 : 2, 0.01);
      row.speed.processor_ms = spread(plain ? 2 : 4, 0.01);
      row.speed.ratio = row.speed.processor_ratio = spread(plain ? 1 : 2, 0.005);
      row.speed.bytes = 1234567890123;
      row.speed.kernels = "scale_bilinear";
      result.rows.push_back(row);
    }
    result.copies.push_back({"pan", scale, spread(1, 0.01), spread(2, 0.01), 10.5});
    bench::FrameRow frame;
    frame.scene = "pan";
    frame.scale = scale;
    frame.method = "bilinear";
    frame.render = {32, 18};
    frame.frame_ms = spread(10 * scale, 0.1);
    frame.resolve_ms = spread(1, 0.1);
    frame.frame_processor_ms = spread(20 * scale, 0.1);
    result.frames.push_back(frame);
  }
  return result;
}

}  // namespace quincunx::testing

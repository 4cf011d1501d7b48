// SPDX-License-Identifier: MIT
// The views of a result: a page that needs nothing else, a plot for documents, and a gallery of crops of truth,
// pictures and error maps at the same pixels, small enough for the page.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bench/speed_error/bench_plan.h"
#include "bench/speed_error/bench_result.h"
#include "quincunx/status.h"
#include "tools/image/image_metrics.h"

namespace quincunx::bench {

// The crops of one scene at one scale as two PNGs. Row y of picture k is row y * names.size() + k of the
// PNG: pictures of one thing differ little, so each row costs little after the one above. In `errors`, grey,
// the first is black.
struct Sheet {
  double scale = 1;
  std::vector<std::uint8_t> pictures;  // tone mapped as the errors are measured
  std::vector<std::uint8_t> errors;    // FLIP: 255 is 1
};

struct GalleryScene {
  std::string name;
  int x = 0;  // column of the crop's upper left pixel in the output; y: its row
  int y = 0;
  std::vector<Sheet> sheets;
};

struct Gallery {
  Extent crop;
  int frame = 0;                   // index among the measured ones
  std::vector<std::string> names;  // "truth", then the methods
  std::vector<GalleryScene> scenes;
};

// Scenes come one after another. The crop of each lies where the methods err most in the mean.
class GalleryMaker {
 public:
  explicit GalleryMaker(const BenchPlan& plan);

  void begin_scene(const std::string& name, const tools::MeasuredPicture& truth);
  void add(double scale, const tools::MeasuredPicture& picture);  // in the order of the methods
  void end_scene();

  Gallery take() { return std::move(gallery_); }

 private:
  struct Shot {
    std::vector<std::uint8_t> rgb;
    std::vector<std::uint8_t> error;  // FLIP
  };
  struct Shots {
    double scale = 1;
    std::vector<Shot> shots;
  };

  void choose_crop(GalleryScene& scene) const;
  std::vector<std::uint8_t> sheet(const GalleryScene& scene, const Shots& shots, bool errors) const;

  Extent output_;
  Gallery gallery_;
  const tools::MeasuredPicture* truth_ = nullptr;
  std::vector<Shots> shots_;
};

// Size of the crops so that all sheets together stay near `bytes`.
Extent crop_for(Extent output, std::size_t pictures, double bytes);

// Returns the page of a result; an empty gallery leaves the viewer out.
std::string page_of(const BenchResult& result, const Gallery& gallery);

// Returns an SVG that stands alone, of error over cost at the headline scale: mean FLIP of all scenes over the mean
// cost in copies, one point a method, with the Pareto front. Empty where there are no rows.
std::string plot_of(const BenchResult& result);

}  // namespace quincunx::bench

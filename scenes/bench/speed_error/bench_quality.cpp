// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_quality.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "bench/harness/measuring.h"
#include "bench/speed_error/bench_plan.h"
#include "embedded_shader_files.h"
#include "frames/target_file.h"
#include "quincunx/advanced/cache_folder.h"
#include "render/truth.h"
#include "tools/image/image_io.h"

namespace quincunx::bench {
namespace {

double mean_square_of(double decibels) {
  return std::pow(10, -decibels / 10);  // 0 for an infinite ratio
}

double pixel_error(const tools::MeasuredPicture& picture, const tools::MeasuredPicture& truth,
                   std::size_t i) {
  double sum = 0;
  for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
    const double difference = double{picture.tone_mapped()[c]} - double{truth.tone_mapped()[c]};
    sum += difference * difference;
  }
  return sum / 3;
}

namespace fs = std::filesystem;

struct Moment {
  scenes::Renderer& renderer;
  const std::string& scene;
  const std::string& gl_version;
  const Conditions& conditions;
  double seconds;
};

std::string key_of(const Moment& moment) {
  const Conditions& conditions = moment.conditions;
  const auto sample = checked(
      scenes::render_truth(moment.renderer, {.output = conditions.output, .samples = 1}, moment.seconds));
  std::string text =
      fmt::format("{} {} {} {} {}x{} {}\n", QUINCUNX_VERSION, moment.scene, conditions.seed, moment.seconds,
                  conditions.output.width, conditions.output.height, conditions.truth_samples);
  text += moment.gl_version;
  for (const EmbeddedFile& file : scenes::embedded_shader_files())
    text += file.text;
  text.append(reinterpret_cast<const char*>(sample.data()), sample.size() * sizeof(float));
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

// RGBA of a kept truth; nothing where there is none of this size.
std::optional<std::vector<float>> kept(const fs::path& path, Extent extent) {
  std::error_code error;
  if (!fs::exists(path, error)) return std::nullopt;
  auto image = tools::read_image(path.string());
  if (!image.ok() || image->extent != extent || image->channels.size() != 4) return std::nullopt;
  return std::move(image->pixels);
}

// As it comes back from the file, so that the first run and the next measure alike.
std::vector<float> truth_of(const Moment& moment) {
  const Extent output = moment.conditions.output;
  const auto draw = [&] {
    return checked(scenes::render_truth(
        moment.renderer, {.output = output, .samples = moment.conditions.truth_samples}, moment.seconds));
  };
  const auto folder = cache_folder();
  if (!folder) return draw();
  const fs::path path = *folder / "truth" / (key_of(moment) + ".exr");
  if (auto pixels = kept(path, output)) return std::move(*pixels);
  auto drawn = draw();
  if (Status status = tools::write_light(path.string(), output, drawn); !status.ok()) {
    spdlog::warn("truth is not kept: {}", status.message());
    return drawn;
  }
  if (auto pixels = kept(path, output)) return std::move(*pixels);
  return drawn;
}

double mean_change(const tools::MeasuredPicture& picture, const tools::MeasuredPicture& previous) {
  double sum = 0;
  for (std::size_t i = 0; i < picture.luma().size(); ++i)
    sum += std::abs(double{picture.luma()[i]} - double{previous.luma()[i]});
  return sum / static_cast<double>(picture.luma().size());
}

// How much of all measured pixels each mask covers.
void add_parts(SceneTruth& truth) {
  double pixels = 0;
  double disoccluded = 0;
  std::array<double, kRegions> regions{};
  for (const FrameMasks& masks : truth.masks) {
    pixels += static_cast<double>(masks.regions.size());
    disoccluded += static_cast<double>(std::count(masks.disoccluded.begin(), masks.disoccluded.end(), 1));
    for (const Region region : masks.regions)
      regions[static_cast<std::size_t>(region)] += 1;
  }
  truth.disoccluded_part = disoccluded / pixels;
  for (std::size_t i = 0; i < kRegions; ++i)
    truth.region_part[i] = regions[i] / pixels;
}

}  // namespace

void QualityTally::add(tools::MeasuredPicture picture, const tools::MeasuredPicture& truth,
                       const tools::MeasuredPicture* previous_truth, const FrameMasks& masks) {
  const tools::PictureScores scores = tools::measure(picture, truth);
  error_ += mean_square_of(scores.psnr_tone_mapped);
  error_linear_ += mean_square_of(scores.psnr_linear);
  ssim_ += scores.ssim;
  flip_ += scores.flip;
  p99_ += scores.error_p99;
  relative_ += scores.relative_error;
  non_finite_ += scores.non_finite;
  if (frames_ == 0 || scores.worst_window.error > worst_.worst_window) {
    worst_.worst_window = scores.worst_window.error;
    worst_.worst_frame = frames_;
    worst_.worst_x = scores.worst_window.x;
    worst_.worst_y = scores.worst_window.y;
  }
  if (latest_ && previous_truth != nullptr) {
    flicker_ += tools::flicker(picture, *latest_, truth, *previous_truth);
  }
  for (std::size_t i = 0; i < masks.regions.size(); ++i) {
    const double error = pixel_error(picture, truth, i);
    regions_[static_cast<std::size_t>(masks.regions[i])].add(error);
    if (masks.disoccluded[i] != 0) disoccluded_.add(error);
    if (!masks.focus.empty()) (masks.focus[i] != 0 ? focus_ : outside_).add(error);
  }
  latest_ = std::move(picture);
  ++frames_;
}

void QualityTally::PartError::add(double squared_error) {
  squares += squared_error;
  ++count;
}

std::optional<double> QualityTally::PartError::psnr() const {
  if (count == 0) return std::nullopt;
  return std::min(-10 * std::log10(mean_square()), kHighestRegionPsnr);
}

Quality QualityTally::quality() const {
  const double count = frames_;
  Quality quality = worst_;
  quality.psnr = -10 * std::log10(error_ / count);
  quality.psnr_linear = -10 * std::log10(error_linear_ / count);
  quality.ssim = ssim_ / count;
  quality.flip = flip_ / count;
  quality.error_p99 = p99_ / count;
  quality.relative_error = relative_ / count;
  if (frames_ > 1) quality.flicker = flicker_ / (count - 1);
  if (disoccluded_.count > 0) quality.ghosting = std::sqrt(disoccluded_.mean_square());
  for (std::size_t i = 0; i < kRegions; ++i)
    quality.region_psnr[i] = regions_[i].psnr();
  quality.psnr_focus = focus_.psnr();
  quality.psnr_outside = outside_.psnr();
  quality.non_finite = non_finite_;
  return quality;
}

SceneTruth make_truth(scenes::Renderer& renderer, const scenes::Scene& scene, const std::string& gl_version,
                      const Conditions& conditions) {
  SceneTruth truth;
  double change = 0;
  for (int frame = 0; frame < conditions.frames; ++frame) {
    const double seconds = seconds_of(conditions, conditions.warm_up + frame);
    auto rgba = truth_of({renderer, scene.name, gl_version, conditions, seconds});
    truth.pictures.push_back(tools::measured(conditions.output, std::move(rgba), scene.exposure));
    if (frame > 0) change += mean_change(truth.pictures.back(), *(truth.pictures.end() - 2));
    spdlog::debug("truth of {} at {:.3f} s", scene.name, seconds);
  }
  if (conditions.frames > 1) truth.flicker = change / (conditions.frames - 1);
  truth.masks = checked(masks_of_frames(renderer, scene, conditions));
  add_parts(truth);
  return truth;
}

}  // namespace quincunx::bench

// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_gallery.h"

#include <algorithm>
#include <cmath>

#include "tools/image/flip.h"
#include "tools/image/image_io.h"

namespace quincunx::bench {
namespace {

// What a page may carry, and what a picture and its error map came to, in bytes a pixel, in practice.
constexpr double kGalleryBytes = 4e6;
constexpr double kBytesPerPixel = 1.6;
constexpr Extent kLargestCrop{320, 180};
constexpr Extent kSmallestCrop{64, 36};

std::vector<std::uint8_t> to_bytes(std::span<const float> values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size());
  for (const float value : values)
    bytes.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255)));
  return bytes;
}

// sums[y * (width + 1) + x]: all that lies above and to the left of pixel (x, y).
std::vector<double> summed(const std::vector<double>& values, Extent extent) {
  const std::size_t stride = static_cast<std::size_t>(extent.width) + 1;
  std::vector<double> sums(stride * (static_cast<std::size_t>(extent.height) + 1), 0);
  for (std::size_t y = 0; y + 1 < sums.size() / stride; ++y) {
    double row = 0;
    for (std::size_t x = 0; x + 1 < stride; ++x) {
      row += values[y * (stride - 1) + x];
      sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row;
    }
  }
  return sums;
}

}  // namespace

Extent crop_for(Extent output, std::size_t pictures, double bytes) {
  const double area = bytes / (kBytesPerPixel * static_cast<double>(std::max<std::size_t>(pictures, 1)));
  const double width = std::sqrt(area * kLargestCrop.width / kLargestCrop.height);
  const double height = width * kLargestCrop.height / kLargestCrop.width;
  const auto fit = [](double side, int low, int high, int there) {
    return std::min(std::clamp(static_cast<int>(side), low, high), there);
  };
  return {fit(width, kSmallestCrop.width, kLargestCrop.width, output.width),
          fit(height, kSmallestCrop.height, kLargestCrop.height, output.height)};
}

GalleryMaker::GalleryMaker(const BenchPlan& plan) : output_(plan.conditions.output) {
  gallery_.frame = plan.conditions.frames - 1;
  gallery_.names = {"truth"};
  for (const BenchMethod& method : plan.methods)
    gallery_.names.push_back(method.name);
  gallery_.crop =
      crop_for(output_, gallery_.names.size() * plan.scenes.size() * plan.scales.size(), kGalleryBytes);
}

void GalleryMaker::begin_scene(const std::string& name, const tools::MeasuredPicture& truth) {
  truth_ = &truth;
  shots_.clear();
  gallery_.scenes.push_back({.name = name, .sheets = {}});
}

void GalleryMaker::add(double scale, const tools::MeasuredPicture& picture) {
  if (shots_.empty() || shots_.back().scale != scale) {
    const std::vector<std::uint8_t> none(truth_->luma().size(), 0);
    shots_.push_back({scale, {{to_bytes(truth_->tone_mapped()), none}}});
  }
  const std::vector<float> map = tools::flip_map(output_, picture.tone_mapped(), truth_->tone_mapped());
  shots_.back().shots.push_back({to_bytes(picture.tone_mapped()), to_bytes(map)});
}

Status GalleryMaker::end_scene() {
  GalleryScene& scene = gallery_.scenes.back();
  choose_crop(scene);
  for (const Shots& shots : shots_) {
    auto pictures = sheet(scene, shots, false);
    if (!pictures.ok()) return pictures.status();
    auto errors = sheet(scene, shots, true);
    if (!errors.ok()) return errors.status();
    scene.sheets.push_back({shots.scale, std::move(pictures).value(), std::move(errors).value()});
  }
  shots_.clear();
  return {};
}

void GalleryMaker::choose_crop(GalleryScene& scene) const {
  std::vector<double> error(static_cast<std::size_t>(output_.area()), 0);
  for (const Shots& shots : shots_) {
    for (const Shot& shot : shots.shots) {
      for (std::size_t i = 0; i < error.size(); ++i)
        error[i] += shot.error[i];
    }
  }
  const std::vector<double> sums = summed(error, output_);
  const int stride = output_.width + 1;
  const auto sum = [&](int x, int y) { return sums[static_cast<std::size_t>(y) * stride + x]; };
  double most = -1;
  for (int y = 0; y + gallery_.crop.height <= output_.height; ++y) {
    for (int x = 0; x + gallery_.crop.width <= output_.width; ++x) {
      const int right = x + gallery_.crop.width;
      const int below = y + gallery_.crop.height;
      const double inside = sum(right, below) - sum(x, below) - sum(right, y) + sum(x, y);
      if (inside <= most) continue;
      most = inside;
      scene.x = x;
      scene.y = y;
    }
  }
}

Result<std::vector<std::uint8_t>> GalleryMaker::sheet(const GalleryScene& scene, const Shots& shots,
                                                      bool errors) const {
  const int channels = errors ? 1 : 3;
  std::vector<std::uint8_t> texels;
  for (int y = scene.y; y < scene.y + gallery_.crop.height; ++y) {
    for (const Shot& shot : shots.shots) {
      const std::vector<std::uint8_t>& source = errors ? shot.error : shot.rgb;
      const auto first =
          source.begin() + (static_cast<std::ptrdiff_t>(y) * output_.width + scene.x) * channels;
      texels.insert(texels.end(), first, first + static_cast<std::ptrdiff_t>(gallery_.crop.width) * channels);
    }
  }
  const Extent extent{gallery_.crop.width, gallery_.crop.height * static_cast<int>(shots.shots.size())};
  return tools::encode_png(extent, channels, texels);
}

}  // namespace quincunx::bench

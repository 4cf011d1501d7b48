// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/harness/measuring.h"
#include "bench/speed_error/bench_findings.h"
#include "bench/speed_error/bench_statistics.h"
#include "embedded_bench_files.h"
#include "tools/image/image_io.h"
#include "tools/image/image_metrics.h"
#include "tools/page/page.h"

namespace quincunx::bench {
namespace {

// Bytes that a page's gallery may take, and bytes a pixel of a picture and its error map, as found in practice.
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

using Json = nlohmann::ordered_json;

Json gallery_json(const Gallery& gallery) {
  Json scenes = Json::array();
  for (const GalleryScene& scene : gallery.scenes) {
    Json sheets = Json::array();
    for (const Sheet& sheet : scene.sheets) {
      sheets.push_back({{"scale", sheet.scale},
                        {"pictures", tools::base64(sheet.pictures)},
                        {"errors", tools::base64(sheet.errors)}});
    }
    scenes.push_back({{"name", scene.name}, {"x", scene.x}, {"y", scene.y}, {"sheets", std::move(sheets)}});
  }
  return {{"width", gallery.crop.width},
          {"height", gallery.crop.height},
          {"frame", gallery.frame},
          {"names", gallery.names},
          {"scenes", std::move(scenes)}};
}

Json page_json(const BenchResult& result, const Gallery& gallery) {
  Json findings = Json::array();
  for (const Finding& finding : findings_of(result)) {
    findings.push_back(
        {{"figure", finding.figure}, {"heading", finding.heading}, {"sentence", finding.sentence}});
  }
  Json measures = Json::array();
  for (const ErrorMeasure& measure : error_measures()) {
    measures.push_back(
        {{"name", measure.name}, {"label", measure.label}, {"higher", measure.higher_is_better}});
  }
  const TypicalNoise noise = typical_noise(result);
  return {{"findings", std::move(findings)},          {"measures", std::move(measures)},
          {"cost_clock", cost_clock(result.machine)}, {"noise", {{"ms", noise.ms}, {"cost", noise.cost}}},
          {"result", Json::parse(to_json(result))},   {"gallery", gallery_json(gallery)}};
}

constexpr double kWidth = 760, kHeight = 420;
constexpr double kLeft = 62, kRight = 740, kTop = 44, kBottom = 366;
constexpr double kCharacter = 7.2;  // width of a label's letter
constexpr double kLine = 16;

struct Box {
  double left, right, top, bottom;
  bool meets(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

// Places of values between two ends; on a logarithmic axis equal quotients are equally far apart.
struct Axis {
  double low, high, from, to;
  bool logarithmic = false;

  double at(double value) const { return logarithmic ? std::log(value) : value; }
  double operator()(double value) const {
    return from + (at(value) - at(low)) / (at(high) - at(low)) * (to - from);
  }
};

// Costs lie between one copy and some tens. Labels need room behind the last.
Axis cost_axis(const std::vector<MethodMean>& means) {
  const auto [low, high] = std::ranges::minmax(means, {}, &MethodMean::cost);
  return {low.cost / 1.15, high.cost * 2.2, kLeft, kRight, true};
}

Axis error_axis(const std::vector<MethodMean>& means) {
  const auto [low, high] = std::ranges::minmax(means, {}, &MethodMean::flip);
  const double room = 0.12 * std::max(high.flip - low.flip, 0.1 * high.flip + 1e-6);
  return {std::max(0.0, low.flip - room), high.flip + room, kBottom, kTop};
}

// 1, 2 or 5 times a power of ten: on a logarithmic axis all of them, else multiples of the one that gives about six.
std::vector<double> ticks(const Axis& axis) {
  std::vector<double> ticks;
  for (double power = 1e-6; power < 1e6; power *= 10) {
    for (const double step : {1.0, 2.0, 5.0}) {
      const double tick = step * power;
      if (axis.logarithmic) {
        if (tick >= axis.low && tick <= axis.high) ticks.push_back(tick);
      } else if (ticks.empty() && tick >= (axis.high - axis.low) / 6) {
        for (double i = std::ceil(axis.low / tick); i * tick <= axis.high; ++i)
          ticks.push_back(i * tick);
      }
    }
  }
  return ticks;
}

std::string text(double x, double y, const char* kind, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, kind, words);
}

std::string grid(const Axis& x, const Axis& y) {
  std::string svg;
  for (const double tick : ticks(x)) {
    svg += fmt::format("<path class=\"grid\" d=\"M{:.1f},{}V{}\"/>\n", x(tick), kTop, kBottom);
    svg += text(x(tick), kBottom + 18, "class=\"quiet\" text-anchor=\"middle\"", fmt::format("{:.3g}", tick));
  }
  for (const double tick : ticks(y)) {
    svg += fmt::format("<path class=\"grid\" d=\"M{},{:.1f}H{}\"/>\n", kLeft, y(tick), kRight);
    svg += text(kLeft - 8, y(tick) + 4, "class=\"quiet\" text-anchor=\"end\"", fmt::format("{:.3g}", tick));
  }
  return svg;
}

// Steps along the methods that nothing beats, cheapest first.
std::string front(std::vector<MethodMean> means, const Axis& x, const Axis& y) {
  std::erase_if(means, [](const MethodMean& mean) { return !mean.on_front; });
  std::ranges::sort(means, {}, &MethodMean::cost);
  std::string path = fmt::format("M{:.1f},{}", x(means.front().cost), kTop);
  for (const MethodMean& mean : means)
    path += fmt::format("H{:.1f}V{:.1f}", x(mean.cost), y(mean.flip));
  return fmt::format("<path class=\"front\" d=\"{}H{}\"/>\n", path, kRight);
}

std::string points(const std::vector<MethodMean>& means, const Axis& x, const Axis& y) {
  std::string svg;
  std::vector<Box> taken;
  for (const MethodMean& mean : means)
    taken.push_back({x(mean.cost) - 7, x(mean.cost) + 7, y(mean.flip) - 7, y(mean.flip) + 7});
  for (const MethodMean& mean : means) {
    const double px = x(mean.cost), py = y(mean.flip);
    const double width = kCharacter * static_cast<double>(mean.method.size());
    Box label{};
    // The nearest line beside the point that is free.
    for (const double line : {0.0, 1.0, -1.0, 2.0, -2.0, 3.0, -3.0}) {
      label = {px + 11, px + 11 + width, py + kLine * line - 7, py + kLine * line + 7};
      if (std::ranges::none_of(taken, [&](const Box& box) { return box.meets(label); })) break;
    }
    taken.push_back(label);
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5.5\" class=\"{}\"/>\n", px, py,
                       mean.on_front ? "best" : "point");
    svg += text(label.left, label.bottom - 2, mean.on_front ? "font-weight=\"600\"" : "", mean.method);
  }
  return svg;
}

constexpr const char* kStyle = R"(<style>
text { font: 13px "DejaVu Sans", sans-serif; fill: #1c2330; paint-order: stroke; stroke: #fff; stroke-width: 3px; }
.quiet { fill: #586174; font-size: 12px; }
.title { font-size: 15px; font-weight: 600; }
.grid { stroke: #d3d7de; fill: none; }
.front { stroke: #0b5fa5; stroke-width: 1.5; fill: none; opacity: .7; }
.best { fill: #0072b2; }
.point { fill: #8a93a5; }
</style>
)";

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

void GalleryMaker::end_scene() {
  GalleryScene& scene = gallery_.scenes.back();
  choose_crop(scene);
  for (const Shots& shots : shots_) {
    scene.sheets.push_back({shots.scale, sheet(scene, shots, false), sheet(scene, shots, true)});
  }
  shots_.clear();
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

std::vector<std::uint8_t> GalleryMaker::sheet(const GalleryScene& scene, const Shots& shots,
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
  return checked(tools::encode_png(extent, channels, texels));
}

std::string page_of(const BenchResult& result, const Gallery& gallery) {
  return tools::make_page({.title = "speed against error",
                           .script = tools::text_of(embedded_bench_files(), "bench.js"),
                           .beside = "bench.csv"},
                          page_json(result, gallery));
}

std::string plot_of(const BenchResult& result) {
  if (result.rows.empty()) return {};
  const double scale = headline_scale(result);
  std::vector<MethodMean> means = method_means(result);
  std::erase_if(means, [scale](const MethodMean& mean) { return mean.scale != scale; });
  const Axis x = cost_axis(means), y = error_axis(means);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      kWidth, kHeight);
  svg += kStyle + grid(x, y) + front(means, x, y) + points(means, x, y);
  svg += text(
      16, 24, "class=\"title\"",
      fmt::format("Error over cost at scale {}, {}x{}, mean of {} scenes", scale,
                  result.conditions.output.width, result.conditions.output.height, result.scenes.size()));
  svg += text(kRight, 24, "class=\"quiet\" text-anchor=\"end\"", "FLIP against truth: down is better");
  svg += text(kRight, kHeight - 12, "class=\"quiet\" text-anchor=\"end\"",
              fmt::format("cost in copies of the picture, by {}, logarithmic: left is better",
                          cost_clock(result.machine)));
  return svg + "</svg>\n";
}

}  // namespace quincunx::bench

// SPDX-License-Identifier: MIT
#include "session/why_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include "frames/target_file.h"
#include "render/truth.h"
#include "session/calibration.h"
#include "session/paced_loop.h"
#include "tools/image/contact_sheet.h"
#include "tools/image/image_metrics.h"
#include "tools/page/scored_frames.h"
#include "tools/program/clock.h"
#include "tools/program/command_line.h"
#include "tools/program/program.h"

namespace quincunx::scenes {
namespace {

constexpr std::array<Method, 3> kMethods = {Method::kBilinear, Method::kQuincunx, Method::kTemporal};
constexpr int kPlacesShown = 3;
constexpr Extent kPart = {80, 60};
constexpr int kShownWidth = 320;  // of an enlarged part
constexpr int kFramesTimed = 8;
constexpr int kTruthSamples = 8;

struct Shown {
  std::string name;
  std::string cost;                // milliseconds
  std::vector<float> flip;         // a pixel; empty: truth
  std::vector<std::uint8_t> rgba;  // presented
};

// The least of a few draws: the first one may upload and compile.
Result<double> draw_ms(Renderer& renderer, Extent extent, const FrontFeed& feed) {
  std::vector<double> ms;
  for (int i = 0; i < 4; ++i) {
    const tools::Clock::time_point start = tools::Clock::now();
    const auto drawn =
        render_truth(renderer, {.output = extent, .samples = 1, .aspect = feed.crop.aspect}, feed.seconds);
    if (!drawn.ok()) return drawn.status();
    ms.push_back(tools::ms_since(start));
  }
  return *std::min_element(ms.begin(), ms.end());
}

class WhyPicture {
 public:
  WhyPicture(const RenderOptions& options, FrameSource& stage, PicturePresenter presenter, float scale)
      : options_(options), stage_(stage), presenter_(std::move(presenter)) {
    feed_.crop = PictureCrop::middle_of(options.output, options.output);
    feed_.scale = scale;
    feed_.fps = options.fps;
    feed_.warm_up = kWarmUpFrames;
    feed_.frames = kFramesTimed;
    feed_.seconds = options.start + feed_.warm_up / feed_.fps;
    render_ = stage.sequence().at(0).render;
  }

  Status draw() {
    for (const auto& [extent, ms] : {std::pair{render_, &draw_ms_}, std::pair{options_.output, &full_ms_}}) {
      const auto measured = draw_ms(stage_.renderer(), extent, feed_);
      if (!measured.ok()) return measured.status();
      *ms = measured.value();
    }
    using Show = tools::Progress::Show;
    tools::Progress progress("comparing", kMethods.size() + 1,
                             options_.quiet ? Show::kNever : Show::kOnTerminal);
    for (std::size_t i = 0; i < kMethods.size(); ++i) {
      progress.update(static_cast<std::int64_t>(i), std::string(name_of(kMethods[i])));
      if (Status status = resolve(kMethods[i]); !status.ok()) return status;
    }
    progress.update(kMethods.size(), "truth");
    if (Status status = draw_truth(); !status.ok()) return status;
    compare();
    return write();
  }

 private:
  Status resolve(Method method) {
    std::vector<float> rgba(static_cast<std::size_t>(options_.output.area()) * 4);
    std::vector<double> ms;
    MethodVariant variant = variant_of(options_.resolve);
    variant.method = method;
    const Status status = run_feed(stage_, feed_, {&variant, 1}, [&](const FrontFrame& frame) -> Status {
      if (frame.index < 0) return {};
      ms.push_back(pass_times(frame.report).method_ms);
      if (frame.index + 1 < feed_.frames) return {};
      return stage_.device().download(frame.resolved, options_.output, rgba.data());
    });
    if (!status.ok()) return status;
    const double least = *std::min_element(ms.begin(), ms.end());
    const std::string resolved = least > 0 ? fmt::format("{:.0f}", std::ceil(least)) : "?";
    return add(name_of(method), fmt::format("{:.0f} + {} ms", draw_ms_, resolved), std::move(rgba));
  }

  Status draw_truth() {
    const double seconds = feed_.seconds + (feed_.frames - 1) / feed_.fps;
    auto rgba =
        render_truth(stage_.renderer(), {.output = options_.output, .samples = kTruthSamples}, seconds);
    if (!rgba.ok()) return rgba.status();
    return add("truth", fmt::format("{} × {:.0f} ms", kTruthSamples * kTruthSamples, full_ms_),
               std::move(rgba).value());
  }

  Status add(std::string_view name, std::string cost, std::vector<float> rgba) {
    auto presented = presenter_.present(rgba);
    if (!presented.ok()) return presented.status();
    shown_.push_back({std::string(name), std::move(cost), {}, std::move(presented).value()});
    pictures_.push_back(tools::measured(options_.output, std::move(rgba), stage_.exposure()));
    return {};
  }

  void compare() {
    for (std::size_t i = 0; i < kMethods.size(); ++i) {
      shown_[i].flip =
          tools::flip_map(options_.output, pictures_[i].tone_mapped(), pictures_.back().tone_mapped());
    }
  }

  // How much farther from truth the worst method is than the best one.
  std::vector<float> spread() const {
    std::vector<float> values;
    for (std::size_t i = 0; i < shown_[0].flip.size(); ++i) {
      const auto [least, most] = std::minmax({shown_[0].flip[i], shown_[1].flip[i], shown_[2].flip[i]});
      values.push_back(most - least);
    }
    return values;
  }

  double mean_flip(const Shown& shown, Place place, Extent part) const {
    std::vector<float> values;
    for (int y = place.y; y < place.y + part.height; ++y) {
      const auto* row = &shown.flip[static_cast<std::size_t>(y) * options_.output.width + place.x];
      values.insert(values.end(), row, row + part.width);
    }
    return tools::flip_mean(values);
  }

  // Each pixel as a square.
  std::vector<std::uint8_t> enlarged(const Shown& shown, Place place, Extent part, int factor) const {
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < part.height * factor; ++y) {
      const auto row = static_cast<std::size_t>(place.y + y / factor) * options_.output.width + place.x;
      for (int x = 0; x < part.width * factor; ++x) {
        const auto* pixel = &shown.rgba[(row + x / factor) * 4];
        rgba.insert(rgba.end(), pixel, pixel + 4);
      }
    }
    return rgba;
  }

  Status add_row(tools::ContactSheet& sheet, Place place, Extent part) const {
    const int factor = kShownWidth / part.width;
    const Extent extent = {part.width * factor, part.height * factor};
    const double worst = mean_flip(shown_[0], place, part);
    for (const Shown& shown : shown_) {
      const bool judged = !shown.flip.empty();
      const double flip = judged ? mean_flip(shown, place, part) : 0;
      const tools::ContactSheetCaption caption = {
          shown.name, judged ? fmt::format("{} · FLIP {:.3f}", shown.cost, flip) : shown.cost,
          judged && worst > 0 ? static_cast<float>(flip / worst) : -1};
      const Status status = sheet.add(extent, enlarged(shown, place, part, factor).data(), caption);
      if (!status.ok()) return status;
    }
    return {};
  }

  Status write() const {
    std::string errors;
    for (const Shown& shown : shown_) {
      if (!shown.flip.empty()) errors += fmt::format(" {:.3f}", tools::flip_mean(shown.flip));
    }
    tools::ContactSheet sheet(
        {.title = fmt::format("{}×{} made from {}×{}", options_.output.width, options_.output.height,
                              render_.width, render_.height),
         .subtitle =
             fmt::format("{} · ms: drawn + resolved; at full size {:.0f} are drawn · FLIP of the whole "
                         "picture:{}",
                         stage_.scene().name, full_ms_, errors),
         .columns = static_cast<int>(shown_.size()),
         .thumbnail_width = kShownWidth});
    const Extent part = {std::min(options_.output.width, kPart.width),
                         std::min(options_.output.height, kPart.height)};
    for (const Place place : largest_parts(options_.output, spread(), part, kPlacesShown)) {
      if (Status status = add_row(sheet, place, part); !status.ok()) return status;
    }
    return sheet.write(options_.why);
  }

  const RenderOptions& options_;
  FrameSource& stage_;
  PicturePresenter presenter_;
  FrontFeed feed_;
  Extent render_;
  double draw_ms_ = 0;
  double full_ms_ = 0;  // of a frame that is drawn at the output's size
  std::vector<Shown> shown_;
  std::vector<tools::MeasuredPicture> pictures_;  // of these
};

}  // namespace

std::vector<Place> largest_parts(Extent picture, std::span<const float> values, Extent part, int count) {
  const int stride = picture.width + 1;
  std::vector<double> sums(static_cast<std::size_t>(stride) *
                           (picture.height + 1));  // above and left of a corner
  const auto sum = [&](int x, int y) -> double& { return sums[static_cast<std::size_t>(y) * stride + x]; };
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      sum(x + 1, y + 1) =
          values[static_cast<std::size_t>(y) * picture.width + x] + sum(x, y + 1) + sum(x + 1, y) - sum(x, y);
    }
  }
  std::vector<Place> places;
  const Extent apart = {std::max(part.width, picture.width / 4), std::max(part.height, picture.height / 4)};
  const auto is_near = [&](int x, int y) {
    return std::any_of(places.begin(), places.end(), [&](Place place) {
      return std::abs(place.x - x) < apart.width && std::abs(place.y - y) < apart.height;
    });
  };
  while (static_cast<int>(places.size()) < count) {
    std::optional<Place> best;
    double most = 0;
    for (int y = 0; y + part.height <= picture.height; ++y) {
      for (int x = 0; x + part.width <= picture.width; ++x) {
        if (is_near(x, y)) continue;
        const double here = sum(x + part.width, y + part.height) - sum(x, y + part.height) -
                            sum(x + part.width, y) + sum(x, y);
        if (best && here <= most) continue;
        best = Place{x, y};
        most = here;
      }
    }
    if (!best) break;
    places.push_back(*best);
  }
  return places;
}

Status draw_why(const RenderOptions& options) {
  if (Status status = tools::ScoredFrames::check(options.output, "--why"); !status.ok()) return status;
  const auto scale = tools::number_in(options.scale);
  if (!scale) return Status::invalid("--why takes one --scale for both axes, not '" + options.scale + "'");
  auto settings = source_settings_for(options);
  if (!settings.ok()) return settings.status();
  auto stage = FrameSource::create(settings.value());
  if (!stage.ok()) return stage.status();
  auto presenter =
      PicturePresenter::create(stage.value()->device(), options.output, options.resolve.output.tone_map,
                               options.resolve.output.dither, stage.value()->exposure());
  if (!presenter.ok()) return presenter.status();
  return WhyPicture(options, *stage.value(), std::move(presenter).value(), static_cast<float>(*scale)).draw();
}

}  // namespace quincunx::scenes

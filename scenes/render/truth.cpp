// SPDX-License-Identifier: MIT
#include "render/truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/renderer_impl.h"
#include "render/truth_targets.h"

namespace quincunx::scenes {
namespace {

// A stride near the golden section of `count` and prime to it: neighbouring places get times far apart, and
// every row, column and block of places covers the shutter evenly (a rank-1 lattice).
int time_stride(int count) {
  constexpr double kGolden = 0.6180339887498949;
  int stride = std::max(1, static_cast<int>(std::lround(kGolden * count)));
  while (std::gcd(stride, count) != 1)
    ++stride;
  return stride;
}

Status check(const TruthSettings& settings) {
  constexpr int kMostSamples = 256;
  if (settings.output.width < 1 || settings.output.height < 1) {
    return Status::invalid(fmt::format("TruthSettings::output is {} x {}; it must be at least 1 x 1",
                                       settings.output.width, settings.output.height));
  }
  if (settings.samples < 1 || settings.samples > kMostSamples) {
    return Status::invalid(fmt::format("TruthSettings::samples is {}; it must lie between 1 and {}",
                                       settings.samples, kMostSamples));
  }
  if (!std::isfinite(settings.shutter_seconds) || settings.shutter_seconds < 0) {
    return Status::invalid("TruthSettings::shutter_seconds must be finite and not negative");
  }
  return {};
}

}  // namespace

Result<std::vector<float>> render_truth(Renderer& renderer, const TruthSettings& settings, double seconds) {
  if (Status status = check(settings); !status.ok()) return status;
  std::unique_ptr<TruthTargets>& targets = renderer.impl_->truth;
  if (!targets || targets->extent() != settings.output) {
    Result<TruthTargets> made = TruthTargets::create(settings.output);
    if (!made.ok()) return made.status();
    targets = std::make_unique<TruthTargets>(std::move(made).value());
  }
  const int n = settings.samples;
  const int count = n * n;
  const int stride = time_stride(count);
  targets->clear();
  for (int k = 0; k < count; ++k) {
    const auto place = [n](int i) { return (static_cast<float>(i) + 0.5f) / static_cast<float>(n) - 0.5f; };
    const int moment = static_cast<int>(static_cast<long long>(k) * stride % count);
    FrameView view;
    view.render = settings.output;
    view.jitter = {place(k % n), place(k / n)};
    view.seconds = seconds - settings.shutter_seconds * (1 - (moment + 0.5) / count);
    view.previous_seconds = view.seconds;
    view.window = view.previous_window = settings.window;
    view.aspect = settings.aspect;
    view.lod_bias = -std::log2(static_cast<float>(n));
    if (Status status = renderer.draw(targets->frame(), view); !status.ok()) return status;
    targets->add(1.0f / static_cast<float>(count));
  }
  return targets->read();
}

}  // namespace quincunx::scenes

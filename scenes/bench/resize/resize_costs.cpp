// SPDX-License-Identifier: MIT
#include "bench/resize/resize_costs.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <utility>

#include "bench/resize/respecified_targets.h"
#include "bench/speed_error/frame_feed.h"

namespace quincunx::bench {
namespace {

constexpr int kWarmUp = 16;

// Sizes of half to all of the largest size's length, no two in a row the same.
std::vector<Extent> random_sizes(const ResizeSettings& settings) {
  std::mt19937_64 random(settings.seed + 1);
  std::vector<Extent> sizes;
  while (sizes.size() < static_cast<std::size_t>(settings.resizes + kWarmUp)) {
    const double scale = 0.5 + static_cast<double>(random() % 4096) / 8192;
    const Extent size = {std::max(1, static_cast<int>(std::lround(settings.largest.width * scale))),
                         std::max(1, static_cast<int>(std::lround(settings.largest.height * scale)))};
    if (sizes.empty() || sizes.back() != size || settings.largest.area() < 16) sizes.push_back(size);
  }
  return sizes;
}

// Of one resize: host time that the resize took; a clear follows.
struct Way {
  std::function<double(Extent)> resize_us;
  std::function<void(Extent)> clear;
  std::function<void()> finish = [] {};  // of the frame; not timed
};

double timed_us(const std::function<void()>& work) {
  const StepClock clock;
  work();
  return 1000 * clock.elapsed().ms;
}

ResizeCost measure(std::string name, std::string what, const std::vector<Extent>& sizes, const Way& way) {
  ResizeCost cost{.name = std::move(name), .what = std::move(what), .resize_us = {}, .first_ms = {}};
  Samples resize_us, first_ms;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    glFinish();
    const double us = way.resize_us(sizes[i]);
    const double ms = timed_us([&] {
                        way.clear(sizes[i]);
                        glFinish();
                      }) /
                      1000;
    way.finish();
    if (i < kWarmUp) continue;
    resize_us.push_back(us);
    first_ms.push_back(ms);
  }
  cost.resize_us = quantiles_of(resize_us);
  cost.first_ms = quantiles_of(first_ms);
  return cost;
}

// A bridge's own way: what begin_draw() says that the resize took.
class BridgeWay {
 public:
  BridgeWay(const scenes::FrameSource& stage, Extent largest, Targets targets) {
    auto bridge = gl::Bridge::create(stage.context(), stage.device(),
                                     {.interop = gl::Interop::kCopy,
                                      .target = largest,
                                      .output = {16, 16},
                                      .depth = true,
                                      .velocity = true,
                                      .reactive = true,
                                      .targets = targets});
    if (!bridge.ok()) throw std::runtime_error(bridge.status().message());
    bridge_ = std::move(bridge).value();
  }

  Way way() {
    return {.resize_us = [this](Extent size) { return resize(size); },
            .clear = [this](Extent size) { targets_->clear(size); },
            .finish = [this] { hand_over(); }};
  }

 private:
  double resize(Extent size) {
    auto targets = bridge_->begin_draw(slot_, size);
    check(targets.status());
    targets_ = targets.value();
    return bridge_->traffic().resize_us;
  }

  void hand_over() {
    check(bridge_->submit(slot_));
    check(bridge_->acquire(slot_).status());
    slot_ = (slot_ + 1) % bridge_->slots();
  }

  static void check(const Status& status) {
    if (!status.ok()) throw std::runtime_error(status.message());
  }

  std::unique_ptr<gl::Bridge> bridge_;
  const gl::RenderTargets* targets_ = nullptr;
  int slot_ = 0;
};

// New targets each time, after the old ones have gone.
class AnewWay {
 public:
  Way way() {
    return {.resize_us =
                [this](Extent size) {
                  return timed_us([&] { targets_.emplace(gl::TargetNeeds{.target = size}); });
                },
            .clear = [this](Extent size) { targets_->clear(size); }};
  }

 private:
  std::optional<gl::RenderTargets> targets_;
};

Way respecified(RespecifiedTargets& targets) {
  return {.resize_us = [&targets](Extent size) { return timed_us([&] { targets.resize(size); }); },
          .clear = [&targets](Extent) { targets.clear(); }};
}

// A few sizes in turn, as a controller goes to and fro between them.
std::vector<Extent> returning_sizes(const ResizeSettings& settings) {
  const Extent largest = settings.largest;
  const auto part = [&](int percent) {
    return Extent{std::max(1, largest.width * percent / 100), std::max(1, largest.height * percent / 100)};
  };
  std::vector<Extent> sizes;
  for (int i = 0; i < settings.resizes + kWarmUp; ++i)
    sizes.push_back(part(i % 2 == 0 ? 70 : 72));
  return sizes;
}

}  // namespace

Result<std::vector<ResizeCost>> measure_resizes(const scenes::FrameSource& stage,
                                                const ResizeSettings& settings) {
  const std::vector<Extent> sizes = random_sizes(settings);
  std::vector<ResizeCost> costs;
  try {
    BridgeWay viewport(stage, settings.largest, Targets::kViewport);
    costs.push_back(
        measure("viewport", "large targets: another part of them is used", sizes, viewport.way()));
    BridgeWay kept(stage, settings.largest, Targets::kPlaced);
    costs.push_back(measure("kept", "placed: two sizes in turn, both still there", returning_sizes(settings),
                            kept.way()));
    BridgeWay placed(stage, settings.largest, Targets::kPlaced);
    costs.push_back(measure("new", "placed: a new size", sizes, placed.way()));
    AnewWay anew;
    costs.push_back(measure("anew", "OpenGL only: new textures, none are kept", sizes, anew.way()));
    RespecifiedTargets same_names;
    costs.push_back(measure("respecified", "OpenGL only: the same textures are given another size", sizes,
                            respecified(same_names)));
  } catch (const std::exception& error) {
    return Status::device(error.what());
  }
  return costs;
}

}  // namespace quincunx::bench

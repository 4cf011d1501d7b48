// SPDX-License-Identifier: MIT
#include "scale_fixture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace quincunx::testing {
namespace {

constexpr double kLargestHalf = 65504;

bool larger(Extent render, Extent output) {
  return render.width > output.width || render.height > output.height;
}

}  // namespace

std::string name_of(const ScaleVariant& variant) {
  std::string method = quincunx::name_of(variant.method);
  std::replace(method.begin(), method.end(), '-', '_');
  return fmt::format("{}{}_{}_{}_to_{}", method, variant.clamp_ringing ? "" : "_unclamped",
                     variant.storage == Storage::kImage ? "image" : "buffer",
                     quincunx::name_of(variant.colour), quincunx::name_of(variant.resolved));
}

bool takes_one_sample(Method method) {
  return method == Method::kPoint || method == Method::kNoise || method == Method::kNoiseOffset;
}

bool rings(Method method) {
  return !takes_one_sample(method) && reference::filter_named(quincunx::name_of(method)).rings;
}

ScaleRig::ScaleRig(const ScaleVariant& variant)
    : variant_(variant), formats_{.storage = variant.storage, .colour = variant.colour} {
  settings_.targets.storage = variant.storage;
  settings_.colour = variant.colour;
  settings_.output.linear = variant.resolved;
  settings_.filter.clamp_ringing = variant.clamp_ringing;
  settings_.method = variant.method;
  settings_.output.present = false;
  settings_.filter.grain = 0.75f;
}

// Each chain serves one output, and viewports up to twice as wide and high or up to `render`.
PassChain& ScaleRig::chain_for(Extent output, Extent render) {
  const bool serves = chain_ && settings_.output_extent == output &&
                      render.width <= settings_.target_extent.width &&
                      render.height <= settings_.target_extent.height;
  if (!serves) {
    settings_.output_extent = output;
    settings_.target_extent = {std::max(2 * output.width, render.width),
                               std::max(2 * output.height, render.height)};
    chain_ = std::make_unique<PassChain>(device(), PlanFacts({}, settings_));
  }
  return *chain_;
}

ScaleRig::Run ScaleRig::run(Rig& rig, const TestFrame& frame, Extent output) {
  const ImageView view = rig.output(settings_.output.linear, output);
  const Counter counter = rig.counter();
  PassChain& chain = chain_for(output, frame.inputs.render_extent);
  FrameReport report;
  chain.run(chain.frame(frame.inputs, nullptr, {.linear = view}, counter), {.linear = view}, report, nullptr);
  Run result{rig.bytes(view, output), {}, 0};
  result.pixels = decode(settings_.output.linear, result.bytes);
  result.non_finite = rig.count(counter);
  const std::vector<Pixel> all = rig.pixels(view, view.extent);
  for (int y = 0; y < view.extent.height; ++y) {
    for (int x = 0; x < view.extent.width; ++x) {
      if (x < output.width && y < output.height) continue;
      EXPECT_EQ(all[static_cast<std::size_t>(y * view.extent.width + x)][0], -7) << x << ", " << y;
    }
  }
  return result;
}

reference::Sampler ScaleRig::sampler(const TestFrame& frame, Extent output) const {
  const reference::Frame& source = frame.reference;
  const auto seed = static_cast<std::uint32_t>(frame.inputs.frame_index);
  const Extent render = frame.inputs.render_extent;
  const double scale = std::sqrt(static_cast<double>(render.area()) / static_cast<double>(output.area()));
  const double amplitude = static_cast<double>(settings_.filter.grain) * std::max(0.0, 1 - scale);
  switch (variant_.method) {
    case Method::kPoint:
      return reference::scale_point(source, output.width, output.height);
    case Method::kNoise:
      return reference::scale_noise(source, amplitude, seed, output.width, output.height);
    case Method::kNoiseOffset:
      return reference::scale_noise_offset(source, seed, output.width, output.height);
    case Method::kBilinear:
      if (!larger(render, output)) return reference::scale_bilinear(source, output.width, output.height);
      [[fallthrough]];
    default:
      return reference::scale_filter(source, reference::filter_named(quincunx::name_of(variant_.method)),
                                     settings_.filter.clamp_ringing && rings(variant_.method), output.width,
                                     output.height);
  }
}

double ScaleRig::relative_error(Extent render, Extent output) const {
  if (variant_.method == Method::kNoise) return kGrainError;
  if (takes_one_sample(variant_.method)) return 0;
  if (variant_.method == Method::kBilinear && !larger(render, output)) return kBilinearError;
  const Filter& filter = filter_of(variant_.method);
  return filter_error(variant_.method, filter_taps(filter, render.width, output.width),
                      filter_taps(filter, render.height, output.height));
}

void ScaleRig::compare(const FrameSpec& spec, Extent output, const std::vector<Pixel>& colour) {
  Rig rig;
  TestFrame source = frame(rig, spec, colour);
  source.inputs.frame_index = spec.seed;
  const Run actual = run(rig, source, output);
  reference::Picture expected = reference::scale(output.width, output.height, sampler(source, output));
  if (settings_.output.linear == PixelFormat::kRGBA16F) {
    for (Pixel& pixel : expected.pixels) {
      for (double& value : pixel)
        value = std::clamp(value, -kLargestHalf, kLargestHalf);
    }
  }
  const double error = relative_error(spec.render, output);
  const auto bound = [&](std::size_t i) {
    double magnitude = expected.largest[i];
    for (const double value : expected.pixels[i])
      magnitude = std::max(magnitude, std::abs(value));
    return error * expected.largest[i] + kDenormal * (1 + error / kRounding) +
           output_rounding(settings_.output.linear, magnitude);
  };
  const std::string what =
      fmt::format("{}x{} -> {}x{}, jitter {}, {}, {}", spec.render.width, spec.render.height, output.width,
                  output.height, spec.jitter.x, spec.jitter.y, name_of(spec.colour));
  expect_close(expected, actual.pixels, bound, what, settings_.output.linear);
  EXPECT_EQ(actual.non_finite, expected.non_finite) << what;
}

}  // namespace quincunx::testing

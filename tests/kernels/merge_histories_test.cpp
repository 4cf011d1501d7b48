// SPDX-License-Identifier: MIT
// merge_histories against its reference. The bound follows from running error analysis beside the reference.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "../reference/temporal.h"
#include "expected.h"
#include "pass_rig.h"
#include "temporal_fixture.h"

namespace quincunx {
namespace {

using reference::HistoryTexel;
using testing::PassRig;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;

struct Formats {
  PixelFormat picture, history;
  bool alpha;
};

class MergeHistories : public ::testing::TestWithParam<Formats> {
 protected:
  using Texels = std::vector<HistoryTexel<double>>;

  static PlanFacts facts() {
    PlanFacts facts({.background = !GetParam().alpha}, {.method = Method::kTemporal,
                                                        .output = {.linear = GetParam().picture},
                                                        .temporal = {.history = GetParam().history}});
    facts.two_way = true;
    return facts;
  }

  // Colours of a pattern, every kind of confidence side by side, other alphas than the colours have; as `format` holds
  // them.
  static Texels texels(Pattern pattern, Extent extent, unsigned seed, PixelFormat format) {
    constexpr std::array kConfidences = {0.0, .15, -.4, .7, 1.5, -0.0, 8.0, -32.0, 32.0, .3, -2.0};
    Texels made;
    for (const Pixel& pixel : testing::pattern_pixels(pattern, extent, seed)) {
      const std::size_t kind = (made.size() * 7 + seed) % kConfidences.size();
      HistoryTexel<double>& texel = made.emplace_back();
      for (std::size_t c = 0; c < 3; ++c)
        texel.texel[c] = testing::stored_value(format, pixel[c]);
      texel.texel[3] = testing::stored_value(GetParam().history, kConfidences.at(kind));
      texel.alpha = GetParam().alpha ? testing::stored_value(format, .1 * static_cast<double>(kind)) : 1;
    }
    return made;
  }

  // The near layer of each texel: coverages beyond 0 and 1, too, and every confidence beside every coverage.
  static reference::NearLayer near_of(std::size_t texel) {
    constexpr std::array kCoverages = {.3, 0.0, 1.0, .75, -.25, 1.5, .05};
    constexpr std::array kConfidences = {.8, 0.0, 6.0, 32.0, .1};
    return {testing::stored_value(GetParam().history, kCoverages.at(texel % kCoverages.size())),
            testing::stored_value(PixelFormat::kRGBA16F, kConfidences.at(texel % kConfidences.size()))};
  }

  // `other` empty: there is none.
  Texels merge(const Texels& own, const Texels& other, Extent extent) {
    const PixelFormat format = GetParam().history;
    std::vector<Pixel> picture, confidences, near, states, others;
    std::vector<double> alphas;
    for (const HistoryTexel<double>& texel : own) {
      picture.push_back({texel.texel[0], texel.texel[1], texel.texel[2], texel.alpha});
      const bool layered = std::signbit(texel.texel[3]);
      const reference::NearLayer layer = near_of(confidences.size());
      near.push_back({NAN, NAN, NAN, layered ? layer.coverage : NAN});
      states.push_back({NAN, NAN, layered ? layer.confidence : NAN, NAN});
      confidences.push_back({NAN, NAN, NAN, texel.texel[3]});
    }
    for (const HistoryTexel<double>& texel : other) {
      others.push_back({texel.texel[0], texel.texel[1], texel.texel[2], texel.texel[3]});
      alphas.push_back(texel.alpha);
    }
    if (other.empty()) {
      others.resize(own.size(), {NAN, NAN, NAN, NAN});
      alphas.resize(own.size(), NAN);
    }
    const auto buffer = [](const std::vector<unsigned char>& bytes) { return testing::to_device(bytes); };
    const cl::Buffer known = buffer(testing::encode(format, confidences));
    const cl::Buffer near_layer = buffer(testing::encode(format, near));
    const cl::Buffer near_states = buffer(testing::encode(PixelFormat::kRGBA16F, states));
    const cl::Buffer second = buffer(testing::encode(format, others));
    const cl::Buffer second_alpha = buffer(testing::encode_plane(format, alphas));
    const std::size_t bytes = own.size() * bytes_per_pixel(format);
    const cl::Buffer merged = buffer(std::vector<unsigned char>(bytes, 0x7f));
    const cl::Buffer merged_alpha = buffer(std::vector<unsigned char>(bytes, 0x7f));
    Rig rig;
    PassRig pass(facts(), "merge_histories");
    pass.set_other_exposure(other.empty() ? 0 : 1);
    pass.run(
        {}, {}, extent, {},
        {{Resource::kCentred, rig.image(GetParam().picture, Storage::kBuffer, extent, picture, 1e30, false)},
         {Resource::kHistory, {.memory = known()}},
         {Resource::kNearHistory, {.memory = near_layer()}},
         {Resource::kLayerStates, {.memory = near_states()}},
         {Resource::kOtherHistory, {.memory = second()}},
         {Resource::kOtherAlpha, {.memory = second_alpha()}},
         {Resource::kMergedHistory, {.memory = merged()}},
         {Resource::kMergedAlpha, {.memory = merged_alpha()}}});
    const std::vector<Pixel> made =
        testing::decode(format, testing::from_device<unsigned char>(merged, bytes));
    std::vector<double> made_alpha(own.size(), 1);
    if (GetParam().alpha) {
      made_alpha =
          testing::decode_plane(format, testing::from_device<unsigned char>(merged_alpha, bytes), own.size());
    }
    Texels result;
    for (std::size_t i = 0; i < made.size(); ++i)
      result.push_back({made[i], made_alpha[i]});
    return result;
  }
};

TEST_P(MergeHistories, MatchesTheReferenceOnEveryPatternAndSize) {
  for (const Extent extent : {Extent{1, 1}, {7, 5}, {9, 17}, {67, 41}}) {
    for (const Pattern pattern : testing::all_patterns()) {
      if (pattern == Pattern::kNonFinite) continue;  // histories are finite
      const Texels own = texels(pattern, extent, 5, GetParam().picture);
      const Texels other = texels(Pattern::kNoise, extent, 8, GetParam().history);
      const Texels made = merge(own, other, extent);
      const auto expected =
          testing::expected_pixels(extent.width, extent.height, [&]<typename Real>(Real, int x, int y) {
            const auto at = static_cast<std::size_t>(y * extent.width + x);
            const auto merged = reference::merge_histories<Real>(own[at], near_of(at), other[at]);
            return std::array<Real, 5>{merged.texel[0], merged.texel[1], merged.texel[2], merged.texel[3],
                                       merged.alpha};
          });
      for (std::size_t i = 0; i < made.size(); ++i) {
        const auto& [texel, alpha] = made[i];
        const std::array actual = {texel[0], texel[1], texel[2], texel[3], alpha};
        ASSERT_FALSE(expected[i].undecided);
        for (std::size_t c = 0; c < actual.size(); ++c) {
          testing::expect_near(expected[i].value[c], expected[i].bound[c], actual[c],
                               fmt::format("{}: value {} of pixel {}", testing::name_of(pattern), c, i),
                               GetParam().history);
          if (HasFatalFailure()) return;
        }
        ASSERT_EQ(std::signbit(texel[3]), std::signbit(expected[i].value[3])) << i;
      }
    }
  }
}

TEST_P(MergeHistories, WithItselfOneLayerIsTwiceAsSure_small) {
  const Extent extent{33, 9};
  const Texels own = texels(Pattern::kNoise, extent, 3, GetParam().history);
  const Texels made = merge(own, own, extent);
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (!std::signbit(own[i].texel[3])) {
      ASSERT_EQ(made[i].texel[3], 2 * own[i].texel[3]) << i;
    }
  }
}

TEST_P(MergeHistories, WithoutAnotherHistoryItStaysWhatItIs) {
  const Extent extent{33, 9};
  const Texels own = texels(Pattern::kNoise, extent, 3, GetParam().picture);
  const Texels made = merge(own, {}, extent);
  for (std::size_t i = 0; i < made.size(); ++i) {
    const double confidence = own[i].texel[3], near = -near_of(i).confidence;
    ASSERT_EQ(std::signbit(made[i].texel[3]), std::signbit(confidence)) << i;
    if (!std::signbit(confidence)) {
      ASSERT_EQ(made[i].texel[3], confidence) << i;
    } else {  // within rounding to halves
      ASSERT_GE(made[i].texel[3], 1.001 * std::min(confidence, near) - 1e-4) << i;
      ASSERT_LE(made[i].texel[3], .999 * std::max(confidence, near) + 1e-4) << i;
    }
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_EQ(made[i].texel[c], testing::stored_value(GetParam().history, own[i].texel[c])) << i;
    ASSERT_EQ(made[i].alpha, testing::stored_value(GetParam().history, own[i].alpha)) << i;
  }
}

std::vector<Formats> all_formats() {
  std::vector<Formats> all;
  for (const PixelFormat picture : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F}) {
    for (const PixelFormat history : {PixelFormat::kRGBA32F, PixelFormat::kRGBA16F}) {
      for (const bool alpha : {false, true})
        all.push_back({picture, history, alpha});
    }
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Variants, MergeHistories, ::testing::ValuesIn(all_formats()),
                         testing::sample_names(all_formats(), [](const Formats& f) {
                           return fmt::format("{}_of_{}{}", name_of(f.picture), name_of(f.history),
                                              f.alpha ? "_alpha" : "");
                         }));

}  // namespace
}  // namespace quincunx

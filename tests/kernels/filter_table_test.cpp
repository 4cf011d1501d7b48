// SPDX-License-Identifier: MIT
#include "passes/tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "resolve_params.h"
#include "scale_fixture.h"

namespace quincunx {
namespace {

// The error bounds of the scale tests count on this for every filter, at every scale and jitter.
TEST(FilterTable, WeightsSumToOne) {
  for (const MethodInfo& method : methods()) {
    if (method.filter.weight == nullptr) continue;
    double largest = 0;
    for (const int render : {1, 2, 5, 64, 100, 183, 257, 513}) {
      for (const double jitter : {-.5, -.25, 0., .1, .5}) {
        constexpr int kOutput = 257;
        const int taps = filter_taps(method.filter, render, kOutput);
        std::vector<FilterSpan> spans(kOutput);
        std::vector<float> weights(static_cast<std::size_t>(kOutput * taps));
        fill_filter(method.filter, render, kOutput, jitter, spans.data(), weights.data());
        for (int x = 0; x < kOutput; ++x) {
          double sum = 0;
          double magnitudes = 0;
          for (int k = 0; k < taps; ++k) {
            const double weight = static_cast<double>(weights[static_cast<std::size_t>(x * taps + k)]);
            sum += weight;
            magnitudes += std::abs(weight);
          }
          // Each weight is rounded once, by 2^-25 of itself at most or to 0 from below 2^-25.
          ASSERT_NEAR(sum, 1, (magnitudes + taps) * 0x1p-25)
              << method.name << " " << render << " pixel " << x;
          largest = std::max(largest, magnitudes);
        }
      }
    }
    EXPECT_LE(largest, testing::largest_weight_sum(method.method)) << method.name;
    EXPECT_EQ(largest > 1 + 1e-3, method.filter.rings) << method.name;
  }
}

}  // namespace
}  // namespace quincunx

// SPDX-License-Identifier: MIT
#include "method_costs.h"

#include <algorithm>
#include <cmath>

namespace quincunx {
namespace {

constexpr int kMostTimes = 10;           // that a factor is the mean of; a later one counts for a tenth
constexpr double kLargestStep = 0.4055;  // log 1.5: of a later time; one slow frame says little

}  // namespace

MethodCosts::MethodCosts(const ErrorFront& front, const std::vector<FrontMethod>& methods,
                         double output_megapixels)
    : front_(&front), methods_(methods), output_megapixels_(output_megapixels), factors_(methods.size()) {}

double MethodCosts::front_ms(std::size_t method, double scale) const {
  return front_->resolve_ms(methods_[method], scale, output_megapixels_).value_or(0);
}

double MethodCosts::ms(std::size_t method, double scale) const {
  const Factor& own = factors_[method];
  if (own.times > 0) return front_ms(method, scale) * std::exp(own.log);
  double sum = 0;
  int times = 0;
  for (const Factor& factor : factors_) {
    sum += factor.times * factor.log;
    times += factor.times;
  }
  return front_ms(method, scale) * std::exp(times > 0 ? sum / times : 0);
}

void MethodCosts::learn(std::size_t method, double scale, double ms) {
  Factor& factor = factors_[method];
  double step = std::log(ms / front_ms(method, scale)) - factor.log;
  if (factor.times > 0) step = std::clamp(step, -kLargestStep, kLargestStep);
  factor.times = std::min(factor.times + 1, kMostTimes);
  factor.log += step / factor.times;
}

}  // namespace quincunx

// SPDX-License-Identifier: MIT
// MethodCosts: what the passes of each method take on this machine, by scale.
//
// The front's times are the first guess. Each is multiplied by what the machine has shown: a method that was timed by
// its own factor, another one by the mean factor of those. Scale costs alike on every machine, so a factor learnt at
// one scale holds at all.
#pragma once

#include <cstddef>
#include <vector>

#include "quincunx/error_front.h"

namespace quincunx {

class MethodCosts {
 public:
  // Every method has points in `front`.
  MethodCosts(const ErrorFront& front, const std::vector<FrontMethod>& methods, double output_megapixels);

  double ms(std::size_t method, double scale) const;

  // The passes of this method took `ms`, above 0.
  void learn(std::size_t method, double scale, double ms);

 private:
  struct Factor {
    double log = 0;  // of measured over the front's
    int times = 0;   // it was learnt from, as far as that matters
  };
  double front_ms(std::size_t method, double scale) const;

  const ErrorFront* front_;
  std::vector<FrontMethod> methods_;
  double output_megapixels_;
  std::vector<Factor> factors_;
};

}  // namespace quincunx

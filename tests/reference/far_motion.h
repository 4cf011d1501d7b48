// SPDX-License-Identifier: MIT
// far_surroundings, far_fit, far_match and what far_velocity makes of them: the specification. error_bound.h tells what
// `Real` may be.
#pragma once

#include <array>
#include <vector>

#include "error_bound.h"
#include "picture.h"

namespace quincunx::reference {

constexpr int kFarTerms = 9;  // parameters of a camera's motion
constexpr int kFarCell = 32;  // samples on either axis

template <typename Real>
using FarModel = std::array<Real, kFarTerms>;

// The normal equations of a fit by least squares, in the order of the parameters.
template <typename Real>
struct FarSums {
  std::array<std::array<Real, kFarTerms>, kFarTerms> products = {};  // the lower triangle
  std::array<Real, kFarTerms> velocities = {};
};

struct FarInputs {
  Frame frame;     // colour, drawn velocity, depth
  Frame previous;  // colour, depth
  int output_width = 0;
  int output_height = 0;
  FarModel<double> model = {};  // fitted to the frame before, or to this one
  bool is_known = false;
};

// Returns the sums of cell (x, y).
template <typename Real>
FarSums<Real> far_surroundings(const FarInputs& in, int cell_x, int cell_y);

template <typename Real>
FarModel<Real> far_fit(const FarSums<double>& total);

// How wrong standing still and the model are about the samples of cell (x, y).
template <typename Real>
std::array<Real, 2> far_match(const FarInputs& in, int cell_x, int cell_y);

// Whether a sample is infinitely far away and was drawn without motion, and how the model moves it, in the units of the
// drawn velocity.
bool is_far_and_still(const Frame& frame, int x, int y);
template <typename Real>
std::array<Real, 2> modelled_far_velocity(const FarInputs& in, int x, int y);

}  // namespace quincunx::reference

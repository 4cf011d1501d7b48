// SPDX-License-Identifier: MIT
// A number and how far single precision may be from it: running error analysis (Wilkinson, "Rounding Errors
// in Algebraic Processes", 1963; Higham, "Accuracy and Stability of Numerical Algorithms", 2002,
// section 3.3). Every operation passes on the errors of what it is made from and adds its own rounding; one
// that a device fuses or makes in higher precision errs less. A decision that rounding may turn is told by
// `decide`.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace quincunx::reference {

constexpr double kUnit = 0x1p-24;        // the largest relative rounding error
constexpr double kFlushed = 0x1p-126;    // what may be lost where denormals are
constexpr double kDivision = 5 * kUnit;  // OpenCL allows 2.5 last places
constexpr double kRoot = 6 * kUnit;      // and 3

struct Bounded {
  double value = 0;
  double error = 0;

  Bounded() = default;
  Bounded(double exact) : value(exact) {}  // NOLINT: numbers mix with it
  Bounded(double about, double off) : value(about), error(off) {}
};

// A constant, or what the host computed in double precision, as single precision holds it.
inline Bounded rounded(double value) {
  return {value, std::abs(value) * kUnit};
}

inline Bounded operator+(const Bounded& a, const Bounded& b) {
  const double sum = a.value + b.value;
  const double error = a.error + b.error;
  return {sum, error + (std::abs(sum) + error) * kUnit};
}

inline Bounded operator-(const Bounded& a) {
  return {-a.value, a.error};
}

inline Bounded operator-(const Bounded& a, const Bounded& b) {
  return a + -b;
}

inline Bounded operator*(const Bounded& a, const Bounded& b) {
  const double product = a.value * b.value;
  const double error = std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error;
  // By 0 or 1 nothing is rounded, which keeps what is copied exact.
  if (error == 0 && (product == 0 || std::abs(a.value) == 1 || std::abs(b.value) == 1)) return product;
  return {product, error + (std::abs(product) + error) * kUnit + kFlushed};
}

inline Bounded operator/(const Bounded& a, const Bounded& b) {
  const double quotient = a.value / b.value;
  const double least = std::max(std::abs(b.value) - b.error, kFlushed);
  const double error = (a.error + std::abs(quotient) * b.error) / least;
  return {quotient, error + (std::abs(quotient) + error) * kDivision + kFlushed};
}

inline Bounded abs(const Bounded& a) {
  return {std::abs(a.value), a.error};
}

// The larger one where it is certain which that is.
inline Bounded max(const Bounded& a, const Bounded& b) {
  if (a.value - a.error >= b.value + b.error) return a;
  if (b.value - b.error >= a.value + a.error) return b;
  return {std::max(a.value, b.value), std::max(a.error, b.error)};
}

inline Bounded min(const Bounded& a, const Bounded& b) {
  return -max(-a, -b);
}

inline Bounded clamp(const Bounded& a, const Bounded& low, const Bounded& high) {
  return min(max(a, low), high);
}

inline Bounded sqrt(const Bounded& a) {
  const double root = std::sqrt(a.value);
  // Its slope may be anything near 0.
  const double error =
      std::max(std::sqrt(a.value + a.error) - root, root - std::sqrt(std::max(a.value - a.error, 0.0)));
  return {root, error + (root + error) * kRoot + std::sqrt(kFlushed)};
}

// f(value), and whether f is the same as far as the error reaches.
template <typename Function>
auto decide(const Bounded& a, Function f, bool& undecided) {
  const auto decision = f(a.value);
  if (f(a.value - a.error) != decision || f(a.value + a.error) != decision) undecided = true;
  return decision;
}

inline bool less(const Bounded& a, const Bounded& b, bool& undecided) {
  return decide(
      a - b, [](double difference) { return difference < 0; }, undecided);
}

inline int floor_of(const Bounded& a, bool& undecided) {
  return decide(
      a, [](double value) { return static_cast<int>(std::floor(value)); }, undecided);
}

}  // namespace quincunx::reference

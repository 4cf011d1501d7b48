// SPDX-License-Identifier: MIT
// How far single precision may be from a reference: worked out beside the references, not in them.
//
// A reference is a function template over its number type and reads as plain C++. With `double` it is the
// specification, whose values the tests expect. With `Bounded` the same lines carry a running error bound as
// well (Wilkinson, "Rounding Errors in Algebraic Processes", 1963; Higham, "Accuracy and Stability of
// Numerical Algorithms", 2002, section 3.3): every operation passes on the errors of its operands and adds
// its own rounding. An operation that a device fuses, or makes in higher precision, errs less.
//
// - A double that meets a Bounded counts as a float constant: exact if a float can hold it, else rounded.
// - A comparison, or a rounding to an integer, that an error may turn is noted by the innermost
//   UndecidedScope. The bound then only holds for the branch that was taken, and tests compare nothing.
// - seamless(condition) marks a branch at whose border both sides give the same value: there a turned
//   decision does no harm, so nothing is noted and the guarded, more general side is taken.
#pragma once

#include <algorithm>
#include <cmath>

namespace quincunx::reference {

constexpr double kUnit = 0x1p-24;        // the largest relative error of a rounding to a float
constexpr double kFlushed = 0x1p-126;    // the largest magnitude that is lost where denormals are flushed
constexpr double kDivision = 5 * kUnit;  // OpenCL C 1.2, section 7.4: a division may be off by 2.5 ulp
constexpr double kRoot = 6 * kUnit;      // and a square root by 3 ulp

// ---- Doubles: what a reference calls by the same name for either number type.

inline double abs(double a) {
  return std::abs(a);
}
inline double sqrt(double a) {
  return std::sqrt(a);
}
inline double min(double a, double b) {
  return std::min(a, b);
}
inline double max(double a, double b) {
  return std::max(a, b);
}
inline double clamp(double a, double low, double high) {
  return std::clamp(a, low, high);
}
inline bool seamless(bool condition) {
  return condition;
}

// An integer `function` of a number, clamped to [low, high].
template <typename Function>
int decide(double a, int low, int high, Function function) {
  return static_cast<int>(std::clamp(function(a), static_cast<double>(low), static_cast<double>(high)));
}

// ---- Numbers with an error bound.

class UndecidedScope {
 public:
  UndecidedScope() : outer_(innermost_) { innermost_ = this; }
  ~UndecidedScope() { innermost_ = outer_; }
  UndecidedScope(const UndecidedScope&) = delete;
  UndecidedScope& operator=(const UndecidedScope&) = delete;

  bool undecided() const { return undecided_; }
  static void note() {
    if (innermost_ != nullptr) innermost_->undecided_ = true;
  }

 private:
  inline static thread_local UndecidedScope* innermost_ = nullptr;
  UndecidedScope* outer_;
  bool undecided_ = false;
};

// The outcome of a comparison. Used as a bool it notes that an error may turn it.
class Decision {
 public:
  Decision(bool outcome, bool certain) : outcome_(outcome), certain_(certain) {}
  operator bool() const {  // NOLINT: it stands where the double's bool stands
    if (!certain_) UndecidedScope::note();
    return outcome_;
  }
  friend bool seamless(const Decision& decision) { return decision.outcome_ || !decision.certain_; }

 private:
  bool outcome_;
  bool certain_;
};

struct Bounded {
  double value = 0;
  double error = 0;  // 0 of what is not finite

  Bounded() = default;
  Bounded(double constant)  // NOLINT: constants stand as in the double's formula
      : value(constant), error(is_float(constant) ? 0 : std::abs(constant) * kUnit) {}
  Bounded(double about, double off) : value(about), error(std::isfinite(about) ? off : 0) {}

  static bool is_float(double a) {
    return !std::isfinite(a) || static_cast<double>(static_cast<float>(a)) == a;
  }
  bool is_zero() const { return value == 0 && error == 0; }
  // 2^n, by which a product or a quotient is not rounded.
  bool is_power_of_two() const {
    int exponent = 0;
    return error == 0 && std::abs(std::frexp(value, &exponent)) == .5;
  }
};

inline Bounded operator+(const Bounded& a, const Bounded& b) {
  if (a.is_zero()) return b;
  if (b.is_zero()) return a;
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
  if (error == 0 && product == 0) return {product, 0};
  if (a.is_power_of_two() || b.is_power_of_two())
    return {product, error + (std::abs(product) - error < kFlushed ? kFlushed : 0)};
  return {product, error + (std::abs(product) + error) * kUnit + kFlushed};
}

inline Bounded operator/(const Bounded& a, const Bounded& b) {
  const double quotient = a.value / b.value;
  if (a.error == 0 && quotient == 0) return {quotient, 0};
  const double least = std::max(std::abs(b.value) - b.error, kFlushed);
  const double error = (a.error + std::abs(quotient) * b.error) / least;
  if (b.is_power_of_two()) return {quotient, error + kFlushed};
  return {quotient, error + (std::abs(quotient) + error) * kDivision + kFlushed};
}

inline Bounded& operator+=(Bounded& a, const Bounded& b) {
  return a = a + b;
}
inline Bounded& operator*=(Bounded& a, const Bounded& b) {
  return a = a * b;
}
inline Bounded& operator/=(Bounded& a, const Bounded& b) {
  return a = a / b;
}

// Nothing is rounded when two numbers are compared.
inline bool is_certain(const Bounded& a, const Bounded& b) {
  const double error = a.error + b.error;
  return error == 0 || std::isnan(a.value) || std::isnan(b.value) || std::abs(a.value - b.value) > error;
}
inline Decision operator<(const Bounded& a, const Bounded& b) {
  return {a.value < b.value, is_certain(a, b)};
}
inline Decision operator>(const Bounded& a, const Bounded& b) {
  return {a.value > b.value, is_certain(a, b)};
}
inline Decision operator<=(const Bounded& a, const Bounded& b) {
  return {a.value <= b.value, is_certain(a, b)};
}
inline Decision operator>=(const Bounded& a, const Bounded& b) {
  return {a.value >= b.value, is_certain(a, b)};
}
inline Decision operator==(const Bounded& a, const Bounded& b) {
  return {a.value == b.value, is_certain(a, b)};
}
inline Decision operator!=(const Bounded& a, const Bounded& b) {
  return {a.value != b.value, is_certain(a, b)};
}

inline Bounded abs(const Bounded& a) {
  return {std::abs(a.value), a.error};
}

// The larger one where it is certain which that is; elsewhere the larger error.
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

template <typename Function>
int decide(const Bounded& a, int low, int high, Function function) {
  const int decision = decide(a.value, low, high, function);
  const bool certain = decide(a.value - a.error, low, high, function) == decision &&
                       decide(a.value + a.error, low, high, function) == decision;
  if (!certain) UndecidedScope::note();
  return decision;
}

// ---- Integers within [low, high]: what a clamp makes of the number in any case is no open decision.

template <typename Real>
int floor_within(const Real& a, int low, int high) {
  return decide(a, low, high, [](double value) { return std::floor(value); });
}
template <typename Real>
int ceil_within(const Real& a, int low, int high) {
  return decide(a, low, high, [](double value) { return std::ceil(value); });
}
template <typename Real>
int truncate_within(const Real& a, int low, int high) {
  return decide(a, low, high, [](double value) { return std::trunc(value); });
}
// To the nearest, half-way cases downwards.
template <typename Real>
int round_down_within(const Real& a, int low, int high) {
  return decide(a, low, high, [](double value) { return std::ceil(value - .5); });
}

// A number as an integer and what is left, in [0, 1): exact in single precision.
template <typename Real>
struct Split {
  int whole = 0;
  Real fraction = 0;
};
inline Split<double> split(double a) {
  return {static_cast<int>(std::floor(a)), a - std::floor(a)};
}
inline Split<Bounded> split(const Bounded& a) {
  const int whole = floor_within(a, -(1 << 30), 1 << 30);
  return {whole, {a.value - whole, a.error}};
}

// ---- What tests ask for: a reference's value, the same with its bound, and whether a rounding may turn it.

template <typename Value, typename Bound>
struct Expected {
  Value value;
  Bound bound;
  bool undecided = false;
};

// `reference` is called with a zero of either number type: reference(double{}) and reference(Bounded{}).
template <typename Reference>
auto expected_of(Reference reference) {
  const UndecidedScope scope;
  auto bound = reference(Bounded{});
  return Expected<decltype(reference(double{})), decltype(bound)>{reference(double{}), bound,
                                                                  scope.undecided()};
}

}  // namespace quincunx::reference

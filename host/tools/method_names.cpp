// SPDX-License-Identifier: MIT
#include "tools/method_names.h"

namespace quincunx::tools {

namespace {

constexpr const char* kVelocitySummary = "both frames, the previous one less where anything moves";

}  // namespace

const std::map<std::string, MethodChoice>& method_choices() {
  using Form = TwoFrameForm;
  static const Form usual = QuincunxSettings{}.form;
  static const std::map<std::string, MethodChoice> choices = {
      {"point", {Method::kPoint, usual, "the nearest sample"}},
      {"bilinear", {Method::kBilinear, usual, "four samples"}},
      {"b-spline", {Method::kBSpline, usual, "16 samples, cubic: smooth, never rings"}},
      {"catmull-rom", {Method::kCatmullRom, usual, "16 samples, cubic: sharp"}},
      {"lanczos2", {Method::kLanczos2, usual, "16 samples, windowed sinc"}},
      {"noise", {Method::kNoise, usual, "the nearest sample with film grain"}},
      {"noise-offset", {Method::kNoiseOffset, usual, "one of bilinear's samples, by chance"}},
      {"quincunx", {Method::kQuincunx, usual, kVelocitySummary}},
      {"quincunx:mean",
       {Method::kQuincunx, Form::kMean, "the plain mean of this frame and the previous one"}},
      {"quincunx:velocity", {Method::kQuincunx, Form::kVelocity, kVelocitySummary}},
  };
  return choices;
}

void choose(ResolveSettings& settings, const MethodChoice& choice) {
  settings.method = choice.method;
  settings.quincunx.form = choice.form;
}

std::string method_name(const ResolveSettings& settings) {
  std::string name = quincunx::name_of(settings.method);
  for (const auto& [longer, choice] : method_choices()) {
    ResolveSettings named = settings;
    choose(named, choice);
    const bool same = named.method == settings.method && named.quincunx.form == settings.quincunx.form;
    if (same && longer.size() > name.size()) name = longer;
  }
  return name;
}

}  // namespace quincunx::tools

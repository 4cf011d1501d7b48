// SPDX-License-Identifier: MIT
#include "tools/program/method_names.h"

namespace quincunx::tools {

namespace {

constexpr const char* kVelocitySummary = "both frames, the previous one less where anything moves";

constexpr const char* kBalancedSummary = "all frames so far, where their surfaces are now";

}  // namespace

const std::map<std::string, MethodChoice>& method_choices() {
  using Form = TwoFrameForm;
  static const auto single = [](Method method, const char* summary) {
    return MethodChoice{.method = method, .summary = summary};
  };
  static const auto both = [](Form form, const char* summary) {
    return MethodChoice{.method = Method::kQuincunx, .form = form, .summary = summary};
  };
  static const auto all = [](TemporalPreset preset, const char* summary) {
    return MethodChoice{.method = Method::kTemporal, .preset = preset, .summary = summary};
  };
  static const std::map<std::string, MethodChoice> choices = {
      {"point", single(Method::kPoint, "the nearest sample")},
      {"bilinear", single(Method::kBilinear, "four samples")},
      {"b-spline", single(Method::kBSpline, "16 samples, cubic: smooth, never rings")},
      {"catmull-rom", single(Method::kCatmullRom, "16 samples, cubic: sharp")},
      {"lanczos2", single(Method::kLanczos2, "16 samples, windowed sinc")},
      {"noise", single(Method::kNoise, "the nearest sample with film grain")},
      {"noise-offset", single(Method::kNoiseOffset, "one of bilinear's samples, by chance")},
      {"quincunx", single(Method::kQuincunx, kVelocitySummary)},
      {"quincunx:mean", both(Form::kMean, "the plain mean of this frame and the previous one")},
      {"quincunx:velocity", both(Form::kVelocity, kVelocitySummary)},
      {"quincunx:point",
       {.form = Form::kVelocity, .sampling = Sampling::kPoint, .summary = "the same of nearest samples"}},
      {"quincunx:reprojected",
       both(Form::kReprojected, "both frames, the previous one where its surfaces were")},
      {"temporal", single(Method::kTemporal, kBalancedSummary)},
      {"temporal:fast", all(TemporalPreset::kFast, "all frames so far, the cheapest way")},
      {"temporal:balanced", all(TemporalPreset::kBalanced, kBalancedSummary)},
      {"temporal:quality", all(TemporalPreset::kQuality, "all frames so far, with all that helps")},
  };
  return choices;
}

void choose(ResolveSettings& settings, const MethodChoice& choice) {
  settings.method = choice.method;
  settings.quincunx.form = choice.form;
  settings.quincunx.sampling = choice.sampling;
  settings.temporal.preset = choice.preset;
}

std::string method_name(const ResolveSettings& settings) {
  std::string name = quincunx::name_of(settings.method);
  for (const auto& [longer, choice] : method_choices()) {
    ResolveSettings named = settings;
    choose(named, choice);
    const bool same = named.method == settings.method && named.quincunx.form == settings.quincunx.form &&
                      named.quincunx.sampling == settings.quincunx.sampling &&
                      named.temporal.preset == settings.temporal.preset;
    if (same && longer.size() > name.size()) name = longer;
  }
  return name;
}

}  // namespace quincunx::tools

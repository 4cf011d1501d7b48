// SPDX-License-Identifier: MIT
#include "tools/method_names.h"

namespace quincunx::tools {

const std::map<std::string, MethodChoice>& method_choices() {
  static const std::map<std::string, MethodChoice> choices = {
      {"point", {Method::kPoint}},
      {"bilinear", {Method::kBilinear}},
      {"b-spline", {Method::kBSpline}},
      {"catmull-rom", {Method::kCatmullRom}},
      {"lanczos2", {Method::kLanczos2}},
      {"noise", {Method::kNoise}},
      {"noise-offset", {Method::kNoiseOffset}},
      {"quincunx", {Method::kQuincunx}},
      {"quincunx:mean", {Method::kQuincunx, TwoFrameForm::kMean}},
      {"quincunx:velocity", {Method::kQuincunx, TwoFrameForm::kVelocity}},
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

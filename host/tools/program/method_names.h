// SPDX-License-Identifier: MIT
// Method names: how command lines and reports name a method with its form: "bilinear", "quincunx:mean".
#pragma once

#include <map>
#include <string>

#include "quincunx/resolve_plan.h"

namespace quincunx::tools {

// What a name stands for.
struct MethodChoice {
  Method method = Method::kQuincunx;
  TwoFrameForm form = QuincunxSettings{}.form;
  Sampling sampling = QuincunxSettings{}.sampling;
  TemporalPreset preset = TemporalSettings{}.preset;
  std::string summary = {};  // what it does, in a few words

  friend bool operator==(const MethodChoice&, const MethodChoice&) = default;
};

// Every name that command lines, reports and benchmarks know: those of quincunx::methods(), each with its usual
// form, and those of the forms.
const std::map<std::string, MethodChoice>& method_choices();

// All of them in one line, for help texts: "point, bilinear, ... or temporal[:fast|:balanced|:quality]".
std::string method_list();

void choose(ResolveSettings& settings, const MethodChoice& choice);

// The longest name for what the settings say: "quincunx:velocity".
std::string method_name(const ResolveSettings& settings);

}  // namespace quincunx::tools

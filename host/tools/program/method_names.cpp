// SPDX-License-Identifier: MIT
#include "tools/program/method_names.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

namespace quincunx::tools {
namespace {

// The forms of those methods that have some, in the order in which help texts list them. The usual form has
// the summary of its method.
std::vector<MethodChoice> all_forms() {
  using Form = TwoFrameForm;
  using Preset = TemporalPreset;
  const auto both = [](Form form, Sampling sampling, const char* summary) {
    return MethodChoice{.method = Method::kQuincunx, .form = form, .sampling = sampling, .summary = summary};
  };
  const auto all = [](Preset preset, const char* summary) {
    return MethodChoice{.method = Method::kTemporal, .preset = preset, .summary = summary};
  };
  return {
      both(Form::kMean, Sampling::kBilinear, "the plain mean of this frame and the previous one"),
      both(Form::kVelocity, Sampling::kBilinear, ""),
      both(Form::kVelocity, Sampling::kPoint, "the same of nearest samples"),
      both(Form::kReprojected, Sampling::kBilinear, "both frames, the previous one where its surfaces were"),
      all(Preset::kFast, "all frames so far, the cheapest way"),
      all(Preset::kBalanced, ""),
      all(Preset::kQuality, "all frames so far, with all that helps"),
  };
}

std::string form_name(const MethodChoice& choice) {
  if (choice.method == Method::kTemporal) return name_of(choice.preset);
  return choice.sampling == Sampling::kPoint ? name_of(choice.sampling) : name_of(choice.form);
}

}  // namespace

const std::map<std::string, MethodChoice>& method_choices() {
  static const auto choices = [] {
    std::map<std::string, MethodChoice> by_name;
    for (const MethodInfo& info : methods())
      by_name[info.name] = {.method = info.method, .summary = info.summary};
    for (MethodChoice& form : all_forms()) {
      const std::string method = name_of(form.method);
      if (form.summary.empty()) form.summary = by_name[method].summary;
      by_name[fmt::format("{}:{}", method, form_name(form))] = std::move(form);
    }
    return by_name;
  }();
  return choices;
}

std::string method_list() {
  std::string list;
  const std::vector<MethodChoice> forms = all_forms();
  for (const MethodInfo& info : methods()) {
    std::string endings;
    for (const MethodChoice& form : forms) {
      if (form.method == info.method)
        endings += fmt::format("{}:{}", endings.empty() ? "" : "|", form_name(form));
    }
    const bool last = &info == &methods().back();
    list += fmt::format("{}{}{}",
                        list.empty() ? ""
                        : last       ? " or "
                                     : ", ",
                        info.name, endings.empty() ? "" : fmt::format("[{}]", endings));
  }
  return list;
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

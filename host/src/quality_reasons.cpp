// SPDX-License-Identifier: MIT
// What a QualityController says of its choice.
#include <fmt/format.h>

#include "quincunx/quality_controller.h"

namespace quincunx {
namespace {

constexpr double kNamedShare = 0.005;  // of the picture: less is not told

std::string text_of(const SceneMix& mix) {
  std::string text;
  for (std::size_t i = 0; i < kSceneClasses; ++i) {
    if (mix.share[i] < kNamedShare) continue;
    text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", name_of(static_cast<SceneClass>(i)),
                        100 * mix.share[i]);
  }
  return text;
}

std::string text_of(const QualityPair& pair) {
  return fmt::format("{} at scale {:.2f}: expected FLIP {:.4f}, {:.2f} ms", name_of(pair.method), pair.scale,
                     pair.flip, pair.ms);
}

}  // namespace

std::string explain(const QualityReasons& reasons) {
  std::string text = fmt::format("Picture        {}\n", text_of(reasons.mix));
  text += fmt::format("Chosen         {} of {:.2f}\n", text_of(reasons.chosen), reasons.budget_ms);
  if (!reasons.others.empty()) text += fmt::format("Next method    {}\n", text_of(reasons.others.front()));
  if (!reasons.next_better) return text + "Next better    none: no pair errs less\n";
  const double more = reasons.next_better->ms - reasons.budget_ms;
  return text + fmt::format("Next better    {}, {:.2f} {} than there is\n", text_of(*reasons.next_better),
                            more > 0 ? more : -more, more > 0 ? "more" : "less");
}

}  // namespace quincunx

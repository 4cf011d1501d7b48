// SPDX-License-Identifier: MIT
#include <cmath>

#include "bench/traces/quality_replay.h"

namespace quincunx::traces {
namespace {

struct Best {
  double error = 1;
  double area = 0;
};

// The largest area at which a frame of this load takes one refresh; the lowest rung's where none does.
double area_that_fits(const QualityStage& stage, const ResolutionLadder& ladder, const FrameLoad& load,
                      const FrontMethod& method) {
  const double target_ms = stage.display.target_ms();
  int low = 0;
  int high = ladder.top();
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    const double area = ladder.area_fraction(middle);
    if (load.gpu(area) * target_ms + passes_ms(stage, ladder, method, area) <= target_ms) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return ladder.area_fraction(low);
}

Best best_of(const QualityStage& stage, const ResolutionLadder& ladder, std::size_t index) {
  const FrameLoad& load = stage.trace->load.frames[index];
  const double target_ms = stage.display.target_ms();
  Best best;
  for (const FrontMethod& method : stage.machine->methods()) {
    const double area = area_that_fits(stage, ladder, load, method);
    const bool fits = load.gpu(area) * target_ms + passes_ms(stage, ladder, method, area) <= target_ms;
    if (!fits && !(method == stage.machine->methods().front())) continue;
    const double error =
        stage.machine->flip(stage.trace->content[index].mix, method, std::sqrt(area)).value();
    if (error < best.error) best = {error, area};
  }
  return best;
}

}  // namespace

QualityScore oracle(const QualityStage& stage, const ResolutionLadder& ladder) {
  QualityScore score;
  for (std::size_t index = kWarmUp; index < stage.trace->content.size(); ++index) {
    const Best best = best_of(stage, ladder, index);
    score.error += best.error;
    score.area += best.area;
    ++score.frames;
  }
  score.error /= score.frames;
  score.area /= score.frames;
  return score;
}

}  // namespace quincunx::traces

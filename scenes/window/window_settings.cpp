// SPDX-License-Identifier: MIT
#include "window/window_settings.h"

namespace quincunx::scenes {

const char* name_of(ResolutionMode mode) {
  switch (mode) {
    case ResolutionMode::kFixed:
      return "fixed scale";
    case ResolutionMode::kController:
      return "by the controller";
    case ResolutionMode::kSweep:
      return "sweep";
    case ResolutionMode::kRandom:
      return "random in each frame";
    case ResolutionMode::kLowest:
      return "lowest";
  }
  return "unknown";
}

const char* name_of(UiDrawing drawing) {
  switch (drawing) {
    case UiDrawing::kOver:
      return "over the picture";
    case UiDrawing::kComposited:
      return "composited";
    case UiDrawing::kEverySecond:
      return "composited, every 2nd frame";
  }
  return "unknown";
}

void switch_dual(LookSettings& look) {
  look.dual = look.dual.empty() ? "auto" : "";
}

}  // namespace quincunx::scenes

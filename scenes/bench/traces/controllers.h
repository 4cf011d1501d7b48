// SPDX-License-Identifier: MIT
// The controllers that are replayed beside each other.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/traces/replay.h"

namespace quincunx::traces {

// A controller by name, made new for each replay.
struct ControllerKind {
  std::string name;
  bool ours = false;  // this library's, rather than a stand-in for somebody else's
  std::function<std::unique_ptr<ResolutionController>(const LadderSettings&, const Display&)> make;
};
std::vector<ControllerKind> controller_kinds();

}  // namespace quincunx::traces

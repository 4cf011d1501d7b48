// SPDX-License-Identifier: MIT
// What a run of the benchmark says: a table to read and JSON to keep.
#pragma once

#include <string>
#include <vector>

#include "interleaved.h"
#include "quincunx/device.h"

namespace quincunx::bench {

struct Run {
  DeviceInfo device;
  std::string opengl;   // renderer and version; empty: no peers of it
  std::string date;     // UTC, "2026-11-21 14:03"
  std::string command;  // as it was typed
  int rounds = 0;
  struct Size {
    Extent output;
    std::vector<Figures> figures;  // the first is the copy
  };
  std::vector<Size> sizes;
};

std::string text_of(const Run& run);
std::string json_of(const Run& run);

}  // namespace quincunx::bench

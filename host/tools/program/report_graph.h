// SPDX-License-Identifier: MIT
// ratio_graph: a run's render ratio as a few lines of text.
#pragma once

#include <span>
#include <string>

namespace quincunx::tools {

// A graph of at most 80 columns by 9 rows, each line ending in a newline: one mark for each column of frames
// at their mean, the axis from the lowest to the highest mean, labelled. Pure. Empty for no values.
std::string ratio_graph(std::span<const double> ratios);

}  // namespace quincunx::tools

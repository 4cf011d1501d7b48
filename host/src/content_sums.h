// SPDX-License-Identifier: MIT
// What measure_content counts, and the shares that follow. Pure.
#pragma once

#include "content_params.h"
#include "quincunx/content_statistics.h"
#include "quincunx/extent.h"

namespace quincunx {

// The tiles that a picture of this size is counted by.
Extent content_tiles(Extent output);

ContentStatistics statistics_of(const ContentSums& sums, Extent output);

}  // namespace quincunx

// SPDX-License-Identifier: MIT
// measure_content counts what a frame shows, for a controller that chooses the method; the shares follow here. Pure.
#pragma once

#include "picture_params.h"
#include "quincunx/advanced/content_statistics.h"
#include "quincunx/advanced/extent.h"

namespace quincunx {

// Returns the tiles that a picture of this size is counted by.
Extent content_tiles(Extent output);

ContentStatistics statistics_of(const ContentSums& sums, Extent output);

}  // namespace quincunx

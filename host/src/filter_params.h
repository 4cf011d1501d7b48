// SPDX-License-Identifier: MIT
// What the passes by scale_filter share.
#pragma once

#include "pass.h"
#include "scale_params.h"

namespace quincunx {

// A picture that a filter reads or makes: the top left `extent` of `view`.
struct FilterPicture {
  Extent extent;
  const ImageView& view;
};

// For the tables of `filter` from the one extent to the other.
FilterParams filter_params(const Filter& filter, const WorkShape& shape, const FilterPicture& from,
                           const FilterPicture& to, const Counter& counter);

}  // namespace quincunx

// SPDX-License-Identifier: MIT
// What the passes share that resize the history where the output's resolution changes.
#pragma once

#include "pass.h"
#include "temporal/resize_params.h"

namespace quincunx {

ResizeParams resize_params(const PassFrame& frame, const WorkShape& shape);

// Where the output's pixels lie among the texels of the history.
TableKey resize_key(const PassFrame& frame);

}  // namespace quincunx

// SPDX-License-Identifier: MIT
// The same work by other means, to compare with: every peer reads a picture at the render extent and writes
// one of RGBA floats at the output extent.
#pragma once

#include <vector>

#include "quincunx/image.h"
#include "stage.h"

namespace quincunx::bench {

// Plain scalar loops in one thread, as the compiler makes them at the build's optimisation level.
void add_cpp_peers(std::vector<Case>& cases, Extent output, double scale);

// ImageBufAlgo::resize with filters equal to ours, and the faster resample; on all processors.
void add_oiio_peers(std::vector<Case>& cases, Extent output, double scale);

// Ordinary GLSL in a pass over the whole picture, half textures in; the clock is a fence, since timer queries
// mean nothing on software renderers. A GL context is current, now and whenever the cases run or end.
void add_gl_peers(std::vector<Case>& cases, Extent output, double scale);

}  // namespace quincunx::bench

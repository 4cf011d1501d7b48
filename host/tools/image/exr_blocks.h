// SPDX-License-Identifier: MIT
// EXR blocks: whether a file holds all of its pixels, told from its size and its tables of offsets alone.
#pragma once

#include <string>

#include "quincunx/status.h"

namespace quincunx::tools {

// Reads the headers and the tables of all parts, and no pixels: well under a millisecond. For files whose headers are
// known to be good (ImageReader::open). It says nothing of a file that is no EXR, of mipmaps, and of a compression that
// it does not know. Errors: kIoFailure where blocks (scanlines or tiles) were never written or lie beyond the file's
// end: a copy or a renderer that was broken off. One sentence that names `path`. Thread-safe.
// Source: "OpenEXR File Layout", OpenEXR documentation.
Status check_blocks(const std::string& path);

}  // namespace quincunx::tools

// SPDX-License-Identifier: MIT
// Load and store of texels: these headers alone know buffer or image, half or float.
#pragma once

#include "texels/colour.h"
#include "texels/resolved.h"
#include "texels/storage.h"
#include "texels/surfaces.h"

// SPDX-License-Identifier: MIT
// The door between the attributes of image_io.h and those of OpenImageIO. For image_io.cpp and
// image_reader.cpp only.
#pragma once

#include <OpenImageIO/imageio.h>

#include <span>
#include <vector>

#include "tools/image/image_io.h"

namespace quincunx::tools {

// Those of a type that AttributeValue holds, in the file's order. Pairs and numbers of other precision are
// rounded to float.
std::vector<Attribute> attributes_of(const OIIO::ImageSpec& spec);

void set_attributes(OIIO::ImageSpec& spec, std::span<const Attribute> attributes);

}  // namespace quincunx::tools

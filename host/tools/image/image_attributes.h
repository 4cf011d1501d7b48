// SPDX-License-Identifier: MIT
// The door between the attributes of image_io.h and those of OpenEXR. For image_io.cpp and image_reader.cpp only.
#pragma once

#include <ImfHeader.h>

#include <span>
#include <vector>

#include "tools/image/image_io.h"

namespace quincunx::tools {

// Those of a type that AttributeValue holds, by name. Pairs and numbers of other precision are rounded to float.
std::vector<Attribute> attributes_of(const Imf::Header& header);

void set_attributes(Imf::Header& header, std::span<const Attribute> attributes);

}  // namespace quincunx::tools

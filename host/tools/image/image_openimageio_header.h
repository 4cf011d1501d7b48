// SPDX-License-Identifier: MIT
// What a file says of itself, in OpenImageIO's words and in ours.
#pragma once

#include <OpenImageIO/imageio.h>

#include <string>

#include "tools/image/image_reader.h"

namespace quincunx::tools::oiio {

void set_attribute(OIIO::ImageSpec& spec, const Attribute& attribute);  // under EXR's name
std::string own_name(const std::string& name);                          // OpenImageIO's of EXR's

// Describes one part of a file. Throws std::runtime_error, with the reason, for a picture that OpenImageIO would read
// as another one.
ImagePart describe(const OIIO::ImageSpec& spec, const std::string& format, const std::string& path);

}  // namespace quincunx::tools::oiio

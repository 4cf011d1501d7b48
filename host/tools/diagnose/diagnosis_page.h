// SPDX-License-Identifier: MIT
// Diagnosis page: what diagnose() found as a page to look at, with the frames that their input's word foretells worst.
#pragma once

#include <span>
#include <string>

#include "tools/diagnose/diagnose.h"

namespace quincunx::tools {

// One HTML file that needs nothing else. `input`: the frames' name; `json`: that of the diagnosis. Pictures of more
// than 960x540 are cropped about their middle. Errors: kInvalidArgument for maps that are no pictures.
Result<std::string> diagnosis_page(const std::string& input, const std::string& json,
                                   std::span<const FailureMap> maps);

}  // namespace quincunx::tools

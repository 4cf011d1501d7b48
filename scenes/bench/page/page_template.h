// SPDX-License-Identifier: MIT
// page_from_template: an HTML file that needs nothing else, from the files of this folder and a document of
// figures.
#pragma once

#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "embedded_file.h"

namespace quincunx::bench {

// The files of this folder.
std::span<const EmbeddedFile> embedded_page_files();

// `html` with bench.css for its mark /*style*/, the scripts one after the other for /*script*/, and the
// figures, whatever names they hold, for /*data*/. Throws std::out_of_range for a file or a mark that is not
// there.
std::string page_from_template(const char* html, std::initializer_list<const char*> scripts,
                               const nlohmann::ordered_json& figures);

}  // namespace quincunx::bench

// SPDX-License-Identifier: MIT
// page_from_template: an HTML file that needs nothing else, no network either, from embedded files and a document of
// figures.
#pragma once

#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "embedded_file.h"

namespace quincunx::tools {

// The files of this folder, which every page may use.
std::span<const EmbeddedFile> embedded_page_files();

// `html` with page.css for its mark /*style*/, the scripts one after the other for /*script*/, and the
// figures, whatever names they hold, for /*data*/. Files are looked for in `own`, then among those of this folder.
// Throws std::out_of_range for a file or a mark that is not there.
std::string page_from_template(std::span<const EmbeddedFile> own, const char* html,
                               std::initializer_list<const char*> scripts,
                               const nlohmann::ordered_json& figures);

}  // namespace quincunx::tools

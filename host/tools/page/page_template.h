// SPDX-License-Identifier: MIT
// page_from_template: an HTML file that needs nothing else, no network either, from embedded files and a document of
// figures. Every page has the same head and tail.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "embedded_file.h"

namespace quincunx::tools {

// Parts that a page has of its own. Files are looked for among its own, then in this folder, which all share.
struct PageParts {
  std::span<const EmbeddedFile> files;
  const char* title = nullptr;  // text without "<" and "&"
  const char* body = nullptr;   // file with a header, sections, and a noscript that says what else to read
  std::initializer_list<const char*> scripts;  // files, in their order; elements.js first
};

// page.html with page.css and the parts; and the figures, whatever names they hold. Throws std::out_of_range for a
// file that is not there.
std::string page_from_template(const PageParts& parts, const nlohmann::ordered_json& figures);

// Bytes as text (RFC 4648, with padding), as pages carry pictures.
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace quincunx::tools

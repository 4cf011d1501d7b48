// SPDX-License-Identifier: MIT
#include "tools/page/page_template.h"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "embedded_page_files.h"

namespace quincunx::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string_view file(std::span<const EmbeddedFile> own, std::string_view name) {
  for (const auto files : {own, embedded_page_files()}) {
    for (const EmbeddedFile& embedded : files) {
      if (embedded.name == name) return embedded.text;
    }
  }
  throw std::out_of_range("page file " + std::string(name));
}

// JSON inside a script element: no "</script>" or "<!--" may end it, whatever a name holds.
std::string safe_in_script(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

// Replaces the one place where `mark` stands.
void put(std::string& page, std::string_view mark, std::string_view text) {
  const std::size_t at = page.find(mark);
  if (at == std::string::npos) throw std::out_of_range("page mark " + std::string(mark));
  page.replace(at, mark.size(), text);
}

}  // namespace

std::string page_from_template(const PageParts& parts, const Json& figures) {
  std::string page{file(parts.files, "page.html")};
  std::string script;
  for (const char* name : parts.scripts)
    script += file(parts.files, name);
  put(page, "/*title*/", parts.title);
  put(page, "/*style*/", file(parts.files, "page.css"));
  put(page, "/*body*/", file(parts.files, parts.body));
  put(page, "/*script*/", script);
  put(page, "/*data*/", safe_in_script(figures.dump(-1, ' ', false, Json::error_handler_t::replace)));
  return page;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t j = i; j < i + 3; ++j)
      group = group << 8 | (j < bytes.size() ? bytes[j] : 0u);
    for (std::size_t j = 0; j < 4; ++j)
      text += i + j <= bytes.size() ? kDigits[group >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

}  // namespace quincunx::tools

// SPDX-License-Identifier: MIT
#include "tools/diagnose/diagnosis_page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "embedded_diagnosis_files.h"
#include "tools/image/image_io.h"
#include "tools/page/page_template.h"

namespace quincunx::tools {
namespace {

using Json = nlohmann::ordered_json;

// Pictures of all maps, cropped to one size about their middle.
Result<Json> pictures_json(std::span<const FailureMap> maps) {
  constexpr Extent kLargest = {960, 540};
  if (maps.empty()) return Json(nullptr);
  Extent crop = kLargest;
  for (const FailureMap& map : maps)
    crop = {std::min(crop.width, map.extent.width), std::min(crop.height, map.extent.height)};
  Json frames = Json::array();
  for (const FailureMap& map : maps) {
    Json pngs = Json::array();
    const int left = (map.extent.width - crop.width) / 2, top = (map.extent.height - crop.height) / 2;
    for (const std::vector<float>* values : {&map.light, &map.error}) {
      std::vector<std::uint8_t> codes;
      for (int y = top; y < top + crop.height; ++y) {
        const float* row = values->data() + static_cast<std::ptrdiff_t>(y) * map.extent.width + left;
        for (int x = 0; x < crop.width; ++x)
          codes.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(row[x], 0.f, 1.f) * 255)));
      }
      const auto png = encode_png(crop, 1, codes);
      if (!png.ok()) return png.status();
      pngs.push_back(base64(png.value()));
    }
    frames.push_back({{"index", map.number}, {"mean", map.mean}, {"pngs", std::move(pngs)}});
  }
  const Extent full = maps.front().extent;
  return Json({{"width", crop.width},
               {"height", crop.height},
               {"x", (full.width - crop.width) / 2},
               {"y", (full.height - crop.height) / 2},
               {"frames", std::move(frames)}});
}

}  // namespace

Result<std::string> diagnosis_page(const std::string& input, const std::string& json,
                                   std::span<const FailureMap> maps) {
  auto pictures = pictures_json(maps);
  if (!pictures.ok()) return pictures.status();
  return page_from_template(
      {.files = embedded_diagnosis_files(),
       .title = "diagnosis",
       .body = "diagnosis.html",
       .scripts = {"elements.js", "viewer.js", "diagnosis.js"}},
      {{"input", input}, {"diagnosis", Json::parse(json)}, {"pictures", std::move(pictures).value()}});
}

}  // namespace quincunx::tools

// SPDX-License-Identifier: MIT
// Checks the JSON of a glTF 2.0 file against what the loader reads. Private to the glTF loader.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace quincunx::scenes {

// Parses the text and rebuilds it from the fields of gltf_schema() only, each with its right type, in range,
// and every index pointing at something; so its depth is small and nothing of it can surprise a trusting
// reader. Extras, unknown extensions and morph targets are gone afterwards. Throws GltfError that names the
// object and the field, also for an extension that the file requires and the loader lacks.
nlohmann::json checked_gltf_json(const std::string& text);

}  // namespace quincunx::scenes

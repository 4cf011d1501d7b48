// SPDX-License-Identifier: MIT
// The part of glTF 2.0 that the loader reads, as tables, and the check against them (validate.cpp). Private to the glTF
// loader.
// Source: Khronos Group, "glTF 2.0 Specification", version 2.0.1, 2021, and the extensions named in
// gltf/loader.h.
#pragma once

#include <cfloat>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

namespace quincunx::scenes {

enum class FieldKind : std::uint8_t {
  kIndex,       // into the root array `of`
  kIndices,     // list of those
  kAttributes,  // object of those
  kCount,       // integer in [low, high]
  kNumber,      // finite, in [low, high]
  kNumbers,     // `length` of those
  kBool,
  kString,
  kChoice,  // string or integer, one of `of`: "A|B|C"
  kObject,
  kObjects,
};

struct ObjectSchema;

struct Field {
  static constexpr double kLowest = -static_cast<double>(FLT_MAX);
  static constexpr double kHighest = static_cast<double>(FLT_MAX);

  const char* name;
  FieldKind kind;
  const char* of = "";
  const ObjectSchema* object = nullptr;
  bool required = false;
  double low = kLowest;
  double high = kHighest;
  std::size_t length = 0;
};

struct ObjectSchema {
  const char* label;  // "mesh"; "" where messages should name the owner instead
  std::span<const Field> fields;
};

const ObjectSchema& gltf_schema();  // returns the schema of the root object

// Parses the text and rebuilds it from the fields of gltf_schema() only, each with its right type, in range,
// and every index pointing at something; so its depth is small and nothing of it can surprise a trusting
// reader. Extras, unknown extensions and morph targets are gone afterwards. Throws GltfError that names the
// object and the field, also for an extension that the file requires and the loader lacks.
nlohmann::json checked_gltf_json(const std::string& text);

}  // namespace quincunx::scenes

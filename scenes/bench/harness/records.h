// SPDX-License-Identifier: MIT
// Records: structs of results whose fields are named once, for JSON in both directions and for CSV.
//
//   QUINCUNX_FIELDS(CopyRow, scene, scale, ms)   in the namespace of CopyRow
//
// defines fields(io, row), which calls io("scene", row.scene) and so on. A struct whose names differ from those of its
// members has a fields() of its own, which may name some by QUINCUNX_EACH_FIELD.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <concepts>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <ranges>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "quincunx/advanced/extent.h"

#define QUINCUNX_FIELD(name) io(#name, value.name);
#define QUINCUNX_EACH_FIELD(...) NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(QUINCUNX_FIELD, __VA_ARGS__))
#define QUINCUNX_FIELDS(Type, ...)                             \
  template <typename Io, ::quincunx::bench::SameAs<Type> Self> \
  void fields(Io& io, Self& value) {                           \
    QUINCUNX_EACH_FIELD(__VA_ARGS__)                           \
  }

namespace quincunx::bench {

template <typename Self, typename Type>
concept SameAs = std::same_as<std::remove_const_t<Self>, Type>;

}  // namespace quincunx::bench

namespace quincunx {

QUINCUNX_FIELDS(Extent, width, height)

}  // namespace quincunx

namespace quincunx::bench {

using Json = nlohmann::ordered_json;

// Whether a type has fields.
template <typename T, typename Io>
concept Record = requires(Io& io, T& value) {
  fields(io, value);
};

// Makes the JSON of a record. Numbers that JSON does not have, and optional ones that are absent, are null.
class JsonWriter {
 public:
  template <typename T>
  void operator()(const char* name, const T& value) {
    json_[name] = json_of(value);
  }
  template <typename T>
  static Json json_of(const T& value) {
    if constexpr (Record<const T, JsonWriter>) {
      JsonWriter inner;
      fields(inner, value);
      return std::move(inner.json_);
    } else if constexpr (std::floating_point<T>) {
      return std::isfinite(value) ? Json(value) : Json(nullptr);
    } else if constexpr (requires { value.has_value(); }) {
      return value ? json_of(*value) : Json(nullptr);
    } else if constexpr (std::ranges::range<T> && !std::convertible_to<T, std::string>) {
      Json list = Json::array();
      for (const auto& item : value)
        list.push_back(json_of(item));
      return list;
    } else {
      return value;
    }
  }

 private:
  Json json_ = Json::object();
};

// Returns the text of a record's JSON.
template <typename T>
std::string json_of(const T& record) {
  return JsonWriter::json_of(record).dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

// Reads what JsonWriter wrote; a number that is null is infinite. Throws Json::exception where a field is of another
// kind, or one that is not optional is missing.
class JsonReader {
 public:
  explicit JsonReader(const Json& json) : json_(json) {}

  template <typename T>
  void operator()(const char* name, T& value) {
    constexpr bool kMayBeMissing = requires {
      value.reset();
    };
    if (kMayBeMissing && !json_.contains(name)) return;
    read(json_.at(name), value);
  }

 private:
  template <typename T>
  static void read(const Json& json, T& value) {
    if constexpr (Record<T, JsonReader>) {
      JsonReader inner(json);
      fields(inner, value);
    } else if constexpr (requires { value.reset(); }) {
      value.reset();
      if (!json.is_null()) read(json, value.emplace());
    } else if constexpr (requires { value.emplace_back(); } && !std::same_as<T, std::string>) {
      for (const Json& item : json)
        read(item, value.emplace_back());
    } else if (std::floating_point<T> && json.is_null()) {
      value = std::numeric_limits<T>::infinity();
    } else {
      json.get_to(value);
    }
  }

  const Json& json_;
};

// Makes a line of CSV (RFC 4180). The fields of a struct inside become columns "ms_median", those of a list are words.
class CsvRow {
 public:
  template <typename T>
  void operator()(const char* name, const T& value) {
    const std::string full = prefix_.empty() ? name : prefix_ + "_" + name;
    if constexpr (Record<const T, CsvRow>) {
      const std::string outer = std::exchange(prefix_, full);
      fields(*this, value);
      prefix_ = outer;
    } else {
      const char* const separator = names_.empty() ? "" : ",";
      names_ += separator + full;
      cells_ += separator + quoted(text_of(value));
    }
  }

  const std::string& names() const { return names_; }
  const std::string& cells() const { return cells_; }

 private:
  template <typename T>
  static std::string text_of(const T& value) {
    if constexpr (std::floating_point<T>) {
      return std::isfinite(value) ? fmt::format("{:.6g}", value) : "inf";
    } else if constexpr (requires { value.has_value(); }) {
      return value ? text_of(*value) : "";
    } else if constexpr (std::ranges::range<T> && !std::convertible_to<T, std::string>) {
      return fmt::format("{}", fmt::join(value, " "));
    } else {
      return fmt::format("{}", value);
    }
  }
  static std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string safe = "\"";
    for (const char c : text)
      safe += c == '"' ? std::string("\"\"") : std::string(1, c);
    return safe + "\"";
  }

  std::string prefix_;
  std::string names_;
  std::string cells_;
};

// Returns a line of names and a line for each row; `row` makes a record of it.
template <std::ranges::range Rows, typename ToRecord = std::identity>
std::string csv_text(const Rows& rows, const ToRecord& to_record = {}) {
  using Row = std::remove_cvref_t<std::invoke_result_t<ToRecord, std::ranges::range_reference_t<const Rows>>>;
  CsvRow names;
  const Row none{};
  fields(names, none);
  std::string text = names.names() + "\n";
  for (const auto& row : rows) {
    CsvRow line;
    const Row record = to_record(row);
    fields(line, record);
    text += line.cells() + "\n";
  }
  return text;
}

}  // namespace quincunx::bench

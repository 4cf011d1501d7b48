// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/program/atomic_file.h"

namespace quincunx::bench {
namespace {

// Lists of like objects as tables: each name once, a line for each object. A third of the size of the objects, and
// changes between two files show line by line.

std::string text_of(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool is_list_of_objects(const Json& value) {
  return value.is_array() && !value.empty() && value.front().is_object();
}

bool is_table(const Json& value) {
  return value.is_object() && value.contains("columns") && value.contains("data");
}

struct Columns {
  Json names = Json::array();
  Json cells = Json::array();

  void add(const std::string& prefix, const Json& object) {
    for (const auto& [name, value] : object.items()) {
      if (value.is_object()) {
        add(prefix + name + ".", value);
      } else {
        names.push_back(prefix + name);
        cells.push_back(value);
      }
    }
  }
};

std::string table_text(const Json& list) {
  Columns first;
  first.add("", list.front());
  std::string text = "{\"columns\": " + text_of(first.names) + ", \"data\": [";
  for (const Json& object : list) {
    Columns row;
    row.add("", object);
    text += (&object == &list.front() ? "\n" : ",\n") + text_of(row.cells);
  }
  return text + "]}";
}

Json list_of(const Json& table) {
  std::vector<Json::json_pointer> places;
  for (const Json& name : table.at("columns")) {
    std::string path = "/" + name.get<std::string>();
    std::replace(path.begin(), path.end(), '.', '/');
    places.emplace_back(path);
  }
  Json list = Json::array();
  for (const Json& row : table.at("data")) {
    if (!row.is_array() || row.size() != places.size())
      throw std::runtime_error("a row has another number of cells than there are columns");
    Json object = Json::object();
    for (std::size_t i = 0; i < places.size(); ++i)
      object[places[i]] = row[i];
    list.push_back(std::move(object));
  }
  return list;
}

// Writes an object with a line for each of its fields. A list of objects becomes a table,
//   {"columns": ["scene", "quality.psnr"], "data": [["pan", 31.2],
//   ["wires", 28.1]]}
// where a dot stands before the field of an object inside. All objects of a list have the same fields.
std::string text_with_tables(const Json& object) {
  std::string text = "{";
  for (const auto& [name, value] : object.items()) {
    text += text.size() == 1 ? "\n" : ",\n";
    text += text_of(name) + ": " + (is_list_of_objects(value) ? table_text(value) : text_of(value));
  }
  return text + "\n}\n";
}

// Makes tables that are fields of `object` into lists of objects again. Throws std::exception where a row has not as
// many cells as there are columns.
Json without_tables(Json object) {
  if (!object.is_object()) return object;
  for (auto& [name, value] : object.items()) {
    if (is_table(value)) value = list_of(value);
  }
  return object;
}

constexpr const char* kProgram = "quincunx-bench";

// Rounds all numbers to the digits that a measurement holds, which are fewer than a double's: half the file.
void round_numbers(Json& json) {
  if (json.is_number_float()) json = std::strtod(fmt::format("{:.6g}", json.get<double>()).c_str(), nullptr);
  if (!json.is_structured()) return;
  for (Json& part : json)
    round_numbers(part);
}

Json objects_of(const BenchResult& result) {
  Json json = {{"program", kProgram}, {"format", kResultFormat}};
  json.update(JsonWriter::json_of(result));
  round_numbers(json);
  return json;
}

void bring_up_to_date(Json& json) {
  for (Json& scene : json.at("scenes"))
    scene["disoccluded"] = scene.at("uncovered");
}

}  // namespace

std::string to_json(const BenchResult& result) {
  return objects_of(result).dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_tables(const BenchResult& result) {
  return text_with_tables(objects_of(result));
}

Result<BenchResult> from_json(const std::string& text, const std::string& path) {
  try {
    Json json = without_tables(Json::parse(text));
    if (json.at("program") != kProgram) {
      return Status::invalid(fmt::format("'{}' is no result of {}", path, kProgram));
    }
    const Json format = json.at("format");
    if (format != 1 && format != kResultFormat) {
      return Status::invalid(fmt::format("'{}' has format {}; this program reads formats 1 and {}", path,
                                         format.dump(), kResultFormat));
    }
    if (format == 1) bring_up_to_date(json);
    BenchResult result;
    JsonReader reader(json);
    fields(reader, result);
    return result;
  } catch (const std::exception& error) {
    return Status::invalid(fmt::format("'{}' is no result of {}: {}", path, kProgram, error.what()));
  }
}

Result<BenchResult> read_result(const std::string& path) {
  const auto text = tools::read_text(path);
  if (!text.ok()) return text.status();
  return from_json(text.value(), path);
}

std::string to_csv(const BenchResult& result) {
  return csv_text(result.rows);
}

}  // namespace quincunx::bench

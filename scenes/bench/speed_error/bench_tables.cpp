// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_tables.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

namespace quincunx::bench {
namespace {

using Json = nlohmann::ordered_json;

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

}  // namespace

std::string text_with_tables(const Json& object) {
  std::string text = "{";
  for (const auto& [name, value] : object.items()) {
    text += text.size() == 1 ? "\n" : ",\n";
    text += text_of(name) + ": " + (is_list_of_objects(value) ? table_text(value) : text_of(value));
  }
  return text + "\n}\n";
}

Json without_tables(Json object) {
  if (!object.is_object()) return object;
  for (auto& [name, value] : object.items()) {
    if (is_table(value)) value = list_of(value);
  }
  return object;
}

}  // namespace quincunx::bench

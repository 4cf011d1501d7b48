// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "bench/speed_error/bench_fields.h"
#include "bench/speed_error/bench_tables.h"

namespace quincunx::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kProgram = "quincunx-bench";

// What a measurement holds, not what a double can: half the file.
double rounded(double value) {
  return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

class Writer {
 public:
  template <typename T>
  void operator()(const char* name, T& value) {
    json_[name] = json_of(value);
  }

  Json take() { return std::move(json_); }

 private:
  template <typename T>
  static Json json_of(T& value) {
    if constexpr (requires(Writer io) { fields(io, value); }) {
      Writer inner;
      fields(inner, value);
      return inner.take();
    } else {
      return value;
    }
  }
  // An infinite PSNR has no place in JSON.
  static Json json_of(double& value) { return std::isfinite(value) ? Json(rounded(value)) : Json(nullptr); }
  template <typename T>
  static Json json_of(std::optional<T>& value) {
    return value ? json_of(*value) : Json(nullptr);
  }

  template <typename T>
  static Json json_of(std::vector<T>& values) {
    Json list = Json::array();
    for (T& value : values)
      list.push_back(json_of(value));
    return list;
  }

  Json json_ = Json::object();
};

// Throws Json::exception where a field is of another kind, or one that is not optional is missing.
class Reader {
 public:
  explicit Reader(const Json& json) : json_(json) {}

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
    if constexpr (requires(Reader io) { fields(io, value); }) {
      Reader inner(json);
      fields(inner, value);
    } else {
      json.get_to(value);
    }
  }
  static void read(const Json& json, double& value) {
    value = json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
  }
  template <typename T>
  static void read(const Json& json, std::optional<T>& value) {
    if (json.is_null()) {
      value.reset();
    } else {
      value = json.get<T>();
    }
  }
  template <typename T>
  static void read(const Json& json, std::vector<T>& values) {
    for (const Json& item : json)
      read(item, values.emplace_back());
  }

  const Json& json_;
};

Json objects_of(BenchResult result) {
  Writer writer;
  std::string program = kProgram;
  int format = kResultFormat;
  writer("program", program);
  writer("format", format);
  fields(writer, result);
  return writer.take();
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
    Reader reader(json);
    fields(reader, result);
    return result;
  } catch (const std::exception& error) {
    return Status::invalid(fmt::format("'{}' is no result of {}: {}", path, kProgram, error.what()));
  }
}

Result<BenchResult> read_result(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) return Status::io(fmt::format("'{}' cannot be read", path));
  return from_json(text, path);
}

}  // namespace quincunx::bench

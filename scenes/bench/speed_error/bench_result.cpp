// SPDX-License-Identifier: MIT
#include "bench/speed_error/bench_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/program/atomic_file.h"

namespace quincunx::bench {
namespace {

using Json = nlohmann::ordered_json;

// The names of all fields of a BenchResult, once for JSON in both directions and CSV: an archive is called
// with each name and field.
template <typename Archive>
void fields(Archive& io, Extent& value) {
  io("width", value.width);
  io("height", value.height);
}

template <typename Archive>
void fields(Archive& io, Spread& value) {
  io("median", value.median);
  io("p95", value.p95);
  io("low", value.low);
  io("high", value.high);
}

// Named for what they are of, with the region behind it: "psnr_thin".
template <typename Archive>
void region_fields(Archive& io, const std::string& prefix, RegionFigures& value) {
  constexpr std::array<const char*, kRegions> kNames = {"thin", "behind_thin", "disoccluded", "edge", "rest"};
  for (std::size_t i = 0; i < kRegions; ++i)
    io((prefix + kNames[i]).c_str(), value[i]);
}

template <typename Archive>
void fields(Archive& io, Quality& value) {
  io("psnr", value.psnr);
  io("psnr_linear", value.psnr_linear);
  io("ssim", value.ssim);
  io("flip", value.flip);
  io("error_p99", value.error_p99);
  io("relative_error", value.relative_error);
  io("worst_window", value.worst_window);
  io("worst_frame", value.worst_frame);
  io("worst_x", value.worst_x);
  io("worst_y", value.worst_y);
  io("flicker", value.flicker);
  io("ghosting", value.ghosting);
  region_fields(io, "psnr_", value.region_psnr);
  io("psnr_focus", value.psnr_focus);
  io("psnr_outside", value.psnr_outside);
  io("non_finite", value.non_finite);
}

template <typename Archive>
void fields(Archive& io, Speed& value) {
  io("ms", value.ms);
  io("least_ms", value.least_ms);
  io("processor_ms", value.processor_ms);
  io("ratio", value.ratio);
  io("processor_ratio", value.processor_ratio);
  io("bytes", value.bytes);
  io("gigabytes_per_second", value.gigabytes_per_second);
  io("kernels", value.kernels);
}

template <typename Archive>
void fields(Archive& io, Row& value) {
  io("scene", value.scene);
  io("scale", value.scale);
  io("method", value.method);
  io("render", value.render);
  io("quality", value.quality);
  io("speed", value.speed);
  io("front", value.front);
}

template <typename Archive>
void fields(Archive& io, CopyRow& value) {
  io("scene", value.scene);
  io("scale", value.scale);
  io("ms", value.ms);
  io("processor_ms", value.processor_ms);
  io("gigabytes_per_second", value.gigabytes_per_second);
}

template <typename Archive>
void fields(Archive& io, FrameRow& value) {
  io("scene", value.scene);
  io("scale", value.scale);
  io("method", value.method);
  io("render", value.render);
  io("draw_ms", value.draw_ms);
  io("interop_ms", value.interop_ms);
  io("resolve_ms", value.resolve_ms);
  io("frame_ms", value.frame_ms);
  io("draw_processor_ms", value.draw_processor_ms);
  io("interop_processor_ms", value.interop_processor_ms);
  io("resolve_processor_ms", value.resolve_processor_ms);
  io("frame_processor_ms", value.frame_processor_ms);
  io("interop_bytes", value.interop_bytes);
}

template <typename Archive>
void fields(Archive& io, SceneRow& value) {
  io("name", value.name);
  io("summary", value.summary);
  io("reason", value.reason);
  io("truth_flicker", value.truth_flicker);
  io("disoccluded", value.disoccluded);
  region_fields(io, "part_", value.region_part);
}

template <typename Archive>
void fields(Archive& io, MethodRow& value) {
  io("name", value.name);
  io("summary", value.summary);
  io("jitter", value.jitter);
  io("lod_bias", value.lod_bias);
}

template <typename Archive>
void fields(Archive& io, Machine& value) {
  io("processor", value.processor);
  io("processors", value.processors);
  io("memory_gib", value.memory_gib);
  io("system", value.system);
  io("cl_device", value.cl_device);
  io("cl_platform", value.cl_platform);
  io("cl_driver", value.cl_driver);
  io("cl_version", value.cl_version);
  io("cl_on_processor", value.cl_on_processor);
  io("gl_renderer", value.gl_renderer);
  io("gl_version", value.gl_version);
  io("interop", value.interop);
  io("load_before", value.load_before);
  io("load_after", value.load_after);
}

template <typename Archive>
void fields(Archive& io, Conditions& value) {
  io("output", value.output);
  io("frames", value.frames);
  io("warm_up", value.warm_up);
  io("history_warm_up", value.history_warm_up);
  io("rounds", value.rounds);
  io("truth_samples", value.truth_samples);
  io("seed", value.seed);
  io("fps", value.fps);
  io("start", value.start);
  io("focus", value.focus);
  io("focus_scale", value.focus_scale);
  io("noise", value.noise);
}

template <typename Archive>
void fields(Archive& io, BenchResult& value) {
  io("version", value.version);
  io("command", value.command);
  io("date", value.date);
  io("wall_seconds", value.wall_seconds);
  io("machine", value.machine);
  io("conditions", value.conditions);
  io("scenes", value.scenes);
  io("methods", value.methods);
  io("copies", value.copies);
  io("rows", value.rows);
  io("frames", value.frames);
}

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

// Rounds to the digits that a measurement holds, which are fewer than a double's: half the file.
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

// RFC 4180.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string safe = "\"";
  for (const char c : text)
    safe += c == '"' ? std::string("\"\"") : std::string(1, c);
  return safe + "\"";
}

// Flattens a row: the fields of a struct inside become columns "ms_median".
class CsvRow {
 public:
  template <typename T>
  void operator()(const char* name, T& value) {
    const std::string full = prefix_.empty() ? name : prefix_ + "_" + name;
    if constexpr (requires(CsvRow io) { fields(io, value); }) {
      const std::string outer = std::exchange(prefix_, full);
      fields(*this, value);
      prefix_ = outer;
    } else {
      add(full, text_of(value));
    }
  }

  const std::string& names() const { return names_; }
  const std::string& cells() const { return cells_; }

 private:
  void add(const std::string& name, const std::string& text) {
    const char* separator = names_.empty() ? "" : ",";
    names_ += separator + name;
    cells_ += separator + quoted(text);
  }

  static std::string text_of(const std::string& value) { return value; }
  static std::string text_of(double value) {
    return std::isfinite(value) ? fmt::format("{:.6g}", value) : "inf";
  }
  static std::string text_of(const std::optional<double>& value) { return value ? text_of(*value) : ""; }
  static std::string text_of(const std::vector<std::string>& values) {
    return fmt::format("{}", fmt::join(values, " "));
  }
  static std::string text_of(std::integral auto value) { return fmt::format("{}", value); }

  std::string prefix_;
  std::string names_;
  std::string cells_;
};

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
  const auto text = tools::read_text(path);
  if (!text.ok()) return text.status();
  return from_json(text.value(), path);
}

std::string to_csv(const BenchResult& result) {
  std::string text;
  // Also without rows there are names.
  for (std::size_t i = 0; i < std::max<std::size_t>(result.rows.size(), 1); ++i) {
    Row row = result.rows.empty() ? Row{} : result.rows[i];
    CsvRow columns;
    fields(columns, row);
    if (i == 0) text = columns.names() + "\n";
    if (!result.rows.empty()) text += columns.cells() + "\n";
  }
  return text;
}

}  // namespace quincunx::bench

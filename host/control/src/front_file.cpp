// SPDX-License-Identifier: MIT
// ErrorFront as JSON text; the one that is built in, and the file of the cache.
#include "quincunx/control/front_file.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "embedded_front_file.h"
#include "quincunx/advanced/cache_folder.h"
#include "quincunx/control/error_front.h"

namespace quincunx {
namespace {

constexpr const char* kFrontVersionKey = "quincunx_error_front";
constexpr const char* kColumns[] = {"class",       "method",           "scale",
                                    "flip",        "flip_spread",      "psnr_db",
                                    "psnr_spread", "ms_per_megapixel", "ms_spread"};

SceneClass class_named(const std::string& name) {
  std::string known;
  for (std::size_t i = 0; i < kSceneClasses; ++i) {
    const auto scene_class = static_cast<SceneClass>(i);
    if (name == name_of(scene_class)) return scene_class;
    known += (known.empty() ? "" : ", ") + std::string(name_of(scene_class));
  }
  throw std::invalid_argument(fmt::format("there is no class '{}'; there are {}", name, known));
}

// The range of a measurement, not of a double.
double rounded(double value) {
  return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
}

nlohmann::ordered_json row_of(const FrontPoint& point) {
  nlohmann::ordered_json row = {name_of(point.scene_class), name_of(point.method)};
  for (const double figure : {point.scale, point.flip, point.flip_spread, point.psnr_db, point.psnr_spread,
                              point.ms_per_megapixel, point.ms_spread})
    row.push_back(rounded(figure));
  return row;
}

FrontPoint point_of(const nlohmann::json& row) {
  if (!row.is_array() || row.size() != std::size(kColumns))
    throw std::invalid_argument(fmt::format("{} is no row of {} cells", row.dump(), std::size(kColumns)));
  const std::string name = row[1].get<std::string>();
  const auto method = parse_variant(name);
  if (!method.ok()) throw std::invalid_argument(method.status().message());
  if (name_of(method.value()) != name)
    throw std::invalid_argument(fmt::format("'{}' must be '{}'", name, name_of(method.value())));
  return {.scene_class = class_named(row[0].get<std::string>()),
          .method = method.value(),
          .scale = row[2].get<double>(),
          .flip = row[3].get<double>(),
          .flip_spread = row[4].get<double>(),
          .psnr_db = row[5].get<double>(),
          .psnr_spread = row[6].get<double>(),
          .ms_per_megapixel = row[7].get<double>(),
          .ms_spread = row[8].get<double>()};
}

FrontSource source_of(const nlohmann::json& root) {
  const auto text = [&](const char* key) { return root.at(key).get<std::string>(); };
  return {.device = text("device"),
          .driver = text("driver"),
          .scene = text("scene"),
          .date = text("date"),
          .command = text("command"),
          .truth = text("truth"),
          .output_extent = {root.at("output").at(0).get<int>(), root.at("output").at(1).get<int>()}};
}

namespace fs = std::filesystem;

// Reads a file; nothing where there is no such one.
std::optional<Result<ErrorFront>> read_front(const FrontKey& key, const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  auto front = ErrorFront::from_json(text);
  if (!front.ok()) return front;
  const FrontSource& source = front->source();
  if (source.device == key.device && source.driver == key.driver && source.scene == key.scene) return front;
  return Result<ErrorFront>(Status::invalid(
      fmt::format("it is of '{}', driver '{}', scene '{}'", source.device, source.driver, source.scene)));
}

}  // namespace

std::optional<fs::path> cache_folder() {
  if (const char* own = std::getenv("QUINCUNX_CACHE_DIR")) {
    return *own == '\0' ? std::nullopt : std::optional<fs::path>(own);
  }
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg != nullptr && *xdg != '\0') {
    return fs::path(xdg) / "quincunx";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    return fs::path(home) / ".cache" / "quincunx";
  }
  return std::nullopt;
}

std::string ErrorFront::to_json() const {
  nlohmann::ordered_json head = {
      {kFrontVersionKey, kFormat}, {"device", source_.device},
      {"driver", source_.driver},  {"scene", source_.scene},
      {"date", source_.date},      {"command", source_.command},
      {"truth", source_.truth},    {"output", {source_.output_extent.width, source_.output_extent.height}},
      {"columns", kColumns}};
  std::string text = "{\n";
  for (const auto& [key, value] : head.items())
    text += fmt::format("\"{}\": {},\n", key,
                        value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  text += "\"points\": [";
  const char* separator = "\n";
  for (const FrontPoint& point : points_) {
    text += separator + row_of(point).dump();
    separator = ",\n";
  }
  return text + "]\n}\n";
}

Result<ErrorFront> ErrorFront::from_json(const std::string& text) {
  const auto refuse = [](const std::string& what) { return Status::invalid("error front: " + what); };
  try {
    const nlohmann::json root = nlohmann::json::parse(text);
    if (root.at(kFrontVersionKey) != kFormat)
      return refuse(
          fmt::format("version {} cannot be read, only {}", root.at(kFrontVersionKey).dump(), kFormat));
    if (root.at("columns") != nlohmann::json(kColumns))
      return refuse(fmt::format("the columns are {}; they must be {}", root.at("columns").dump(),
                                nlohmann::json(kColumns).dump()));
    std::vector<FrontPoint> points;
    for (const nlohmann::json& row : root.at("points"))
      points.push_back(point_of(row));
    auto front = create(source_of(root), std::move(points));
    if (!front.ok()) return refuse(front.status().message());
    return front;
  } catch (const nlohmann::json::exception& error) {
    const std::string why = error.what();  // "[json.exception.parse_error.101] parse error at line 1, ..."
    return refuse("it must be the JSON that a front gave, and is not: " + why.substr(why.find("] ") + 2));
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
}

const ErrorFront& ErrorFront::built_in() {
  static const ErrorFront front = [] {
    auto read = from_json(std::string(embedded_front_file().front().text));
    if (!read.ok()) throw std::logic_error(read.status().message());
    read->built_in_ = true;
    return std::move(read).value();
  }();
  return front;
}

std::string ErrorFront::summary() const {
  const std::string where =
      fmt::format("measured on {}, driver {}, {}", source_.device, source_.driver, source_.date);
  if (built_in_) return fmt::format("built in, {}: its times are another device's", where);
  return source_.scene.empty() ? where : fmt::format("{}, for scene {}", where, source_.scene);
}

std::optional<fs::path> front_path(const FrontKey& key) {
  const auto folder = cache_folder();
  if (!folder) return std::nullopt;
  const std::string text = fmt::format("{}\n{}\n{}", key.device, key.driver, key.scene);
  return *folder / fmt::format("front-{:016x}.json", XXH3_64bits(text.data(), text.size()));
}

FoundFront find_front(const FrontKey& key) {
  std::string passed_over;
  for (const std::string& scene : {key.scene, std::string()}) {
    const FrontKey wanted = {key.device, key.driver, scene};
    const auto path = front_path(wanted);
    auto front = path ? read_front(wanted, *path) : std::nullopt;
    if (front && front->ok()) {
      std::string explanation =
          fmt::format("{}; {}{}", front->value().summary(), path->string(), passed_over);
      return {std::move(*front).value(), std::move(explanation)};
    }
    if (front && passed_over.empty())
      passed_over = fmt::format("; '{}' was not taken: {}", path->string(), front->status().message());
  }
  const ErrorFront& front = ErrorFront::built_in();
  return {front, front.summary() + passed_over};
}

}  // namespace quincunx

// SPDX-License-Identifier: MIT
#include "quincunx/front_file.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <fstream>
#include <iterator>

#include "quincunx/cache_folder.h"
#include "quincunx/device.h"

namespace quincunx {
namespace {

namespace fs = std::filesystem;

// Nothing where there is no such file.
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

FrontKey front_key(const DeviceInfo& device, const std::string& scene) {
  return {.device = device.platform + " " + device.name, .driver = device.driver, .scene = scene};
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

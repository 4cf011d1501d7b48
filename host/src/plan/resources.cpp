// SPDX-License-Identifier: MIT
#include "plan/resources.h"

#include <array>

namespace quincunx {
namespace {

constexpr auto kIsPrevious = [] {
  std::array<bool, kResourceCount> is_previous = {};
  for (const ResourceInfo& info : kResources) {
    if (info.previous) is_previous[index_of(*info.previous)] = true;
  }
  return is_previous;
}();

// Checks all that previous_of() and bind_inputs() take for granted.
constexpr bool is_consistent() {
  std::size_t row = 0;
  std::size_t pairs = 0, before = 0;
  for (const ResourceInfo& info : kResources) {
    if (index_of(info.resource) != row) return false;
    if (info.previous && info_of(*info.previous).input != info.input) return false;
    pairs += info.previous ? 1 : 0;
    before += kIsPrevious[row++] ? 1 : 0;
  }
  return pairs == before && row == index_of(Resource::kPresented) + 1;
}
static_assert(is_consistent(), "a row for each enumerator in their order; two of a pair are the same input");

}  // namespace

bool is_previous(Resource resource) {
  return kIsPrevious[index_of(resource)];
}

Storage storage_of(Resource resource, const PlanFacts& facts) {
  if (resource == Resource::kPresented) return facts.presented_storage();
  return info_of(resource).input != nullptr ? facts.settings.targets.storage : Storage::kBuffer;
}

}  // namespace quincunx

// SPDX-License-Identifier: MIT
#include "catalog/scene_catalog.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "builtin/scenes.h"
#include "gltf/loader.h"

namespace quincunx::scenes {

namespace {

struct BuiltIn {
  const char* name;
  const char* summary;
  const char* reason;
  Scene (*make)(std::uint64_t seed);
};

constexpr std::array kBuiltIns = std::to_array<BuiltIn>({
    {"courtyard", "A courtyard with a fountain among four orange trees, late in the afternoon",
     "everything at once: fine railings, lettering, foliage, moving objects, lamps, water, particles, a "
     "moving camera",
     make_courtyard},
    {"chart", "A still chart: zone plate, star, slanted edges, line pairs, text, patches",
     "resolution of one still frame: nothing moves, so every method must converge", make_chart},
    {"pan", "A brick wall with posters behind columns, crates and a railing",
     "only the camera moves: velocity follows from depth, no velocity target is needed", make_pan},
    {"wires", "Power lines, a wire fence and a lattice mast before sky and brickwork",
     "lines thinner than a pixel under a slow camera: flicker and broken lines", make_wires},
    {"wheel", "Spoked wheels with lettering on their rims, turning at three speeds",
     "rotation: velocity that varies within an object, a camera that stands still", make_wheel},
    {"occluders", "Slats, hoops and balls that circle fast before a lettered wall",
     "tens of pixels a frame before detail: what they disocclude has no history", make_occluders},
    {"particles", "Smoke, sparks and tinted glass before a lettered wall",
     "transparents without velocity: reactive values must keep their trails away", make_particles},
    {"flight", "The courtyard, flown through; smoke hangs before the camera for a third of the way",
     "a load that changes: what a resolution controller makes of it", make_flight},
    {"still", "The courtyard, stopped at one moment",
     "nothing moves at all: what accumulates must come to rest, and near the truth", make_still},
    {"zoom", "A walk to a lettered wall between columns, and back",
     "everything grows or shrinks: history of another size than the frame", make_zoom},
    {"cut", "Two shots of the brick wall behind columns, four seconds each",
     "the camera jumps: the first frames of a shot have no history", make_cut},
    {"sparkles", "Turning mirror balls and swinging strings of tiny lamps in the evening",
     "moving points of light, smaller than a pixel and hundreds of times brighter than white", make_sparkles},
    {"shadows", "Shadows of turning blades over a lettered wall; polished vases that turn",
     "light that moves otherwise than what it falls on: no velocity tells where it goes", make_shadows},
    {"cables", "Cables, whips and stays before the sky; some sway",
     "thin things before what is far: what one history layer breaks into dashes", make_cables},
    {"fence", "Railings and wire mesh close to a camera that walks past a lettered wall",
     "a regular pattern that moves three times as fast as what is behind it", make_fence},
    {"backdrop", "Columns, a mast and a wind wheel against the evening sun, under a camera that turns",
     "a sky that moves and says that it does not: its velocity is 0", make_backdrop},
    {"cutout", "A wheel, a swinging sign, cords and balls with nothing behind them",
     "alpha: a transparent background, to be laid over something else", make_cutout},
    {"faults", "Signs that swing before a wall; ten times a second a frame holds three wrong blocks",
     "colours of 50, of -5 and infinite, for one frame each: none may be seen in the next", make_faults},
});

bool is_gltf_path(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower.ends_with(".gltf") || lower.ends_with(".glb");
}

std::string names_in_a_row() {
  std::string names;
  for (const BuiltIn& entry : kBuiltIns)
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  return names;
}

}  // namespace

std::vector<SceneEntry> list_scenes() {
  std::vector<SceneEntry> entries;
  entries.reserve(kBuiltIns.size());
  for (const BuiltIn& entry : kBuiltIns)
    entries.push_back({entry.name, entry.summary, entry.reason});
  return entries;
}

Result<Scene> open_scene(const std::string& name, std::uint64_t seed) {
  if (is_gltf_path(name)) return load_gltf(name);
  const auto entry = std::find_if(kBuiltIns.begin(), kBuiltIns.end(), [&](const BuiltIn& candidate) {
    return name.empty() || name == candidate.name;
  });
  if (entry == kBuiltIns.end()) {
    return Status::invalid(
        fmt::format("there is no scene '{}': the built-in ones are {}; a file must end in .gltf or .glb",
                    name, names_in_a_row()));
  }
  Scene scene = entry->make(seed);
  scene.name = entry->name;
  scene.summary = entry->summary;
  scene.reason = entry->reason;
  return scene;
}

}  // namespace quincunx::scenes

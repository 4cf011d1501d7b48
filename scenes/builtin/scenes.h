// SPDX-License-Identifier: MIT
// The built-in scenes. Each is a pure function of its seed; docs/scenes.md says what each is for.
//
// name, summary and reason are left to the catalogue. All repeat without a jump after Scene::duration.
#pragma once

#include <cstdint>

#include "scene.h"

namespace quincunx::scenes {

// courtyard.cpp
Scene make_courtyard(std::uint64_t seed);
Scene make_still(std::uint64_t seed);
Scene make_flight(std::uint64_t seed);

// moving_cameras.cpp
Scene make_pan(std::uint64_t seed);
Scene make_zoom(std::uint64_t seed);
Scene make_cut(std::uint64_t seed);
Scene make_wires(std::uint64_t seed);
Scene make_cables(std::uint64_t seed);
Scene make_fence(std::uint64_t seed);

// moving_objects.cpp
Scene make_wheel(std::uint64_t seed);
Scene make_occluders(std::uint64_t seed);
Scene make_shadows(std::uint64_t seed);
Scene make_particles(std::uint64_t seed);

// odd_pixels.cpp
Scene make_backdrop(std::uint64_t seed);
Scene make_cutout(std::uint64_t seed);
Scene make_sparkles(std::uint64_t seed);
Scene make_faults(std::uint64_t seed);

// chart.cpp
Scene make_chart(std::uint64_t seed);

}  // namespace quincunx::scenes

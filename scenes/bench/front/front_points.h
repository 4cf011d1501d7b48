// SPDX-License-Identifier: MIT
// The points of an ErrorFront, from results of the bench; the built-in scenes that stand for each class, and those that
// its users are judged by. Pure.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "quincunx/control/error_front.h"

namespace quincunx::bench {

struct ClassScenes {
  SceneClass scene_class;
  std::span<const std::string_view> measured;  // by --front
  std::span<const std::string_view> held_out;  // never: who chooses by a front proves itself on these
};

// Each class once, in the order of SceneClass. No scene is there twice.
std::span<const ClassScenes> class_scenes();

// The means of each class, method and scale over all rows of its measured scenes. All results have the same methods,
// scales and output; rows of other scenes do not count. Errors: kInvalidArgument for a method that an ErrorFront does
// not know.
Result<std::vector<FrontPoint>> front_points(std::span<const BenchResult> results);

// A table for a terminal: for each class and method FLIP, dB and milliseconds by scale; what is on the front is marked.
std::string text_of(const ErrorFront& front);

}  // namespace quincunx::bench

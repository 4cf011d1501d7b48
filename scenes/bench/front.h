// SPDX-License-Identifier: MIT
// quincunx-bench --front: error and cost by class of scenes, method and scale, from results of the bench.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/speed_error/bench_result.h"
#include "quincunx/control/error_front.h"
#include "quincunx/status.h"

namespace quincunx::tools {
class CommandLine;
}

namespace quincunx::bench {

struct BenchOptions;

struct FrontOptions {
  std::string file;  // to write; empty: no front is wanted
};

// Sets the defaults of --front where no option says otherwise: the methods that are on a front, scales and conditions.
void apply_front_defaults(const tools::CommandLine& app, BenchOptions& options);

// Measures two views of each scene of class_scenes(): --start with --seed, and a later moment with another seed. Takes
// minutes. Throws a Failure where a step fails.
ErrorFront measure_front(const BenchOptions& options);

// Writes it to the file of the options and to where find_front() looks for it. Throws a Failure where a step fails.
void write_front(const BenchOptions& options, const ErrorFront& front);

// The built-in scenes that stand for a class, and those that the users of a front are judged by.
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

// SPDX-License-Identifier: MIT
// quincunx-bench --front: its option, and what it does.
#pragma once

#include <string>

#include "quincunx/status.h"

namespace quincunx {
class ErrorFront;
}
namespace quincunx::tools {
class CommandLine;
}

namespace quincunx::bench {

struct BenchOptions;

struct FrontOptions {
  std::string file;  // to write; empty: no front is wanted
};

// --front. After --scenes, --out and --compare, which it excludes.
// Sets the defaults of --front where no option says otherwise: the methods that are on a front, scales and conditions.
void apply_front_defaults(const tools::CommandLine& app, BenchOptions& options);

// Measures two views of each scene of class_scenes(): --start with --seed, and a later moment with another seed. Takes
// minutes. Errors: of any part, as that part words them.
Result<ErrorFront> measure_front(const BenchOptions& options);

// Writes it to the file of the options and to where find_front() looks for it. Errors: kIoFailure.
Status write_front(const BenchOptions& options, const ErrorFront& front);

}  // namespace quincunx::bench

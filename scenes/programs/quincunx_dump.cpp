// SPDX-License-Identifier: MIT
// quincunx-dump: every stage of a frame as numbers and as pictures, or a run as a sequence.
#include <fmt/format.h>

#include "programs/dump_session.h"
#include "tools/program/program.h"

namespace quincunx::scenes {
namespace {

int dump_stages(const DumpOptions& options) {
  auto session = DumpSession::create(options);
  if (!session.ok()) return tools::fail(session.status());
  if (Status status = session.value()->run(); !status.ok()) return tools::fail(status);
  if (!options.quiet) {
    for (const std::string& file : session.value()->files())
      fmt::print("{}\n", file);
  }
  return tools::kDone;
}

int run(int argc, char** argv) {
  DumpOptions options;
  if (const auto exit_code = command_line(options).parse(argc, argv)) return *exit_code;
  tools::set_up_log(options.quiet, options.verbosity);
  if (options.list_scenes) {
    print_scenes();
  } else if (options.list_devices) {
    print_devices(options);
  } else if (!options.sequence.empty()) {
    const Status status = dump_sequence(options);
    return status.ok() ? tools::kDone : tools::fail(status);
  } else {
    return dump_stages(options);
  }
  return tools::kDone;
}

}  // namespace
}  // namespace quincunx::scenes

int main(int argc, char** argv) {
  return quincunx::tools::run_program("quincunx-dump", quincunx::scenes::run, argc, argv);
}

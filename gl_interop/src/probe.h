// SPDX-License-Identifier: MIT
// What a probe of shared memory needs: bytes to carry, and a wait that ends.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cl_handle.h"
#include "quincunx/device.h"

namespace quincunx::gl {

constexpr std::size_t kProbeBytes = 16384;

std::vector<std::uint8_t> probe_bytes(std::uint32_t seed);

// On a queue of its own: one that waits for ever would hold all frames. Throws InteropError.
Device probe_device(const Device& device);

// Keeps what a queue that waits for ever may use yet, as long as the program runs.
void keep_for_ever(std::shared_ptr<const void> used);

// Returns the first kProbeBytes of `memory`, once `peer`, "OpenGL", has signalled. Throws InteropError where that does
// not come; the queue of `own` may then wait for it yet, and use the memory.
std::vector<std::uint8_t> read_probe(const Device& own, cl_mem memory, const char* peer);

}  // namespace quincunx::gl

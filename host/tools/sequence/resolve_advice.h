// SPDX-License-Identifier: MIT
// Resolve advice: what a careful user would want to know before the first frame. Pure.
#pragma once

#include <string>
#include <vector>

#include "tools/sequence/resolve_task.h"

namespace quincunx::tools {

// Sentences, each once for the whole run: no motion, a jitter that does not suit the method, a compression that loses
// motion, an output of another shape than the frames or smaller. Sizes that the frames ask for themselves
// (quincunx:outputSize) are as they should be. Nothing of frames that cannot be used.
std::vector<std::string> advice_on(const ResolveTask& task);

}  // namespace quincunx::tools

// SPDX-License-Identifier: MIT
// What most files of the product include, precompiled. No file may count on it: each includes what it uses, which
// the builds without precompiled headers check (docs/testing.md).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "../../host/src/device/opencl.h"

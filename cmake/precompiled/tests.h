// SPDX-License-Identifier: MIT
// The same for the tests.
#include <gtest/gtest.h>

#include "product.h"

// SPDX-License-Identifier: MIT
// REAL(function): the library's own function, from within one of that name in this executable, which takes its place.
#pragma once

#include <dlfcn.h>

#define REAL(function) reinterpret_cast<decltype(&function)>(dlsym(RTLD_NEXT, #function))

// SPDX-License-Identifier: MIT
// Options of the kernels that follow surfaces.
//
//   MOTION    1 (default): they read what reproject wrote | 0: nothing moves
//   REACTIVE  0 (default) | 1: they read reactive values themselves
#pragma once

#ifndef MOTION
#define MOTION 1
#endif
#ifndef REACTIVE
#define REACTIVE 0
#endif
#if MOTION < 0 || MOTION > 1
#error "MOTION must be 0 or 1"
#endif
#if REACTIVE < 0 || REACTIVE > 1
#error "REACTIVE must be 0 or 1"
#endif

/* SPDX-License-Identifier: MIT */
/* export: what a shared library of Quincunx shows. Everything else in it is hidden. Readable from C and C++. */
#ifndef QUINCUNX_EXPORT_H
#define QUINCUNX_EXPORT_H

/* Before a function, or between class and its name: part of the interface. */
#define QUINCUNX_API __attribute__((visibility("default")))
/* Of a class within such a class: none of it. */
#define QUINCUNX_HIDDEN __attribute__((visibility("hidden")))

#endif

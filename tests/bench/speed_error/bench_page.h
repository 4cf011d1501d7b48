// SPDX-License-Identifier: MIT
// page_of: a result as one HTML file that needs nothing else.
#pragma once

#include <span>
#include <string>

#include "bench_gallery.h"
#include "bench_result.h"
#include "embedded_file.h"

namespace quincunx::bench {

// tests/bench/page/*
std::span<const EmbeddedFile> embedded_page_files();

// The template with style, script, figures and pictures put in. An empty gallery leaves the viewer out. Pure.
std::string page_of(const BenchResult& result, const Gallery& gallery);

}  // namespace quincunx::bench

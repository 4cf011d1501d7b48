// SPDX-License-Identifier: MIT
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>

#include <memory>
#include <stdexcept>

#include "peers.h"
#include "stage.h"

namespace quincunx::bench {
namespace {

OIIO::ImageSpec spec_of(Extent extent) {
  return {extent.width, extent.height, 4, OIIO::TypeDesc::FLOAT};
}

}  // namespace

void add_oiio_peers(std::vector<Case>& cases, Extent output, double scale) {
  const Extent render = scaled(output, scale);
  const auto source = std::make_shared<OIIO::ImageBuf>(spec_of(render));
  const auto result = std::make_shared<OIIO::ImageBuf>(spec_of(output));
  OIIO::ImageBufAlgo::noise(*source, "uniform", 0.1f, 1.0f);
  const auto add = [&](const std::string& name, std::function<bool()> run) {
    cases.push_back(
        {.name = fmt::format("OpenImageIO {} {:.2f}", name, scale),
         .scale = scale,
         .bytes = bytes_of(render, PixelFormat::kRGBA32F) + bytes_of(output, PixelFormat::kRGBA32F),
         .run = [result, run = std::move(run)] {
           return wall_ms([&] {
             if (!run()) throw std::runtime_error(result->geterror());
           });
         }});
  };
  const OIIO::ROI roi = result->roi();
  add("resample bilinear", [=] { return OIIO::ImageBufAlgo::resample(*result, *source, true, roi); });
  for (const char* filter : {"triangle", "bspline", "catmull-rom"}) {
    add(fmt::format("resize {}", filter),
        [=] { return OIIO::ImageBufAlgo::resize(*result, *source, filter, 0, roi); });
  }
}

}  // namespace quincunx::bench

// SPDX-License-Identifier: MIT
#include "pass_options.h"

#include <fmt/format.h>

namespace quincunx {

const char* precision_of(PixelFormat format) {
  return format == PixelFormat::kRGBA16F || format == PixelFormat::kRG16F ? "HALF" : "FLOAT";
}

std::size_t alpha_bytes(const ResolveSettings& settings) {
  return bytes_per_pixel(settings.temporal.history) / 4;
}

const char* storage_option(Storage storage) {
  return storage == Storage::kImage ? "IMAGE" : "BUFFER";
}

std::string colour_options(const ResolveSettings& settings) {
  const bool encoded = settings.colour == PixelFormat::kRGBA8;
  if (settings.storage == Storage::kImage)
    return encoded ? "-D SOURCE_STORAGE=IMAGE -D SOURCE_FORMAT=SRGB8" : "-D SOURCE_STORAGE=IMAGE";
  return fmt::format("-D SOURCE_STORAGE=BUFFER -D SOURCE_FORMAT={}",
                     encoded ? "SRGB8" : precision_of(settings.colour));
}

std::string scale_options(const ResolveSettings& settings) {
  return fmt::format("{} -D OUTPUT_FORMAT={}", colour_options(settings), precision_of(settings.resolved));
}

std::string velocity_options(const ResolveSettings& settings) {
  if (settings.storage == Storage::kImage) return "-D SOURCE_STORAGE=IMAGE";
  return fmt::format("-D SOURCE_STORAGE=BUFFER -D VELOCITY_FORMAT={}", precision_of(settings.velocity));
}

}  // namespace quincunx

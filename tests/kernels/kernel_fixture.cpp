// SPDX-License-Identifier: MIT
#include "kernel_fixture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <limits>
#include <random>
#include <string_view>

#include "../reference/number_formats.h"
#include "error_table.h"

namespace quincunx::testing {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_half(PixelFormat format) {
  return format == PixelFormat::kRGBA16F || format == PixelFormat::kRG16F;
}
bool is_unorm(PixelFormat format) {
  return format == PixelFormat::kRGBA8 || format == PixelFormat::kR8;
}

std::size_t area(Extent extent) {
  return static_cast<std::size_t>(extent.area());
}

std::uint8_t unorm_code(double value) {
  return static_cast<std::uint8_t>(
      std::floor(std::clamp(std::isnan(value) ? 0.0 : value, 0.0, 1.0) * 255 + 0.5));
}

// Returns RGBA8 codes for light of any size: of its fraction where it lies outside of [0, 1], so that all codes occur.
Pixel encoded(const Pixel& light) {
  Pixel codes = {};
  for (std::size_t c = 0; c < 4; ++c) {
    const double held = light[c] >= 0 && light[c] <= 1 ? light[c] : light[c] - std::floor(light[c]);
    codes[c] = c < 3 ? reference::srgb_of_linear(held) : held;
  }
  return codes;
}

// The floats nearest to linear light, which is what every pass takes RGBA8 for.
Pixel decoded(const Pixel& codes) {
  Pixel light = {};
  for (std::size_t c = 0; c < 4; ++c) {
    light[c] =
        static_cast<double>(static_cast<float>(c < 3 ? reference::linear_of_srgb(codes[c]) : codes[c]));
  }
  return light;
}

DeviceProfile profile_of(const char* text) {
  DeviceProfile profile;
  WorkShape& shape = profile.shape;
  char end = 0;
  const int read =
      std::sscanf(text, "%dx%dx%d%c", &shape.group_width, &shape.group_height, &shape.pixels_per_item, &end);
  if (read == 3 && shape.group_width > 0 && shape.group_height > 0 && shape.pixels_per_item >= 0)
    return profile;
  std::fprintf(stderr, "QUINCUNX_TEST_PROFILE is '%s' and must be like 16x8x4\n", text);
  std::exit(1);
}

// Frames lie in targets that are this much larger, at this offset.
constexpr int kMarginX = 3;
constexpr int kMarginY = 2;
constexpr std::size_t kOffset = 48;

// Whether the running case is one of a variant that stands for all.
bool is_sample() {
  return std::string_view(::testing::UnitTest::GetInstance()->current_test_info()->name())
      .ends_with("_sample");
}

}  // namespace

const Device& device() {
  // Never destroyed: some OpenCL layers are gone before static objects are.
  static const Device* const opened = [] {
    Result<Device> result = Device::open();
    if (!result.ok()) {
      std::fprintf(stderr, "%s\n", result.status().message().c_str());
      std::exit(1);
    }
    if (const char* text = std::getenv("QUINCUNX_TEST_PROFILE")) result->impl()->profile = profile_of(text);
    return new Device(result.value());
  }();
  return *opened;
}

const Device::Impl& impl() {
  return *device().impl();
}

std::size_t channel_count(PixelFormat format) {
  switch (format) {
    case PixelFormat::kR8:
    case PixelFormat::kR32F:
      return 1;
    case PixelFormat::kRG16F:
    case PixelFormat::kRG32F:
      return 2;
    default:
      return 4;
  }
}

double stored_value(PixelFormat format, double value) {
  if (is_half(format)) return reference::half_value(reference::half_bits(value));
  if (is_unorm(format)) return unorm_code(value) / 255.0;
  return static_cast<double>(static_cast<float>(value));
}

std::vector<unsigned char> encode(PixelFormat format, const std::vector<Pixel>& pixels) {
  std::vector<unsigned char> bytes;
  bytes.reserve(pixels.size() * bytes_per_pixel(format));
  const auto append = [&](const auto& value) {
    unsigned char raw[sizeof(value)];
    std::memcpy(raw, &value, sizeof(value));
    bytes.insert(bytes.end(), raw, raw + sizeof(value));
  };
  for (const Pixel& pixel : pixels) {
    for (std::size_t c = 0; c < channel_count(format); ++c) {
      if (is_half(format)) {
        append(reference::half_bits(pixel[c]));
      } else if (is_unorm(format)) {
        append(unorm_code(pixel[c]));
      } else {
        append(static_cast<float>(pixel[c]));
      }
    }
  }
  return bytes;
}

std::vector<Pixel> decode(PixelFormat format, const std::vector<unsigned char>& bytes) {
  std::vector<Pixel> pixels(bytes.size() / bytes_per_pixel(format));
  const unsigned char* next = bytes.data();
  const auto take = [&](auto value) {
    std::memcpy(&value, next, sizeof(value));
    next += sizeof(value);
    return value;
  };
  for (Pixel& pixel : pixels) {
    for (std::size_t c = 0; c < channel_count(format); ++c) {
      if (is_half(format)) {
        pixel[c] = reference::half_value(take(std::uint16_t{}));
      } else if (is_unorm(format)) {
        pixel[c] = take(std::uint8_t{}) / 255.0;
      } else {
        pixel[c] = static_cast<double>(take(float{}));
      }
    }
  }
  return pixels;
}

ImageView Rig::image(PixelFormat format, Storage storage, Extent used, const std::vector<Pixel>& pixels,
                     double outside, bool tight) {
  const Extent target = tight ? used : Extent{used.width + kMarginX, used.height + kMarginY};
  std::vector<Pixel> all(area(target), Pixel{outside, outside, outside, outside});
  for (int y = 0; y < used.height; ++y) {
    std::copy_n(pixels.begin() + static_cast<std::ptrdiff_t>(y) * used.width, used.width,
                all.begin() + static_cast<std::ptrdiff_t>(y) * target.width);
  }
  const std::vector<unsigned char> bytes = encode(format, all);
  if (storage == Storage::kImage) {
    Result<Image> image = device().allocate(target, format, storage);
    EXPECT_TRUE(image.ok()) << image.status().message();
    if (!image.ok()) return {};
    images_.push_back(std::move(image).value());
    const Status status = device().upload(images_.back().view(), target, bytes.data());
    EXPECT_TRUE(status.ok()) << status.message();
    return images_.back().view();
  }
  buffers_.emplace_back(impl().context, CL_MEM_READ_WRITE, kOffset + bytes.size());
  impl().queue.enqueueWriteBuffer(buffers_.back(), CL_TRUE, kOffset, bytes.size(), bytes.data());
  return {.memory = buffers_.back()(),
          .storage = storage,
          .format = format,
          .extent = target,
          .offset = kOffset,
          .pitch = static_cast<std::size_t>(target.width) * bytes_per_pixel(format)};
}

ImageView Rig::output(PixelFormat format, Extent extent, Storage storage) {
  return image(format, storage, extent, std::vector<Pixel>(area(extent), Pixel{-7, -7, -7, -7}), -7);
}

std::vector<unsigned char> Rig::bytes(const ImageView& view, Extent extent) const {
  std::vector<unsigned char> texels(area(extent) * bytes_per_pixel(view.format));
  const Status status = device().download(view, extent, texels.data());
  EXPECT_TRUE(status.ok()) << status.message();
  return texels;
}

std::vector<Pixel> Rig::pixels(const ImageView& view, Extent extent) const {
  return decode(view.format, bytes(view, extent));
}

Counter Rig::counter() {
  const std::vector<cl_uint> zeros(4, 0);
  buffers_.emplace_back(impl().context, CL_MEM_READ_WRITE, zeros.size() * sizeof(cl_uint));
  impl().queue.enqueueWriteBuffer(buffers_.back(), CL_TRUE, 0, zeros.size() * sizeof(cl_uint), zeros.data());
  return {buffers_.back()(), 2};
}

std::int64_t Rig::count(Counter counter) const {
  std::vector<cl_uint> values(4);
  clEnqueueReadBuffer(impl().queue(), counter.memory, CL_TRUE, 0, values.size() * sizeof(cl_uint),
                      values.data(), 0, nullptr, nullptr);
  EXPECT_EQ(values[0] + values[1] + values[3], 0u) << "a counter beside the pass's own was touched";
  return values[2];
}

const std::vector<Pattern>& all_patterns() {
  static const std::vector<Pattern> patterns = {Pattern::kImpulse, Pattern::kConstant, Pattern::kRamp,
                                                Pattern::kNoise,   Pattern::kExtremes, Pattern::kNonFinite};
  return patterns;
}

std::vector<Pattern> patterns_for(Extent output, std::size_t scale) {
  constexpr int kLarge = 65 * 65;
  const std::vector<Pattern>& all = all_patterns();
  if (is_sample() && output.width * output.height < kLarge) return all;
  return {all[scale % all.size()]};
}

std::vector<Extent> sizes_for(Extent largest) {
  std::vector<Extent> sizes = {{1, 1}, {7, 5}, {64, 64}};
  if (is_sample()) sizes.push_back(largest);
  return sizes;
}

const char* name_of(Pattern pattern) {
  switch (pattern) {
    case Pattern::kImpulse:
      return "impulse";
    case Pattern::kConstant:
      return "constant";
    case Pattern::kRamp:
      return "ramp";
    case Pattern::kNoise:
      return "noise";
    case Pattern::kExtremes:
      return "extremes";
    case Pattern::kNonFinite:
      return "non-finite";
  }
  return "unknown";
}

std::vector<Pixel> pattern_pixels(Pattern pattern, Extent extent, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 3);
  const double extremes[] = {65504, -65504, 6e-8, -3e-5, 0, 1};
  const double non_finite[] = {kNan, kInfinity, -kInfinity};
  std::vector<Pixel> pixels;
  for (int y = 0; y < extent.height; ++y) {
    for (int x = 0; x < extent.width; ++x) {
      Pixel pixel = {};
      for (std::size_t c = 0; c < 4; ++c) {
        switch (pattern) {
          case Pattern::kImpulse:
            pixel[c] =
                x == extent.width / 2 && y == extent.height / 2 ? 1000.0 * static_cast<double>(c + 1) : 0;
            break;
          case Pattern::kConstant:
            pixel[c] = 0.3 + static_cast<double>(c);
            break;
          case Pattern::kRamp:
            pixel[c] = 0.01 * x * static_cast<double>(c) - 0.02 * y;
            break;
          case Pattern::kNoise:
            pixel[c] = uniform(random);
            break;
          case Pattern::kExtremes:
            pixel[c] = extremes[random() % std::size(extremes)];
            break;
          case Pattern::kNonFinite:
            pixel[c] = random() % 40 == 0 ? non_finite[random() % std::size(non_finite)] : uniform(random);
            break;
        }
      }
      pixels.push_back(pixel);
    }
  }
  return pixels;
}

TestFrame make_frame(Rig& rig, const FrameFormats& formats, const FrameSpec& spec) {
  return make_frame(rig, formats, spec, pattern_pixels(spec.colour, spec.render, spec.seed));
}

TestFrame make_frame(Rig& rig, const FrameFormats& formats, const FrameSpec& spec,
                     const std::vector<Pixel>& colour) {
  TestFrame frame;
  frame.inputs.render_extent = spec.render;
  frame.inputs.jitter = spec.jitter;
  frame.reference.width = spec.render.width;
  frame.reference.height = spec.render.height;
  frame.reference.jitter_x = static_cast<double>(spec.jitter.x);
  frame.reference.jitter_y = static_cast<double>(spec.jitter.y);
  const auto put = [&](PixelFormat format, std::vector<Pixel> pixels, ImageView& view) {
    view = rig.image(format, formats.storage, spec.render, pixels, spec.outside, spec.tight);
    for (Pixel& pixel : pixels) {
      for (double& value : pixel)
        value = stored_value(format, value);
    }
    return pixels;
  };

  if (formats.colour == PixelFormat::kRGBA8) {
    std::vector<Pixel> codes(colour.size());
    std::transform(colour.begin(), colour.end(), codes.begin(), encoded);
    codes = put(formats.colour, codes, frame.inputs.colour);
    std::transform(codes.begin(), codes.end(), std::back_inserter(frame.reference.colour), decoded);
  } else {
    frame.reference.colour = put(formats.colour, colour, frame.inputs.colour);
  }
  if (formats.with_velocity) {
    // A few output pixels at most, so that the previous frame counts.
    std::vector<Pixel> velocity = pattern_pixels(spec.velocity, spec.render, spec.seed + 100);
    for (Pixel& pixel : velocity) {
      for (double& value : pixel)
        value *= spec.speed;
    }
    for (const Pixel& pixel : put(formats.velocity, velocity, frame.inputs.velocity)) {
      frame.reference.velocity.push_back({pixel[0], pixel[1]});
    }
  }
  if (formats.with_depth) {
    std::vector<Pixel> depth = pattern_pixels(spec.velocity, spec.render, spec.seed + 200);
    for (Pixel& pixel : depth)
      pixel[0] = std::abs(pixel[0]) / 4;
    for (const Pixel& pixel : put(PixelFormat::kR32F, depth, frame.inputs.depth)) {
      frame.reference.depth.push_back(pixel[0]);
    }
  }
  if (formats.with_reactive) {
    const std::vector<Pixel> reactive = pattern_pixels(Pattern::kNoise, spec.render, spec.seed + 300);
    for (const Pixel& pixel : put(PixelFormat::kR8, reactive, frame.inputs.reactive)) {
      frame.reference.reactive.push_back(pixel[0]);
    }
  }
  return frame;
}

Extent scaled(Extent output, double scale_x, double scale_y) {
  return {std::max(1, static_cast<int>(std::lround(output.width * scale_x))),
          std::max(1, static_cast<int>(std::lround(output.height * scale_y)))};
}

void expect_close(const reference::Picture& expected, const std::vector<Pixel>& actual,
                  const std::function<double(std::size_t)>& bound, const std::string& what,
                  PixelFormat stored) {
  ASSERT_EQ(expected.pixels.size(), actual.size()) << what;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    const double allowed = bound(i);
    double error = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      ASSERT_TRUE(std::isfinite(actual[i][c]))
          << what << ": pixel " << i << " channel " << c << " is not finite";
      ASSERT_NEAR(expected.pixels[i][c], actual[i][c], allowed)
          << what << ": pixel (" << i % static_cast<std::size_t>(expected.width) << ", "
          << i / static_cast<std::size_t>(expected.width) << ") channel " << c;
      error = std::max(error, std::abs(expected.pixels[i][c] - actual[i][c]));
    }
    if (!std::isfinite(allowed)) continue;  // a rounding decided what was compared
    record_error({.error = error, .bound = allowed, .largest = expected.largest[i], .stored = stored});
  }
}

bool holds_non_finite(PixelFormat format) {
  return !is_unorm(format);
}

double input_rounding(PixelFormat format, double magnitude) {
  if (format != PixelFormat::kRGBA8) return output_rounding(format, magnitude);
  return reference::linear_of_srgb(1) - reference::linear_of_srgb(1 - 0.5 / 255);
}

double output_rounding(PixelFormat format, double magnitude, Storage storage) {
  if (!is_half(format)) return 0;
  const double steps = storage == Storage::kImage ? 1 : 0.5;
  return steps * (magnitude * 0x1p-10 + 0x1p-24);
}

double velocity_rounding(PixelFormat format, Storage storage, double magnitude) {
  return is_half(format) ? output_rounding(format, magnitude, storage) : magnitude * 0x1p-24;
}

}  // namespace quincunx::testing

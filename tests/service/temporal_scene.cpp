// SPDX-License-Identifier: MIT
#include "temporal_scene.h"

#include <algorithm>
#include <cmath>

namespace quincunx::testing {
namespace {

double square(double value) {
  return value * value;
}

double unit_noise(int x, int y, unsigned salt) {
  unsigned mixed =
      static_cast<unsigned>(x) * 73856093u ^ static_cast<unsigned>(y) * 19349663u ^ salt * 83492791u;
  mixed = (mixed ^ mixed >> 15) * 2246822519u;
  mixed = (mixed ^ mixed >> 13) * 3266489917u;
  return ((mixed ^ mixed >> 16) & 0xffffff) / 16777216.;
}

double value_noise(Place place, unsigned salt) {
  const double left = std::floor(place.real()), top = std::floor(place.imag());
  const double fx = place.real() - left, fy = place.imag() - top;
  const int x = static_cast<int>(left), y = static_cast<int>(top);
  const double upper = unit_noise(x, y, salt) * (1 - fx) + unit_noise(x + 1, y, salt) * fx;
  const double lower = unit_noise(x, y + 1, salt) * (1 - fx) + unit_noise(x + 1, y + 1, salt) * fx;
  return upper * (1 - fy) + lower * fy;
}

double radical_inverse(int index, int base) {
  double sum = 0;
  for (double part = 1. / base; index > 0; index /= base, part /= base)
    sum += part * (index % base);
  return sum;
}

Place local_place(const Surface& surface, Place place, int frame) {
  const Place centre = surface.centre + surface.velocity * static_cast<double>(frame);
  return surface.turn == Place(1) ? place - centre : (place - centre) / std::pow(surface.turn, frame);
}

// Returns where the point of a surface that is at `place` in a frame was in the frame before.
Place previous_place(const Surface& surface, Place place, int frame) {
  const Place moved = place - surface.centre - surface.velocity * static_cast<double>(frame);
  return place - (surface.velocity + moved - moved / surface.turn);
}

bool holds(const Surface& surface, Place local) {
  switch (surface.shape) {
    case Surface::Shape::kPlane:
      return true;
    case Surface::Shape::kRectangle:
      return std::abs(local.real()) < surface.half_size.real() &&
             std::abs(local.imag()) < surface.half_size.imag();
    case Surface::Shape::kDisc:
      return std::norm(local) < square(surface.half_size.real());
  }
  return false;
}

// The nearest surface there; those that are reactive only if they are asked for.
const Surface& surface_at(const TemporalScene& scene, Place place, int frame, bool with_reactive) {
  for (const Surface& surface : scene.surfaces) {
    if ((with_reactive || !surface.reactive) && holds(surface, local_place(surface, place, frame)))
      return surface;
  }
  return scene.surfaces.back();
}

// A camera under which what is infinitely far away moves like a surface, which is affine.
CameraMotion camera_of(const Surface& sky, Extent output, int frame) {
  const auto to_ndc = [=](Place place) {
    return Place(2 * place.real() / output.width - 1, 1 - 2 * place.imag() / output.height);
  };
  const auto before = [&](double x, double y) {  // x, y: normalised device coordinates
    const Place place((x + 1) / 2 * output.width, (1 - y) / 2 * output.height);
    return to_ndc(previous_place(sky, place, frame));
  };
  const Place centre = before(0, 0), right = before(1, 0) - centre, up = before(0, 1) - centre;
  CameraMotion motion;
  const auto set = [&motion](std::size_t column, Place value) {
    motion.clip_to_previous_clip[4 * column] = static_cast<float>(value.real());
    motion.clip_to_previous_clip[4 * column + 1] = static_cast<float>(value.imag());
  };
  set(0, right);
  set(1, up);
  set(3, centre);
  return motion;
}

template <typename Function>
void for_each_pixel(Extent output, const Mask& mask, const Function& function) {
  for (int y = 0; y < output.height; ++y) {
    for (int x = 0; x < output.width; ++x) {
      if (!mask || mask(x, y)) function(static_cast<std::size_t>(y * output.width + x));
    }
  }
}

}  // namespace

Pixel TemporalScene::colour_at(Place place, int frame) const {
  const Surface& surface = surface_at(*this, place, frame, true);
  Pixel colour = surface.texture(local_place(surface, place, frame));
  const auto factor = static_cast<float>(light ? light(place, frame) : 1);
  for (int c = 0; c < 3; ++c)
    colour[c] *= factor;
  return colour;
}

std::vector<Pixel> TemporalScene::truth(int frame) const {
  constexpr int kSide = 4;
  std::vector<Pixel> pixels(static_cast<std::size_t>(output.area()), Pixel{});
  for (int y = 0; y < output.height * kSide; ++y) {
    for (int x = 0; x < output.width * kSide; ++x) {
      const Pixel colour = colour_at(Place(x + .5, y + .5) / static_cast<double>(kSide), frame);
      Pixel& sum = pixels[static_cast<std::size_t>(y / kSide * output.width + x / kSide)];
      for (int c = 0; c < 4; ++c)
        sum[c] += colour[c] / (kSide * kSide);
    }
  }
  return pixels;
}

HostFrame TemporalScene::render(int frame, Extent render, Vec2 jitter) const {
  const double step_x = static_cast<double>(output.width) / render.width;
  const double step_y = static_cast<double>(output.height) / render.height;
  const auto place_of = [=](int x, int y) {
    return Place((x + .5 + jitter.x) * step_x, (y + .5 + jitter.y) * step_y);
  };
  HostFrame host;
  host.render = render;
  host.jitter = jitter;
  host.exposure = exposure;
  host.colour = [=, this](int x, int y) { return colour_at(place_of(x, y), frame); };
  host.velocity = [=, this](int x, int y) {
    const Place place = place_of(x, y);
    const Surface& surface = surface_at(*this, place, frame, false);
    if (surface.is_sky) return Vec2{};
    const Place step = place - previous_place(surface, place, frame);
    return Vec2{static_cast<float>(step.real() / output.width),
                static_cast<float>(step.imag() / output.height)};
  };
  host.depth = [=, this](int x, int y) {
    const Surface& surface = surface_at(*this, place_of(x, y), frame, false);
    return surface.is_sky ? 0 : static_cast<float>(1 / surface.distance);
  };
  host.reactive = [=, this](int x, int y) {
    return static_cast<std::uint8_t>(surface_at(*this, place_of(x, y), frame, true).reactive ? 255 : 0);
  };
  const auto sky = std::find_if(surfaces.begin(), surfaces.end(), [](const Surface& s) { return s.is_sky; });
  if (sky != surfaces.end()) host.camera = camera_of(*sky, output, frame);
  return host;
}

Texture noise_texture(double cell, unsigned salt) {
  return [=](Place place) {
    const Place cells = place / cell;
    const bool odd =
        (static_cast<int>(std::floor(cells.real())) + static_cast<int>(std::floor(cells.imag()))) % 2 != 0;
    const double check = odd ? .25 : 1;
    const double coarse = value_noise(cells / 3., salt), fine = value_noise(place / 1.3, salt + 1);
    const double red = check * (.1 + .8 * coarse) * (.6 + .8 * fine), blue = check * (.9 - .8 * coarse);
    const Pixel colour{static_cast<float>(red), static_cast<float>((red + blue) / 2),
                       static_cast<float>(blue), 1};
    return colour;
  };
}

Texture plain_texture(float red, float green, float blue) {
  return [=](Place) { return Pixel{red, green, blue, 1}; };
}

TemporalScene wires_before_a_wall() {
  TemporalScene scene;
  for (int i = 0; i < 6; ++i) {
    scene.surfaces.push_back({.shape = Surface::Shape::kRectangle,
                              .half_size = {.5 + .1 * (i % 4), 200},
                              .centre = {12. + 23.3 * i, 48},
                              .velocity = {.83, 0},
                              .distance = 4,
                              .texture = plain_texture(.02f, .02f, .03f)});
  }
  scene.surfaces.push_back({.velocity = {-.31, 0}, .texture = noise_texture(12)});
  return scene;
}

Vec2 halton_jitter(int frame, int phases) {
  const int index = frame % phases + 1;
  return {static_cast<float>(radical_inverse(index, 2) - .5),
          static_cast<float>(radical_inverse(index, 3) - .5)};
}

int halton_phases(Extent output, Extent render) {
  return std::max(8, static_cast<int>(std::ceil(8. * static_cast<double>(output.area()) /
                                                static_cast<double>(render.area()))));
}

double tone_of(float colour) {
  const double value = std::max(0., static_cast<double>(colour));
  const double tone = value / (1 + value);
  return tone <= .0031308 ? 12.92 * tone : 1.055 * std::pow(tone, 1 / 2.4) - .055;
}

double squared_error(const std::vector<Pixel>& a, const std::vector<Pixel>& b, Extent output,
                     const Mask& mask) {
  double sum = 0;
  int count = 0;
  for_each_pixel(output, mask, [&](std::size_t i) {
    for (int c = 0; c < 3; ++c)
      sum += square(tone_of(a[i][c]) - tone_of(b[i][c]));
    count += 3;
  });
  return sum / std::max(count, 1);
}

double psnr(double squared_error) {
  return -10 * std::log10(std::max(squared_error, 1e-12));
}

double psnr(const std::vector<Pixel>& a, const std::vector<Pixel>& b) {
  return psnr(squared_error(a, b, {static_cast<int>(a.size()), 1}));
}

double largest_difference(const std::vector<Pixel>& a, const std::vector<Pixel>& b, Extent output,
                          const Mask& mask) {
  double most = 0;
  for_each_pixel(output, mask, [&](std::size_t i) {
    for (int c = 0; c < 3; ++c) {
      const double difference = std::abs(tone_of(a[i][c]) - tone_of(b[i][c]));
      if (!(difference <= most)) most = std::isnan(difference) ? 1e9 : difference;
    }
  });
  return most;
}

}  // namespace quincunx::testing

// SPDX-License-Identifier: MIT
// overlay_particles: particles of a viewport of their own, laid over the frame.
#include "../reference/overlay_particles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "expected.h"
#include "kernel_fixture.h"
#include "pass_rig.h"

namespace quincunx {
namespace {

using testing::FrameSpec;
using testing::PassRig;
using testing::Pattern;
using testing::Pixel;
using testing::Rig;
using testing::TestFrame;

struct Variant {
  Storage storage;
  PixelFormat colour;
  bool reactive;
};

struct Overlaid {
  ImageView colour, reactive;
};

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

class Overlay : public ::testing::TestWithParam<Variant> {
 protected:
  Overlay() {
    const Variant& v = GetParam();
    settings_.method = v.reactive ? Method::kQuincunx : Method::kBilinear;
    settings_.targets.storage = v.storage;
    settings_.colour = v.colour;
    settings_.output_extent = settings_.target_extent =
        settings_.targets.particle_extent = {1, 1};  // the plan's; not the frames'
    pass_ = std::make_unique<PassRig>(SceneNeeds{}, settings_, "overlay_particles");
  }

  // A near surface whose slanting edge runs across the picture, before a far plane and nothing at all.
  enum class Surface { kNear, kNothing, kFar };
  static Surface surface_at(double u, double v) {
    if (u + .3 * v < .55) return Surface::kNear;
    return v < .4 ? Surface::kNothing : Surface::kFar;
  }
  static double depth_at(double u, double v) {
    const Surface surface = surface_at(u, v);
    return surface == Surface::kNothing ? 0 : surface == Surface::kNear ? .25 + .03 * u : .02 + .01 * v;
  }

  // With those surfaces as depth, here and there nothing that is finite.
  TestFrame frame(Rig& rig, const FrameSpec& spec, const std::vector<Pixel>& colour) const {
    const Variant& v = GetParam();
    TestFrame made = make_frame(
        rig, {.storage = v.storage, .colour = v.colour, .with_depth = true, .with_reactive = v.reactive},
        spec, colour);
    std::vector<Pixel> depth;
    std::mt19937 random(spec.seed);
    for (int y = 0; y < spec.render.height; ++y) {
      for (int x = 0; x < spec.render.width; ++x) {
        double z = depth_at((x + .5) / spec.render.width, (y + .5) / spec.render.height);
        if (spec.velocity == Pattern::kNonFinite && random() % 16 == 0)
          z = random() % 2 == 0 ? std::nan("") : HUGE_VAL;
        depth.push_back({z, 0, 0, 0});
        made.reference.depth[reference::index_of(spec.render.width, x, y)] =
            testing::stored_value(PixelFormat::kR32F, z);
      }
    }
    made.inputs.depth =
        rig.image(PixelFormat::kR32F, v.storage, spec.render, depth, spec.outside, spec.tight);
    return made;
  }

  TestFrame bare(Rig& rig, const FrameSpec& spec) const {
    return frame(rig, spec, testing::pattern_pixels(spec.colour, spec.render, spec.seed));
  }

  // Particles: the pattern's light of some coverage; a third of the picture has none.
  TestFrame particles(Rig& rig, const FrameSpec& spec) const {
    std::vector<Pixel> colour = testing::pattern_pixels(spec.colour, spec.render, spec.seed);
    for (int y = 0; y < spec.render.height; ++y) {
      for (int x = 0; x < spec.render.width; ++x) {
        Pixel& pixel = colour[reference::index_of(spec.render.width, x, y)];
        const double part = std::fmod(std::abs(pixel[3]), 1);
        pixel[3] = std::isfinite(pixel[3]) ? part : pixel[3];
        if (3 * x < spec.render.width && spec.render.width > 2) pixel = {0, 0, 0, 0};
      }
    }
    TestFrame made = frame(rig, spec, colour);
    if (!GetParam().reactive) return made;
    std::vector<Pixel> marks;
    for (std::size_t i = 0; i < colour.size(); ++i) {
      if (colour[i] == Pixel{}) made.reference.reactive[i] = 0;
      marks.push_back({made.reference.reactive[i], 0, 0, 0});
    }
    made.inputs.reactive =
        rig.image(PixelFormat::kR8, GetParam().storage, spec.render, marks, spec.outside, spec.tight);
    return made;
  }

  Overlaid run(Rig& rig, const TestFrame& bare, const TestFrame& over, bool tight = false) {
    FrameInputs inputs = bare.inputs;
    inputs.particle_colour = over.inputs.colour;
    inputs.particle_depth = over.inputs.depth;
    inputs.particle_reactive = over.inputs.reactive;
    inputs.particle_render_extent = over.inputs.render_extent;
    const std::vector<Pixel> untouched(static_cast<std::size_t>(inputs.render_extent.area()),
                                       Pixel{-7, -7, -7, -7});
    const auto output = [&](PixelFormat format) {
      return rig.image(format, settings_.targets.storage, inputs.render_extent, untouched, -7, tight);
    };
    const Overlaid made = {output(settings_.colour), output(PixelFormat::kR8)};
    pass_->run(inputs, inputs, {1, 1}, {},
               {{Resource::kColour, made.colour}, {Resource::kReactive, made.reactive}});
    const std::vector<Pixel> all = rig.pixels(made.colour, made.colour.extent);
    for (int i = 0; i < made.colour.extent.area(); ++i) {
      const int x = i % made.colour.extent.width, y = i / made.colour.extent.width;
      if (x < inputs.render_extent.width && y < inputs.render_extent.height) continue;
      EXPECT_EQ(all[static_cast<std::size_t>(i)][0], -7) << "beyond the viewport";
    }
    return made;
  }

  std::vector<unsigned char> run_bits(Rig& rig, const TestFrame& bare, const TestFrame& over,
                                      bool tight = false) {
    const Overlaid made = run(rig, bare, over, tight);
    std::vector<unsigned char> all = rig.bytes(made.colour, bare.inputs.render_extent);
    const auto marks = rig.bytes(made.reactive, bare.inputs.render_extent);
    all.insert(all.end(), marks.begin(), marks.end());
    return all;
  }

  void compare(const FrameSpec& spec, const FrameSpec& spec_over);

  ResolveSettings settings_;
  std::unique_ptr<PassRig> pass_;
  std::int64_t compared_ = 0, undecided_ = 0, kept_ = 0;
};

void Overlay::compare(const FrameSpec& spec, const FrameSpec& spec_over) {
  Rig rig;
  const Variant& v = GetParam();
  const TestFrame below = bare(rig, spec), over = particles(rig, spec_over);
  const Overlaid made = run(rig, below, over);
  const std::vector<Pixel> colour = rig.pixels(made.colour, spec.render);
  const std::vector<Pixel> marks = rig.pixels(made.reactive, spec.render);
  const double most = v.colour == PixelFormat::kRGBA16F ? 65504 : HUGE_VAL;
  for (int y = 0; y < spec.render.height; ++y) {
    for (int x = 0; x < spec.render.width; ++x) {
      const std::size_t i = reference::index_of(spec.render.width, x, y);
      const std::string what = fmt::format("{}x{} of {}x{} ({}, {})", spec.render.width, spec.render.height,
                                           spec_over.render.width, spec_over.render.height, x, y);
      const auto [value, bound, undecided] = reference::expected_of([&](auto zero) {
        return reference::overlay_particles<decltype(zero)>(below.reference, over.reference, x, y);
      });
      ++compared_;
      undecided_ += undecided ? 1 : 0;
      if (undecided) continue;
      if (!value.has_particles || value.keeps_colour) {
        ++kept_;
        for (std::size_t c = 0; c < 4; ++c)
          ASSERT_TRUE(same(colour[i][c], below.reference.colour[i][c])) << what;
      } else {
        for (std::size_t c = 0; c < 4; ++c) {
          const double expected = std::clamp(value.colour[c], -most, most);
          testing::expect_near(expected, {expected, bound.colour[c].error}, colour[i][c], what, v.colour,
                               v.storage);
          if (HasFatalFailure()) return;
        }
      }
      if (v.reactive) {
        ASSERT_NEAR(marks[i][0], value.reactive, .5 / 255 + bound.reactive.error + 1e-6) << what;
      }
    }
  }
}

TEST_P(Overlay, MatchesTheReference) {
  unsigned seed = 0;
  for (const Extent render : {Extent{1, 1}, {1, 2}, {7, 5}, {64, 64}, {129, 33}}) {
    for (const Extent drawn : {render, Extent{(render.width + 1) / 2, (render.height + 1) / 2},
                               Extent{(2 * render.width + 2) / 3, (render.height + 3) / 4}, Extent{1, 1}}) {
      for (const Pattern pattern : testing::all_patterns()) {
        FrameSpec spec{.render = render, .colour = pattern, .seed = ++seed};
        spec.outside = std::nan("");
        spec.velocity = pattern == Pattern::kNonFinite ? Pattern::kNonFinite : Pattern::kNoise;
        FrameSpec over = spec;
        over.render = drawn;
        over.seed = ++seed;
        compare(spec, over);
        if (HasFatalFailure()) return;
      }
    }
  }
  EXPECT_LT(undecided_, compared_ / 64) << "of " << compared_;
  EXPECT_GT(kept_, 0);
}

// Drawn at the frame's own resolution, particles are where they were drawn.
TEST_P(Overlay, AtTheFramesResolutionEachPixelHasItsOwnTexel) {
  Rig rig;
  const FrameSpec spec{.render = {45, 23}};
  FrameSpec other = spec;
  other.seed = 9;
  const TestFrame below = bare(rig, spec), over = particles(rig, other);
  const std::vector<Pixel> colour = rig.pixels(run(rig, below, over).colour, spec.render);
  for (std::size_t i = 0; i < colour.size(); ++i) {
    const Pixel& c = over.reference.colour[i];
    for (std::size_t k = 0; k < 4; ++k) {
      const double expected = c[k] + (1 - c[3]) * below.reference.colour[i][k];
      EXPECT_NEAR(colour[i][k], expected, 1e-3 * (1 + std::abs(expected))) << i;
    }
  }
}

// The texels of the near surface are black, those of the far plane white, those of nothing grey: each pixel with a
// texel of its surface among the four around it has that surface's light and nothing of the others'. A device may round
// halves in images towards zero, what sums to a hair less to 2^-11 of these lights less. PoCL does not.
TEST_P(Overlay, NoHaloAtTheEdgeOfASurface_small) {
  constexpr Extent kFrame{96, 64};
  constexpr double kLight[] = {0, .5, 1};
  const bool may_round_down = GetParam().storage == Storage::kImage &&
                              testing::device().info().platform != "Portable Computing Language";
  const double step = may_round_down ? 0x1p-11 : 0;
  for (const Extent drawn : {Extent{48, 32}, {29, 19}, {24, 16}, {12, 8}, {7, 5}}) {
    Rig rig;
    FrameSpec spec{.render = drawn};
    std::vector<Pixel> lights;
    for (int y = 0; y < drawn.height; ++y) {
      for (int x = 0; x < drawn.width; ++x) {
        const Surface surface = surface_at((x + .5) / drawn.width, (y + .5) / drawn.height);
        const double light = kLight[static_cast<int>(surface)];
        lights.push_back({light, light, light, 1});
      }
    }
    const TestFrame over = frame(rig, spec, lights);
    spec.render = kFrame;
    const TestFrame below = frame(rig, spec, std::vector<Pixel>(kFrame.width * kFrame.height, {0, 0, 0, 1}));
    const std::vector<Pixel> colour = rig.pixels(run(rig, below, over).colour, kFrame);
    int wrong = 0, reachable = 0;
    for (int y = 0; y < kFrame.height; ++y) {
      for (int x = 0; x < kFrame.width; ++x) {
        const double u = (x + .5) / kFrame.width, v = (y + .5) / kFrame.height;
        const Surface own = surface_at(u, v);
        const double at_x = u * drawn.width - .5, at_y = v * drawn.height - .5;
        bool has_texel = false;
        for (const double column : {std::floor(at_x), std::floor(at_x) + 1}) {
          for (const double row : {std::floor(at_y), std::floor(at_y) + 1}) {
            const double tu = (std::clamp(column, 0., drawn.width - 1.) + .5) / drawn.width;
            const double tv = (std::clamp(row, 0., drawn.height - 1.) + .5) / drawn.height;
            has_texel = has_texel || surface_at(tu, tv) == own;
          }
        }
        if (!has_texel) continue;
        ++reachable;
        const double light = colour[reference::index_of(kFrame.width, x, y)][0];
        const double expected = kLight[static_cast<int>(own)];
        wrong += light > expected + 1e-6 || light < expected - 1e-6 - step * expected ? 1 : 0;
      }
    }
    EXPECT_EQ(wrong, 0) << drawn.width << "x" << drawn.height;
    EXPECT_GT(reachable, kFrame.area() * 9 / 10) << drawn.width << "x" << drawn.height;
  }
}

TEST_P(Overlay, PoisonOutsideBothViewportsChangesNoBit) {
  for (const Extent render : {Extent{1, 1}, {1, 9}, {9, 1}, {45, 23}}) {
    Rig rig;
    FrameSpec spec{.render = render};
    FrameSpec over = spec;
    over.render = {(render.width + 2) / 3, (render.height + 1) / 2};
    const auto clean = run_bits(rig, bare(rig, spec), particles(rig, over));
    for (const double poison : testing::kPoisons) {
      spec.outside = over.outside = poison;
      EXPECT_EQ(clean, run_bits(rig, bare(rig, spec), particles(rig, over)));
    }
  }
}

// Under a memory checker this also shows that nothing beyond the viewports is read or written.
TEST_P(Overlay, ATightImageGivesTheSameBits) {
  for (const Extent render : {Extent{1, 1}, {1, 9}, {9, 1}, {13, 7}, {16, 2}}) {
    Rig rig;
    FrameSpec spec{.render = render};
    FrameSpec over = spec;
    over.render = {(render.width + 1) / 2, (render.height + 2) / 3};
    const auto roomy = run_bits(rig, bare(rig, spec), particles(rig, over));
    spec.tight = over.tight = true;
    EXPECT_EQ(roomy, run_bits(rig, bare(rig, spec), particles(rig, over), true));
  }
}

TEST_P(Overlay, TwoRunsAgreeBitForBit) {
  Rig rig;
  FrameSpec spec{.render = {183, 92}, .colour = Pattern::kNonFinite, .velocity = Pattern::kNonFinite};
  const TestFrame below = bare(rig, spec);
  spec.render = {77, 31};
  const TestFrame over = particles(rig, spec);
  EXPECT_EQ(run_bits(rig, below, over), run_bits(rig, below, over));
}

const std::vector<Variant> kVariants = {{Storage::kBuffer, PixelFormat::kRGBA16F, true},
                                        {Storage::kBuffer, PixelFormat::kRGBA16F, false},
                                        {Storage::kBuffer, PixelFormat::kRGBA32F, true},
                                        {Storage::kImage, PixelFormat::kRGBA16F, true}};
INSTANTIATE_TEST_SUITE_P(Variants, Overlay, ::testing::ValuesIn(kVariants),
                         testing::sample_names(kVariants, [](const Variant& v) {
                           return fmt::format("{}{}_{}", v.reactive ? "reactive_" : "",
                                              v.storage == Storage::kImage ? "image" : "buffer",
                                              name_of(v.colour));
                         }));

}  // namespace
}  // namespace quincunx

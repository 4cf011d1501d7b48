// SPDX-License-Identifier: MIT
// Particles of a viewport of their own, as a caller of the service sees them.
#include <cstring>
#include <limits>
#include <random>

#include "service_fixture.h"

namespace quincunx {
namespace {

using testing::HostFrame;
using testing::Pixel;
using testing::random_frame;
using testing::ServiceRig;

constexpr Extent kOutput{48, 27};
constexpr Extent kTarget{96, 54};

struct Run {
  const char* name;
  ResolveSettings settings;
};

// Images for particles, at most as large as the frame's targets.
class Particles {
 public:
  explicit Particles(Device& device, Storage storage = Storage::kBuffer)
      : device_(device),
        colour_(device.allocate(kTarget, PixelFormat::kRGBA32F, storage).value()),
        depth_(device.allocate(kTarget, PixelFormat::kR32F, storage).value()),
        reactive_(device.allocate(kTarget, PixelFormat::kR8, storage).value()) {}

  void fill(Extent extent, const HostFrame& frame) {
    put<Pixel>(colour_, extent, frame.colour);
    put<float>(depth_, extent, frame.depth);
    put<std::uint8_t>(reactive_, extent, frame.reactive);
  }

  void add_to(FrameInputs& inputs, Extent extent) const {
    inputs.particle_colour = colour_.view();
    inputs.particle_depth = depth_.view();
    inputs.particle_reactive = reactive_.view();
    inputs.particle_render_extent = extent;
  }

 private:
  template <typename T>
  void put(const Image& image, Extent extent, const std::function<T(int, int)>& value) {
    std::vector<T> texels;
    for (int y = 0; y < extent.height; ++y) {
      for (int x = 0; x < extent.width; ++x)
        texels.push_back(value(x, y));
    }
    EXPECT_TRUE(device_.upload(image.view(), extent, texels.data()).ok());
  }

  Device& device_;
  Image colour_, depth_, reactive_;
};

HostFrame particles_of(const HostFrame& frame, Extent own) {
  HostFrame over = frame;
  over.colour = [=](int x, int y) {
    if ((x / 5 + y / 3) % 2 == 0) return Pixel{};
    const float cover = 0.25f + 0.5f * static_cast<float>((x + y) % 3) / 2;
    return Pixel{cover, 0.5f * cover, 0.1f, cover};
  };
  over.depth = [=](int x, int y) {
    return frame.depth(x * frame.render.width / own.width, y * frame.render.height / own.height);
  };
  over.reactive = [=](int x, int y) { return static_cast<std::uint8_t>((x / 5 + y / 3) % 2 == 0 ? 0 : 120); };
  return over;
}

class ParticleOverlay : public ::testing::TestWithParam<Run> {
 protected:
  static ResolveSettings with_particles(ResolveSettings settings) {
    settings.targets.particle_extent = kTarget;
    return settings;
  }
};

std::vector<Pixel> resolve(ServiceRig& rig, const HostFrame& frame, const Particles& particles, Extent own) {
  FrameInputs inputs = rig.upload(frame);
  particles.add_to(inputs, own);
  const FrameReport report = rig.dispatch(inputs);
  EXPECT_TRUE(report.ok()) << report.status.message();
  return rig.resolved();
}

// With as many texels as the frame has pixels, of the same depth, the picture is that of a frame that has them.
TEST_P(ParticleOverlay, AtTheFramesResolutionItIsAsIfTheFrameHadThem) {
  ServiceRig apart({}, with_particles(GetParam().settings), kOutput, kTarget);
  ServiceRig together({}, GetParam().settings, kOutput, kTarget);
  Particles particles(apart.device());
  // Colours up to 4 differ by the roundings of one sum, which a history of halves may round to the next half.
  const bool accumulates = GetParam().settings.method == Method::kTemporal;
  const double tolerance = accumulates ? 4 * 0x1p-10 : 1e-4;
  std::mt19937 random(7);
  for (int i = 0; i < 40; ++i) {
    HostFrame frame = random_frame(random, kTarget);
    frame.parity = frame.render == Extent{1, 1} ? 0 : i % 2;
    frame.reset = i == 0;
    frame.reactive = [](int, int) { return std::uint8_t{0}; };
    frame.colour = [colour = frame.colour](int x, int y) {
      Pixel pixel = colour(x, y);
      for (float& value : pixel)
        value = std::min(std::abs(value), 4.0f);
      return pixel;
    };
    const HostFrame over = particles_of(frame, frame.render);
    HostFrame laid = frame;
    laid.colour = [=](int x, int y) {
      const Pixel c = over.colour(x, y);
      Pixel pixel = frame.colour(x, y);
      for (std::size_t k = 0; k < 4; ++k)
        pixel[k] = c[k] + (1 - c[3]) * pixel[k];
      return pixel;
    };
    laid.reactive = over.reactive;
    particles.fill(frame.render, over);
    const std::vector<Pixel> actual = resolve(apart, frame, particles, frame.render);
    const std::vector<Pixel> expected = together.resolve(laid);
    for (std::size_t p = 0; p < actual.size(); ++p) {
      for (std::size_t c = 0; c < 4; ++c)
        ASSERT_NEAR(actual[p][c], expected[p][c], tolerance) << "frame " << i << ", pixel " << p;
    }
  }
}

// Both viewports of another size in each frame: what lies outside of the particles' changes no bit.
TEST_P(ParticleOverlay, PoisonOutsideTheirViewportNeverShows) {
  const ResolveSettings settings = with_particles(GetParam().settings);
  ServiceRig clean({}, settings, kOutput, kTarget), poisoned({}, settings, kOutput, kTarget);
  Particles tidy(clean.device()), dirty(poisoned.device());
  std::mt19937 random(11);
  const float values[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          1e30f};
  for (int i = 0; i < 120; ++i) {
    HostFrame frame = random_frame(random, kTarget);
    frame.parity = frame.render == Extent{1, 1} ? 0 : i % 2;
    const Extent own = {1 + static_cast<int>(random() % static_cast<unsigned>(frame.render.width)),
                        1 + static_cast<int>(random() % static_cast<unsigned>(frame.render.height))};
    const HostFrame over = particles_of(frame, own);
    HostFrame poison = over;
    const float value = values[i % 3];
    poison.colour = [=](int, int) { return Pixel{value, value, value, value}; };
    poison.depth = [=](int, int) { return value; };
    poison.reactive = [](int, int) { return std::uint8_t{255}; };
    dirty.fill(kTarget, poison);
    dirty.fill(own, over);
    tidy.fill(own, over);
    const std::vector<Pixel> expected = resolve(clean, frame, tidy, own);
    const std::vector<Pixel> actual = resolve(poisoned, frame, dirty, own);
    ASSERT_EQ(std::memcmp(expected.data(), actual.data(), expected.size() * sizeof(Pixel)), 0)
        << "frame " << i << ", " << own.width << "x" << own.height;
  }
}

// Where there are none, the picture is that of a plan without them: also where the output is dynamic, so that the
// history of the frame before is resized before they are laid over.
TEST_P(ParticleOverlay, NoneChangeNoBit) {
  ResolveSettings settings = GetParam().settings;
  settings.output.min_extent = {1, 1};
  ServiceRig apart({}, with_particles(settings), kOutput, kTarget);
  ServiceRig without({}, settings, kOutput, kTarget);
  Particles particles(apart.device());
  std::mt19937 random(13);
  for (int i = 0; i < 60; ++i) {
    HostFrame frame = random_frame(random, kTarget);
    frame.output = random_frame(random, kOutput).render;
    frame.parity = frame.render == Extent{1, 1} ? 0 : i % 2;
    HostFrame none = frame;
    none.colour = [](int, int) { return Pixel{}; };
    none.reactive = [](int, int) { return std::uint8_t{0}; };
    particles.fill(frame.render, none);
    const std::vector<Pixel> actual = resolve(apart, frame, particles, frame.render);
    const std::vector<Pixel> expected = without.resolve(frame);
    ASSERT_EQ(std::memcmp(expected.data(), actual.data(), expected.size() * sizeof(Pixel)), 0) << i;
  }
}

const Run kRuns[] = {
    {"bilinear", {.method = Method::kBilinear}},
    {"quincunx", {.method = Method::kQuincunx, .quincunx = {.form = TwoFrameForm::kReprojected}}},
    {"temporal", {.method = Method::kTemporal}},
    {"checkerboard", {.method = Method::kBilinear, .targets = {.shading = Shading::kCheckerboard}}},
    {"checkerboard_temporal", {.method = Method::kTemporal, .targets = {.shading = Shading::kCheckerboard}}},
};

INSTANTIATE_TEST_SUITE_P(Methods, ParticleOverlay, ::testing::ValuesIn(kRuns),
                         [](const auto& instance) { return instance.param.name; });

// Where targets are images, so are the service's own that hold the particles as well.
TEST(ParticleImages, MakeThePicturesOfBuffers) {
  ResolveSettings settings{.method = Method::kTemporal, .targets = {.particle_extent = kTarget}};
  ServiceRig buffers({}, settings, kOutput, kTarget);
  settings.targets.storage = Storage::kImage;
  ServiceRig images(buffers.device(), {}, settings, kOutput, kTarget);
  Particles in_buffers(buffers.device()), in_images(images.device(), Storage::kImage);
  std::mt19937 random(17);
  for (int i = 0; i < 3; ++i) {
    const HostFrame frame = random_frame(random, kTarget);
    const HostFrame over = particles_of(frame, frame.render);
    in_buffers.fill(frame.render, over);
    in_images.fill(frame.render, over);
    const std::vector<Pixel> expected = resolve(buffers, frame, in_buffers, frame.render);
    const std::vector<Pixel> actual = resolve(images, frame, in_images, frame.render);
    EXPECT_EQ(std::memcmp(expected.data(), actual.data(), expected.size() * sizeof(Pixel)), 0) << i;
  }
}

TEST(ParticlePlan, HasThePassItsImagesAndDepth) {
  ResolveSettings settings{.method = Method::kBilinear,
                           .output_extent = {64, 36},
                           .target_extent = {64, 36},
                           .targets = {.particle_extent = {32, 18}}};
  const auto plan = plan_for({}, settings);
  ASSERT_TRUE(plan.ok()) << plan.status().message();
  EXPECT_EQ(plan->passes.front().kernel, "overlay_particles");
  EXPECT_TRUE(plan->reads_depth);
  EXPECT_FALSE(plan->reads_reactive) << "a method of one frame";
  std::uint64_t own = 0;
  for (const PlannedBuffer& buffer : plan->buffers) {
    if (buffer.scaling != Scaling::kOwn) continue;
    EXPECT_EQ(buffer.extent, settings.targets.particle_extent);
    EXPECT_FALSE(buffer.owned);
    own += buffer.bytes;
  }
  EXPECT_EQ(own, 32u * 18u * (8 + 4));
  EXPECT_NE(plan->explain().find("its own"), std::string::npos);
  settings.method = Method::kQuincunx;
  EXPECT_TRUE(plan_for({}, settings)->reads_reactive);
}

TEST(ParticlePlan, RefusesATargetThatDoesNotFitAndEncodedColour) {
  ResolveSettings settings{.output_extent = {64, 36}, .target_extent = {64, 36}};
  for (const Extent target : {Extent{65, 36}, {64, 37}, {0, 5}, {-4, 5}}) {
    settings.targets.particle_extent = target;
    const auto plan = plan_for({}, settings);
    ASSERT_FALSE(plan.ok());
    EXPECT_NE(plan.status().message().find("particle_extent"), std::string::npos) << plan.status().message();
  }
  settings.targets.particle_extent = {32, 18};
  settings.colour = PixelFormat::kRGBA8;
  const auto plan = plan_for({}, settings);
  ASSERT_FALSE(plan.ok());
  EXPECT_NE(plan.status().message().find("linear"), std::string::npos) << plan.status().message();
}

TEST(ParticlePlan, AFrameWithoutThemIsRefused) {
  ServiceRig rig({}, {.method = Method::kQuincunx, .targets = {.particle_extent = kTarget}}, kOutput,
                 kTarget);
  HostFrame frame;
  frame.render = {20, 10};
  FrameInputs inputs = rig.upload(frame);
  const std::string missing = rig.dispatch(inputs).status.message();
  for (const char* field : {"particle_colour is missing", "particle_depth is missing",
                            "particle_reactive is missing", "particle_render_extent is 0x0"})
    EXPECT_NE(missing.find(field), std::string::npos) << missing;
  Particles particles(rig.device());
  particles.add_to(inputs, {97, 10});
  EXPECT_NE(rig.dispatch(inputs).status.message().find("particle_render_extent is 97x10"), std::string::npos);
  particles.add_to(inputs, {10, 10});
  EXPECT_TRUE(rig.dispatch(inputs).ok()) << rig.dispatch(inputs).status.message();
}

}  // namespace
}  // namespace quincunx

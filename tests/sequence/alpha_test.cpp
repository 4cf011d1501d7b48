// SPDX-License-Identifier: MIT
// Alpha of a sequence: accumulated as colour is where the files have it, or do not cover their picture.
#include <algorithm>
#include <cmath>

#include "sequence_fixture.h"
#include "tools/exr_files.h"

namespace quincunx {
namespace {

constexpr Extent kRender = {32, 20}, kPicture = {64, 40};
constexpr float kColour[] = {.8f, .4f, .1f};
constexpr int kLast = 24;

struct Place {
  double x, y;  // output pixels
};

// A disc of one colour before nothing, which moves by `velocity` output pixels a frame, alone or with the nothing.
struct Matte {
  Place velocity = {};
  bool moves_alone = false;

  bool covers(Place at, int frame) const {
    const double x = at.x - (24 + velocity.x * frame);
    const double y = at.y - (21 + velocity.y * frame);
    return x * x + y * y < 14 * 14;
  }
};

// Halton's, as quincunx-render has it but for its mean.
Vec2 jitter_at(int frame) {
  const auto inverse = [](int index, int base) {
    double sum = 0;
    for (double part = 1. / base; index > 0; index /= base, part /= base)
      sum += part * (index % base);
    return static_cast<float>(sum - .5);
  };
  return {inverse(frame % 32 + 1, 2), inverse(frame % 32 + 1, 3)};
}

class Alpha : public testing::SequenceTest {
 protected:
  // The channels of one frame, those of `names`, as a file would have them.
  static std::vector<float> samples(const Matte& matte, int frame, const tools::ImageWindow& window,
                                    std::size_t channels) {
    std::vector<float> pixels;
    const Vec2 jitter = jitter_at(frame);
    const double scale = static_cast<double>(kPicture.width) / kRender.width;
    for (int y = window.y; y < window.y + window.extent.height; ++y) {
      for (int x = window.x; x < window.x + window.extent.width; ++x) {
        const double at_x = x + .5 + static_cast<double>(jitter.x);
        const double at_y = y + .5 + static_cast<double>(jitter.y);
        const bool covered = matte.covers({at_x * scale, at_y * scale}, frame);
        const bool moves = covered || !matte.moves_alone;
        const float values[] = {covered ? kColour[0] : 0,
                                covered ? kColour[1] : 0,
                                covered ? kColour[2] : 0,
                                covered ? 1.f : 0,
                                moves ? static_cast<float>(-matte.velocity.x / scale) : 0,
                                moves ? static_cast<float>(matte.velocity.y / scale) : 0,  // +y up
                                covered ? 5.f : 1e10f};
        pixels.insert(pixels.end(), values, values + channels);
      }
    }
    return pixels;
  }

  void write_sequence(const Matte& matte, const tools::ImageWindow& window) {
    for (int frame = 1; frame <= kLast; ++frame) {
      testing::ExrPart part;
      part.data = window;
      part.display = {0, 0, kRender};
      part.channels = {"R", "G", "B", "A", "backward.u", "backward.v", "Z"};
      part.types.assign(part.channels.size(), Imf::FLOAT);
      part.pixels = samples(matte, frame, window, part.channels.size());
      testing::write_exr_parts(input(frame), {part});
    }
    std::ofstream jitters(folder_.file("jitter.txt"));
    for (int frame = 1; frame <= kLast; ++frame)
      jitters << frame << " " << jitter_at(frame).x << " " << jitter_at(frame).y << "\n";
  }

  void resolve_as(const std::string& name, const std::string& method) {
    resolve_to(name, fmt::format("--output 64x40 --store float --jitter '{}' --method {}",
                                 folder_.file("jitter.txt"), method));
  }

  std::vector<float> channel(const std::string& name, int frame, const char* which) const {
    const tools::LoadedImage picture = image(output(frame, name));
    std::vector<float> values;
    for (int y = 0; y < picture.extent.height; ++y) {
      for (int x = 0; x < picture.extent.width; ++x)
        values.push_back(picture.at(x, y, picture.channel(which)));
    }
    return values;
  }

  // Root mean square of what alpha differs from the part of each pixel that is covered.
  double error_of(const std::string& name, const Matte& matte, int frame) const {
    constexpr int kSide = 8;
    const std::vector<float> alpha = channel(name, frame, "A");
    double sum = 0;
    for (int i = 0; i < static_cast<int>(kPicture.area()); ++i) {
      double covered = 0;
      for (int s = 0; s < kSide * kSide; ++s) {
        const Place at = {i % kPicture.width + (s % kSide + .5) / kSide,
                          i / kPicture.width + (s / kSide + .5) / kSide};
        covered += matte.covers(at, frame) ? 1. / (kSide * kSide) : 0;
      }
      const double error = static_cast<double>(alpha[static_cast<std::size_t>(i)]) - covered;
      sum += error * error;
    }
    return std::sqrt(sum / static_cast<double>(kPicture.area()));
  }
};

constexpr tools::ImageWindow kWhole = {0, 0, kRender};

TEST_F(Alpha, OfManyFramesItConvergesToTruth) {
  for (const Matte& matte : {Matte{}, Matte{{.7, -.3}}}) {
    write_sequence(matte, kWhole);
    for (const char* preset : {"temporal:fast", "temporal", "temporal:quality"}) {
      resolve_as("many", preset);
      resolve_as("one", "bilinear");
      EXPECT_LT(error_of("many", matte, kLast), .6 * error_of("one", matte, kLast))
          << preset << " " << matte.velocity.x;
      EXPECT_LT(error_of("many", matte, kLast), .7 * error_of("many", matte, 1))
          << preset << " " << matte.velocity.x;
    }
  }
}

// Each channel is its part of the same alpha, as all were mixed with the same weights. Only where history is rectified,
// at the edges of what moves alone, they differ: colour by its tone, alpha as it is.
TEST_F(Alpha, ColourStaysPremultiplied) {
  for (const Matte& matte : {Matte{}, Matte{{.7, -.3}}, Matte{{.7, -.3}, true}}) {
    write_sequence(matte, kWhole);
    resolve_as("u", "temporal");
    const std::vector<float> alpha = channel("u", kLast, "A");
    const char* names[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::vector<float> colour = channel("u", kLast, names[c]);
      double worst = 0;
      for (std::size_t i = 0; i < alpha.size(); ++i)
        worst = std::max(worst, std::abs(static_cast<double>(colour[i] - alpha[i] * kColour[c])));
      EXPECT_LT(worst, matte.moves_alone ? .05 : .002) << names[c];
    }
    EXPECT_EQ(*std::min_element(alpha.begin(), alpha.end()), 0);
    EXPECT_NEAR(*std::max_element(alpha.begin(), alpha.end()), 1, 1e-3);
  }
}

// Beyond its data window a file has nothing: it is as if it had empty pixels there.
TEST_F(Alpha, ASmallDataWindowIsEmptyAround) {
  const Matte matte;
  write_sequence(matte, kWhole);
  resolve_as("whole", "temporal");
  write_sequence(matte, {3, 1, {20, 19}});
  resolve_as("window", "temporal");
  for (const char* name : {"R", "A"})
    EXPECT_EQ(channel("whole", kLast, name), channel("window", kLast, name)) << name;
}

// Without alpha a file is opaque, as far as it reaches.
TEST_F(Alpha, WithoutAlphaADataWindowIsOpaque) {
  const tools::ImageWindow window = {8, 5, {16, 10}};
  for (int frame = 1; frame <= 8; ++frame) {
    testing::ExrPart part = testing::simple_part(window.extent, {"R", "G", "B"}, {});
    part.data = window;
    part.display = kWhole;
    part.pixels.assign(static_cast<std::size_t>(window.extent.area()) * 3, .5f);
    testing::write_exr_parts(input(frame), {part});
  }
  for (const char* method : {"bilinear", "temporal"}) {
    resolve_to("u", fmt::format("--output 64x40 --method {} --jitter none", method));
    const std::vector<float> alpha = channel("u", 8, "A");
    for (int y = 0; y < kPicture.height; ++y) {
      for (int x = 0; x < kPicture.width; ++x) {
        const double past = std::max({16 - (x + .5), x + .5 - 48, 10 - (y + .5), y + .5 - 30});
        if (std::abs(past) < 2.5) continue;  // the edge
        EXPECT_NEAR(alpha[static_cast<std::size_t>(y * kPicture.width + x)], past < 0 ? 1 : 0, 1e-3)
            << method << " " << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace quincunx

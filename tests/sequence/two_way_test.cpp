// SPDX-License-Identifier: MIT
// --two-way: frames that know later ones, on a disc before a wall, both moving, with exact motion and truth.
#include <sys/resource.h>

#include <cmath>
#include <csignal>

#include "sequence_fixture.h"
#include "tools/sequence/sequence_histories.h"
#include "tools/sequence/sequence_reader.h"
#include "tools/sequence/sequence_scan.h"

namespace quincunx {
namespace {

using tools::ScannedFrame;
using tools::two_way_windows;
using tools::TwoWayWindow;

std::vector<ScannedFrame> scanned(std::int64_t first, std::int64_t last, std::int64_t wanted_from = 0) {
  std::vector<ScannedFrame> frames;
  for (std::int64_t number = first; number <= last; ++number) {
    const bool is_first = number == first;
    frames.push_back(
        {.number = number, .wanted = number >= wanted_from, .reset = is_first, .opens = is_first});
  }
  return frames;
}

TEST(TwoWayWindows, FollowTheNumbersAndLookAheadWithinAShot) {
  using Windows = std::vector<TwoWayWindow>;
  static_assert(tools::kWindowFrames == 24);
  EXPECT_EQ(two_way_windows({}, 8), Windows());
  EXPECT_EQ(two_way_windows(scanned(5, 5), 8), (Windows{{0, 0, 0}}));
  EXPECT_EQ(two_way_windows(scanned(0, 59), 8), (Windows{{0, 23, 31}, {24, 47, 55}, {48, 59, 59}}));
  EXPECT_EQ(two_way_windows(scanned(20, 60), 2), (Windows{{0, 3, 25}, {4, 27, 29}, {28, 40, 40}}));
  EXPECT_EQ(two_way_windows(scanned(0, 40, 30), 4), (Windows{{30, 40, 40}}));  // the rest is history
  auto frames = scanned(0, 30);
  frames[10].reset = true;  // a cut
  EXPECT_EQ(two_way_windows(frames, 8), (Windows{{0, 9, 9}, {10, 23, 30}, {24, 30, 30}}));
  for (std::size_t i = 21; i < frames.size(); ++i)
    frames[i].wanted = false;  // they are looked ahead to
  EXPECT_EQ(two_way_windows(frames, 8), (Windows{{0, 9, 9}, {10, 20, 30}}));
  frames = scanned(0, 60);
  frames[20].reset = true;  // a bad frame before it, which may show only later
  EXPECT_EQ(two_way_windows(frames, 8), (Windows{{0, 19, 19}, {20, 23, 31}, {24, 47, 55}, {48, 60, 60}}));
  frames[20].opens = true;
  EXPECT_EQ(two_way_windows(frames, 8), (Windows{{0, 19, 19}, {20, 23, 51}, {24, 47, 55}, {48, 60, 60}}));
}

TEST(TwoWayWindows, SeeNoFurtherThanIsNeeded) {
  const auto last_seen = [](std::int64_t first, std::int64_t first_wanted, std::int64_t last_wanted,
                            std::int64_t last_asked) {
    tools::SequenceScan scan = {scanned(first, 99, first_wanted)};
    for (ScannedFrame& frame : scan.frames)
      frame.wanted = frame.wanted && frame.number <= last_wanted;
    drop_unseen(scan, last_asked, 8);
    return scan.frames.back().number;
  };
  EXPECT_EQ(last_seen(0, 0, 47, 47), 55);
  EXPECT_EQ(last_seen(0, 0, 30, 47), 55);  // the others are there already
  EXPECT_EQ(last_seen(23, 23, 23, 23), 54);
  EXPECT_EQ(last_seen(23, 23, 24, 24), 54);
  EXPECT_EQ(last_seen(23, 24, 24, 24), 32);
  EXPECT_EQ(last_seen(23, 23, 22, 24), 99);  // none is wanted
}

class BothWays : public testing::SequenceTest {
 protected:
  static constexpr Extent kRender = {48, 30};
  static constexpr Extent kPicture = {96, 60};

  float noise_ = 0;        // variance of a sample, of its square
  float fade_ = 0;         // of the light, that each frame adds
  bool jittered_ = false;  // the motion holds the jitter
  std::string samples_;    // as Cycles has them; empty: it does not
  std::string albedo_;     // layer of it; empty: there is none

  struct Seen {
    float light[3], distance, speed_x, speed_y;  // output pixels a frame
  };

  // Value noise of two sizes.
  static float texture(double x, double y, std::uint32_t salt) {
    const auto cell = [salt](double u, double v) {
      const auto i = static_cast<std::uint32_t>(std::floor(u) + 4096);
      return testing::noise(salt, 0, static_cast<std::uint32_t>(std::floor(v) + 4096) * 8192 + i);
    };
    return .6f * cell(x / 5, y / 5) + .4f * cell(x / 1.7, y / 1.7);
  }

  static Seen seen_at(double x, double y, int time) {
    const double disc_x = x - (70 - 1.3 * time), disc_y = y - (26 + .2 * time);
    const bool disc = disc_x * disc_x + disc_y * disc_y < 14 * 14;
    const double u = disc ? disc_x : x - .7 * time, v = disc ? disc_y : y;
    const float value = texture(u, v, disc ? 2 : 1);
    return {{value, disc ? .2f : value, 1 - value}, disc ? 4.f : 9.f, disc ? -1.3f : .7f, disc ? .2f : 0.f};
  }

  static double halton(int index, int base) {
    double value = 0, part = 1;
    for (int i = index + 1; i > 0; i /= base)
      value += (part /= base) * (i % base);
    return value - .5;
  }

  // One file; `next`: names of the channels of motion to the next frame, as next - this or the other way.
  void write(int number, const std::vector<std::string>& next = {"forward.u", "forward.v"}, float sign = 1,
             float alpha = 1, Extent render = kRender, bool cut = false) {
    const Vec2 jitter = {static_cast<float>(halton(number % 16, 2)),
                         static_cast<float>(halton(number % 16, 3))};
    const Vec2 since = jittered_ ? Vec2{jitter.x - static_cast<float>(halton((number - 1) % 16, 2)),
                                        jitter.y - static_cast<float>(halton((number - 1) % 16, 3))}
                                 : Vec2{};
    std::vector<std::string> names = {"R", "G", "B", "A", "Z", "backward.u", "backward.v"};
    names.insert(names.end(), next.begin(), next.end());
    for (const char* channel : {".R", ".G", ".B"})
      if (!albedo_.empty()) names.push_back(albedo_ + channel);
    std::vector<std::vector<float>> planes(names.size());
    const double step_x = 1. * kPicture.width / render.width, step_y = 1. * kPicture.height / render.height;
    for (int y = 0; y < render.height; ++y) {
      for (int x = 0; x < render.width; ++x) {
        const Seen seen = seen_at(step_x * (x + .5 + jitter.x), step_y * (y + .5 + jitter.y), number);
        const auto u = static_cast<float>(seen.speed_x / step_x),
                   v = static_cast<float>(-seen.speed_y / step_y);
        const float chance = testing::noise(number + 2, 0, y * render.width + x) - .5f;  // variance 1/12
        const float light =
            alpha * (1 + std::sqrt(12 * noise_) * chance) * (1 + fade_ * static_cast<float>(number));
        const float values[] = {light * seen.light[0],
                                light * seen.light[1],
                                light * seen.light[2],
                                alpha,
                                seen.distance,
                                -u + since.x,
                                -v - since.y,
                                sign * u,
                                sign * v,
                                seen.light[0],
                                seen.light[1],
                                seen.light[2]};
        for (std::size_t c = 0; c < planes.size(); ++c)
          planes[c].push_back(values[c]);
      }
    }
    std::vector<tools::Channel> channels;
    for (std::size_t c = 0; c < planes.size(); ++c) {
      channels.push_back({.name = names[c],
                          .type = tools::ChannelType::kFloat,
                          .data = planes[c].data(),
                          .stored = tools::ChannelType::kFloat});
    }
    std::vector<tools::Attribute> attributes = {
        {"quincunx:jitter", jitter}, {"quincunx:outputSize", Vec2{kPicture.width, kPicture.height}}};
    if (!samples_.empty()) attributes.push_back({"cycles.ViewLayer.samples", samples_});
    if (cut) attributes.push_back({"quincunx:reset", 1});
    const Status status = tools::write_exr(input(number), render, channels, attributes);
    ASSERT_TRUE(status.ok()) << status.message();
  }

  void write_all(int first, int last) {
    for (int number = first; number <= last; ++number)
      write(number);
  }

  void expect_same_files(int first, int last, const std::string& name, const std::string& as = "u") const {
    for (int number = first; number <= last; ++number)
      EXPECT_TRUE(testing::read_file(output(number, as)) == testing::read_file(output(number, name)))
          << number;
  }

  std::vector<float> colours(const std::string& path) const {
    const tools::LoadedImage picture = image(path);
    std::vector<float> values;
    for (int y = 0; y < kPicture.height; ++y) {
      for (int x = 0; x < kPicture.width; ++x) {
        for (const char* channel : {"R", "G", "B", "A"})
          values.push_back(picture.at(x, y, picture.channel(channel)));
      }
    }
    return values;
  }

  static double psnr(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      sum += (a[i] - b[i]) * (a[i] - b[i]) / static_cast<double>(a.size());
    return -10 * std::log10(sum);
  }

  double psnr_of(const std::string& name, int number) const {
    constexpr int kSide = 4;
    std::vector<float> truth;
    for (int y = 0; y < kPicture.height; ++y) {
      for (int x = 0; x < kPicture.width; ++x) {
        float sum[3] = {};
        for (int i = 0; i < kSide * kSide; ++i) {
          const Seen seen =
              seen_at(x + (i % kSide + .5) / kSide, y + (std::floor(i / kSide) + .5) / kSide, number);
          for (int c = 0; c < 3; ++c)
            sum[c] += seen.light[c] / (kSide * kSide);
        }
        truth.insert(truth.end(), {sum[0], sum[1], sum[2], 1});
      }
    }
    return psnr(colours(output(number, name)), truth);
  }
};

TEST_F(BothWays, TheFirstFrameIsAsGoodAsLaterOnesAndNoneIsWorse) {
  write_all(1, 26);
  for (const char* method : {"temporal:fast", "temporal", "temporal:quality"}) {
    // `temporal` is refined both ways, as one way only `quality` is.
    const char* refined = method == std::string("temporal") ? "temporal:quality" : method;
    resolve_to("one", fmt::format("--method {} --two-way 0", refined));
    resolve_to("two", fmt::format("--method {} --two-way 8", method));
    double gain = 0;
    for (int number = 1; number <= 26; ++number) {
      const double one = psnr_of("one", number), two = psnr_of("two", number);
      EXPECT_GT(two, one - .1) << method << " " << number;
      if (number > 10 && number < 20) gain += (two - one) / 9;
    }
    // The last one knows no more: it is the same but for a rounding to halves, which files have, too, and for the
    // wider taps of `quality`.
    EXPECT_GT(psnr(colours(output(26, "one")), colours(output(26, "two"))), refined == method ? 70 : 45)
        << method;
    EXPECT_GT(psnr_of("two", 1), psnr_of("one", 1) + 2) << method;
    EXPECT_GT(psnr_of("two", 1), psnr_of("one", 20) - .3) << method;
    EXPECT_GT(gain, .3) << method;
  }
}

TEST_F(BothWays, EightFramesAheadAreTheDefaultWhereMotionToThemIsKnown) {
  write_all(1, 5);
  resolve_to("u", "");
  resolve_to("eight", "--two-way 8");
  resolve_to("zero", "--two-way 0");
  expect_same_files(1, 5, "eight");
  const std::string explained = resolve("'{}/f.%04d.exr' --explain").out;
  EXPECT_NE(explained.find("Both ways      8 frames ahead"), std::string::npos) << explained;
  EXPECT_NE(explained.find("\n  merge_histories "), std::string::npos) << explained;
  EXPECT_NE(explained.find("\n  merged history "), std::string::npos) << explained;
  for (int number = 1; number <= 5; ++number)
    write(number, {});
  resolve_to("u", "");
  expect_same_files(1, 5, "zero");
  EXPECT_EQ(resolve("'{}/f.%04d.exr' --explain").out.find("merge"), std::string::npos);
}

TEST_F(BothWays, NoiseThatIsToldIsTakenOutOfWhatIsShown) {
  noise_ = .25f;
  write_all(1, 10);
  for (const char* way :
       {"temporal:fast --two-way 0", "temporal --two-way 0", "temporal", "temporal:quality"}) {
    resolve_to("noisy", fmt::format("--method {}", way));
    resolve_to("denoised", fmt::format("--method {} --noise 4", way));
    for (int number = 1; number <= 10; ++number)
      EXPECT_GT(psnr_of("denoised", number), psnr_of("noisy", number) + .3) << way << " " << number;
  }
  samples_ = "4";
  write_all(1, 10);
  resolve_to("auto", "--method temporal:quality --noise auto");
  for (int number = 1; number <= 10; ++number)
    EXPECT_EQ(colours(output(number, "auto")), colours(output(number, "denoised"))) << number;
  samples_ = "65";  // clean
  write_all(1, 10);
  resolve_to("auto", "--method temporal:quality --noise auto");
  for (int number = 1; number <= 10; ++number)
    EXPECT_EQ(colours(output(number, "auto")), colours(output(number, "noisy"))) << number;
  EXPECT_NE(resolve("'{}/f.%04d.exr' --explain --noise 4").out.find("\n  temporal_denoise "),
            std::string::npos);
  EXPECT_EQ(resolve("'{}/f.%04d.exr' --explain").out.find("temporal_denoise"), std::string::npos);
}

TEST_F(BothWays, NoiseIsSeenInFramesThatDoNotTellIt) {
  write_all(1, 33);
  resolve_to("clean", "--frames 1-8");
  resolve_to("auto", "--noise auto --frames 1-8");
  expect_same_files(1, 8, "clean", "auto");
  fade_ = .1f;
  write_all(1, 33);
  EXPECT_EQ(resolve("'{}/f.%04d.exr' --explain --noise auto").out.find("temporal_denoise"),
            std::string::npos);
  fade_ = 0;
  for (const float noise : {.0625f, .25f}) {
    noise_ = noise;
    write_all(1, 33);
    resolve_to("noisy", "");
    resolve_to("told", fmt::format("--noise {}", 1 / noise));
    resolve_to("auto", "--noise auto");
    resolve_to("chunk", "--noise auto --frames 20-23");
    double told = 0, by_frames = 0;
    for (int number = 1; number <= 33; ++number) {
      told += psnr_of("told", number) - psnr_of("noisy", number);
      by_frames += psnr_of("auto", number) - psnr_of("noisy", number);
    }
    EXPECT_GT(told, 0) << noise;
    EXPECT_GT(by_frames, .75 * told) << noise;
    expect_same_files(20, 23, "auto", "chunk");
  }
}

TEST_F(BothWays, NoiseIsSeenWhereMotionHoldsTheJitter) {
  jittered_ = true;
  noise_ = .0625f;
  write_all(1, 33);
  const std::string options = "--velocity-jittered --two-way 0 --frames 20-33";
  resolve_to("noisy", options);
  resolve_to("told", options + " --noise 16");
  resolve_to("auto", options + " --noise auto");
  double told = 0, by_frames = 0;
  for (int number = 20; number <= 33; ++number) {
    told += psnr_of("told", number) - psnr_of("noisy", number);
    by_frames += psnr_of("auto", number) - psnr_of("noisy", number);
  }
  EXPECT_GT(told, 0);
  EXPECT_GT(by_frames, .75 * told);
}

TEST_F(BothWays, AlbedoKeepsWhatSurfacesShowFromWhatIsDenoised) {
  noise_ = .25f;
  write_all(1, 10);
  resolve_to("noisy", "");
  resolve_to("without", "--noise 4");
  for (const char* layer : {"Albedo", "ViewLayer.Denoising Albedo"}) {
    albedo_ = layer;
    write_all(1, 10);
    EXPECT_NE(
        resolve("'{}/f.%04d.exr' -n --noise 4").out.find(fmt::format("; albedo {0}.R,{0}.G,{0}.B;", layer)),
        std::string::npos);
    resolve_to("with", "--noise 4");
    for (int number = 1; number <= 10; ++number)
      EXPECT_GT(psnr_of("with", number), psnr_of("without", number) + .3) << layer << " " << number;
  }
  resolve_to("spilled", "--noise 4 --memory 0MB");
  resolve_to("clean", "");
  for (int number = 1; number <= 10; ++number) {
    EXPECT_EQ(colours(output(number, "spilled")), colours(output(number, "with"))) << number;
    EXPECT_EQ(colours(output(number, "clean")), colours(output(number, "noisy"))) << number;
  }
  EXPECT_EQ(resolve("'{}/f.%04d.exr' -n --noise 4 --two-way 0").out.find("albedo"), std::string::npos);
}

// What is read without history is a shot of its own: the frames after it may be another.
TEST_F(BothWays, WithoutHistoryThereIsNoFuture) {
  write_all(1, 12);
  const auto listing = resolve("'{}/f.%04d.exr' -n --frames 1-6 --warm-up 0 --json");
  EXPECT_NE(listing.out.find("\"history_only\": []"), std::string::npos) << listing.out;
  EXPECT_NE(resolve("'{}/f.%04d.exr' -n --frames 1-3").out.find("Read      12 frames: 1-12"),
            std::string::npos);
}

TEST_F(BothWays, MotionFromOtherRenderersIsReadInTheSenseOfTheirVelocity) {
  write_all(1, 12);
  resolve_to("u", "--two-way 4");
  for (int number = 1; number <= 12; ++number)
    write(number, {"Vector.Z", "Vector.W"}, -1);
  resolve_to("blender", "--two-way 4 --velocity-next Vector.Z,Vector.W");
  resolve_to("named",
             "--two-way 4 --velocity-next Vector.Z,Vector.W --velocity backward.u,backward.v "
             "--velocity-convention blender");
  for (int number = 1; number <= 12; ++number) {
    EXPECT_TRUE(colours(output(number)) == colours(output(number, "blender"))) << number;
    EXPECT_TRUE(colours(output(number)) == colours(output(number, "named"))) << number;
  }
}

// Where files have none, the next frame's motion is turned round: nearly as good.
TEST_F(BothWays, MotionToTheNextFrameIsMadeWhereItIsMissing) {
  write_all(1, 20);
  resolve_to("one", "--two-way 0");
  resolve_to("two", "--two-way 8");
  for (int number = 1; number <= 20; ++number)
    write(number, {});
  const auto listing = resolve("'{}/f.%04d.exr' -n --two-way 8");
  EXPECT_NE(listing.out.find("8 frames ahead by their own motion, turned round"), std::string::npos)
      << listing.out;
  resolve_to("made", "--two-way 8");
  double loss = 0;
  for (int number = 1; number <= 20; ++number) {
    const double made = psnr_of("made", number);
    EXPECT_GT(made, psnr_of("one", number) - .1) << number;
    loss += (psnr_of("two", number) - made) / 20;
  }
  EXPECT_LT(loss, .2);
}

TEST(TurnedMotion, IsThatOfTheSurfaceThatASampleShows) {
  // A wall that moves by a sample to the right, and before it a near thing at column 3 that moves to column 5.
  constexpr Extent kExtent = {8, 2};
  const auto samples = [&](int thing, float wall_speed, float thing_speed) {
    tools::MotionSamples made = {kExtent, {}, {}, {}};
    for (int i = 0; i < kExtent.area(); ++i) {
      const bool near = i % kExtent.width == thing;
      made.velocity.push_back({(near ? thing_speed : wall_speed) / 8, 0});
      made.depth.push_back(near ? .5f : .1f);
    }
    return made;
  };
  const auto turned = tools::turned_motion(samples(3, 0, 0), samples(5, 1, 2));
  for (std::size_t i = 0; i < turned.size(); ++i) {
    const int column = static_cast<int>(i) % kExtent.width;
    if (column == 4 || column == 7) {  // hidden by the thing; out of the picture
      EXPECT_TRUE(std::isnan(turned[i].x)) << i;
    } else {
      EXPECT_EQ(turned[i], (Vec2{column == 3 ? -.25f : -.125f, 0})) << i;
    }
  }
}

TEST_F(BothWays, NothingIsSeenBeyondACutAndOneFrameStandsAlone) {
  write_all(1, 12);
  resolve_to("u", "--two-way 8");
  write(14);
  resolve_to("gap", "--two-way 8 --skip-bad-frames");
  expect_same_files(1, 12, "gap");
  resolve_to("one", "--two-way 0 --frames 14 --warm-up 0 --method temporal:quality");  // refined, too
  // But for a rounding to halves.
  EXPECT_GT(psnr(colours(output(14, "gap")), colours(output(14, "one"))), 70);
  write(13, {"forward.u", "forward.v"}, 1, 1, kRender, true);
  resolve_to("cut", "--two-way 8");
  expect_same_files(1, 12, "cut");
}

TEST_F(BothWays, FramesThatAreOnlyLookedAheadToCountAsInAWholeRun) {
  write_all(1, 18);
  resolve_to("u", "--two-way 8");
  resolve_to("ten", "--two-way 8 --frames 1-10");
  expect_same_files(1, 10, "ten");
  EXPECT_FALSE(std::filesystem::exists(output(11, "ten")));
  resolve_to("third", "--two-way 8 --frames 3-18x3");
  for (int number = 3; number <= 18; number += 3)
    expect_same_files(number, number, "third");
  EXPECT_FALSE(std::filesystem::exists(output(4, "third")));
}

TEST_F(BothWays, AShotsFirstFrameLooksAsFarAheadWhereverItIs) {
  write_all(22, 60);
  write(46, {"forward.u", "forward.v"}, 1, 1, kRender, true);
  EXPECT_NE(resolve("'{}/f.%04d.exr' -n --frames 22-24").out.find("Read      32 frames: 22-53"),
            std::string::npos);
  resolve_to("u", "");
  for (const char* chunk : {"22-23", "24-47"})
    resolve_to("chunk", fmt::format("--frames {}", chunk));
  expect_same_files(22, 47, "chunk");
}

TEST_F(BothWays, FramesMayHaveOtherSizes) {
  const auto write_sizes = [this](const std::vector<std::string>& next) {
    for (int number = 1; number <= 20; ++number)
      write(number, next, 1, 1,
            number % 3 == 0   ? Extent{60, 36}
            : number % 3 == 1 ? kRender
                              : Extent{40, 34});
  };
  write_sizes({"forward.u", "forward.v"});
  resolve_to("one", "--two-way 0");
  resolve_to("two", "--two-way 8");
  write_sizes({});
  resolve_to("made", "--two-way 8");
  for (const char* name : {"two", "made"}) {
    double gain = 0;
    for (int number = 1; number <= 20; ++number) {
      const double difference = psnr_of(name, number) - psnr_of("one", number);
      EXPECT_GT(difference, -.1) << name << " " << number;
      gain += difference / 20;
    }
    EXPECT_GT(gain, .5) << name;
  }
}

// Its header is whole, so it shows where it is read: forwards, before those that know it are shown.
TEST_F(BothWays, AFrameAheadThatCannotBeReadIsNamedOnce) {
  write_all(1, 36);
  resolve_to("u", "--two-way 8");
  const std::string whole = testing::read_file(input(34));
  std::string broken = whole;
  std::fill(broken.end() - 800, broken.end() - 200, '\0');
  std::ofstream(input(34), std::ios::binary) << broken;
  const auto times_named = [this](const std::string& text) {
    const std::string complaint = "'" + input(34) + "' cannot be read";
    int times = 0;
    for (std::size_t at = 0; (at = text.find(complaint, at)) != std::string::npos; ++at)
      ++times;
    return times;
  };
  const std::string run = "'{}/f.%04d.exr' --out '{}/b.%04d.exr' --two-way 8";
  const auto stopped = resolve(run);
  EXPECT_EQ(stopped.exit_code, 1);
  EXPECT_EQ(times_named(stopped.err), 1) << stopped.err;
  expect_same_files(1, 23, "b");  // their window looks ahead to 32
  EXPECT_FALSE(std::filesystem::exists(output(24, "b")));
  const auto skipped = resolve(run + " --resume --skip-bad-frames");
  EXPECT_EQ(skipped.exit_code, 0) << skipped.err;
  EXPECT_EQ(times_named(skipped.err), 1) << skipped.err;
  for (int number = 24; number <= 36; ++number)
    EXPECT_EQ(std::filesystem::exists(output(number, "b")), number != 34) << number;
  std::filesystem::remove(input(34));  // as if it had never been there
  resolve_to("gap", "--two-way 8 --frames 24-36 --skip-bad-frames");
  expect_same_files(24, 33, "gap", "b");
  expect_same_files(35, 36, "gap", "b");
  for (int number = 24; number <= 33; ++number)
    std::filesystem::remove(output(number, "b"));
  for (const int number : {35, 36})
    std::filesystem::remove(output(number, "b"));
  std::ofstream(input(34), std::ios::binary) << whole;
  EXPECT_EQ(resolve(run + " --resume").exit_code, 0);
  expect_same_files(1, 36, "b");
}

TEST_F(BothWays, HistoriesBeyondMemoryGoIntoFilesThatVanish) {
  for (int number = 1; number <= 26; ++number)
    write(number, {"forward.u", "forward.v"}, 1, .5f);
  resolve_to("u", "--two-way 8 --blur 1");  // with alpha, velocity and depth
  const std::string temporary = folder_.file("temporary");
  std::filesystem::create_directory(temporary);
  const std::string run = "'{}/f.%04d.exr' --out '{}/%.%04d.exr' --two-way 8 --blur 1 --memory ";
  const auto resolve_in = [&](const std::string& shell, const std::string& name, const std::string& size) {
    std::string arguments = run + size;
    arguments.replace(arguments.find("%.%"), 1, name);
    return testing::run_program(folder_, arguments, (shell + " " QUINCUNX_PROGRAM).c_str());
  };
  const std::string in_folder = fmt::format("TMPDIR='{}'", temporary);
  for (const char* size : {"0.2MB", "0GB"}) {  // three frames; none
    const auto result = resolve_in(in_folder, "spilled", size);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("are put into files in '" + temporary), std::string::npos) << result.err;
    expect_same_files(1, 26, "spilled");
    EXPECT_TRUE(std::filesystem::is_empty(temporary));
  }
  EXPECT_EQ(resolve_in(in_folder, "held", "500MB").err.find("are put into files"), std::string::npos);
  expect_same_files(1, 26, "held");
  const auto refused = resolve_in("TMPDIR=/no/folder", "refused", "0MB");
  EXPECT_EQ(refused.exit_code, 1) << refused.err;
  EXPECT_NE(refused.err.find("folder '/no/folder' takes no temporary file of 0.1 MB: No such file"),
            std::string::npos)
      << refused.err;
  EXPECT_FALSE(std::filesystem::exists(output(1, "refused")));
}

TEST(SequenceHistories, NothingIsTakenTwice) {
  tools::SequenceHistories histories(100'000);
  ASSERT_TRUE(histories.put(3, {}).ok());
  EXPECT_TRUE(histories.take(3).ok());
  EXPECT_EQ(histories.take(3).status().message(), "no history is kept under the key 3");
}

TEST(SequenceHistories, AFullDiskIsRefusedInASentence) {
  tools::SequenceHistories histories(100'000);
  const KeptHistory kept = {1, std::vector<std::byte>(60'000, std::byte{3}), {}, {}, {std::byte{4}}};
  ASSERT_TRUE(histories.put(1, kept).ok());  // in memory
  rlimit before = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit full = {30'000, before.rlim_max};
  const auto on_signal = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &full), 0);
  const Status refused = histories.put(2, kept);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, on_signal);
  EXPECT_EQ(refused.code(), StatusCode::kIoFailure);
  EXPECT_NE(
      refused.message().find("takes no temporary file of 0.1 MB: File too large; say a larger --memory"),
      std::string::npos)
      << refused.message();
  ASSERT_TRUE(histories.put(2, kept).ok());
  for (const std::size_t key : {1, 2}) {
    const auto taken = histories.take(key);
    ASSERT_TRUE(taken.ok());
    EXPECT_EQ(taken->texels, kept.texels);
    EXPECT_EQ(taken->depth, kept.depth);
    EXPECT_TRUE(taken->alpha.empty());
  }
}

TEST_F(BothWays, ChunksOfWholeWindowsAndResumedRunsGiveTheSameBytes) {
  write_all(1, 36);
  resolve_to("u", "--two-way 6");
  resolve_to("chunk", "--two-way 6 --frames 1-23");
  resolve_to("chunk", "--two-way 6 --frames 24-36");
  expect_same_files(1, 36, "chunk");
  for (const int number : {1, 7, 8, 23, 30})
    std::filesystem::remove(output(number, "chunk"));
  resolve_to("chunk", "--two-way 6 --resume");
  expect_same_files(1, 36, "chunk");
}

TEST_F(BothWays, AlphaBlurAndPresentedPicturesFollow) {
  for (int number = 1; number <= 12; ++number)
    write(number, {"forward.u", "forward.v"}, 1, .5f);
  resolve_to("flat", "--two-way 6 --method temporal:fast");  // of one layer
  resolve_to("u", "--two-way 6");
  for (int number = 1; number <= 12; ++number) {
    const std::vector<float> values = colours(output(number, "flat"));
    for (std::size_t i = 3; i < values.size(); i += 4)
      ASSERT_NEAR(values[i], .5, 2e-3) << number;
  }
  resolve_to("blurred", "--two-way 6 --blur 2");
  resolve_to("one", "--two-way 0 --blur 2");
  for (int number = 6; number <= 12; ++number) {
    const std::vector<float> both = colours(output(number, "blurred")), one = colours(output(number, "one"));
    EXPECT_GT(psnr(both, one), 28) << number;
    EXPECT_LT(psnr(both, colours(output(number))), psnr(both, one)) << number;
  }
  // The last frame knows as much either way, but history's halves may round to the next code.
  for (const char* arguments :
       {"--out '{}/two.%04d.png' --two-way 6", "--out '{}/one.%04d.png' --two-way 0"}) {
    const auto result = resolve(std::string("'{}/f.%04d.exr' -q --method temporal:quality ") + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
  const auto farthest_code = [this](int number) {
    const tools::LoadedImage one = image(folder_.file(fmt::format("one.{:04}.png", number)));
    const tools::LoadedImage two = image(folder_.file(fmt::format("two.{:04}.png", number)));
    double farthest = 0;
    for (int i = 0; i < 3 * kPicture.area(); ++i) {
      const int x = i / 3 % kPicture.width, y = i / 3 / kPicture.width, channel = i % 3;
      farthest = std::max(farthest, 255. * std::abs(one.at(x, y, channel) - two.at(x, y, channel)));
    }
    return farthest;
  };
  EXPECT_LT(farthest_code(12), 1.01);
  EXPECT_GT(farthest_code(1), 20);
}

TEST_F(BothWays, WhatCannotBeIsRefusedInASentence) {
  write_all(1, 3);
  const auto refused = [this](const std::string& arguments, int code, const std::string& part) {
    expect_refused("'{}/f.%04d.exr' --out '{}/o/u.%04d.exr' " + arguments, code, part);
  };
  refused("--two-way 8 --method bilinear", 2, "it goes with --method temporal");
  refused("--two-way 65", 2, "--two-way");
  for (const char* size : {"2", "GB", "-1GB", "2KB"})
    refused(std::string("--memory ") + size, 2,
            fmt::format("--memory: '{}' is no size; write for example 2GB", size));
  refused("--two-way 8 --velocity-next Z", 2, "--velocity-next");
  refused("--two-way 8 --velocity-next no.u,no.v", 1, "has no channel 'no.u'");
  refused("--two-way 8 --output 30x20", 2, "--two-way merges histories, but frame 1 has 48x30 pixels");
  const auto listing = resolve("'{}/f.%04d.exr' -n --two-way 8 --velocity-next backward.u,backward.v");
  EXPECT_NE(listing.out.find("both ways, 8 frames ahead by backward.u,backward.v"), std::string::npos)
      << listing.out;
}

}  // namespace
}  // namespace quincunx

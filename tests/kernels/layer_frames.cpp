// SPDX-License-Identifier: MIT
#include "layer_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "../reference/reproject.h"

namespace quincunx::testing {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double as_float(double value) {
  return static_cast<double>(static_cast<float>(value));
}

// The surface at a place. Motion: this frame's place less the previous one's, output pixels.
struct Seen {
  double depth = 0;
  std::array<double, 2> motion = {};
};

Seen wall_at(double x) {
  return {.depth = .1 + .0003 * x, .motion = {1.3, -.4}};
}

// At an output position in frame 0 or 1: the nearest of the things there.
Seen wires_at(double x, double y, int frame) {
  Seen seen = wall_at(x);
  if (y > 50) seen.depth = .1 + .02 * (y - 50);  // a plane seen at a slant
  if (y > 50) seen.motion[1] = 8 * seen.depth;
  const auto cover = [&](double depth, double vx, double vy) {
    if (depth > seen.depth) seen = {depth, {vx, vy}};
  };
  if (x > 40 - 3 * frame && x < 47 - 3 * frame) cover(.2, -3, .7);  // thick
  const double wire = (x - 2.6 * frame) / 17;
  if (wire - std::floor(wire) < .1) {
    const bool speeds_up = static_cast<int>(std::floor(wire)) % 2 == 0;
    cover(.3, speeds_up ? 2.6 + .3 * frame : 2.6, 0);
  }
  const double rail = (y + .04 * x + 1.7 * frame) / 23;
  if (rail - std::floor(rail) < .07) cover(.25, .02, -1.7);
  const double close = (x + y) / 31;  // nearer by less than 3 %
  if (close - std::floor(close) < .05) cover(.102 + .0003 * x, -2, 2);
  return seen;
}

Seen noise_at(std::mt19937& random) {
  constexpr double kDepths[] = {.1, .102, .105, .2, .31, .5};
  constexpr double kMotions[][2] = {{0, 0}, {1.5, -.75}, {1.52, -.75}, {-6, 2}, {30, -40}};
  std::uniform_real_distribution<double> uniform(-1, 1);
  Seen seen{.depth = kDepths[random() % std::size(kDepths)]};
  const auto& motion = kMotions[random() % std::size(kMotions)];
  seen.motion = {motion[0], motion[1]};
  if (random() % 2 == 0) seen.motion = {motion[0] + uniform(random), motion[1] + .1 * uniform(random)};
  return seen;
}

// Some values that no scene has.
void damage(Seen& seen, std::mt19937& random, double largest_velocity) {
  const double velocities[] = {kNan, kInfinity, -kInfinity, largest_velocity, -largest_velocity, 1e-7};
  constexpr double kDepths[] = {kNan, kInfinity, -kInfinity, 0, -.2, 1e30};
  if (random() % 12 == 0) seen.motion[random() % 2] = velocities[random() % std::size(velocities)];
  if (random() % 12 == 0) seen.depth = kDepths[random() % std::size(kDepths)];
}

// Jitters that are no multiple of a small fraction, nor is their difference: no place is half-way between two by
// rounding, and no two are as far from one.
constexpr Vec2 kJitter = {.21f, -.17f};
constexpr Vec2 kPreviousJitter = {-.317f, .273f};

reference::LayerRecord to_reference(const LayerRecord& record) {
  const auto number = [](float value) { return static_cast<double>(value); };
  return {.place = {number(record.x), number(record.y)},
          .depth = number(record.depth),
          .motion = {number(record.motion_x), number(record.motion_y)},
          .drift = {number(record.drift_x), number(record.drift_y)},
          .is_thin = record.is_thin != 0};
}

std::size_t area(Extent extent) {
  return static_cast<std::size_t>(extent.area());
}

// Adds carried records to what a frame has left: of all ages, some of them beyond the borders, many in one place.
void add_carried(KernelGrid& grid, const LayerSpec& spec) {
  std::mt19937 random(spec.seed + 77);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto width = static_cast<float>(spec.output.width), height = static_cast<float>(spec.output.height);
  for (std::size_t i = 0; i < grid.keys.size(); ++i) {
    if (grid.keys[i] != 0 || random() % 6 != 0) continue;
    const auto cell = static_cast<float>(i);
    const auto columns = static_cast<float>(spec.previous.width);
    LayerRecord record{.x = (std::fmod(cell, columns) + .5f + .4f * uniform(random)) * width / columns,
                       .y = (std::floor(cell / columns) + .5f + .4f * uniform(random)) * height /
                            static_cast<float>(spec.previous.height),
                       .depth = .2f + .1f * uniform(random),
                       .motion_x = 3 * uniform(random),
                       .motion_y = 3 * uniform(random),
                       .drift_x = .2f * uniform(random),
                       .drift_y = .2f * uniform(random),
                       .is_thin = random() % 4 != 0 ? 1 : 0};
    if (random() % 8 == 0) record.motion_x = record.x - .37f * width;  // they meet in a column
    if (random() % 8 == 0) record.motion_y = 2 * height * uniform(random);
    if (random() % 40 == 0) record.motion_x = 3e9f * uniform(random);
    grid.keys[i] = to_key({.age = static_cast<int>(random() % 9), .origin = static_cast<int>(i)});
    grid.records[i] = record;
  }
}

// Returns reproject's findings for the frame: motion edges, either sign, and poison elsewhere where nothing reads it.
std::vector<Pixel> make_reprojection(const LayerFrames& in, const LayerSpec& spec) {
  std::mt19937 random(spec.seed + 99);
  const reference::ReprojectOptions options{.output_width = spec.output.width,
                                            .output_height = spec.output.height};
  reference::Frame previous = in.reference.frame;  // matters to no motion edge
  std::vector<Pixel> made;
  for (int y = 0; y < spec.render.height; ++y) {
    for (int x = 0; x < spec.render.width; ++x) {
      const double edge =
          reference::reproject<double>(in.reference.frame, previous, options, x, y).motion_edge;
      made.push_back({.25, -.5, .75, as_float(random() % 2 == 0 ? edge : -1.5 * edge)});
    }
  }
  return made;
}

// Returns open trusts, with a minus sign where there is a motion edge.
std::vector<float> make_open_trust(const LayerFrames& in, const LayerSpec& spec) {
  constexpr double kEdgeMin = static_cast<double>(.05f);  // px
  std::mt19937 random(spec.seed + 5);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<float> made;
  for (const Pixel& sample : in.reprojection)
    made.push_back(std::copysign(uniform(random), std::abs(sample[3]) > kEdgeMin ? -1.f : 1.f));
  return made;
}

}  // namespace

std::vector<LayerVariant> layer_variants() {
  return {{}, {.velocity = PixelFormat::kRG32F}, {.storage = Storage::kImage}};
}

std::string name_of(const LayerVariant& v) {
  return fmt::format("{}_{}", v.storage == Storage::kImage ? "image" : "buffer",
                     quincunx::name_of(v.velocity));
}

std::string name_of(const LayerSpec& spec) {
  return fmt::format("{}x{} after {}x{} -> {}x{}, surfaces {}, seed {}{}", spec.render.width,
                     spec.render.height, spec.previous.width, spec.previous.height, spec.output.width,
                     spec.output.height, static_cast<int>(spec.surfaces), spec.seed,
                     spec.first ? ", first" : "");
}

std::vector<LayerSpec> all_layer_specs() {
  std::vector<LayerSpec> specs;
  unsigned seed = 0;
  for (const Extent output : {Extent{1, 1}, Extent{7, 5}, Extent{64, 64}, Extent{129, 77}}) {
    for (const auto& scale :
         {Vec2{.33f, .4f}, Vec2{.5f, .71f}, Vec2{1, 1}, Vec2{1.37f, .05f}, Vec2{.02f, .9f}}) {
      for (const Surfaces surfaces : {Surfaces::kWires, Surfaces::kNoise, Surfaces::kNonFinite}) {
        const Extent render = scaled(output, static_cast<double>(scale.x), static_cast<double>(scale.y));
        LayerSpec spec{.output = output, .render = render, .previous = render, .surfaces = surfaces};
        spec.seed = ++seed;
        spec.first = seed % 7 == 0;
        if (seed % 3 == 0) spec.previous = {render.width + 3, std::max(render.height - 2, 1)};
        if (seed % 5 == 0) spec.previous = {std::max(render.width / 2, 1), render.height * 2};
        specs.push_back(spec);
      }
    }
  }
  return specs;
}

cl_uint to_key(const reference::RecordCell& cell) {
  if (!cell.has_record()) return 0;
  return static_cast<cl_uint>(15 - cell.age) << 28 | (0x0fffffffu - static_cast<cl_uint>(cell.origin));
}

reference::RecordGrid to_reference(const KernelGrid& grid) {
  reference::RecordGrid made;
  for (const cl_uint key : grid.keys) {
    reference::RecordCell cell;
    if (key != 0)
      cell = {.age = 15 - static_cast<int>(key >> 28),
              .origin = static_cast<int>(0x0fffffffu - (key & 0x0fffffffu))};
    made.cells.push_back(cell);
  }
  for (const LayerRecord& record : grid.records)
    made.records.push_back(to_reference(record));
  return made;
}

std::unique_ptr<PassRig> RecordStages::rig(const char* kernel) const {
  ResolveSettings settings{
      .method = Method::kTemporal, .velocity = variant_.velocity, .targets = {.storage = variant_.storage}};
  return std::make_unique<PassRig>(SceneNeeds{.background = true}, settings, kernel);
}

RecordStages::RecordStages(const LayerVariant& variant)
    : variant_(variant),
      records_(rig("layer_records")),
      turn_(rig("turn_records")),
      advect_(rig("advect_records")),
      split_(rig("layer_split")) {}

TestFrame RecordStages::surfaces(Rig& rig, const LayerSpec& spec, bool is_previous) const {
  const Extent render = is_previous ? spec.previous : spec.render;
  const Vec2 jitter = is_previous ? kPreviousJitter : kJitter;
  std::mt19937 random(spec.seed + (is_previous ? 1000 : 0));
  std::uniform_real_distribution<double> uniform(-.01, .01);
  const double largest = variant_.velocity == PixelFormat::kRG16F ? 65504 : 1e36;
  std::vector<Pixel> velocity, depth;
  TestFrame frame;
  for (int y = 0; y < render.height; ++y) {
    for (int x = 0; x < render.width; ++x) {
      Seen seen;
      if (spec.surfaces == Surfaces::kWires) {
        seen = wires_at((x + .5 + static_cast<double>(jitter.x)) * spec.output.width / render.width,
                        (y + .5 + static_cast<double>(jitter.y)) * spec.output.height / render.height,
                        is_previous ? 0 : 1);
        seen.motion[0] += uniform(random);
      } else if (spec.surfaces == Surfaces::kWall) {
        seen = wall_at((x + .5 + static_cast<double>(jitter.x)) * spec.output.width / render.width);
      } else {
        seen = noise_at(random);
      }
      if (spec.surfaces == Surfaces::kNonFinite) damage(seen, random, largest);
      velocity.push_back({seen.motion[0] / spec.output.width, seen.motion[1] / spec.output.height, 0, 0});
      depth.push_back({seen.depth, 0, 0, 0});
    }
  }
  frame.inputs.render_extent = render;
  frame.inputs.jitter = jitter;
  frame.inputs.velocity =
      rig.image(variant_.velocity, variant_.storage, render, velocity, spec.outside, spec.tight);
  frame.inputs.depth =
      rig.image(PixelFormat::kR32F, variant_.storage, render, depth, spec.outside, spec.tight);
  frame.reference.width = render.width;
  frame.reference.height = render.height;
  frame.reference.jitter_x = static_cast<double>(jitter.x);
  frame.reference.jitter_y = static_cast<double>(jitter.y);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    frame.reference.velocity.push_back(
        {stored_value(variant_.velocity, velocity[i][0]), stored_value(variant_.velocity, velocity[i][1])});
    frame.reference.depth.push_back(as_float(depth[i][0]));
  }
  return frame;
}

LayerFrames RecordStages::frames(Rig& rig, const LayerSpec& spec) {
  const auto of = [&](const TestFrame& current, const TestFrame& previous) {
    LayerFrames in;
    in.current = current.inputs;
    in.previous = previous.inputs;
    in.reference.frame = current.reference;
    in.reference.previous_width = previous.reference.width;
    in.reference.previous_height = previous.reference.height;
    in.reference.previous_jitter = {previous.reference.jitter_x, previous.reference.jitter_y};
    in.reference.output_width = spec.output.width;
    in.reference.output_height = spec.output.height;
    in.before = {std::vector<cl_uint>(previous.reference.depth.size()),
                 std::vector<LayerRecord>(previous.reference.depth.size())};
    return in;
  };
  const TestFrame before = surfaces(rig, spec, true);
  const TestFrame now = surfaces(rig, spec, false);
  LayerFrames in = of(now, before);
  if (!spec.first) {
    LayerSpec earlier = spec;
    earlier.render = spec.previous;
    LayerFrames alone = of(before, before);
    alone.reprojection = make_reprojection(alone, earlier);
    alone.open_trust = make_open_trust(alone, earlier);
    in.before = find_records(rig, alone, earlier);
    add_carried(in.before, spec);
  }
  in.reference.before = to_reference(in.before);
  in.reprojection = make_reprojection(in, spec);
  in.open_trust = make_open_trust(in, spec);
  return in;
}

KernelGrid RecordStages::find_records(Rig& rig, const LayerFrames& in, const LayerSpec& spec) {
  const GuardedBuffer open_trust(in.open_trust);
  const GuardedBuffer previous_keys(in.before.keys);
  const GuardedBuffer previous_records(in.before.records);
  const GuardedBuffer keys(std::vector<cl_uint>(area(spec.render), 0x12345678));
  const GuardedBuffer records(std::vector<LayerRecord>(area(spec.render)));
  records_->run(in.current, in.previous, spec.output, rig.counter(),
                {{Resource::kOpenTrust, open_trust.view()},
                 {Resource::kPreviousRecordKeys, previous_keys.view()},
                 {Resource::kPreviousRecords, previous_records.view()},
                 {Resource::kRecordKeys, keys.view()},
                 {Resource::kRecords, records.view()}});
  return {keys.elements(), records.elements()};
}

LayerFrames RecordStages::turn_records(Rig& rig, LayerFrames in, const LayerSpec& spec,
                                       const KernelGrid& found) {
  const GuardedBuffer previous_keys(in.before.keys);
  const GuardedBuffer previous_records(in.before.records);
  const GuardedBuffer keys(found.keys);
  const GuardedBuffer records(found.records);
  turn_->run(in.current, in.previous, spec.output, rig.counter(),
             {{Resource::kPreviousRecordKeys, previous_keys.view()},
              {Resource::kRecordKeys, keys.view()},
              {Resource::kRecords, records.view()},
              {Resource::kPreviousRecords, previous_records.view()}});
  in.before.records = previous_records.elements();
  in.reference.before = to_reference(in.before);
  return in;
}

KernelGrid RecordStages::advect_records(Rig& rig, const LayerFrames& in, const LayerSpec& spec,
                                        const KernelGrid& found) {
  const GuardedBuffer previous_keys(in.before.keys);
  const GuardedBuffer previous_records(in.before.records);
  const GuardedBuffer keys(found.keys);
  advect_->run(in.current, in.previous, spec.output, rig.counter(),
               {{Resource::kPreviousRecordKeys, previous_keys.view()},
                {Resource::kPreviousRecords, previous_records.view()},
                {Resource::kRecordKeys, keys.view()}});
  return {keys.elements(), found.records};
}

KernelGrid RecordStages::run_records(Rig& rig, LayerFrames& in, const LayerSpec& spec) {
  const KernelGrid found = find_records(rig, in, spec);
  in = turn_records(rig, in, spec, found);
  return advect_records(rig, in, spec, found);
}

RecordStages::Split RecordStages::run_split(Rig& rig, const LayerFrames& in, const LayerSpec& spec,
                                            const KernelGrid& now) {
  const ImageView reprojection = rig.image(PixelFormat::kRGBA32F, Storage::kBuffer, spec.render,
                                           in.reprojection, spec.outside, spec.tight);
  const Extent tiles = extent_of(Area::kTiles, {spec.render, spec.previous, spec.output});
  const GuardedBuffer open_trust(in.open_trust);
  const GuardedBuffer previous_keys(in.before.keys);
  const GuardedBuffer keys(now.keys);
  const GuardedBuffer previous_records(in.before.records);
  const GuardedBuffer records(now.records);
  const GuardedBuffer splits(std::vector<LayerSplit>(area(spec.render), {-7, -7, -7, -7}));
  const GuardedBuffer marks(std::vector<cl_int>(area(tiles)));
  split_->run(in.current, in.previous, spec.output, rig.counter(),
              {{Resource::kReprojection, reprojection},
               {Resource::kOpenTrust, open_trust.view()},
               {Resource::kPreviousRecordKeys, previous_keys.view()},
               {Resource::kRecordKeys, keys.view()},
               {Resource::kPreviousRecords, previous_records.view()},
               {Resource::kRecords, records.view()},
               {Resource::kSplits, splits.view()},
               {Resource::kSplitMarks, marks.view()}});
  Split made{splits.elements(),     marks.elements(),
             records.elements(),    rig.pixels(reprojection, spec.render),
             open_trust.elements(), rig.bytes(reprojection, spec.render)};
  const auto append = [&](const auto& elements) {
    const auto bytes = bytes_of(elements);
    made.bytes.insert(made.bytes.end(), bytes.begin(), bytes.end());
  };
  append(made.splits);
  append(made.marks);
  append(made.records);
  append(made.open_trust);
  return made;
}

}  // namespace quincunx::testing

// SPDX-License-Identifier: MIT
#include "temporal_fixture.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "kernel_options.h"
#include "program_cache.h"

namespace quincunx::testing {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double as_float(double value) {
  return static_cast<double>(static_cast<float>(value));
}

Extent tile_count(const reference::TemporalInputs& in) {
  return {in.tiles_x(), in.tiles_y()};
}

// A random number of each zone of the picture, and of each sample in it.
class Zones {
 public:
  explicit Zones(unsigned seed) : seed_(seed) {}
  std::mt19937 of(int x, int y) const {
    return std::mt19937(seed_ + static_cast<unsigned>(7919 * x + 104729 * y));
  }

 private:
  unsigned seed_;
};

// Output pixels a frame; thresholds of the kernels lie well between them.
constexpr double kZoneMoves[][2] = {{0, 0},     {0, 0},       {-.37, 0},   {3, -2},
                                    {.25, 1.8}, {-9.3, 14.6}, {2.6, -700}, {.3, .45}};

// Zones of 40 x 24 output pixels: three of four move as one.
std::vector<reference::Move> make_moves(const reference::TemporalInputs& in, unsigned seed) {
  const Zones zones(seed);
  std::mt19937 random(seed + 1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<reference::Move> moves;
  for (int y = 0; y < in.frame.height; ++y) {
    for (int x = 0; x < in.frame.width; ++x) {
      std::mt19937 zone =
          zones.of(static_cast<int>(x * in.spacing(0) / 40), static_cast<int>(y * in.spacing(1) / 24));
      const bool rigid = zone() % 4 != 0;
      const auto& motion = kZoneMoves[zone() % std::size(kZoneMoves)];
      reference::Move move{.x = motion[0], .y = motion[1], .trust = 1};
      if (rigid && zone() % 3 == 0 && random() % 30 == 0) move.trust = .75;
      if (rigid && zone() % 3 == 0 && random() % 30 == 0) move.contrast = as_float(uniform(random) - .5);
      if (!rigid) {
        const double spread = zone() % 2 == 0 ? 1 : .02;  // little enough to show one surface
        move = {.x = spread * (12 * uniform(random) - 6),
                .y = spread * (8 * uniform(random) - 4),
                .trust = uniform(random)};
        if (random() % 2 == 0) move.trust = 1;
        if (random() % 20 == 0) move.trust = 0;
        if (random() % 2 == 0) move.contrast = as_float(3 * uniform(random) - 1.5);
        if (random() % 50 == 0) move = {.trust = kNan};
      }
      move.x = as_float(move.x / in.move_scale(0));
      move.y = as_float(move.y / in.move_scale(1));
      move.trust = as_float(move.trust);
      moves.push_back(move);
    }
  }
  return moves;
}

std::vector<reference::Tile> make_tiles_before(const reference::TemporalInputs& in, bool moves,
                                               unsigned seed) {
  const Zones zones(seed);
  std::vector<reference::Tile> tiles;
  for (int y = 0; y < in.tiles_y(); ++y) {
    for (int x = 0; x < in.tiles_x(); ++x) {
      std::mt19937 zone = zones.of(x / 4, y / 3);
      std::uniform_real_distribution<double> uniform(-.5, .5);
      reference::Tile tile;
      if (moves && zone() % 2 == 0) tile.offset = {as_float(uniform(zone)), as_float(uniform(zone))};
      tile.persistence = as_float(uniform(zone));
      tiles.push_back(tile);
    }
  }
  return tiles;
}

std::vector<Pixel> make_history(const reference::TemporalInputs& in, PixelFormat format, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Pixel> history;
  for (int i = 0; i < in.output_width * in.output_height; ++i) {
    Pixel texel = {3 * uniform(random), uniform(random), 2 * uniform(random), 32 * uniform(random)};
    if (random() % 4 == 0) texel[3] = 2 * uniform(random);
    if (random() % 8 == 0) texel[3] = .3 * uniform(random);
    if (random() % 32 == 0) texel = {};
    for (double& value : texel)
      value = stored_value(format, value);
    history.push_back(texel);
  }
  return history;
}

}  // namespace

std::string name_of(const StageVariant& v) {
  return fmt::format("{}{}_{}_{}_history_{}_to_{}", v.moves ? "moving" : "still",
                     v.reactive ? "_reactive" : "", v.storage == Storage::kImage ? "image" : "buffer",
                     quincunx::name_of(v.colour), quincunx::name_of(v.history),
                     quincunx::name_of(v.resolved));
}

TemporalTile to_kernel(const reference::Tile& tile) {
  const auto number = [](const reference::Bounded& value) { return static_cast<float>(value.value); };
  return {.offset_x = number(tile.offset[0]),
          .offset_y = number(tile.offset[1]),
          .source_x = number(tile.source[0]),
          .source_y = number(tile.source[1]),
          .step_x = tile.step[0],
          .step_y = tile.step[1],
          .rigid = tile.rigid ? 1 : 0,
          .plain = tile.plain ? 1 : 0,
          .torn = tile.torn ? 1 : 0,
          .brightening = number(tile.brightening),
          .light = number(tile.light),
          .history_error = number(tile.history_error),
          .neighbour_error = number(tile.neighbour_error),
          .count = static_cast<float>(tile.samples),
          .brighter = static_cast<float>(tile.brighter),
          .persistence = number(tile.persistence),
          .flicker = number(tile.flicker),
          .doubt = number(tile.doubt),
          .gain = number(tile.gain)};
}

reference::Tile to_reference(const TemporalTile& tile) {
  const auto number = [](float value) { return static_cast<double>(value); };
  return {.offset = {number(tile.offset_x), number(tile.offset_y)},
          .source = {number(tile.source_x), number(tile.source_y)},
          .step = {tile.step_x, tile.step_y},
          .rigid = tile.rigid != 0,
          .plain = tile.plain != 0,
          .torn = tile.torn != 0,
          .brightening = number(tile.brightening),
          .light = number(tile.light),
          .history_error = number(tile.history_error),
          .neighbour_error = number(tile.neighbour_error),
          .persistence = number(tile.persistence),
          .flicker = number(tile.flicker),
          .doubt = number(tile.doubt),
          .gain = number(tile.gain),
          .samples = static_cast<int>(tile.count),
          .brighter = static_cast<int>(tile.brighter)};
}

StageInputs TemporalStages::inputs(Rig& rig, const StageSpec& spec) const {
  std::vector<Pixel> colour = pattern_pixels(spec.colour, spec.render, spec.seed);
  for (Pixel& pixel : colour) {
    for (double& value : pixel)
      value = std::abs(value);  // light
  }
  const TestFrame made = make_frame(
      rig, {.storage = variant_.storage, .colour = variant_.colour, .with_reactive = variant_.reactive},
      {.render = spec.render,
       .jitter = spec.jitter,
       .seed = spec.seed,
       .outside = spec.outside,
       .tight = spec.tight},
      colour);
  StageInputs in;
  in.frame = made.inputs;
  reference::TemporalInputs& out = in.reference;
  out.frame = made.reference;
  out.judged_apart = spec.seed % 2 == 0 ? 2 : 4;
  out.previous_width = spec.previous.width;
  out.previous_height = spec.previous.height;
  out.output_width = spec.output.width;
  out.output_height = spec.output.height;
  out.history = make_history(out, variant_.history, spec.seed + 1000);
  out.before = make_tiles_before(out, variant_.moves, spec.seed + 2000);
  if (variant_.reactive) {
    const TestFrame previous = make_frame(
        rig, {.storage = variant_.storage, .with_reactive = true},
        {.render = spec.previous, .seed = spec.seed + 500, .outside = spec.outside, .tight = spec.tight});
    in.reactive_before = previous.inputs.reactive;
    out.reactive_before = previous.reference.reactive;
  }
  if (!variant_.moves) return in;
  out.moves = make_moves(out, spec.seed + 3000);
  std::vector<Pixel> moves;
  for (const reference::Move& move : out.moves)
    moves.push_back({move.x, move.y, move.trust, move.contrast});
  in.moves = rig.image(PixelFormat::kRGBA32F, Storage::kBuffer, spec.render, moves, spec.outside, spec.tight);
  return in;
}

std::vector<reference::Tile> TemporalStages::tiles(const StageInputs& in, unsigned seed) const {
  const Zones zones(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<reference::Tile> made;
  for (const reference::Tile& tile : reference::temporal_tiles(in.reference)) {
    reference::Tile exact = to_reference(to_kernel(tile));
    const int i = static_cast<int>(made.size());
    std::mt19937 zone = zones.of(i % in.reference.tiles_x() / 5, i / in.reference.tiles_x() / 4);
    if (zone() % 3 == 0) exact.doubt = as_float(uniform(zone));
    if (zone() % 3 == 0) exact.gain = as_float(.25 + 2 * uniform(zone));
    made.push_back(exact);
  }
  return made;
}

ResolvePlan TemporalStages::plan(TemporalPreset preset) const {
  ResolvePlan plan;
  plan.settings = {.method = Method::kTemporal,
                   .colour = variant_.colour,
                   .resolved = variant_.resolved,
                   .storage = variant_.storage};
  plan.settings.temporal = {.preset = preset, .history = variant_.history};
  plan.velocity = variant_.moves ? VelocitySource::kTarget : VelocitySource::kNone;
  plan.reads_reactive = variant_.reactive;
  return plan;
}

cl::Buffer TemporalStages::history(const StageInputs& in) const {
  return to_device(encode(variant_.history, in.reference.history));
}

namespace {

// Built once for all sizes and inputs.
cl::Kernel kernel(const std::string& name, const std::string& options) {
  // Never destroyed: some OpenCL layers are gone before static objects are.
  static auto& built = *new std::map<std::string, cl::Kernel>;
  const auto found = built.find(name + options);
  if (found != built.end()) return found->second;
  return built.emplace(name + options, build_kernel(impl(), name, options)).first->second;
}

cl::Buffer tiles_to_device(const std::vector<reference::Tile>& tiles) {
  std::vector<TemporalTile> made;
  for (const reference::Tile& tile : tiles)
    made.push_back(to_kernel(tile));
  return to_device(made);
}

SourceFrame source_of(const StageInputs& in) {
  return {.width = in.reference.frame.width,
          .height = in.reference.frame.height,
          .colour = layout_of(in.frame.colour),
          .velocity = {},
          .reactive = {}};
}

float to_float(double value) {
  return static_cast<float>(value);
}

}  // namespace

TemporalStages::Tiles TemporalStages::run_tiles(const StageInputs& in) const {
  const reference::TemporalInputs& r = in.reference;
  const Extent count = tile_count(r);
  TemporalTileParams params{};
  params.frame = source_of(in);
  params.output_width = r.output_width;
  params.output_height = r.output_height;
  params.tiles_x = count.width;
  params.tiles_y = count.height;
  params.moves = variant_.moves ? layout_of(in.moves) : TexelLayout{};
  params.spacing_x = to_float(r.spacing(0));
  params.spacing_y = to_float(r.spacing(1));
  params.start_x = to_float((.5 + r.frame.jitter_x) * r.spacing(0));
  params.start_y = to_float((.5 + r.frame.jitter_y) * r.spacing(1));
  params.move_x = to_float(r.move_scale(0));
  params.move_y = to_float(r.move_scale(1));
  params.judged_apart = r.judged_apart;
  const cl::Buffer before = tiles_to_device(r.before);
  const cl::Buffer now = to_device(std::vector<TemporalTile>(r.before.size()));
  const cl::Buffer total = to_device(std::vector<TotalLight>(1));
  cl::Kernel tiles = kernel("temporal_tiles", temporal_tiles_options(plan(TemporalPreset::kBalanced)));
  tiles.setArg(0, params);
  set_memory(tiles, 1, in.frame.colour.memory);
  set_memory(tiles, 2, variant_.moves ? in.moves.memory : before());
  const cl::Buffer known = history(in);
  tiles.setArg(3, known);
  tiles.setArg(4, before);
  tiles.setArg(5, now);
  tiles.setArg(6, total);
  enqueue_rows(impl(), impl().queue, tiles, count, 1, nullptr);
  return {from_device<TemporalTile>(now, r.before.size()), from_device<TotalLight>(total, 1).front()};
}

std::vector<TemporalTile> TemporalStages::run_light(Extent tiles, const std::vector<reference::Tile>& before,
                                                    const TotalLight& total,
                                                    const std::vector<reference::Tile>& now) const {
  const cl::Buffer changed = tiles_to_device(now);
  cl::Kernel light = kernel("temporal_light", "");
  light.setArg(0, tiles.width);
  light.setArg(1, tiles.height);
  const cl::Buffer previous = tiles_to_device(before);
  const cl::Buffer sums = to_device(std::vector<TotalLight>{total});
  light.setArg(2, previous);
  light.setArg(3, sums);
  light.setArg(4, changed);
  enqueue_rows(impl(), impl().queue, light, tiles, 1, nullptr);
  return from_device<TemporalTile>(changed, now.size());
}

TemporalStages::Result TemporalStages::run_resolve(Rig& rig, const StageInputs& in,
                                                   const std::vector<reference::Tile>& tiles,
                                                   TemporalPreset preset) const {
  const reference::TemporalInputs& r = in.reference;
  const Extent output{r.output_width, r.output_height};
  PositionTables tables(impl(), output);
  const ImageView view = rig.output(variant_.resolved, output);
  const Counter counter = rig.counter();
  TemporalParams params{};
  params.output_width = output.width;
  params.output_height = output.height;
  params.frame0 = source_of(in);
  params.frame1.width = r.previous_width;
  params.frame1.height = r.previous_height;
  if (variant_.reactive) {
    params.frame0.reactive = layout_of(in.frame.reactive);
    params.frame1.reactive = layout_of(in.reactive_before);
  }
  params.moves = variant_.moves ? layout_of(in.moves) : TexelLayout{};
  params.view = kViewPicture;
  params.output = layout_of(view);
  params.columns = tables.columns();
  params.counter = counter.index;
  params.columns_per_item = columns_per_item(impl(), output.width, kReprojectedBlock);
  params.move_x = to_float(r.move_scale(0));
  params.move_y = to_float(r.move_scale(1));
  params.spacing_x = to_float(r.spacing(0));
  params.spacing_y = to_float(r.spacing(1));
  params.tiles_x = r.tiles_x();
  params.tiles_y = r.tiles_y();
  const std::size_t bytes = r.history.size() * bytes_per_pixel(variant_.history);
  const cl::Buffer updated = to_device(std::vector<unsigned char>(bytes, 0x7f));
  const cl::Buffer before = tiles_to_device(r.before);
  cl::Kernel resolve = kernel("resolve_temporal", temporal_options(plan(preset)));
  resolve.setArg(0, params);
  resolve.setArg(1, tables.get(impl().queue, in.frame.render, in.frame.jitter));
  set_memory(resolve, 2, in.frame.colour.memory);
  set_memory(resolve, 3, variant_.moves ? in.moves.memory : before());
  set_memory(resolve, 4, (variant_.reactive ? in.frame.reactive : in.frame.colour).memory);
  set_memory(resolve, 5, (variant_.reactive ? in.reactive_before : in.frame.colour).memory);
  const cl::Buffer known = history(in);
  const cl::Buffer now = tiles_to_device(tiles);
  resolve.setArg(6, known);
  resolve.setArg(7, before);
  resolve.setArg(8, now);
  resolve.setArg(9, updated);
  set_memory(resolve, 10, view.memory);
  set_memory(resolve, 11, counter.memory);
  enqueue_rows(impl(), impl().queue, resolve, output, params.columns_per_item, nullptr);
  Result result{from_device<unsigned char>(updated, bytes), {}, rig.count(counter)};
  result.pixels = decode(variant_.history, result.bytes);
  return result;
}

TemporalStages::Result TemporalStages::run_display(Rig& rig, const StageInputs& in,
                                                   const std::vector<reference::Tile>& tiles,
                                                   const Shown& shown) const {
  const reference::TemporalInputs& r = in.reference;
  const Extent output{r.output_width, r.output_height};
  PositionTables tables(impl(), output);
  const ImageView view = rig.output(variant_.resolved, output);
  TemporalDisplayParams params{};
  params.output_width = output.width;
  params.output_height = output.height;
  params.frame0 = source_of(in);
  params.output = layout_of(view);
  params.tiles_x = r.tiles_x();
  params.columns = tables.columns();
  params.columns_per_item = columns_per_item(impl(), output.width, kTemporalTile);
  ResolvePlan display_plan = plan(shown.preset);
  display_plan.needs.background = shown.background;
  params.first = shown.first ? 1 : 0;
  cl::Kernel display = kernel("temporal_display", temporal_display_options(display_plan));
  display.setArg(0, params);
  display.setArg(1, tables.get(impl().queue, in.frame.render, in.frame.jitter));
  set_memory(display, 2, in.frame.colour.memory);
  const cl::Buffer known = history(in);
  const cl::Buffer now = tiles_to_device(tiles);
  display.setArg(3, now);
  display.setArg(4, known);
  set_memory(display, 5, view.memory);
  enqueue_rows(impl(), impl().queue, display, output, params.columns_per_item, nullptr);
  Result result{rig.bytes(view, output), {}, 0};
  result.pixels = decode(variant_.resolved, result.bytes);
  return result;
}

}  // namespace quincunx::testing

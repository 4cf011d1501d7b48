// SPDX-License-Identifier: MIT
#include "temporal_fixture.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "device/program_cache.h"
#include "pass_rig.h"
#include "passes/frame_params.h"
#include "resolve_params.h"

namespace quincunx::testing {

std::string name_of(const StageVariant& v) {
  return fmt::format(
      "{}{}{}{}_{}_{}_history_{}_to_{}", v.moves ? "moving" : "still", v.reactive ? "_reactive" : "",
      v.alpha    ? "_alpha"
      : v.layers ? "_layered"
                 : "",
      v.checkerboard ? "_checkerboard" : "", v.storage == Storage::kImage ? "image" : "buffer",
      quincunx::name_of(v.colour), quincunx::name_of(v.history), quincunx::name_of(v.resolved));
}

KernelTile to_kernel(const reference::Tile& tile) {
  const auto number = [](double value) { return static_cast<float>(value); };
  const auto& [reprojection, evidence, light] = tile;
  KernelTile made;
  static_cast<TileReprojection&>(made) = {.phase_x = number(reprojection.phase[0]),
                                          .phase_y = number(reprojection.phase[1]),
                                          .source_phase_x = number(reprojection.source_phase[0]),
                                          .source_phase_y = number(reprojection.source_phase[1]),
                                          .step_x = reprojection.step[0],
                                          .step_y = reprojection.step[1],
                                          .is_rigid = reprojection.is_rigid ? 1 : 0,
                                          .is_trusted = reprojection.is_trusted ? 1 : 0,
                                          .has_motion_edge = reprojection.has_motion_edge ? 1 : 0};
  static_cast<TileEvidence&>(made) = {.brightening = number(evidence.brightening),
                                      .light = number(evidence.light),
                                      .history_error = number(evidence.history_error),
                                      .neighbour_error = number(evidence.neighbour_error),
                                      .count = static_cast<float>(evidence.count),
                                      .brighter = static_cast<float>(evidence.brighter),
                                      .outliers = static_cast<float>(evidence.outliers),
                                      .lag = number(evidence.lag),
                                      .lit = number(evidence.lit),
                                      .cells = {}};
  static_cast<TileLight&>(made) = {.gain = number(light.gain),
                                   .rejection = number(light.rejection),
                                   .cut = number(light.cut),
                                   .new_cut = number(light.new_cut),
                                   .persistence = number(light.persistence),
                                   .confirmation = number(light.confirmation),
                                   .recent_outliers = number(light.recent_outliers),
                                   .holds_back = light.holds_back ? 1 : 0,
                                   .trend = number(light.trend),
                                   .cells = {}};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& cell = evidence.cells[i];
    static_cast<TileEvidence&>(made).cells[i] = {number(cell.brightening), static_cast<float>(cell.brighter),
                                                 static_cast<float>(cell.count)};
    const auto& lit = light.cells[i];
    static_cast<TileLight&>(made).cells[i] = {number(lit.rejection), number(lit.mean_brightening),
                                              number(lit.flicker), number(lit.suspicion), number(lit.drift)};
  }
  return made;
}

LayerSplit to_kernel(const reference::LayerSplit& split) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  if (!split.is_split()) return {kNan, kNan, kNan, kNan};
  return {.near_depth = static_cast<float>(split.near_depth),
          .far_depth = static_cast<float>(split.far_depth),
          .motion_x = static_cast<float>(split.motion[0]),
          .motion_y = static_cast<float>(split.motion[1])};
}

LayerTile to_kernel(const reference::LayerTile& tile) {
  return {.phase_x = static_cast<float>(tile.phase[0]),
          .phase_y = static_cast<float>(tile.phase[1]),
          .between = static_cast<float>(tile.between),
          .motion_range = static_cast<float>(tile.motion_range),
          .is_rigid = tile.is_rigid ? 1 : 0,
          .is_split = tile.is_split ? 1 : 0,
          .is_layered = tile.is_layered ? 1 : 0};
}

reference::Tile to_reference(const KernelTile& tile) {
  const auto number = [](float value) { return static_cast<double>(value); };
  reference::Tile made{
      .reprojection = {.phase = {number(tile.phase_x), number(tile.phase_y)},
                       .source_phase = {number(tile.source_phase_x), number(tile.source_phase_y)},
                       .step = {tile.step_x, tile.step_y},
                       .is_rigid = tile.is_rigid != 0,
                       .is_trusted = tile.is_trusted != 0,
                       .has_motion_edge = tile.has_motion_edge != 0},
      .evidence = {.brightening = number(tile.brightening),
                   .light = number(tile.light),
                   .history_error = number(tile.history_error),
                   .neighbour_error = number(tile.neighbour_error),
                   .count = static_cast<int>(tile.count),
                   .brighter = static_cast<int>(tile.brighter),
                   .outliers = static_cast<int>(tile.outliers),
                   .lag = number(tile.lag),
                   .lit = number(tile.lit),
                   .cells = {}},
      .light = {.gain = number(tile.gain),
                .rejection = number(tile.rejection),
                .cut = number(tile.cut),
                .new_cut = number(tile.new_cut),
                .persistence = number(tile.persistence),
                .confirmation = number(tile.confirmation),
                .recent_outliers = number(tile.recent_outliers),
                .holds_back = tile.holds_back != 0,
                .trend = number(tile.trend),
                .cells = {}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const CellEvidence& cell = tile.TileEvidence::cells[i];
    made.evidence.cells[i] = {number(cell.brightening), static_cast<int>(cell.count),
                              static_cast<int>(cell.brighter)};
    const CellLight& lit = tile.TileLight::cells[i];
    made.light.cells[i] = {number(lit.rejection), number(lit.mean_brightening), number(lit.flicker),
                           number(lit.suspicion), number(lit.drift)};
  }
  return made;
}

std::vector<unsigned char> encode_plane(PixelFormat texels, const std::vector<double>& values) {
  std::vector<Pixel> fours((values.size() + 3) / 4);
  for (std::size_t i = 0; i < values.size(); ++i)
    fours[i / 4][i % 4] = values[i];
  return encode(texels, fours);
}

std::vector<double> decode_plane(PixelFormat texels, const std::vector<unsigned char>& bytes,
                                 std::size_t count) {
  std::vector<double> values;
  for (const Pixel& four : decode(texels, bytes))
    values.insert(values.end(), four.begin(), four.end());
  values.resize(count);
  return values;
}

PlanFacts TemporalStages::facts(TemporalPreset preset) const {
  ResolveSettings settings{.method = Method::kTemporal,
                           .colour = variant_.colour,
                           .targets = {.storage = variant_.storage},
                           .output = {.linear = variant_.resolved}};
  if (variant_.checkerboard) settings.targets.shading = Shading::kCheckerboard;
  settings.temporal = {.preset = preset, .history = variant_.history};
  return {{.moving_objects = variant_.moves,
           .camera_motion = variant_.moves,
           .transparents = variant_.reactive,
           .background = !variant_.alpha},
          settings};
}

std::vector<Pixel> before_change(std::vector<Pixel> texels, const Exposure& exposure) {
  for (Pixel& texel : texels) {
    for (std::size_t c = 0; c < 3; ++c)
      texel[c] /= static_cast<double>(exposure.change);
  }
  return texels;
}

cl::Buffer TemporalStages::history(const StageInputs& in) const {
  return to_device(encode(variant_.history, before_change(in.reference.history, in.exposure)));
}

// Any memory where the kernels read none.
cl::Buffer TemporalStages::history_alpha(const StageInputs& in) const {
  return variant_.alpha ? to_device(encode_plane(variant_.history, in.reference.history_alpha)) : history(in);
}

namespace {

Extent tile_count(const reference::TemporalInputs& in) {
  return {in.tiles_x(), in.tiles_y()};
}

// Built once for all sizes and inputs.
cl::Kernel kernel(const std::string& name, const std::string& options) {
  // Never destroyed: some OpenCL layers are gone before static objects are.
  static auto& built = *new std::map<std::string, cl::Kernel>;
  const auto found = built.find(name + options);
  if (found != built.end()) return found->second;
  return built.emplace(name + options, build_kernel(impl(), name, options)).first->second;
}

// Returns the options of a variant with one layer only.
std::string without_layers(std::string options) {
  const std::string layers = "LAYERS=1";
  const std::size_t found = options.find(layers);
  if (found != std::string::npos) options.replace(found, layers.size(), "LAYERS=0");
  return options;
}

// One of the structs that make a KernelTile, of each tile.
template <typename Part>
std::vector<Part> parts_of(const std::vector<reference::Tile>& tiles) {
  std::vector<Part> parts;
  for (const reference::Tile& tile : tiles)
    parts.push_back(to_kernel(tile));
  return parts;
}

// Each element as the kernels hold it.
template <typename Element>
auto all_to_kernel(const std::vector<Element>& elements) {
  std::vector<decltype(to_kernel(elements.front()))> made;
  for (const Element& element : elements)
    made.push_back(to_kernel(element));
  return made;
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
  params.reprojection = variant_.moves ? layout_of(in.reprojection) : TexelLayout{};
  params.spacing_x = to_float(r.spacing(0));
  params.spacing_y = to_float(r.spacing(1));
  params.start_x = to_float((.5 + r.frame.jitter_x) * r.spacing(0));
  params.start_y = to_float((.5 + r.frame.jitter_y) * r.spacing(1));
  params.motion_x = to_float(r.reprojection_scale(0));
  params.motion_y = to_float(r.reprojection_scale(1));
  params.parity = r.parity;
  const cl::Buffer before = to_device(parts_of<TileReprojection>(r.before));
  const cl::Buffer now = to_device(std::vector<TileReprojection>(r.before.size()));
  const cl::Buffer evidence = to_device(std::vector<TileEvidence>(r.before.size()));
  const cl::Buffer total = to_device(std::vector<TotalLight>(1));
  const std::string options = spec_of(facts(TemporalPreset::kBalanced), "temporal_tiles").options;
  cl::Kernel tiles = kernel("temporal_tiles", variant_.layers ? options : without_layers(options));
  tiles.setArg(0, params);
  set_memory(tiles, 1, in.frame.colour.memory);
  set_memory(tiles, 2, variant_.moves ? in.reprojection.memory : before());
  const cl::Buffer known = history(in);
  tiles.setArg(3, known);
  tiles.setArg(4, before);
  set_memory(tiles, 5, (variant_.layers ? in.frame.depth : in.frame.colour).memory);
  tiles.setArg(6, variant_.layers ? layout_of(in.frame.depth) : TexelLayout{});
  const cl::Buffer splits = variant_.layers ? to_device(all_to_kernel(r.splits)) : before;
  const cl::Buffer marks = variant_.layers ? to_device(r.split_marks) : before;
  const cl::Buffer layers_before = variant_.layers ? to_device(all_to_kernel(r.layers_before)) : before;
  const cl::Buffer layers = to_device(std::vector<LayerTile>(r.before.size()));
  tiles.setArg(7, splits);
  tiles.setArg(8, marks);
  tiles.setArg(9, layers_before);
  tiles.setArg(10, layers);
  const cl::Buffer listed = to_device(std::vector<cl_int>(r.before.size()));
  tiles.setArg(11, listed);
  tiles.setArg(12, now);
  tiles.setArg(13, evidence);
  tiles.setArg(14, total);
  const cl::Buffer exposure = to_device(std::vector<Exposure>{in.exposure});
  tiles.setArg(15, exposure);
  enqueue_rows(impl().profile.shape, impl().queue, tiles, count,
               columns_per_item(impl().profile.shape, count.width, 1), nullptr);
  const auto reprojections = from_device<TileReprojection>(now, r.before.size());
  const auto found = from_device<TileEvidence>(evidence, r.before.size());
  Tiles made{{},
             from_device<LayerTile>(layers, r.before.size()),
             from_device<cl_int>(listed, r.before.size()),
             from_device<TotalLight>(total, 1).front()};
  made.listed.resize(static_cast<std::size_t>(made.total.layered));
  for (std::size_t i = 0; i < found.size(); ++i)
    made.tiles.push_back({reprojections[i], found[i], {}});
  return made;
}

std::vector<TileLight> TemporalStages::run_light(Extent tiles, const std::vector<reference::Tile>& before,
                                                 const TotalLight& total,
                                                 const std::vector<reference::Tile>& now) const {
  const cl::Buffer reprojections = to_device(parts_of<TileReprojection>(now));
  const cl::Buffer evidence = to_device(parts_of<TileEvidence>(now));
  const cl::Buffer previous = to_device(parts_of<TileLight>(before));
  const cl::Buffer changed = to_device(std::vector<TileLight>(now.size()));
  const cl::Buffer sums = to_device(std::vector<TotalLight>{total});
  cl::Kernel light = kernel("temporal_light", "");
  light.setArg(0, tiles.width);
  light.setArg(1, tiles.height);
  light.setArg(2, reprojections);
  light.setArg(3, evidence);
  light.setArg(4, sums);
  light.setArg(5, previous);
  light.setArg(6, changed);
  enqueue_rows(impl().profile.shape, impl().queue, light, tiles,
               columns_per_item(impl().profile.shape, tiles.width, 1), nullptr);
  return from_device<TileLight>(changed, now.size());
}

TemporalStages::Result TemporalStages::run_resolve(Rig& rig, const StageInputs& in,
                                                   const std::vector<reference::Tile>& tiles,
                                                   const ResolveVariant& how) const {
  const reference::TemporalInputs& r = in.reference;
  const Extent output{r.output_width, r.output_height};
  PositionTables tables(impl(), output);
  const ImageView view = rig.output(variant_.resolved, output);
  const Counter counter = rig.counter();
  TemporalParams params{};
  params.parity = r.parity;
  params.output_width = output.width;
  params.output_height = output.height;
  params.frame0 = source_of(in);
  params.frame1.width = r.previous_width;
  params.frame1.height = r.previous_height;
  if (variant_.reactive) {
    params.frame0.reactive = layout_of(in.frame.reactive);
    params.frame1.reactive = layout_of(in.reactive_before);
  }
  params.reprojection = variant_.moves ? layout_of(in.reprojection) : TexelLayout{};
  params.output = layout_of(view);
  params.columns = position_columns(output);
  params.counter = counter.index;
  params.columns_per_item = columns_per_item(impl().profile.shape, output.width, 1);
  params.motion_x = to_float(r.reprojection_scale(0));
  params.motion_y = to_float(r.reprojection_scale(1));
  params.spacing_x = to_float(r.spacing(0));
  params.spacing_y = to_float(r.spacing(1));
  params.tiles_x = r.tiles_x();
  params.tiles_y = r.tiles_y();
  const std::size_t bytes = r.history.size() * bytes_per_pixel(variant_.history);
  const cl::Buffer updated = to_device(std::vector<unsigned char>(bytes, 0x7f));
  const std::size_t alpha_bytes = (r.history.size() + 3) / 4 * bytes_per_pixel(variant_.history);
  const cl::Buffer updated_alpha = to_device(std::vector<unsigned char>(alpha_bytes, 0x7f));
  const cl::Buffer before = to_device(parts_of<TileReprojection>(r.before));
  const std::string options = spec_of(facts(how.preset), "resolve_temporal").options;
  cl::Kernel resolve = kernel("resolve_temporal", how.layers.empty() ? without_layers(options) : options);
  resolve.setArg(0, params);
  resolve.setArg(1, tables.get(impl().queue, {output, in.frame.render_extent, in.frame.jitter}));
  set_memory(resolve, 2, in.frame.colour.memory);
  set_memory(resolve, 3, variant_.moves ? in.reprojection.memory : before());
  set_memory(resolve, 4, (variant_.reactive ? in.frame.reactive : in.frame.colour).memory);
  set_memory(resolve, 5, (variant_.reactive ? in.reactive_before : in.frame.colour).memory);
  const cl::Buffer known = history(in);
  const cl::Buffer now = to_device(parts_of<TileReprojection>(tiles));
  const cl::Buffer light = to_device(parts_of<TileLight>(tiles));
  const cl::Buffer known_alpha = history_alpha(in);
  resolve.setArg(6, known);
  resolve.setArg(7, known_alpha);
  resolve.setArg(8, before);
  resolve.setArg(9, now);
  resolve.setArg(10, light);
  const cl::Buffer layers = how.layers.empty() ? before : to_device(how.layers);
  resolve.setArg(11, layers);
  resolve.setArg(12, updated);
  resolve.setArg(13, updated_alpha);
  set_memory(resolve, 14, view.memory);
  set_memory(resolve, 15, counter.memory);
  const cl::Buffer exposure = to_device(std::vector<Exposure>{in.exposure});
  resolve.setArg(16, exposure);
  enqueue_rows(impl().profile.shape, impl().queue, resolve, output, params.columns_per_item, nullptr,
               kTemporalTile);
  Result result{from_device<unsigned char>(updated, bytes), {}, {}, rig.count(counter)};
  result.pixels = decode(variant_.history, result.bytes);
  if (!variant_.alpha) return result;
  const auto made = from_device<unsigned char>(updated_alpha, alpha_bytes);
  result.alpha = decode_plane(variant_.history, made, r.history.size());
  result.bytes.insert(result.bytes.end(), made.begin(), made.end());
  return result;
}

TemporalStages::Result TemporalStages::run_display(Rig& rig, const StageInputs& in,
                                                   const std::vector<reference::Tile>& tiles,
                                                   const Shown& shown) const {
  const reference::TemporalInputs& r = in.reference;
  const Extent output{r.output_width, r.output_height};
  const ImageView view = rig.output(variant_.resolved, output);
  TemporalDisplayParams params{};
  params.output_width = output.width;
  params.output_height = output.height;
  params.output = layout_of(view);
  params.tiles_x = r.tiles_x();
  params.columns_per_item = columns_per_item(impl().profile.shape, output.width, 1);
  params.first = shown.first ? 1 : 0;
  cl::Kernel display = kernel("temporal_display", spec_of(facts(shown.preset), "temporal_display").options);
  display.setArg(0, params);
  const cl::Buffer known = history(in);
  const cl::Buffer now = to_device(parts_of<TileReprojection>(tiles));
  const cl::Buffer known_alpha = history_alpha(in);
  display.setArg(1, now);
  display.setArg(2, known);
  display.setArg(3, known_alpha);
  set_memory(display, 4, view.memory);
  const cl::Buffer exposure = to_device(std::vector<Exposure>{in.exposure});
  display.setArg(5, exposure);
  enqueue_rows(impl().profile.shape, impl().queue, display, output, params.columns_per_item, nullptr,
               kTemporalTile);
  Result result{rig.bytes(view, output), {}, {}, 0};
  result.pixels = decode(variant_.resolved, result.bytes);
  return result;
}

}  // namespace quincunx::testing

// SPDX-License-Identifier: MIT
#include "c_interface/c_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "c_interface/sized_struct.h"
#include "quincunx/c/settings.h"

namespace quincunx::c {
namespace {

struct GivenImage {
  ImageView view;
  HostMemory host;
};

Status bad(const char* name, const std::string& what) {
  return Status::invalid(fmt::format("{}.{}", name, what));
}

// Checks what validate() cannot know of images in host memory.
Status check_host(const char* name, const quincunx_image& image, const ImageView& view) {
  const std::size_t row = static_cast<std::size_t>(std::max(image.width, 0)) * bytes_per_pixel(view.format);
  if (image.offset != 0)
    return bad(name, fmt::format("offset is {}; in host memory it must be 0", image.offset));
  if (image.pitch != 0 && image.pitch < row) {
    return bad(name, fmt::format("pitch is {}; a row of {} texels of {} takes {}", image.pitch, image.width,
                                 name_of(view.format), row));
  }
  const std::size_t rows = static_cast<std::size_t>(std::max(image.height, 1));
  if (image.pitch > std::numeric_limits<std::ptrdiff_t>::max() / rows) {
    return bad(name, fmt::format("pitch is {}; no memory holds {} such rows, and none lies before the first",
                                 image.pitch, rows));
  }
  return {};
}

// `storage` is what an image in host memory passes for.
Result<GivenImage> read_image(const char* name, const quincunx_image* given, Storage storage) {
  if (given == nullptr) return GivenImage();
  quincunx_image image = {};
  if (Status status = read_sized(given, name, image); !status.ok()) return status;
  if (image.place < QUINCUNX_BUFFER || image.place > QUINCUNX_HOST) {
    return bad(name, fmt::format("place is {}; it must lie in [0, {}]", image.place, int{QUINCUNX_HOST}));
  }
  if (image.format < QUINCUNX_R8 || image.format > QUINCUNX_RGBA32F) {
    return bad(name, fmt::format("format is {}; it must lie in [{}, {}]", image.format, int{QUINCUNX_R8},
                                 int{QUINCUNX_RGBA32F}));
  }
  if (image.memory == nullptr) return bad(name, "memory is NULL; it must be a cl_mem or host memory");
  GivenImage made;
  made.view = {.memory = static_cast<cl_mem>(image.memory),
               .storage = image.place == QUINCUNX_HOST ? storage : static_cast<Storage>(image.place),
               .format = static_cast<PixelFormat>(image.format),
               .extent = {image.width, image.height},
               .offset = image.offset,
               .pitch = image.pitch};
  if (image.place != QUINCUNX_HOST) return made;
  made.view.pitch = 0;
  const std::size_t row =
      static_cast<std::size_t>(std::max(image.width, 0)) * bytes_per_pixel(made.view.format);
  made.host = {image.memory, image.pitch != 0 ? image.pitch : row};
  const Status status = check_host(name, image, made.view);
  return status.ok() ? Result<GivenImage>(made) : status;
}

Status read_into(const char* name, const quincunx_image* given, Storage storage, ImageView& view,
                 HostMemory& host) {
  auto image = read_image(name, given, storage);
  if (!image.ok()) return image.status();
  view = image->view;
  host = image->host;
  return {};
}

Status read_images(const ResolvePlan& plan, const CInputs& from, FrameInputs& to, HostInputs& host) {
  for (std::size_t i = 0; i < std::size(kInputs); ++i) {
    const InputImage& input = kInputs[i];
    // Nothing of what the plan does not read is checked or copied.
    if (input.viewport != nullptr && planned_for(plan, input) == nullptr) continue;
    const Storage storage = input.viewport != nullptr ? plan.settings.targets.storage : Storage::kBuffer;
    if (Status status = read_into(input.name_in_c(), input.in_c(from), storage, to.*input.image, host[i]);
        !status.ok())
      return status;
  }
  return {};
}

void read_numbers(const quincunx_inputs& from, FrameInputs& to) {
  to.render_extent = {from.render_width, from.render_height};
  to.output_extent = {from.output_width, from.output_height};
  to.jitter = {from.jitter_x, from.jitter_y};
  to.velocity_scale = {from.velocity_scale_x, from.velocity_scale_y};
  const auto& matrix = from.clip_to_previous_clip;
  const bool stands_still =
      std::all_of(std::begin(matrix), std::end(matrix), [](float element) { return element == 0; });
  if (!stands_still) std::copy(std::begin(matrix), std::end(matrix), to.camera.clip_to_previous_clip.begin());
  to.near_plane = from.near_plane;
  to.far_plane = from.far_plane;
  to.exposure = from.exposure;
  to.reset = from.reset != 0;
  to.parity = from.parity;
  to.frame_index = from.frame_index;
}

Status read_sync(const quincunx_sync* given, FrameSync& to) {
  if (given == nullptr) return {};
  quincunx_sync sync = {};
  if (Status status = read_sized(given, "sync", sync); !status.ok()) return status;
  to.done = reinterpret_cast<cl_event*>(sync.done);
  if (to.done != nullptr) *to.done = nullptr;
  if (sync.wait_count < 0)
    return Status::invalid(fmt::format("sync.wait_count is {}; it must be at least 0", sync.wait_count));
  if (sync.wait_count > 0 && sync.wait_for == nullptr) {
    return Status::invalid(fmt::format("sync.wait_for is NULL; it must point to {} events", sync.wait_count));
  }
  to.wait_for = {reinterpret_cast<const cl_event*>(sync.wait_for), static_cast<std::size_t>(sync.wait_count)};
  for (const auto& [name, semaphores, count, span] :
       {std::tuple("wait_semaphore", sync.wait_semaphores, sync.wait_semaphore_count, &to.wait_semaphores),
        std::tuple("signal_semaphore", sync.signal_semaphores, sync.signal_semaphore_count,
                   &to.signal_semaphores)}) {
    if (count < 0 || (count > 0 && semaphores == nullptr)) {
      return Status::invalid(
          fmt::format("sync.{0}_count is {1}; {0}s must point to so many, at least 0", name, count));
    }
    *span = {reinterpret_cast<Semaphore* const*>(semaphores), static_cast<std::size_t>(count)};
  }
  return {};
}

// All of a frame but its focus.
Status read_inputs(const ResolvePlan& plan, const quincunx_inputs& in, FrameInputs& to, HostInputs& host) {
  CInputs from = {.frame = in};
  from.fade.weight = 1;
  if (in.particles != nullptr) {
    if (Status status = read_sized(in.particles, "particles", from.particles); !status.ok()) return status;
  }
  if (in.fade != nullptr) {
    if (Status status = read_sized(in.fade, "fade", from.fade); !status.ok()) return status;
    if (from.fade.from == nullptr) return Status::invalid("fade.from is NULL; it must point to an image");
  }
  if (Status status = read_images(plan, from, to, host); !status.ok()) return status;
  read_numbers(in, to);
  to.particle_render_extent = {from.particles.render_width, from.particles.render_height};
  to.fade_weight = from.fade.weight;
  return {};
}

Status read_rectangles(const quincunx_focus& from, FocusInputs& to) {
  to.rectangle_count = from.rectangle_count;
  if (from.rectangle_count <= 0 || from.rectangle_count > FocusInputs::kMaxRectangles) return {};
  if (from.rectangles == nullptr) {
    return Status::invalid(
        fmt::format("focus.rectangles is NULL; it must point to {} of them", from.rectangle_count));
  }
  for (int i = 0; i < from.rectangle_count; ++i) {
    const quincunx_rectangle& where = from.rectangles[i];
    to.rectangles[static_cast<std::size_t>(i)] = {where.x, where.y, where.width, where.height};
  }
  return {};
}

Status read_focus(const ResolvePlan& plan, const quincunx_focus* given, Frame& frame) {
  if (given == nullptr) return {};
  const std::optional<ResolvePlan> region = plan.focus_plan();
  if (!region)
    return Status::invalid(
        "focus is given, but the plan has none; set settings.focus_width and focus_height");
  quincunx_focus focus = {};
  quincunx_inputs inputs = {};
  if (Status status = read_sized(given, "focus", focus); !status.ok()) return status;
  if (Status status = read_sized(focus.frame, "focus.frame", inputs); !status.ok()) return status;
  if (inputs.focus != nullptr)
    return Status::invalid("focus.frame.focus is given; a focus has none of its own");
  if (inputs.sync != nullptr)
    return Status::invalid("focus.frame.sync is given; it belongs to the picture's frame");
  FocusInputs to;
  if (Status status = read_inputs(*region, inputs, to.frame, frame.host_focus); !status.ok())
    return Status::invalid("of focus.frame: " + status.message());
  to.x = focus.x;
  to.y = focus.y;
  to.feather = focus.feather;
  if (Status status = read_rectangles(focus, to); !status.ok()) return status;
  if (plan.settings.focus.mask) {
    const Status status = read_into("focus.mask", focus.mask, Storage::kBuffer, to.mask, frame.host_mask);
    if (!status.ok()) return status;
  }
  frame.focus = to;
  return {};
}

Status read_outputs(const ResolvePlan& plan, const quincunx_outputs& out, Frame& frame) {
  if (Status status =
          read_into("linear", out.linear, Storage::kBuffer, frame.outputs.linear, frame.host_outputs[0]);
      !status.ok())
    return status;
  return read_into("presented", out.presented, plan.presented_storage(), frame.outputs.presented,
                   frame.host_outputs[1]);
}

}  // namespace

Result<Frame> checked_frame(const ResolvePlan& plan, const quincunx_inputs* inputs,
                            const quincunx_outputs* outputs) {
  quincunx_inputs in = {};
  quincunx_outputs out = {};
  Frame frame;
  if (Status status = read_sized(inputs, "inputs", in); !status.ok()) return status;
  if (Status status = read_sync(in.sync, frame.sync); !status.ok()) return status;
  if (Status status = read_sized(outputs, "outputs", out); !status.ok()) return status;
  if (Status status = read_inputs(plan, in, frame.inputs, frame.host_inputs); !status.ok()) return status;
  if (Status status = read_focus(plan, in.focus, frame); !status.ok()) return status;
  if (Status status = read_outputs(plan, out, frame); !status.ok()) return status;
  const Status status = frame.focus ? validate(plan, frame.inputs, *frame.focus, frame.outputs)
                                    : validate(plan, frame.inputs, frame.outputs);
  return status.ok() ? Result<Frame>(frame) : in_c_words(status);
}

Result<ImageView> memory_object(const char* name, const quincunx_image* image) {
  if (image == nullptr) return Status::invalid(fmt::format("{} is NULL; it must point to one", name));
  auto read = read_image(name, image, Storage::kBuffer);
  if (!read.ok()) return read.status();
  if (read->host.texels != nullptr) return bad(name, "place is host memory; it must be a memory object");
  return read->view;
}

Result<quincunx_report> read_report(const quincunx_report* report) {
  if (Status status = check_size(report, "report"); !status.ok()) return status;
  quincunx_report own = {};
  std::memcpy(&own, report, std::min(report->struct_size, sizeof(own)));
  if ((own.passes != nullptr || own.in_focus != nullptr) && own.pass_capacity < 0) {
    return Status::invalid(
        fmt::format("report.pass_capacity is {}; it must be at least 0", own.pass_capacity));
  }
  if (own.content != nullptr) {
    if (Status status = check_size(own.content, "report.content"); !status.ok()) return status;
  }
  return own;
}

void write_report(const FrameReport& from, quincunx_report report, quincunx_report* to) {
  report.pass_count = static_cast<int>(from.passes.size());
  report.frame_index = from.frame_index;
  report.non_finite_pixels = from.non_finite_pixels;
  report.render_width = from.render_extent.width;
  report.render_height = from.render_extent.height;
  report.ratio_x = from.ratio.x;
  report.ratio_y = from.ratio.y;
  report.used_previous = from.used_previous;
  report.output_width = from.output_extent.width;
  report.output_height = from.output_extent.height;
  report.focused = from.focused;
  report.content_known = from.content.has_value();
  report.motion = sentence_of(from.motion.verdict);
  report.motion_margin_db = from.motion.margin_db;
  for (int i = 0; i < std::min(report.pass_count, report.pass_capacity); ++i) {
    const PassReport& pass = from.passes[static_cast<std::size_t>(i)];
    if (report.passes != nullptr) report.passes[i] = {pass.kernel, pass.ms, pass.bytes};
    if (report.in_focus != nullptr) report.in_focus[i] = pass.in_focus;
  }
  if (report.content != nullptr && from.content) write_sized(content_to_c(*from.content), report.content);
  write_sized(report, to);
}

quincunx_content content_to_c(const ContentStatistics& content) {
  quincunx_content to = {};
  to.moving = content.moving;
  to.speed_px = content.speed_px;
  to.apart = content.apart;
  to.thin = content.thin;
  to.light = content.light;
  to.zoom = content.zoom;
  to.cut = content.cut;
  to.judged = content.judged;
  return to;
}

Result<ContentStatistics> content_of(const quincunx_content* given) {
  quincunx_content content = {};
  if (Status status = read_sized(given, "content", content); !status.ok()) return status;
  const ContentStatistics to = {.moving = content.moving,
                                .speed_px = content.speed_px,
                                .apart = content.apart,
                                .thin = content.thin,
                                .light = content.light,
                                .zoom = content.zoom,
                                .cut = content.cut != 0,
                                .judged = content.judged != 0};
  Status status = check(to);
  return status.ok() ? Result<ContentStatistics>(to) : status;
}

namespace {

Status make(const Device& device, Image& image, Extent extent, const ImageView& like) {
  if (image) return {};
  auto made = device.allocate(extent, like.format, like.storage);
  if (made.ok()) image = std::move(made).value();
  return made.status();
}

}  // namespace

namespace {

// Returns the size in which an input is allocated.
Extent target_of(const InputImage& input, const ResolveSettings& settings) {
  if (input.image == &FrameInputs::exposure_image) return {1, 1};
  if (input.viewport == nullptr) return settings.output_extent;
  return input.viewport == &FrameInputs::particle_render_extent ? settings.targets.particle_extent
                                                                : settings.target_extent;
}

}  // namespace

Status HostStream::bring(FrameInputs& inputs, const HostInputs& host) {
  for (std::size_t i = 0; i < std::size(kInputs); ++i) {
    if (host[i].texels == nullptr) continue;
    const InputImage& input = kInputs[i];
    ImageView& view = inputs.*input.image;
    const bool is_kept = std::any_of(
        plan_.buffers.begin(), plan_.buffers.end(),
        [&](const PlannedBuffer& buffer) { return buffer.input == input.image && !is_input(buffer); });
    Image& image = images_[is_kept ? turn_ : 0][i];
    const Extent size = target_of(input, plan_.settings);
    const Extent used = input.viewport != nullptr ? inputs.*input.viewport : size;
    if (Status status = make(device_, image, size, view); !status.ok()) return status;
    view = image.view();
    if (input.viewport != nullptr && plan_.settings.targets.placement == Targets::kPlaced) {
      view.extent = used;
      view.pitch = 0;
    }
    if (Status status = device_.upload(view, used, host[i].texels, host[i].row_bytes); !status.ok())
      return status;
  }
  return {};
}

HostImages::HostImages(const Device& device, const ResolvePlan& plan)
    : device_(device),
      output_(plan.settings.output_extent),
      picture_(device, plan),
      region_(plan.settings.focus.extent) {
  if (const auto region = plan.focus_plan()) focus_.emplace(device, *region);
}

Status HostImages::bring(Frame& frame) {
  if (Status status = picture_.bring(frame.inputs, frame.host_inputs); !status.ok()) return status;
  if (frame.focus) {
    if (Status status = focus_->bring(frame.focus->frame, frame.host_focus); !status.ok()) return status;
    if (frame.host_mask.texels != nullptr) {
      ImageView& mask = frame.focus->mask;
      if (Status status = make(device_, mask_, region_, mask); !status.ok()) return status;
      mask = mask_.view();
      const Status status = device_.upload(mask, region_, frame.host_mask.texels, frame.host_mask.row_bytes);
      if (!status.ok()) return status;
    }
  }
  for (std::size_t i = 0; i < kOutputImages.size(); ++i) {
    if (frame.host_outputs[i].texels == nullptr) continue;
    ImageView& view = frame.outputs.*kOutputImages[i];
    if (Status status = make(device_, outputs_[i], output_, view); !status.ok()) return status;
    view = outputs_[i].view();
  }
  return {};
}

Status HostImages::fetch(const Frame& frame) {
  picture_.advance();
  if (focus_) focus_->advance();
  for (std::size_t i = 0; i < kOutputImages.size(); ++i) {
    const HostMemory& host = frame.host_outputs[i];
    if (host.texels == nullptr) continue;
    const Status status =
        device_.download(frame.outputs.*kOutputImages[i], output_, host.texels, host.row_bytes);
    if (!status.ok()) return status;
  }
  return {};
}

}  // namespace quincunx::c
